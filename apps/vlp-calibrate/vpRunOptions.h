/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpRunOptions_h
#define vpRunOptions_h

#include <string>
#include <vector>

#include <visp3/vlp_calibration/vpLampBundle.h>

#include "common/vpFrameOptions.h"

BEGIN_VISP_NAMESPACE

//! What `mount` and `lamps` are told alike: the drive, and what is known of rig and lamps.
struct vpRunOptions {
  vpFrameOptions frames;
  std::string rig, lamps, odometry, motion = "wheels", places, turnFrom = "wheels", separation;
  std::vector<std::string> fixed, priors;
  std::string out;

  void add(CLI::App &app);

  //! Fills in defaults. \throw vpException (badValue) with one line that names the option.
  void finish();

  //! Looks at all frames. \throw vpException with one line where a file is bad.
  std::vector<vpLampRun> read(const vpVlpRig &rig, const vpLampMap &map) const;

  //! What --fix, --prior and --turn-from say.
  void apply(vpLampBundle &bundle) const;
};

//! Finite number above 0 that an option takes. \throw vpException (badValue) that names it.
double vpPositiveOption(const std::string &option, const std::string &text);

END_VISP_NAMESPACE

#endif
