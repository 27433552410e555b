/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vlp-simulate: whole run folders that the other programs read, and nothing half-written.

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <thread>

#include <sys/resource.h>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <visp3/vlp_core/vpCsvTable.h>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpTrajectory.h>
#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_robot/vpOdometry.h>
#include <visp3/vlp_sensor/vpPictureSequence.h>

#include "apps/vpExpectRefused.h"
#include "apps/vpLocateScene.h"
#include "common/vpProcess.h"

namespace
{
namespace fs = std::filesystem;
using vpLocateScene::with;

const std::string drive =
    "motion: {type: commands, start_m: [0.05, -0.04], start_yaw_deg: 20, commands: [{v_m_s: 0.1, "
    "w_rad_s: 0.2, duration_s: 100}]}\n";

//! Writes scenario.yaml over the rig and the lamps of vpLocateScene. \return Its path.
std::string writeScenario(const vpTemporaryFolder &folder, int count, const std::string &motion = drive)
{
  vpLocateScene::writeRig(folder);
  return folder.write("scenario.yaml", "rig: rig.yaml\nlamps: lamps.yaml\nframes: {rate_hz: 12, count: " +
                                           std::to_string(count) + "}\n" + motion);
}

//! Runs vlp-simulate, which should succeed. \return What it said.
std::string simulate(const std::vector<std::string> &arguments)
{
  vpProcess program("vlp-simulate", arguments);
  EXPECT_EQ(program.wait(), 0) << program.err();
  EXPECT_EQ(program.out(), "");
  return program.err();
}

//! Runs a program that should say one line on stderr with all of \e parts and end with bad input.
void expectSimulateRefuses(const std::vector<std::string> &arguments, const std::vector<std::string> &parts)
{
  EXPECT_EQ(vpExpectRefused("vlp-simulate", arguments, 2, parts), "") << testing::PrintToString(arguments);
}

//! Name and bytes of each file of a folder.
std::map<std::string, std::string> contents(const std::string &folder)
{
  std::map<std::string, std::string> files;
  for (const auto &entry : fs::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    files[entry.path().filename().string()] = {std::istreambuf_iterator<char>(file), {}};
  }
  return files;
}

//! While it lives, programs that are started cannot write files of more than 4 kB.
class SmallFiles
{
public:
  SmallFiles()
  {
    getrlimit(RLIMIT_FSIZE, &m_before);
    rlimit limit = m_before;
    limit.rlim_cur = 4096;
    setrlimit(RLIMIT_FSIZE, &limit);
    m_handler = std::signal(SIGXFSZ, SIG_IGN); // then writing fails instead
  }
  ~SmallFiles()
  {
    setrlimit(RLIMIT_FSIZE, &m_before);
    std::signal(SIGXFSZ, m_handler);
  }
  SmallFiles(const SmallFiles &) = delete;
  SmallFiles &operator=(const SmallFiles &) = delete;

private:
  rlimit m_before{};
  void (*m_handler)(int) = SIG_DFL;
};

std::vector<std::string> names(const std::string &folder)
{
  std::vector<std::string> all;
  for (const auto &entry : fs::directory_iterator(folder)) {
    all.push_back(entry.path().filename().string());
  }
  std::sort(all.begin(), all.end());
  return all;
}
} // namespace

