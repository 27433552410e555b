/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The nodes of apps/ros as separate processes about one master, which with-master.sh starts.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/Twist.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Image.h>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_robot/vpOdometry.h>
#include <visp3/vlp_sensor/vpPictureSequence.h>
#include <visp_vlp/GetImage.h>
#include <visp_vlp/LampObservations.h>
#include <visp_vlp/LedInfo.h>
#include <visp_vlp/VlpLocation.h>

#include "common/vpProcess.h"

namespace
{
const std::string data = VLP_DATA_DIR, rig = data + "/rigs/ub300-800x600.yaml",
                  lamps = data + "/lamps/paper.yaml";

double now()
{
  return ros::Time::now().toSec();
}

//! Lets callbacks run until \e done, or for so many seconds. \return Whether it was done.
bool spinUntil(const std::function<bool()> &done, double seconds)
{
  const double begin = now();
  while (!done() && now() - begin < seconds) {
    ros::spinOnce();
    ros::Duration(0.005).sleep();
  }
  return done();
}

//! A robot and its nodes, all in one namespace.
class Robot
{
public:
  explicit Robot(const std::string &name) : m_name(name)
  {
    for (const std::string node : {"simulator", "CamKF", "ID_recognition", "vlc_locator"}) {
      startNode(node);
    }
  }

  void startNode(const std::string &node)
  {
    start(node, node == "simulator" ? std::vector<std::string>{"_scenario:=" + data + "/scenarios/servo.yaml",
                                                               "_start_x:=-0.35"}
                                    : std::vector<std::string>{"_rig:=" + rig, "_lamps:=" + lamps});
  }

  void start(const std::string &node, std::vector<std::string> arguments, const std::string &as = "")
  {
    arguments.push_back("__ns:=/" + m_name);
    m_nodes[as.empty() ? node : as] = std::make_unique<vpProcess>(node, arguments);
  }
  void kill(const std::string &node) { m_nodes.erase(node); } // by SIGKILL
  vpProcess &node(const std::string &name) { return *m_nodes.at(name); }

private:
  std::string m_name;
  std::map<std::string, std::unique_ptr<vpProcess>> m_nodes;
};

//! What a robot's topics said.
class Listener
{
public:
  struct Place {
    double stamp, heard, x, y; // s, s, m, m
  };
  std::vector<Place> truth, location, inOne;
  std::vector<Place> commands; // x: m/s

  explicit Listener(const std::string &robot)
  {
    m_subscribers = {
        m_nh.subscribe<geometry_msgs::PoseStamped>("/" + robot + "/ground_truth", 1000,
                                                   [this](const geometry_msgs::PoseStampedConstPtr &pose) {
                                                     truth.push_back({pose->header.stamp.toSec(), now(),
                                                                      pose->pose.position.x,
                                                                      pose->pose.position.y});
                                                   }),
        m_nh.subscribe<geometry_msgs::PoseWithCovarianceStamped>(
            "/" + robot + "/location", 1000,
            [this](const geometry_msgs::PoseWithCovarianceStampedConstPtr &pose) { add(*pose, location); }),
        m_nh.subscribe<geometry_msgs::PoseWithCovarianceStamped>(
            "/" + robot + "/one/location", 1000,
            [this](const geometry_msgs::PoseWithCovarianceStampedConstPtr &pose) { add(*pose, inOne); }),
        m_nh.subscribe<geometry_msgs::Twist>("/" + robot + "/cmd_vel", 1000,
                                             [this](const geometry_msgs::TwistConstPtr &twist) {
                                               commands.push_back({now(), now(), twist->linear.x, 0});
                                             })};
  }

  //! m, distance from the truth, of those whose frame was taken from \e begin (s) on.
  std::vector<double> errors(const std::vector<Place> &places, double begin) const
  {
    std::vector<double> errors;
    for (const Place &place : places) {
      const auto after = std::lower_bound(truth.begin(), truth.end(), place.stamp,
                                          [](const Place &each, double time) { return each.stamp < time; });
      if (place.stamp < begin || after == truth.begin() || after == truth.end()) {
        continue;
      }
      const auto before = std::prev(after);
      const double share = (place.stamp - before->stamp) / (after->stamp - before->stamp);
      errors.push_back(std::hypot(before->x + share * (after->x - before->x) - place.x,
                                  before->y + share * (after->y - before->y) - place.y));
    }
    return errors;
  }

private:
  static void add(const geometry_msgs::PoseWithCovarianceStamped &pose, std::vector<Place> &to)
  {
    to.push_back({pose.header.stamp.toSec(), now(), pose.pose.pose.position.x, pose.pose.pose.position.y});
  }

