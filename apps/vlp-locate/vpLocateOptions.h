/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLocateOptions_h
#define vpLocateOptions_h

#include <memory>
#include <string>
#include <vector>

#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include "common/vpFrameOptions.h"

BEGIN_VISP_NAMESPACE

//! What the command line of vlp-locate says; a name that is empty was not given.
struct vpLocateOptions {
  std::string rigFile;
  std::string lampsFile;
  vpFrameOptions frames;
  bool listCameras = false; // and nothing else
  std::string odometry;     // of the robot, a file
  bool noTrack = false;     // each frame by itself
  bool freeAttitude = false;
  bool twoLamps = false; // the paper's solver
  std::string poses;     // outputs
  std::string fixes;
  std::string seen;
  std::string overlay; // a folder
  bool display = false;

  //! \return False where the help was asked for and is printed. \throw vpException on bad usage.
  bool parse(int argc, char **argv);

  //! Nothing else was asked for, so the poses go to stdout.
  bool posesToStdout() const
  {
    return poses.empty() && fixes.empty() && seen.empty() && overlay.empty() && !display;
  }

  //! \throw vpException where \e map can never give what was asked for.
  vpVlpLocalizer localizer(const vpVlpRig &rig, const vpLampMap &map) const;

private:
  void check() const;
};

END_VISP_NAMESPACE

#endif
