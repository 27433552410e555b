/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpServoRobot_h
#define vpServoRobot_h

#include <memory>
#include <string>

#include <visp3/vlp_robot/vpMobileBase.h>
#include <visp3/vlp_servo/vpPoseSource.h>
#include <visp3/vlp_servo/vpServoClock.h>

BEGIN_VISP_NAMESPACE

/*!
  What a vpServoLoop needs of a robot whose poses come from elsewhere, as from the nodes of apps/ros.
*/
class VISP_EXPORT vpServoRobot
{
public:
  virtual ~vpServoRobot() = default;

  virtual vpMobileBase &base() = 0;
  virtual vpServoClock &clock() = 0;
  //! The robot's pose as it is told; lives no longer than this.
  virtual std::unique_ptr<vpPoseSource> poses() = 0;

  /*!
    Opens a robot on ROS, for programs that stand on no ROS: libvlp_servo_ros.so has it, which apps/ros
    builds. The loader finds it where `source setup.bash` has set LD_LIBRARY_PATH.

    \param nameSpace Of the robot's topics cmd_vel, odom and vlp_location, as "/robot1".

    \throw vpException (ioError) where there is no such library, no ROS master, or no odometry for ten
    seconds.
  */
  static std::unique_ptr<vpServoRobot> openRos(const std::string &nameSpace);
};

END_VISP_NAMESPACE

#endif
