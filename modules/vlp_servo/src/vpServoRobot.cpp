/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_servo/vpServoRobot.h>

#include <dlfcn.h>

#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

std::unique_ptr<vpServoRobot> vpServoRobot::openRos(const std::string &nameSpace)
{
  const char *const name = "libvlp_servo_ros.so", *const opens = "vpOpenRosServoRobot";
  void *const library = dlopen(name, RTLD_NOW | RTLD_GLOBAL); // stays: ROS has threads of its own
  void *const found = library != nullptr ? dlsym(library, opens) : nullptr;
  if (found == nullptr) {
    throw vpException(vpException::ioError, std::string(name) +
                                                ": cannot be loaded, expected the ROS package visp_vlp "
                                                "(apps/ros) to be built and its setup.bash to be sourced");
  }
  const auto open = reinterpret_cast<vpServoRobot *(*)(const char *)>(found);
  return std::unique_ptr<vpServoRobot>(open(nameSpace.c_str()));
}

END_VISP_NAMESPACE
