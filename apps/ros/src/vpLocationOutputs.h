/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLocationOutputs_h
#define vpLocationOutputs_h

#include <deque>
#include <optional>
#include <string>

#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>

/*!
  What a node that locates gives to ROS:

  | name | type | what |
  |---|---|---|
  | `location` | geometry_msgs/PoseWithCovarianceStamped | the base in the map, at the frame's stamp |
  | `vlp_location` | visp_vlp/VlpLocation | the same of each frame, with the reason where there is no pose |
  | `lamps` | visualization_msgs/MarkerArray | the map's lamps, those in use bright; once a second |
  | `path` | nav_msgs/Path | the latest 1000 of `location`; once a second |
  | `/tf` | | map to base; with the private parameter `odom_frame`, map to that frame |
  | `/diagnostics` | diagnostic_msgs/DiagnosticArray | state, lamps, standard deviation; once a second |

  Frames by private parameters: `map_frame` (map), `base_frame` (base_link), `odom_frame` (none).
*/
class vpLocationOutputs
{
public:
  vpLocationOutputs(ros::NodeHandle &nh, const ros::NodeHandle &own);

  void setMap(const vpLampMap &map) { m_map = map; }

  //! For map to odom: where the odometry has the base. It may come before or after the frames.
  void addOdometry(const nav_msgs::Odometry &odom);
  void publish(const vpVlpLocation &location);

private:
  void publishTransform(const vpVlpLocation &location);
  void publishLamps(const vpVlpLocation &location);
  void publishDiagnostics(const vpVlpLocation &location);
  std::optional<vpHomogeneousMatrix> odomMbAt(double time) const;

  vpLampMap m_map;
  std::string m_mapFrame, m_baseFrame, m_odomFrame;
  ros::Publisher m_location, m_whole, m_lamps, m_pathTopic, m_diagnostics;
  tf2_ros::TransformBroadcaster m_transforms;
  std::deque<nav_msgs::Odometry> m_odometry; // of the last second
  nav_msgs::Path m_path;
  double m_second = -1; // in which lamps and diagnostics were published last
};

#endif