  ros::NodeHandle m_nh;
  std::vector<ros::Subscriber> m_subscribers;
};

double rms(const std::vector<double> &values)
{
  double sum = 0;
  for (double value : values) {
    sum += value * value;
  }
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double quantile(std::vector<double> values, double share)
{
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<size_t>(share * static_cast<double>(values.size())))];
}

// The same pictures go through four nodes and through one: their errors along line A are alike.
TEST(RosNodes, DriveLineAAsInOneProcess)
{
  Robot robot("drive");
  robot.start("vlp", {"_rig:=" + rig, "_lamps:=" + lamps, "_base_frame:=one", "location:=one/location",
                      "vlp_location:=one/vlp_location", "lamps:=one/lamps"});
  Listener heard("drive");
  ASSERT_TRUE(spinUntil([&] { return heard.location.size() > 10 && heard.inOne.size() > 10; }, 20));
  const double begin = now();
  robot.start("vlp_servo", {"_path:=" + data + "/paths/line-a.yaml", "_speed:=0.1"});
  ASSERT_TRUE(spinUntil([&] { return robot.node("vlp_servo").ended(); }, 30));
  EXPECT_EQ(robot.node("vlp_servo").wait(), 0) << robot.node("vlp_servo").err();
  spinUntil([] { return false; }, 0.3);

  EXPECT_NEAR(heard.truth.back().x, 0.35, 0.005);
  EXPECT_NEAR(heard.truth.back().y, -0.005, 0.005);
  ASSERT_FALSE(heard.commands.empty());
  EXPECT_EQ(heard.commands.back().x, 0);
  const std::vector<double> four = heard.errors(heard.location, begin),
                            one = heard.errors(heard.inOne, begin);
  ASSERT_GT(four.size(), 60u); // 7 s at 12 Hz
  ASSERT_GT(one.size(), 60u);
  EXPECT_LT(rms(four), 0.001);
  EXPECT_LT(rms(four), 1.1 * rms(one) + 5e-6); // 5 um: the truth between two samples
  std::vector<double> latency;
  for (const Listener::Place &place : heard.location) {
    latency.push_back(place.heard - place.stamp);
  }
  std::cout << "four nodes: " << four.size() << " poses, error rms " << 1e3 * rms(four) << " mm, 95 % "
            << 1e3 * quantile(four, 0.95) << " mm; one process: " << one.size() << " poses, rms "
            << 1e3 * rms(one) << " mm; from the first line's exposure to the message: median "
            << 1e3 * quantile(latency, 0.5) << " ms, 95 % " << 1e3 * quantile(latency, 0.95) << " ms\n";
}

// Pictures as JPEG, and without loss, to a second localizer: what compression costs.
TEST(RosNodes, CompressedPicturesDoAsWell)
{
  for (const int quality : {90, 0}) {
    SCOPED_TRACE(quality);
    const std::string name = "quality" + std::to_string(quality);
    Robot robot(name);
    robot.kill("simulator");
    robot.start("simulator", {"_scenario:=" + data + "/scenarios/servo.yaml", "_start_x:=-0.35",
                              "_jpeg_quality:=" + std::to_string(quality)});
    robot.start("vlp",
                {"_rig:=" + rig, "_lamps:=" + lamps, "_image_transport:=compressed", "_base_frame:=one",
                 "location:=one/location", "vlp_location:=one/vlp_location", "lamps:=one/lamps"});
    Listener heard(name);
    ASSERT_TRUE(spinUntil([&] { return heard.location.size() > 30 && heard.inOne.size() > 30; }, 30));
    const std::vector<double> raw = heard.errors(heard.location, 0),
                              compressed = heard.errors(heard.inOne, 0);
    EXPECT_LT(rms(compressed), quality == 0 ? 1.1 * rms(raw) + 5e-6 : 0.001);
    std::cout << (quality == 0 ? "PNG" : "JPEG") << ": error rms " << 1e3 * rms(compressed)
              << " mm, of raw pictures " << 1e3 * rms(raw) << " mm\n";
  }
}

