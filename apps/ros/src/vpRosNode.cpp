/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpRosNode.h"

#include <exception>

#include <visp3/core/vpException.h>

int vpRunNode(int argc, char **argv, const std::string &name, const std::function<void()> &run)
{
  ros::init(argc, argv, name);
  const ros::NodeHandle alive; // the log ends with the last one
  try {
    run();
    return 0;
  } catch (const std::exception &error) { // vpException, too
    ROS_FATAL("%s", error.what());
    return 2;
  }
}

void vpHandle(const std::function<void()> &handle)
{
  try {
    handle();
  } catch (const std::exception &error) {
    ROS_ERROR_THROTTLE(1, "%s", error.what());
  }
}

std::string vpRequiredParameter(const ros::NodeHandle &own, const std::string &name,
                                const std::string &expected)
{
  std::string value;
  if (!own.getParam(name, value) || value.empty()) {
    throw vpException(vpException::badValue, own.resolveName(name) + ": missing, expected " + expected);
  }
  return value;
}

vpVlpRig vpRigParameter(const ros::NodeHandle &own)
{
  return vpVlpRig::load(vpRequiredParameter(own, "rig", "the name of a rig.yaml"));
}
