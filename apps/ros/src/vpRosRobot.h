/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpRosRobot_h
#define vpRosRobot_h

#include <deque>
#include <mutex>
#include <vector>

#include <geometry_msgs/Twist.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <visp3/vlp_robot/vpMobileBase.h>
#include <visp3/vlp_servo/vpPoseSource.h>
#include <visp_vlp/VlpLocation.h>

//! A base behind `cmd_vel` and `odom`.
class vpRosBase : public vpMobileBase
{
public:
  double deadline = 0.5; // s, that the newest sample of odom may be old

  vpRosBase(ros::NodeHandle &nh, const vpBaseLimits &limits);
  ~vpRosBase() override { vpRosBase::stop(); }

  vpBaseVelocity setVelocity(double v, double w) override;
  void stop() override { m_commands.publish(geometry_msgs::Twist()); }
  vpOdometry odometry() override;
  vpBaseLimits limits() const override { return m_limits; }

private:
  void move(const nav_msgs::OdometryConstPtr &odom);

  vpBaseLimits m_limits;
  ros::Publisher m_commands;
  ros::Subscriber m_odom;
  std::mutex m_mutex;
  vpOdometry m_newest;
};

//! Poses of `vlp_location`, carried on by the odometry since.
class vpRosPose : public vpPoseSource
{
public:
  double odometryShare =
      0.05; // of the way and turn since the pose, standard deviation of uncalibrated odometry

  explicit vpRosPose(ros::NodeHandle &nh);

  void addOdometry(const vpOdometry &sample) override;
  std::vector<vpLocatedPicture> look(double now) override;
  bool needsPictures() const override { return true; }
  vpVlpFix at(double time) const override;

private:
  void locate(const visp_vlp::VlpLocationConstPtr &location);

  ros::Subscriber m_locations;
  std::mutex m_mutex; // of m_new
  std::vector<vpLocatedPicture> m_new;
  vpLocatedPicture m_last;
  bool m_any = false;
  std::deque<vpOdometry> m_odometry; // of the last seconds
};

#endif
