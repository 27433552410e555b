/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What the nodes write where system calls on their files fail: whole or not there, and one error.

#include <filesystem>
#include <functional>
#include <string>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Image.h>
#include <visp3/vlp_core/vpLampMap.h>

#include "common/vpFaultyProcess.h"

namespace
{
const std::string shared = VLP_DATA_DIR;

//! A recording of two small grey pictures.
void record(const std::string &file)
{
  rosbag::Bag bag(file, rosbag::bagmode::Write);
  for (int k = 0; k < 2; ++k) {
    sensor_msgs::Image image;
    image.header.stamp = ros::Time(100 + k);
    image.width = image.step = 40;
    image.height = 30;
    image.encoding = "mono8";
    image.data.assign(image.step * image.height, 7);
    bag.write("/camera/image", image.header.stamp, image);
  }
}

size_t filesIn(const std::string &folder)
{
  const std::filesystem::directory_iterator all(folder);
  return static_cast<size_t>(std::distance(begin(all), end(all)));
}
} // namespace

TEST(RosWriters, ARecordingBecomesAWholeRunOrNone)
{
  const vpTemporaryFolder folder;
  record(folder / "drive.bag");
  for (const std::string call : {"open", "write", "close", "rename", "mkdir"}) {
    bool hit = true;
    for (int at = 1; at < 10 && hit; ++at) {
      const vpFault fault{call, "ENOSPC", std::to_string(at)};
      SCOPED_TRACE(testing::PrintToString(fault));
      const vpTemporaryFolder out;
      const vpEnding ending = vpRunWith(fault, out.path(), "bag_to_run",
                                        {folder / "drive.bag", "--rig", shared + "/rigs/ub300-800x600.yaml",
                                         "--lamps", shared + "/paper-room/lamps.yaml", "--out", out / "run"});
      hit = ending.hit;
      EXPECT_TRUE(hit || at > 1) << call << " was not called";
      EXPECT_EQ(ending.code, hit ? 2 : 0) << ending.err;
      EXPECT_EQ(filesIn(out.path()), hit ? 0u : 1u);
      if (hit) {
        EXPECT_EQ(ending.err.rfind("bag_to_run: error: " + out.path(), 0), 0u) << ending.err;
        EXPECT_EQ(std::count(ending.err.begin(), ending.err.end(), '\n'), 1) << ending.err;
      } else {
        EXPECT_EQ(filesIn(out / "run"), 6u); // two pictures, their list, rig, camera, lamps
      }
    }
  }
}

TEST(RosWriters, AFloorPlanThatCannotBeWrittenIsAnErrorAndTheNodeLives)
{
  const auto within = [](double seconds, const std::function<bool()> &done) {
    for (int k = 0; k < 100 * seconds && !done(); ++k) {
      usleep(10000);
    }
    return done();
  };
  for (const std::string call : {"open", "write", "close", "rename"}) {
    SCOPED_TRACE(call);
    const vpTemporaryFolder folder;
    const std::string lamps = folder / "lamps.yaml", floor = folder / "floor";
    const vpLampMap map = vpLampMap::load(shared + "/paper-room/lamps.yaml");
    map.save(lamps);
    const vpFaultyCalls calls({call, "ENOSPC", "1"}, floor);
    vpProcess node("lamp_map", {"__ns:=/" + call, "_lamps:=" + lamps, "_floor_plan:=" + floor});
    EXPECT_TRUE(within(20, [&] { return node.err().find(floor + ".pgm") != std::string::npos; }))
        << node.err();
    EXPECT_TRUE(calls.hit());
    EXPECT_EQ(folder.count(), 1u) << "a part of a plan is left";
    map.save(lamps); // is new to the node
    EXPECT_TRUE(within(5, [&] { return std::filesystem::exists(floor + ".yaml"); })) << node.err();
    EXPECT_EQ(folder.count(), 3u);
  }
}
