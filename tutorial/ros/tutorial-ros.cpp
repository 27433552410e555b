/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
//! \example tutorial-ros.cpp
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <ros/ros.h>

int main(int argc, char **argv)
{
  ros::init(argc, argv, "where");
  ros::NodeHandle nh;
  int left = ros::NodeHandle("~").param("poses", 5);

  const boost::function<void(const geometry_msgs::PoseWithCovarianceStamped &)> tell =
      [&left](const geometry_msgs::PoseWithCovarianceStamped &location) {
        const auto &p = location.pose.pose.position;
        const auto &q = location.pose.pose.orientation;
        const auto &covariance = location.pose.covariance; // 6 x 6, of x, y, z and rotations about x, y, z
        const double yaw = 2 * std::atan2(q.z, q.w);       // rad, of a robot that stands level
        const double sigma = std::sqrt(std::max(covariance[0], covariance[7]));
        std::printf("x %7.4f  y %7.4f m  yaw %6.1f degrees  +/- %.2f mm, %.0f ms old\n", p.x, p.y,
                    yaw * 180 / M_PI, 1000 * sigma,
                    1000 * (ros::Time::now() - location.header.stamp).toSec());
        --left;
      };
  const ros::Subscriber subscriber =
      nh.subscribe<geometry_msgs::PoseWithCovarianceStamped>("location", 1, tell);

  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(20);
  for (ros::WallRate rate(100); ros::ok() && left > 0 && ros::WallTime::now() < end; rate.sleep()) {
    ros::spinOnce();
  }
  return left == 0 ? 0 : 1;
}
