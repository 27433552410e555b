/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpRosServoRobot.h"

#include <visp3/core/vpException.h>

vpRosServoRobot::vpRosServoRobot(const ros::NodeHandle &nh, const vpBaseLimits &limits, double patience)
    : m_nh(nh), m_base(m_nh, limits)
{
  m_spinner.start();
  for (const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(patience); ros::ok();) {
    try {
      m_base.odometry();
      return;
    } catch (const vpException &) {
      if (ros::WallTime::now() > end) {
        throw vpException(vpException::ioError, m_nh.resolveName("odom") + ": no sample for " +
                                                    std::to_string(static_cast<int>(patience)) +
                                                    " s, expected a robot's driver to publish it");
      }
      ros::WallDuration(0.05).sleep();
    }
  }
}