// A pose within two seconds after the node's start.
void expectPosesAgain(Robot &robot, const std::string &node, const std::vector<Listener::Place> &location)
{
  const size_t poses = location.size();
  robot.startNode(node);
  const double begin = now();
  ASSERT_TRUE(spinUntil([&] { return location.size() > poses; }, 2));
  std::cout << node << ": a pose again " << now() - begin << " s after its start\n";
}

// Each node is killed in the middle of a drive and started again: the robot stands, poses come back, it goes
// on.
TEST(RosNodes, ANodeThatIsKilledComesBack)
{
  Robot robot("killed");
  Listener heard("killed");
  ASSERT_TRUE(spinUntil([&] { return heard.location.size() > 10; }, 20));
  robot.start("vlp_servo", {"_path:=" + data + "/paths/line-a.yaml", "_speed:=0.05"});
  for (const std::string node : {"vlc_locator", "CamKF", "ID_recognition"}) {
    SCOPED_TRACE(node);
    ASSERT_TRUE(spinUntil([&] { return !heard.commands.empty() && heard.commands.back().x > 0.03; }, 20));
    robot.kill(node);
    if (node != "ID_recognition") { // without which lamps that are followed keep their names
      ASSERT_TRUE(spinUntil([&] { return heard.commands.back().x == 0; }, 2)) << "it drives on";
    }
    spinUntil([] { return false; }, 0.5);
    expectPosesAgain(robot, node, heard.location);
  }
  ASSERT_TRUE(spinUntil([&] { return robot.node("vlp_servo").ended(); }, 40));
  EXPECT_EQ(robot.node("vlp_servo").wait(), 0) << robot.node("vlp_servo").err();
  EXPECT_LT(quantile(heard.errors(heard.location, 0), 1), 0.005);
}

TEST(RosNodes, ARobotWhoseCameraDiesStands)
{
  Robot robot("blind");
  Listener heard("blind");
  ASSERT_TRUE(spinUntil([&] { return heard.location.size() > 10; }, 20));
  robot.start("vlp_servo", {"_path:=" + data + "/paths/line-a.yaml", "_speed:=0.05"});
  ASSERT_TRUE(spinUntil([&] { return !heard.commands.empty() && heard.commands.back().x > 0.03; }, 20));
  robot.kill("simulator");
  ASSERT_TRUE(spinUntil([&] { return heard.commands.back().x == 0; }, 2)) << "it drives on";
  expectPosesAgain(robot, "simulator", heard.location);
  EXPECT_NEAR(heard.location.back().x, -0.35, 0.01); // where its world begins, not where it was
}

TEST(RosNodes, BadMessagesAreOneClearLine)
{
  ros::NodeHandle nh;
  vpProcess tracker("CamKF", {"__ns:=/bad", "_rig:=" + rig}),
      locator("vlc_locator", {"__ns:=/bad", "_rig:=" + rig, "_lamps:=" + lamps});
  ros::Publisher images = nh.advertise<sensor_msgs::Image>("/bad/camera/image", 1),
                 seen = nh.advertise<visp_vlp::LampObservations>("/bad/lamp_observations", 1);
  ASSERT_TRUE(spinUntil([&] { return images.getNumSubscribers() > 0 && seen.getNumSubscribers() > 0; }, 10));
  const auto expectLine = [](const vpProcess &node, const auto &publish, const std::string &line) {
    double last = 0;
    EXPECT_TRUE(spinUntil(
        [&] {
          if (now() - last > 0.3) {
            last = now();
            publish();
          }
          return node.err().find(line) != std::string::npos;
        },
        5))
        << line << "\n"
        << node.err();
  };
  sensor_msgs::Image image;
  image.width = 800;
  image.height = 600;
  image.step = 800;
  image.encoding = "16UC1";
  expectLine(
      tracker, [&] { images.publish(image); }, "image.encoding: '16UC1', expected mono8");
  image.encoding = "mono8";
  image.data.resize(10);
  expectLine(
      tracker, [&] { images.publish(image); },
      "image.data: 10 bytes in steps of 800, expected a picture of 800 x 600");
  image.width = image.step = 320;
  image.data.resize(320 * 600);
  expectLine(
      tracker,
      [&] {
        image.header.stamp = ros::Time::now();
        images.publish(image);
      },
      "picture is 320 x 600");
  image.width = image.step = 800;
  image.data.resize(800 * 600);
  expectLine(
      tracker, [&] { images.publish(image); }, "the clock stands still, the frame is dropped");
  visp_vlp::LampObservations lampsSeen;
  lampsSeen.width = 640;
  expectLine(
      locator, [&] { seen.publish(lampsSeen); },
      "lamp_observations: of pictures of 640 x 0, expected the rig's 800 x 600");
  lampsSeen.width = 800;
  lampsSeen.height = 600;
  lampsSeen.lamps.resize(1);
  lampsSeen.lamps[0].u = std::nan("");
  expectLine(
      locator, [&] { seen.publish(lampsSeen); }, "lamp.u: nan, expected a finite number");
  EXPECT_FALSE(tracker.ended());
  EXPECT_FALSE(locator.ended());
}

