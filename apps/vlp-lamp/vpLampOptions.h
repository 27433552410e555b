/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampOptions_h
#define vpLampOptions_h

#include <string>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! What the command line of vlp-lamp says; a name that is empty was not given.
struct vpLampOptions {
  std::string port; // of the lamp
  std::string map;  // a lamp map
  std::string lamp; // id in it
  bool all = false; // lamps of the map, one after the other
  bool show = false;
  bool listPorts = false;

  //! \return False where the help was asked for and is printed. \throw vpException on bad usage.
  bool parse(int argc, char **argv);
};

END_VISP_NAMESPACE

#endif
