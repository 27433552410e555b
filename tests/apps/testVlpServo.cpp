/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vlp-servo as a user runs it: it drives, logs, stops on signals, and says in one line what it cannot do.

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>
#include <visp3/vlp_servo/vpServoLog.h>

#include "apps/vpExpectRefused.h"
#include "apps/vpLocateScene.h"
#include "common/vpProcess.h"

namespace
{
namespace fs = std::filesystem;
using vpLocateScene::with;

const std::string data = VLP_DATA_DIR;
const std::vector<std::string> sim = {"--robot", "sim", "--scenario", data + "/scenarios/servo.yaml"};

//! A path of 12 cm, driven in a second or two.
std::vector<std::string> briefDrive(const vpTemporaryFolder &folder)
{
  const std::string path = folder.write("path.yaml", "{type: polyline, points_m: [[0, 0], [0.12, 0]]}\n");
  return with(sim, {"--path", path});
}

void expectServoRefuses(const std::vector<std::string> &arguments, const std::vector<std::string> &parts,
                        int code = 2)
{
  vpExpectRefused("vlp-servo", arguments, code, parts);
}

//! Runs in real time, sends \e signal on the way. \return What the log holds.
vpServoLog signalled(int signal)
{
  const vpTemporaryFolder folder;
  const std::string path = folder.write("path.yaml", "{type: polyline, points_m: [[-0.4, 0], [0.4, 0]]}\n");
  vpProcess program("vlp-servo",
                    with(sim, {"--path", path, "--real-time", "--log", folder / "run", "--speed", "0.05"}));
  std::this_thread::sleep_for(std::chrono::seconds(2));
  EXPECT_FALSE(program.ended()) << program.err();
  program.signal(signal);
  EXPECT_EQ(program.wait(), 0) << program.err();
  EXPECT_NE(program.err().find("stopped on the way"), std::string::npos) << program.err();
  return vpServoLog::load(folder / "run");
}
} // namespace

TEST(VlpServo, DrivesAndKeepsALog)
{
  const vpTemporaryFolder folder;
  vpProcess program("vlp-servo", with(briefDrive(folder), {"--log", folder / "deep/run", "--seed", "3"}));
  EXPECT_EQ(program.wait(), 0) << program.err();
  for (const std::string word :
       {"RMS, mm", "true", "as estimated", "poses per second", "picture to command"}) {
    EXPECT_NE(program.out().find(word), std::string::npos) << word << program.out();
  }
  const vpServoLog log = vpServoLog::load(folder / "deep/run");
  EXPECT_GT(log.poses.size(), 10u);
  EXPECT_EQ(log.truth.size(), log.run.steps.size());
  const vpHomogeneousMatrix end = log.truth.poses().back().wMb;
  EXPECT_NEAR(end[0][3], 0.12, 0.01);
  EXPECT_NEAR(end[1][3], 0, 0.005);
  EXPECT_EQ(log.run.steps.back().told.v, 0);
  EXPECT_TRUE(fs::exists(folder / "deep/run/odometry.csv"));
  vpProcess evaluate("vlp-evaluate",
                     {"--truth", folder / "deep/run/truth.tum", "--estimate", folder / "deep/run/poses.tum"});
  EXPECT_EQ(evaluate.wait(), 0) << evaluate.err();
}

TEST(VlpServo, ComparisonsCloseNoLoopOverLamps)
{
  const vpTemporaryFolder folder;
  const std::string path = folder.write("path.yaml", "{type: polyline, points_m: [[-0.3, 0], [0.4, 0]]}\n");
  std::vector<double> off;
  for (const std::vector<std::string> &mode :
       {std::vector<std::string>{}, {"--odometry-only"}, {"--open-loop"}}) {
    const std::string run = folder / ("run" + std::to_string(off.size()));
    vpProcess program("vlp-servo", with(with(sim, {"--path", path, "--log", run}), mode));
    EXPECT_EQ(program.wait(), 0) << program.err();
    const vpHomogeneousMatrix end = vpServoLog::load(run).truth.poses().back().wMb;
    off.push_back(std::abs(end[1][3]));
  }
  EXPECT_LT(off[0], 0.003);
  vpProcess evaluate("vlp-evaluate",
                     {"--runs", folder / "run0", folder / "run2", "--out", folder / "report"});
  EXPECT_EQ(evaluate.wait(), 0) << evaluate.err();
  for (const std::string word : {"run0, true", "run0, as estimated", "run2, true"}) {
    EXPECT_NE(evaluate.out().find(word), std::string::npos) << evaluate.out();
  }
  EXPECT_TRUE(fs::exists(folder / "report/report.html"));
  EXPECT_TRUE(fs::exists(folder / "report/tracks-1.png"));
  EXPECT_FALSE(fs::exists(folder / "report/tracks-2.png")); // both drove the same path
  EXPECT_GT(off[2], 0.02);                                  // wheels of unlike size lead it astray
}

TEST(VlpServo, InterruptAndTerminateStopTheRobot)
{
  for (const int signal : {SIGINT, SIGTERM}) {
    const vpServoLog log = signalled(signal);
    EXPECT_GT(log.run.steps.size(), 25u);
    EXPECT_LT(log.run.steps.back().reference.s, 0.7);
  }
}

