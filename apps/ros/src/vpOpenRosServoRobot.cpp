/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/core/vpException.h>

#include "vpRosServoRobot.h"

//! For vpServoRobot::openRos().
extern "C" vpServoRobot *vpOpenRosServoRobot(const char *nameSpace)
{
  ros::init(ros::M_string(), "vlp_servo",
            ros::init_options::NoSigintHandler | ros::init_options::AnonymousName);
  if (!ros::master::check()) {
    throw vpException(vpException::ioError, "no ROS master at " + ros::master::getURI() +
                                                ", expected roscore or roslaunch to run there");
  }
  return new vpRosServoRobot(ros::NodeHandle(nameSpace), {vpRosServoRobot::mostV, vpRosServoRobot::mostW});
}