// A survey moves a lamp of the file that all robots share: poses follow.
TEST(RosNodes, AMapThatChangesReachesARobot)
{
  const vpTemporaryFolder folder;
  const std::string file = folder / "lamps.yaml";
  vpLampMap map = vpLampMap::load(lamps);
  map.save(file);
  vpProcess shared("lamp_map", {"_lamps:=" + file, "_floor_plan:=" + (folder / "floor")});
  Robot robot("mapped");
  for (const std::string node : {"ID_recognition", "vlc_locator"}) {
    robot.kill(node);
    robot.start(node, {"_rig:=" + rig});
  }
  Listener heard("mapped");
  ASSERT_TRUE(spinUntil([&] { return heard.location.size() > 10; }, 20));
  EXPECT_NEAR(heard.location.back().x, -0.35, 0.001);
  const std::string plan = folder.read("floor.pgm"), yaml = folder.read("floor.yaml");
  EXPECT_EQ(plan.rfind("P5", 0), 0u); // as map_server wants it, lamps -0.465 to 0.48 m and a metre around
  EXPECT_NE(yaml.find("image: floor.pgm\nresolution: 0.01\norigin: [-1.465, -1.425, 0]"), std::string::npos)
      << yaml;
  for (vpLamp &lamp : map.lamps) {
    lamp.position.x() += 1;
  }
  map.save(file);
  EXPECT_TRUE(spinUntil([&] { return std::abs(heard.location.back().x - 0.65) < 0.001; }, 5))
      << heard.location.back().x;
  std::ofstream(file) << "lamps: none\n"; // a mistake changes nothing
  spinUntil([] { return false; }, 1.5);
  EXPECT_NEAR(heard.location.back().x, 0.65, 0.001);
  EXPECT_NEAR(heard.location.back().heard, now(), 0.5);
}

