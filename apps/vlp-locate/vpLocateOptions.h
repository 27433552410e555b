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
#include <visp3/vlp_sensor/vpFrameSource.h>

#include "common/vpCameraOptions.h"

BEGIN_VISP_NAMESPACE

//! What the command line of vlp-locate says; a name that is empty was not given.
struct vpLocateOptions {
  std::string rigFile;
  std::string lampsFile;
  std::string run;                // a folder; one of these five is given
  std::string pattern;            // of numbered pictures
  std::vector<std::string> files; // pictures
  std::string video;
  vpCameraOptions camera;
  size_t frames = 0;        // to take at most; 0: all there are
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

  //! \throw vpException where the frames cannot be opened.
  std::unique_ptr<vpFrameSource> openFrames(const vpVlpRig &rig) const;

  //! What the frames were given by, for messages.
  std::string framesName() const;

  //! \throw vpException where \e map can never give what was asked for.
  vpVlpLocalizer localizer(const vpVlpRig &rig, const vpLampMap &map) const;

private:
  void check() const;
};

END_VISP_NAMESPACE

#endif
