/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLocationOutputs.h"

#include <algorithm>
#include <cmath>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/TransformStamped.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_servo/vpPoseSource.h>
#include <visp_vlp/VlpLocation.h>
#include <visualization_msgs/MarkerArray.h>

#include "vpRosMessages.h"

namespace
{
const char *nameOf(vpVlpFilter::State state)
{
  static const char *const names[] = {"starting", "tracking", "coasting", "lost"};
  return names[static_cast<int>(state)];
}
} // namespace

vpLocationOutputs::vpLocationOutputs(ros::NodeHandle &nh, const ros::NodeHandle &own)
    : m_mapFrame(own.param<std::string>("map_frame", "map")),
      m_baseFrame(own.param<std::string>("base_frame", "base_link")),
      m_odomFrame(own.param<std::string>("odom_frame", "")),
      m_location(nh.advertise<geometry_msgs::PoseWithCovarianceStamped>("location", 10)),
      m_whole(nh.advertise<visp_vlp::VlpLocation>("vlp_location", 10)),
      m_lamps(nh.advertise<visualization_msgs::MarkerArray>("lamps", 1, true)),
      m_pathTopic(nh.advertise<nav_msgs::Path>("path", 1, true)),
      m_diagnostics(nh.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 1))
{
}

void vpLocationOutputs::addOdometry(const nav_msgs::Odometry &odom)
{
  if (m_odomFrame.empty()) {
    return;
  }
  if (!m_odometry.empty() && odom.header.stamp <= m_odometry.back().header.stamp) {
    m_odometry.clear();
  }
  m_odometry.push_back(odom);
  while (m_odometry.front().header.stamp + ros::Duration(1) < odom.header.stamp) {
    m_odometry.pop_front();
  }
}

void vpLocationOutputs::publish(const vpVlpLocation &location)
{
  const vpVlpFix &fix = location.fix;
  const geometry_msgs::PoseWithCovarianceStamped pose =
      vpRosMessages::location(fix, location.timestamp, m_mapFrame);
  visp_vlp::VlpLocation whole;
  whole.header = pose.header;
  whole.valid = fix.valid;
  whole.refusal = fix.refusal;
  whole.tracked = location.tracked;
  whole.relocated = location.relocated;
  whole.ambiguous = fix.ambiguous;
  whole.state = nameOf(location.state);
  whole.lamps = fix.lamps;
  whole.pose = pose.pose;
  m_whole.publish(whole);
  if (!fix.valid) {
    ROS_WARN_THROTTLE(1, "no pose: %s", fix.refusal.c_str());
  }
  if (fix.valid && !fix.ambiguous) { // a reader of location has no field that would warn it
    m_location.publish(pose);
    static const size_t longest = 1000; // poses
    m_path.header = pose.header;
    if (m_path.poses.size() >= longest) {
      m_path.poses.erase(m_path.poses.begin());
    }
    m_path.poses.emplace_back();
    m_path.poses.back().header = pose.header;
    m_path.poses.back().pose = pose.pose.pose;
    publishTransform(location);
  }
  const double second = std::floor(location.timestamp);
  if (second != m_second) {
    m_second = second;
    publishLamps(location);
    m_pathTopic.publish(m_path);
    publishDiagnostics(location);
  }
}

std::optional<vpHomogeneousMatrix> vpLocationOutputs::odomMbAt(double time) const
{
  static const double farthest = 0.5; // s, that a sample is carried
  const auto distance = [time](const nav_msgs::Odometry &odom) {
    return std::abs(odom.header.stamp.toSec() - time);
  };
  const auto nearest = std::min_element(
      m_odometry.begin(), m_odometry.end(),
      [&](const nav_msgs::Odometry &a, const nav_msgs::Odometry &b) { return distance(a) < distance(b); });
  if (nearest == m_odometry.end() || distance(*nearest) > farthest) {
    return std::nullopt;
  }
  const vpOdometry sample = vpRosMessages::odometry(*nearest);
  return vpDrivenOn(vpRosMessages::matrix(nearest->pose.pose), {sample.v, sample.w}, time - sample.timestamp);
}

