/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// One lamp map for all robots of a master: /lamp_map and /floor_plan, latched, and again each time that its
// file changes.

#include <filesystem>

#include <std_msgs/String.h>
#include <visp3/vlp_core/vpReadFile.h>

#include "vpFloorPlan.h"
#include "vpRosNode.h"

namespace
{
void run()
{
  ros::NodeHandle nh, own("~");
  const std::string file = vpRequiredParameter(own, "lamps", "the name of a lamps.yaml");
  const std::string frameId = own.param<std::string>("map_frame", "map"),
                    prefix = own.param<std::string>("floor_plan", "");
  ros::Publisher topic = nh.advertise<std_msgs::String>("/lamp_map", 1, true),
                 floor = nh.advertise<nav_msgs::OccupancyGrid>("/floor_plan", 1, true);
  std::filesystem::file_time_type written;
  for (ros::Rate rate(2); ros::ok(); rate.sleep()) {
    std::error_code gone; // between two versions
    const auto now = std::filesystem::last_write_time(file, gone);
    if (!gone && now != written) {
      written = now;
      vpHandle([&] {
        const vpFloorPlan plan(vpLampMap::load(file)); // a file with a mistake goes to nobody
        std_msgs::String text;
        text.data = vpReadFile(file);
        topic.publish(text);
        floor.publish(plan.grid(frameId));
        if (!prefix.empty()) {
          plan.save(prefix);
        }
      });
    }
    ros::spinOnce();
  }
}
} // namespace

int main(int argc, char **argv)
{
  return vpRunNode(argc, argv, "lamp_map", run);
}