TEST(RosNodes, ARecordingBecomesARun)
{
  const vpTemporaryFolder folder;
  Robot robot("recorded");
  ros::NodeHandle nh;
  std::vector<sensor_msgs::Image> images;
  std::vector<nav_msgs::Odometry> samples;
  const ros::Subscriber pictures = nh.subscribe<sensor_msgs::Image>(
                            "/recorded/camera/image", 100,
                            [&](const sensor_msgs::ImageConstPtr &image) { images.push_back(*image); }),
                        odom = nh.subscribe<nav_msgs::Odometry>(
                            "/recorded/odom", 100,
                            [&](const nav_msgs::OdometryConstPtr &sample) { samples.push_back(*sample); });
  ASSERT_TRUE(spinUntil([&] { return images.size() >= 5 && samples.size() >= 5; }, 20));
  const std::string file = folder / "drive.bag";
  rosbag::Bag bag(file, rosbag::bagmode::Write);
  for (const sensor_msgs::Image &image : images) {
    bag.write("/recorded/camera/image", image.header.stamp, image);
  }
  for (const nav_msgs::Odometry &sample : samples) {
    bag.write("/recorded/odom", sample.header.stamp, sample);
  }
  bag.close();
  const std::vector<std::string> options = {
      "--image", "/recorded/camera/image", "--odom", "/recorded/odom", "--rig", rig, "--out", folder / "run"};
  const auto convert = [&options](const std::string &recording) {
    std::vector<std::string> arguments = {recording};
    arguments.insert(arguments.end(), options.begin(), options.end());
    vpProcess program("bag_to_run", arguments);
    const int code = program.wait();
    return std::to_string(code) + " " + program.out() + program.err();
  };
  EXPECT_EQ(convert(file), "0 " + (folder / "run") + ": " + std::to_string(images.size()) + " frames, " +
                               std::to_string(samples.size()) + " samples of odometry\n");
  vpPictureSequence run = vpPictureSequence::fromRun(folder / "run");
  vpVlpFrame frame;
  ASSERT_TRUE(run.next(frame));
  EXPECT_EQ(frame.timestamp, images[0].header.stamp.toSec());
  EXPECT_TRUE(std::equal(images[0].data.begin(), images[0].data.end(), frame.I.bitmap));
  EXPECT_EQ(vpReadOdometry(folder / "run/odometry.csv").size(), samples.size());

  EXPECT_EQ(convert(file),
            "2 bag_to_run: error: " + (folder / "run") + ": exists, expected a new or empty folder\n");
  std::filesystem::remove_all(folder / "run");
  const std::string half = folder.write("half.bag", folder.read("drive.bag").substr(0, 100000));
  EXPECT_EQ(convert(half).rfind("2 bag_to_run: error: ", 0), 0u);
  EXPECT_FALSE(std::filesystem::exists(folder / "run"));
}

// The folder of a run through mvcam: its frames get the times of now, and poses are those of its truth.
TEST(RosNodes, ARunIsPlayed)
{
  ros::NodeHandle nh;
  std::vector<geometry_msgs::PoseWithCovarianceStamped> poses;
  const ros::Subscriber location = nh.subscribe<geometry_msgs::PoseWithCovarianceStamped>(
      "/played/location", 100,
      [&](const geometry_msgs::PoseWithCovarianceStampedConstPtr &pose) { poses.push_back(*pose); });
  const vpTemporaryFolder folder; // nine places, one each half second instead of ten
  const std::string room = folder / "room";
  std::filesystem::copy(data + "/paper-room", room);
  std::ofstream frames(room + "/frames.csv");
  frames << "timestamp_s,file\n";
  for (int k = 0; k < 9; ++k) {
    frames << 0.5 * k << ",frame" << k << ".png\n";
  }
  frames.close();
  vpProcess locator("vlp",
                    {"__ns:=/played", "_rig:=" + room + "/rig.yaml", "_lamps:=" + room + "/lamps.yaml"});
  ASSERT_TRUE(spinUntil([&] { return location.getNumPublishers() > 0; }, 10));
  vpProcess camera("mvcam", {"__ns:=/played", "_rig:=" + room + "/rig.yaml", "_camera:=" + room});
  EXPECT_TRUE(spinUntil([&] { return poses.size() >= 5; }, 20)) << camera.err();
  camera.signal(SIGKILL);
  spinUntil([] { return false; }, 1);
  const size_t before = poses.size();
  vpProcess again("mvcam", {"__ns:=/played", "_rig:=" + room + "/rig.yaml", "_camera:=" + room});
  EXPECT_TRUE(spinUntil([&] { return poses.size() > before; }, 2)) << again.err();
  for (const geometry_msgs::PoseWithCovarianceStamped &pose : poses) {
    EXPECT_NEAR(pose.header.stamp.toSec(), now(), 20);
    EXPECT_LT(std::hypot(pose.pose.pose.position.x, pose.pose.pose.position.y), 1);
  }
}

TEST(RosNodes, AMissingParameterIsNamed)
{
  vpProcess locator("vlc_locator", {"__ns:=/missing", "_lamps:=" + lamps});
  EXPECT_EQ(locator.wait(), 2);
  EXPECT_NE(locator.err().find("/missing/vlc_locator/rig: missing, expected the name of a rig.yaml"),
            std::string::npos)
      << locator.err();
}
} // namespace

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_nodes");
  const ros::NodeHandle nh;
  return RUN_ALL_TESTS();
}