TEST(VlpSimulate, RunFolderIsWholeAndAgreesWithItself)
{
  const vpTemporaryFolder folder;
  const std::string scenario = writeScenario(folder, 4), run = folder / "deep/run";
  const std::string said = simulate({"--scenario", scenario, "--out", run});
  EXPECT_NE(said.find("4 frames in " + run), std::string::npos) << said;
  EXPECT_EQ(names(run), (std::vector<std::string>{"camera.xml", "frame000000.png", "frame000001.png",
                                                  "frame000002.png", "frame000003.png", "frames.csv",
                                                  "lamps.yaml", "odometry.csv", "rig.yaml", "truth.tum"}));
  EXPECT_EQ(fs::directory_iterator(folder / "deep")->path().filename(), "run"); // and nothing beside it

  const vpVlpRig rig = vpVlpRig::load(run + "/rig.yaml"), given = vpVlpRig::load(folder / "rig.yaml");
  EXPECT_EQ(rig.camera.get_px(), given.camera.get_px());
  EXPECT_EQ(rig.shutter.rowTime, given.shutter.rowTime);
  EXPECT_EQ(vpLampMap::load(run + "/lamps.yaml").lamps.size(), vpLocateScene::lamps.size());
  const vpTrajectory truth = vpTrajectory::load(run + "/truth.tum");
  vpPictureSequence pictures = vpPictureSequence::fromRun(run);
  ASSERT_EQ(pictures.size(), 4u);
  vpVlpFrame frame;
  for (int k = 0; k < 4; ++k) {
    ASSERT_TRUE(pictures.next(frame));
    EXPECT_EQ(frame.timestamp, k / 12.0);
    EXPECT_EQ(frame.I.getWidth(), rig.width);
    EXPECT_EQ(std::count_if(truth.poses().begin(), truth.poses().end(),
                            [&](const vpTimedPose &pose) { return pose.timestamp == frame.timestamp; }),
              1);
  }
  const std::vector<vpOdometry> odometry = vpReadOdometry(run + "/odometry.csv");
  EXPECT_GE(odometry.size(), 13u); // 0.25 s and the readout of the last frame, 50 times a second
  EXPECT_LE(odometry.size(), 16u);
  EXPECT_NEAR(odometry.back().v, 0.1, 1e-9);
  EXPECT_NEAR((*truth.at(0.25))[0][3], 0.05 + 0.025 * std::cos(20 * M_PI / 180 + 0.025), 1e-5);
}

TEST(VlpSimulate, OtherProgramsReadIt)
{
  const vpTemporaryFolder folder;
  const std::string run = folder / "run";
  simulate({"--scenario", writeScenario(folder, 3), "--out", run});
  vpProcess locate("vlp-locate", {"--run", run, "--poses", folder / "poses.tum"});
  EXPECT_EQ(locate.wait(), 0) << locate.err();
  const vpTrajectory poses = vpTrajectory::load(folder / "poses.tum"),
                     truth = vpTrajectory::load(run + "/truth.tum");
  ASSERT_EQ(poses.size(), 3u);
  for (const vpTimedPose &pose : poses.poses()) {
    const vpHomogeneousMatrix there = *truth.at(pose.timestamp);
    EXPECT_LT(std::hypot(pose.wMb[0][3] - there[0][3], pose.wMb[1][3] - there[1][3]), 3e-3);
  }
  vpProcess evaluate("vlp-evaluate", {"--truth", run + "/truth.tum", "--estimate", folder / "poses.tum"});
  EXPECT_EQ(evaluate.wait(), 0) << evaluate.err();
  EXPECT_FALSE(evaluate.out().empty());
}

TEST(VlpSimulate, SameSeedSameBytesOfAllFiles)
{
  const vpTemporaryFolder folder;
  const std::string scenario = writeScenario(folder, 2, drive + "draw: {lamp_shift_m: 0.01}\n");
  simulate({"--scenario", scenario, "--out", folder / "a", "--seed", "5"});
  simulate({"--scenario", scenario, "--out", folder / "b", "--seed", "5"});
  simulate({"--scenario", scenario, "--out", folder / "c", "--seed", "6"});
  simulate({"--scenario", scenario, "--out", folder / "d"});
  simulate({"--scenario", scenario, "--out", folder / "e", "--seed", "1"}); // the default
  EXPECT_EQ(contents(folder / "a"), contents(folder / "b"));
  EXPECT_EQ(contents(folder / "d"), contents(folder / "e"));
  auto a = contents(folder / "a"), c = contents(folder / "c");
  EXPECT_NE(a["frame000000.png"], c["frame000000.png"]);
  for (const std::string claim : {"rig.yaml", "camera.xml", "lamps.yaml"}) {
    EXPECT_EQ(a[claim], c[claim]) << claim;
  }
}

