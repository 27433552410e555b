/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampMapSource_h
#define vpLampMapSource_h

#include <functional>

#include <ros/ros.h>
#include <std_msgs/String.h>
#include <visp3/vlp_core/vpLampMap.h>

/*!
  A node's lamp map: the file of its private parameter `lamps`; without one, what the latched topic
  `/lamp_map` has, a lamps.yaml as text, and each time that it changes. A text that is no lamp map is an error
  line of the log, and the map before it stays.
*/
class vpLampMapSource
{
public:
  using Use = std::function<void(const vpLampMap &)>;

  //! Calls \e use before it returns where there is a file. \throw vpException as vpLampMap::load().
  vpLampMapSource(ros::NodeHandle &nh, const ros::NodeHandle &own, const Use &use);

private:
  void read(const std_msgs::StringConstPtr &text) const;

  Use m_use;
  ros::Subscriber m_topic;
};

#endif
