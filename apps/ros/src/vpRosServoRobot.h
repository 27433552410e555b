/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpRosServoRobot_h
#define vpRosServoRobot_h

#include <visp3/vlp_servo/vpServoRobot.h>

#include "vpRosRobot.h"

//! A robot behind `cmd_vel`, `odom` and `vlp_location`, on the clock of ROS, which may be simulated.
class vpRosServoRobot : public vpServoRobot
{
public:
  static constexpr double mostV = 0.22, mostW = 2.84; // m/s, rad/s; a TurtleBot3 Burger's

  /*!
    \param patience s, that the first sample of odom may take. \throw vpException (ioError) where none comes.
  */
  vpRosServoRobot(const ros::NodeHandle &nh, const vpBaseLimits &limits, double patience = 10);

  vpMobileBase &base() override { return m_base; }
  vpServoClock &clock() override { return m_clock; }
  std::unique_ptr<vpPoseSource> poses() override { return std::make_unique<vpRosPose>(m_nh); }

private:
  class Clock : public vpServoClock
  {
  public:
    double period() const override { return m_period; }
    double next() override
    {
      m_rate.sleep();
      return now();
    }
    double now() override { return ros::Time::now().toSec(); }

  private:
    double m_period = 0.02; // s
    ros::Rate m_rate{1 / m_period};
  };

  ros::NodeHandle m_nh;
  vpRosBase m_base;
  Clock m_clock;
  ros::AsyncSpinner m_spinner{1};
};

#endif