TEST(VlpSimulate, FormatAndNumberOfFrames)
{
  const vpTemporaryFolder folder;
  const std::string scenario = writeScenario(folder, 50);
  simulate({"--scenario", scenario, "--out", folder / "png", "--frames", "2"});
  simulate({"--scenario", scenario, "--out", folder / "pgm", "--frames", "2", "--format", "pgm"});
  EXPECT_EQ(vpPictureSequence::fromRun(folder / "png").size(), 2u);
  for (const std::string frame : {"frame000000", "frame000001"}) {
    const cv::Mat png = cv::imread(folder / "png/" + frame + ".png", cv::IMREAD_UNCHANGED);
    const cv::Mat pgm = cv::imread(folder / "pgm/" + frame + ".pgm", cv::IMREAD_UNCHANGED);
    ASSERT_EQ(png.size(), cv::Size(640, 480));
    EXPECT_EQ(png.type(), CV_8UC1);
    EXPECT_EQ(cv::norm(png, pgm, cv::NORM_INF), 0);
  }
}

TEST(VlpSimulate, StationsHaveNoOdometry)
{
  const vpTemporaryFolder folder;
  const std::string motion =
      "motion: {type: stations, frames_each: 1, points: [{at_m: [0, 0]}, {at_m: [0.1, 0]}]}\n";
  simulate({"--scenario", writeScenario(folder, 2, motion), "--out", folder / "run"});
  EXPECT_FALSE(fs::exists(folder / "run/odometry.csv"));
  EXPECT_EQ(vpTrajectory::load(folder / "run/truth.tum").size(), 2u);
}

TEST(VlpSimulate, FolderThatIsNotEmptyIsLeftAlone)
{
  const vpTemporaryFolder folder;
  const std::string scenario = writeScenario(folder, 1);
  fs::create_directory(folder / "mine");
  folder.write("mine/diary.txt", "dear diary");
  folder.write("file", "text");
  const size_t before = folder.count();
  expectSimulateRefuses({"--scenario", scenario, "--out", folder / "mine"},
                        {folder / "mine", "exists, expected a new or empty"});
  expectSimulateRefuses({"--scenario", scenario, "--out", folder / "mine/"},
                        {"exists, expected a new or empty"});
  expectSimulateRefuses({"--scenario", scenario, "--out", folder / "file"},
                        {"exists, expected a new or empty"});
  expectSimulateRefuses({"--scenario", scenario, "--out", folder / "file/run"}, {"file/run"});
  EXPECT_EQ(names(folder / "mine"), std::vector<std::string>{"diary.txt"});
  EXPECT_EQ(folder.count(), before);
}

TEST(VlpSimulate, EmptyFolderAndLinkToOneAreFilled)
{
  const vpTemporaryFolder folder;
  const std::string scenario = writeScenario(folder, 1);
  fs::create_directory(folder / "empty");
  fs::create_directory(folder / "behind");
  fs::create_directory_symlink(folder / "behind", folder / "link");
  for (const std::string name : {"empty/", "link"}) {
    simulate({"--scenario", scenario, "--out", folder / name});
    EXPECT_EQ(names(folder / name).size(), 7u) << name;
  }
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
}

TEST(VlpSimulate, FolderThatCannotBeWritten)
{
  const vpTemporaryFolder folder;
  const std::string scenario = writeScenario(folder, 1);
  expectSimulateRefuses({"--scenario", scenario, "--out", "/proc/run"},
                        {"/proc/run: the folder cannot be made"});
  expectSimulateRefuses({"--scenario", scenario, "--out", "/dev/null/run"}, {"/dev/null/run"});
}

TEST(VlpSimulate, NothingIsLeftAfterAnError)
{
  const vpTemporaryFolder folder;
  const std::string scenario = writeScenario(folder, 1);
  const size_t before = folder.count();
  folder.write("scenario.yaml", folder.read("scenario.yaml") + "colour: red\n");
  expectSimulateRefuses({"--scenario", scenario, "--out", folder / "a/b/run"},
                        {"scenario.yaml:5: colour: unknown key"});
  // One that is found only once the folder is begun: a picture that does not fit into a file of this size.
  writeScenario(folder, 1);
  const SmallFiles limit;
  vpProcess program("vlp-simulate", {"--scenario", scenario, "--out", folder / "a/b/run"});
  EXPECT_EQ(program.wait(), 2);
  EXPECT_NE(program.err().find("frame000000.png"), std::string::npos) << program.err();
  EXPECT_EQ(folder.count(), before) << testing::PrintToString(names(folder.path()));
}

