/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpRosRobot.h"

#include <cmath>

#include <visp3/core/vpException.h>
#include <visp3/core/vpMath.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "vpRosMessages.h"
#include "vpRosNode.h"

vpRosBase::vpRosBase(ros::NodeHandle &nh, const vpBaseLimits &limits)
    : m_limits(limits), m_commands(nh.advertise<geometry_msgs::Twist>("cmd_vel", 1)),
      m_odom(nh.subscribe("odom", 100, &vpRosBase::move, this, ros::TransportHints().tcpNoDelay()))
{
}

vpBaseVelocity vpRosBase::setVelocity(double v, double w)
{
  const vpBaseVelocity told = m_limits.saturated({v, w});
  geometry_msgs::Twist twist;
  twist.linear.x = told.v;
  twist.angular.z = told.w;
  m_commands.publish(twist);
  return told;
}

vpOdometry vpRosBase::odometry()
{
  const std::lock_guard<std::mutex> lock(m_mutex);
  if (ros::Time::now().toSec() - m_newest.timestamp > deadline) {
    throw vpException(vpException::ioError, "odom: no sample for " + vpNumberText(deadline) + " s");
  }
  return m_newest;
}

void vpRosBase::move(const nav_msgs::OdometryConstPtr &odom)
{
  vpHandle([&] {
    const vpOdometry sample = vpRosMessages::odometry(*odom);
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_newest = sample;
  });
}

vpRosPose::vpRosPose(ros::NodeHandle &nh)
    : m_locations(
          nh.subscribe("vlp_location", 10, &vpRosPose::locate, this, ros::TransportHints().tcpNoDelay()))
{
}

void vpRosPose::locate(const visp_vlp::VlpLocationConstPtr &location)
{
  vpHandle([&] {
    vpLocatedPicture picture;
    picture.timestamp = location->header.stamp.toSec();
    picture.known = ros::Time::now().toSec();
    vpVlpLocation &where = picture.location;
    where.timestamp = picture.timestamp;
    where.tracked = location->tracked;
    where.relocated = location->relocated;
    where.fix.valid = location->valid;
    where.fix.refusal = location->refusal;
    where.fix.ambiguous = location->ambiguous;
    where.fix.lamps = location->lamps;
    if (location->valid) {
      where.fix.wMb = vpRosMessages::matrix(location->pose.pose);
      for (int i = 0; i < 36; ++i) {
        where.fix.covariance(i / 6, i % 6) = location->pose.covariance[static_cast<size_t>(i)];
      }
    }
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_new.push_back(picture);
  });
}

void vpRosPose::addOdometry(const vpOdometry &sample)
{
  static const double longest = 3; // s, that a picture may be old
  m_odometry.push_back(sample);
  while (m_odometry.front().timestamp < sample.timestamp - longest) {
    m_odometry.pop_front();
  }
}

std::vector<vpLocatedPicture> vpRosPose::look(double /*now*/)
{
  std::vector<vpLocatedPicture> pictures;
  {
    const std::lock_guard<std::mutex> lock(m_mutex);
    pictures.swap(m_new);
  }
  for (const vpLocatedPicture &picture : pictures) {
    if (picture.location.fix.valid) {
      m_last = picture;
      m_any = true;
    }
  }
  return pictures;
}

vpVlpFix vpRosPose::at(double time) const
{
  vpVlpFix fix = m_last.location.fix;
  if (!m_any) {
    fix.valid = false;
    fix.refusal = "no pose yet";
    return fix;
  }
  vpOdometryPose carried(fix.wMb, m_last.timestamp);
  double at = m_last.timestamp, way = 0, turn = 0; // s, m, rad
  for (const vpOdometry &sample : m_odometry) {
    if (sample.timestamp > at) {
      carried.addOdometry(sample);
      way += std::abs(sample.v) * (sample.timestamp - at);
      turn += std::abs(sample.w) * (sample.timestamp - at);
      at = sample.timestamp;
    }
  }
  fix.wMb = carried.at(time).wMb;
  fix.covariance.diagonal().head<2>().array() += vpMath::sqr(odometryShare * way);
  fix.covariance(5, 5) += vpMath::sqr(odometryShare * turn);
  return fix;
}
