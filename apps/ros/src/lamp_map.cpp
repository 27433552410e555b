/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// One lamp map for all robots of a master: /lamp_map, latched, and again each time that its file changes.

#include <filesystem>

#include <std_msgs/String.h>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpReadFile.h>

#include "vpRosNode.h"

namespace
{
void run()
{
  ros::NodeHandle nh, own("~");
  const std::string file = vpRequiredParameter(own, "lamps", "the name of a lamps.yaml");
  ros::Publisher topic = nh.advertise<std_msgs::String>("/lamp_map", 1, true);
  std::filesystem::file_time_type written;
  for (ros::Rate rate(2); ros::ok(); rate.sleep()) {
    std::error_code gone; // between two versions
    const auto now = std::filesystem::last_write_time(file, gone);
    if (!gone && now != written) {
      written = now;
      vpHandle([&] {
        vpLampMap::load(file); // a file with a mistake goes to nobody
        std_msgs::String text;
        text.data = vpReadFile(file);
        topic.publish(text);
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