TEST(VlpSimulate, BadUsage)
{
  const vpTemporaryFolder folder;
  const std::string scenario = writeScenario(folder, 1), run = folder / "run";
  expectSimulateRefuses({}, {"--scenario"});
  expectSimulateRefuses({"--out", run}, {"--scenario"});
  expectSimulateRefuses({"--scenario", scenario}, {"--out"});
  const std::vector<std::string> good = {"--scenario", scenario, "--out", run};
  expectSimulateRefuses(with(good, {"--seed", "-1"}), {"--seed: -1, expected a whole number"});
  expectSimulateRefuses(with(good, {"--seed", "many"}), {"--seed"});
  expectSimulateRefuses(with(good, {"--seed", "1e3"}), {"--seed"});
  expectSimulateRefuses(with(good, {"--seed", "18446744073709551616"}), {"--seed"});
  expectSimulateRefuses(with(good, {"--frames", "0"}), {"--frames"});
  expectSimulateRefuses(with(good, {"--frames", "-3"}), {"--frames"});
  expectSimulateRefuses(with(good, {"--every", "0"}), {"--every: 0, expected a whole number from 1 to"});
  expectSimulateRefuses(with(good, {"--format", "gif"}), {"--format: gif", "png"});
  expectSimulateRefuses(with(good, {"--nonsense"}), {"--nonsense"});
  expectSimulateRefuses({"--scenario", "", "--out", run}, {"--scenario"});
  expectSimulateRefuses({"--scenario", scenario, "--out", ""}, {"--out"});
  expectSimulateRefuses({"--scenario", folder / "none.yaml", "--out", run}, {"none.yaml: cannot be opened"});
  expectSimulateRefuses({"--scenario", folder.path(), "--out", run}, {folder.path()});
  EXPECT_FALSE(fs::exists(run));
}

TEST(VlpSimulate, InterruptKeepsTheFramesSoFar)
{
  const vpTemporaryFolder folder;
  const std::string scenario = writeScenario(folder, 1200), run = folder / "run";
  vpProcess program("vlp-simulate", {"--scenario", scenario, "--out", run});
  const auto begun = [&folder] {
    for (const auto &entry : fs::directory_iterator(folder.path())) {
      if (entry.path().filename().string().rfind("run", 0) == 0 &&
          fs::exists(entry.path() / "frame000002.png")) {
        return true;
      }
    }
    return false;
  };
  while (!begun() && !program.ended()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ASSERT_FALSE(program.ended()) << program.err();
  EXPECT_FALSE(fs::exists(run)); // whole or not at all
  program.signal(SIGINT);
  EXPECT_EQ(program.wait(), 0) << program.err();
  EXPECT_NE(program.err().find(" of 1200 frames"), std::string::npos) << program.err();

  vpPictureSequence pictures = vpPictureSequence::fromRun(run);
  EXPECT_GE(pictures.size(), 3u);
  EXPECT_LT(pictures.size(), 1200u);
  EXPECT_EQ(names(run).size(), pictures.size() + 6); // with frames.csv, rig, camera, lamps, truth, odometry
  const vpTrajectory truth = vpTrajectory::load(run + "/truth.tum");
  vpVlpFrame frame;
  while (pictures.next(frame)) {
    EXPECT_TRUE(truth.at(frame.timestamp)) << frame.timestamp;
  }
  EXPECT_GE(vpReadOdometry(run + "/odometry.csv").back().timestamp, frame.timestamp - 0.02);
  EXPECT_EQ(names(folder.path()),
            (std::vector<std::string>{"camera.xml", "lamps.yaml", "rig.yaml", "run", "scenario.yaml"}));
}

TEST(VlpSimulate, HelpNamesEveryOptionAndFile)
{
  vpProcess program("vlp-simulate", {"--help"});
  EXPECT_EQ(program.wait(), 0);
  EXPECT_EQ(program.err(), "");
  const std::string help = program.out();
  for (const std::string word :
       {"--scenario", "--out", "--seed", "--format", "--frames", "Example", "frames.csv", "truth.tum",
        "odometry.csv", "timestamp_s,v_m_s,w_rad_s", "Exit code"}) {
    EXPECT_NE(help.find(word), std::string::npos) << word;
  }
}