TEST(VlpServo, FenceEndsTheRunWithItsReason)
{
  const vpTemporaryFolder folder;
  vpProcess program("vlp-servo",
                    with(briefDrive(folder), {"--fence", "-0.1,-0.1,0.06,0.1", "--log", folder / "run"}));
  EXPECT_EQ(program.wait(), 3);
  EXPECT_NE(program.err().find("the robot stands: the base is about to leave the fence"), std::string::npos)
      << program.err();
  const vpServoLog log = vpServoLog::load(folder / "run");
  for (const vpTimedPose &pose : log.truth.poses()) {
    EXPECT_LT(pose.wMb[0][3], 0.06);
  }
}

TEST(VlpServo, WithoutAScreenItDrivesAllTheSame)
{
  const vpTemporaryFolder folder;
  const char *const kept = std::getenv("DISPLAY");
  const std::string before = kept == nullptr ? "" : kept;
  unsetenv("DISPLAY");
  vpProcess program("vlp-servo", with(briefDrive(folder), {"--display"}));
  EXPECT_EQ(program.wait(), 0) << program.err();
  EXPECT_EQ(program.err().rfind("vlp-servo: warning: --display: ", 0), 0u) << program.err();
  if (kept != nullptr) {
    setenv("DISPLAY", before.c_str(), 1);
  }
}

TEST(VlpServo, BadUsage)
{
  const vpTemporaryFolder folder;
  const std::vector<std::string> good = briefDrive(folder);
  expectServoRefuses({}, {"--robot"});
  expectServoRefuses({"--robot", "sim", "--path", "x"}, {"--scenario"});
  expectServoRefuses(sim, {"--path"});
  expectServoRefuses(with(sim, {"--path", folder / "none.yaml"}), {"none.yaml"});
  expectServoRefuses({"--robot", "tank", "--path", "x"}, {"--robot: tank", "opencr:usb"});
  expectServoRefuses({"--robot", "opencr:usb", "--path", "x"}, {"--rig, --lamps, --camera"});
  expectServoRefuses({"--robot", "ros:/r", "--path", "x", "--rig", "x"}, {"beside --robot ros:/r"});
  expectServoRefuses(with(good, {"--speed", "0"}), {"--speed: 0"});
  expectServoRefuses(with(good, {"--speed", "fast"}), {"--speed: fast"});
  expectServoRefuses(with(good, {"--gain", "-1"}), {"--gain: -1"});
  expectServoRefuses(with(good, {"--laps", "0"}), {"--laps"});
  expectServoRefuses(with(good, {"--seed", "-1"}), {"--seed: -1, expected a whole number"});
  expectServoRefuses(with(good, {"--start", "1,2"}), {"--start: 1,2", "x,y,yaw"});
  expectServoRefuses(with(good, {"--fence", "1,0,0,1"}), {"--fence: 1,0,0,1"});
  expectServoRefuses(with(good, {"--open-loop", "--odometry-only"}), {"--open-loop"});
  expectServoRefuses(with(good, {"--display", "--headless"}), {"--display"});
  expectServoRefuses(with(good, {"--camera", "uvc://1:2"}), {"--camera"});
  expectServoRefuses(with(good, {"--rig", folder / "rig.yaml"}), {"rig.yaml"});
  folder.write("file", "text");
  expectServoRefuses(with(good, {"--log", folder / "file"}), {"exists, expected a new or empty"});
  // Before anything moves.
  expectServoRefuses(with(good, {"--log", "/proc/run"}), {"/proc/run: the folder cannot be made"});
  expectServoRefuses({"--robot", "sim", "--scenario", folder / "path.yaml", "--path", folder / "path.yaml"},
                     {"path.yaml"});
}

TEST(VlpServo, HelpNamesEveryOptionAndFile)
{
  vpProcess program("vlp-servo", {"--help"});
  EXPECT_EQ(program.wait(), 0);
  EXPECT_EQ(program.err(), "");
  const std::string help = program.out();
  for (const std::string word : {"--robot", "--list-robots", "--scenario", "--seed",      "--rig",
                                 "--lamps", "--camera",      "--path",     "--speed",     "--gain",
                                 "--laps",  "--start",       "--fence",    "--open-loop", "--odometry-only",
                                 "--log",   "--display",     "--headless", "--real-time", "--wheels-only",
                                 "Example", "commands.csv",  "poses.tum",  "truth.tum",   "Exit code"}) {
    EXPECT_NE(help.find(word), std::string::npos) << word;
  }
}

// Nothing is attached here, and on some machines there is no USB to ask.
TEST(VlpServo, ListOfRobotsSaysWhatItFound)
{
  vpProcess program("vlp-servo", {"--list-robots"});
  const int code = program.wait();
  EXPECT_EQ(program.out(), "");
  if (code == 3) {
    EXPECT_NE(program.err().find("no board found on USB"), std::string::npos) << program.err();
  } else {
    EXPECT_EQ(code, 2);
    EXPECT_NE(program.err().find("USB"), std::string::npos) << program.err();
  }
}
