/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpServoOptions_h
#define vpVlpServoOptions_h

#include <cstdint>
#include <optional>
#include <string>

#include <visp3/vlp_servo/vpServoLoop.h>
#include <visp3/vlp_servo/vpServoSimulation.h>

#include "common/vpCameraOptions.h"

BEGIN_VISP_NAMESPACE

//! What the command line of vlp-servo says; a name that is empty was not given.
struct vpVlpServoOptions {
  enum class Pose { lamps, odometry, commands };

  bool listRobots = false; // and end; the rest is not asked for
  std::string robot;       // sim, opencr:usb, opencr:DEVICE, ros:NAMESPACE
  std::string scenario;    // of sim, a file
  std::uint64_t seed = 1;
  bool typical = false;    // rig errors as vpScenario::useTypicalRig() draws them
  bool wheelsOnly = false; // the turn rate of sim's odometry is that of the wheels
  bool realTime = false;   // sim on the host's clock
  double latency = 0.02;   // s, of sim's localizer
  std::string rigFile;
  std::string lampsFile;
  vpCameraOptions camera; // of a real robot
  std::string pathFile;
  Pose pose = Pose::lamps;
  std::optional<vpServoStart> start; // where the robot stands at first; default: at the start of the path
  std::string log;                   // a folder
  bool display = false;
  vpServoLoopSettings loop;

  //! \return False where the help was asked for and is printed. \throw vpException on bad usage.
  bool parse(int argc, char **argv);

  //! Whether robot is behind topics of ROS.
  bool onRos() const { return robot.rfind("ros:", 0) == 0; }

  //! start, or that of \e path.
  vpServoStart startOn(const vpPath &path) const;

private:
  void check() const;
};

END_VISP_NAMESPACE

#endif