void vpLocationOutputs::publishTransform(const vpVlpLocation &location)
{
  vpHomogeneousMatrix M = location.fix.wMb;
  std::string child = m_baseFrame;
  if (!m_odomFrame.empty()) {
    const std::optional<vpHomogeneousMatrix> odomMb = odomMbAt(location.timestamp);
    if (!odomMb) {
      ROS_WARN_THROTTLE(1, "odom: no sample within 0.5 s of the frame, so that map to %s is not published",
                        m_odomFrame.c_str());
      return;
    }
    M = M * odomMb->inverse();
    child = m_odomFrame;
  }
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ros::Time().fromSec(location.timestamp);
  transform.header.frame_id = m_mapFrame;
  transform.child_frame_id = child;
  transform.transform = vpRosMessages::transform(M);
  m_transforms.sendTransform(transform);
}

void vpLocationOutputs::publishLamps(const vpVlpLocation &location)
{
  visualization_msgs::MarkerArray markers;
  for (const vpLamp &lamp : m_map.lamps) {
    const bool used = std::count(location.fix.lamps.begin(), location.fix.lamps.end(), lamp.id) > 0;
    visualization_msgs::Marker marker;
    marker.header.stamp = ros::Time().fromSec(location.timestamp);
    marker.header.frame_id = m_mapFrame;
    marker.ns = "lamps";
    marker.id = static_cast<int>(markers.markers.size());
    marker.type = lamp.shape == vpLamp::Shape::square ? visualization_msgs::Marker::CUBE
                                                      : visualization_msgs::Marker::CYLINDER;
    marker.pose.position.x = lamp.position.x();
    marker.pose.position.y = lamp.position.y();
    marker.pose.position.z = lamp.position.z();
    marker.pose.orientation.z = std::sin(lamp.yaw / 2);
    marker.pose.orientation.w = std::cos(lamp.yaw / 2);
    marker.scale.x = marker.scale.y =
        std::isfinite(lamp.size) ? lamp.size : 0.15; // m, where nobody measured it
    marker.scale.z = 0.02;
    marker.color.r = marker.color.g = used ? 1 : 0.4f;
    marker.color.b = used ? 0.3f : 0.4f;
    marker.color.a = 1;
    markers.markers.push_back(marker);
    marker.ns = "ids";
    marker.type = visualization_msgs::Marker::TEXT_VIEW_FACING;
    marker.text = lamp.id;
    marker.pose.position.z += 0.12;
    marker.scale.z = 0.1;
    markers.markers.push_back(marker);
  }
  m_lamps.publish(markers);
}

void vpLocationOutputs::publishDiagnostics(const vpVlpLocation &location)
{
  using Status = diagnostic_msgs::DiagnosticStatus;
  const auto value = [](const std::string &key, const std::string &text) {
    diagnostic_msgs::KeyValue pair;
    pair.key = key;
    pair.value = text;
    return pair;
  };
  const vpVlpFix &fix = location.fix;
  Status status;
  status.name = ros::this_node::getName() + ": visible light positioning";
  status.hardware_id = m_baseFrame;
  const bool sure = fix.valid && !fix.ambiguous && !location.relocated;
  status.level = !fix.valid ? Status::ERROR : sure ? Status::OK : Status::WARN;
  status.message = !fix.valid           ? fix.refusal
                   : fix.ambiguous      ? "two poses explain the frame"
                   : location.relocated ? "the robot seems to have been put there; not confirmed yet"
                                        : nameOf(location.state);
  std::string lamps;
  for (const std::string &id : fix.lamps) {
    lamps += (lamps.empty() ? "" : ", ") + id;
  }
  status.values = {value("state", nameOf(location.state)), value("lamps", lamps),
                   value("regions", std::to_string(location.observations.size()))};
  if (fix.valid) {
    status.values.push_back(value("sigma_x_m", std::to_string(std::sqrt(fix.covariance(0, 0)))));
    status.values.push_back(value("sigma_y_m", std::to_string(std::sqrt(fix.covariance(1, 1)))));
    status.values.push_back(value("sigma_yaw_rad", std::to_string(std::sqrt(fix.covariance(5, 5)))));
  }
  diagnostic_msgs::DiagnosticArray array;
  array.header.stamp = ros::Time().fromSec(location.timestamp);
  array.status = {status};
  m_diagnostics.publish(array);
}
