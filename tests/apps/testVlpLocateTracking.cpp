/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vlp-locate on sequences: the pose carried from frame to frame, odometry, times that repeat.

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <visp3/vlp_core/vpCsvTable.h>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpTrajectory.h>
#include <visp3/vlp_evaluation/vpFixLog.h>

#include "apps/vpExpectRefused.h"
#include "apps/vpLocateScene.h"
#include "common/vpProcess.h"

namespace
{
using vpLocateScene::encoded;
using vpLocateScene::with;

using namespace vpStatus;
using vpLocateScene::fixColumns;

//! Runs vlp-locate and expects that it refuses in one line with all of \e parts, and writes nothing.
void expectRefused(const std::vector<std::string> &arguments, const std::vector<std::string> &parts)
{
  EXPECT_EQ(vpExpectRefused("vlp-locate", arguments, badInput, parts), "")
      << testing::PrintToString(arguments);
}

//! A folder with rig, lamps and three pictures: the scene, black, and from elsewhere.
class Recording
{
public:
  Recording()
  {
    vpLocateScene::writeRig(m_folder);
    m_folder.write("lamps.png", encoded(".png", vpLocateScene::picture()));
    m_folder.write("black.png", encoded(".png", cv::Mat(480, 640, CV_8UC1, cv::Scalar(4))));
    m_folder.write("there.png",
                   encoded(".png", vpLocateScene::picture(vpLocateScene::robot(0.16, 0.02, 0.9))));
  }

  std::string path() const { return m_folder.path(); }
  std::string operator/(const std::string &name) const { return m_folder / name; }
  std::string read(const std::string &name) const { return m_folder.read(name); }
  std::string write(const std::string &name, const std::string &text) const
  {
    return m_folder.write(name, text);
  }

  //! The list of frames: time, picture.
  void list(const std::vector<std::pair<double, std::string>> &frames) const
  {
    std::string text = "timestamp_s,file\n";
    for (const auto &[time, name] : frames) {
      text += vpNumberText(time) + "," + name + ".png\n";
    }
    m_folder.write("frames.csv", text);
  }

  //! What vlp-locate says of them.
  vpCsvTable fixes(const std::vector<std::string> &more = {})
  {
    vpProcess locate("vlp-locate", with({"--run", m_folder.path(), "--fixes", m_folder / "fixes.csv",
                                         "--poses", m_folder / "poses.tum"},
                                        more));
    EXPECT_EQ(locate.wait(), 0) << locate.err();
    said = locate.err();
    return vpCsvTable::load(m_folder / "fixes.csv", fixColumns);
  }

  std::string said; // on stderr by the last fixes()

private:
  vpTemporaryFolder m_folder;
};

std::string poseIn(const vpCsvTable &table, size_t row)
{
  std::string text;
  for (size_t column = 1; column < 13; ++column) {
    text += table.text(row, column) + ",";
  }
  return text + table.text(row, 13);
}
//! Of all these frames, those of \e late have no position, and every other has the right one.
void expectLate(const vpCsvTable &fixes, const std::vector<std::pair<double, std::string>> &frames,
                const std::set<size_t> &late)
{
  ASSERT_EQ(fixes.rows(), frames.size());
  for (size_t row = 0; row < frames.size(); ++row) {
    EXPECT_EQ(fixes.number(row, 0), frames[row].first);
    EXPECT_EQ(fixes.text(row, 13) == "none", late.count(row) == 1) << row << ": " << fixes.text(row, 13);
    if (late.count(row) == 0) {
      const bool there = frames[row].second == "there";
      EXPECT_NEAR(fixes.number(row, 1), there ? 0.16 : 0.06, 2e-3) << row;
      EXPECT_NEAR(fixes.number(row, 2), there ? 0.02 : -0.04, 2e-3) << row;
      EXPECT_NEAR(fixes.number(row, 6), there ? 0.9 : 0.5, 5e-3) << row;
      EXPECT_TRUE(std::isfinite(fixes.number(row, 10))) << row;
    }
  }
}

size_t count(const std::string &text, const std::string &part)
{
  size_t times = 0;
  for (size_t i = text.find(part); i != std::string::npos; i = text.find(part, i + 1)) {
    ++times;
  }
  return times;
}
} // namespace

TEST(VlpLocateTracking, OdometryThatIsNoneIsOneClearLine)
{
  const Recording run;
  run.list({{0, "lamps"}});
  const std::string header = "timestamp_s,v_m_s,w_rad_s\n";
  expectRefused({"--run", run.path(), "--odometry", run / "none.csv"}, {run / "none.csv"});
  struct Case {
    std::string text;
    std::vector<std::string> parts;
  };
  for (const Case &bad :
       {Case{"timestamp_s,v,w_rad_s\n0,0,0\n", {":1", "expected timestamp_s,v_m_s,w_rad_s"}},
        Case{"", {"expected"}}, Case{header, {"no samples", "expected one or more"}},
        Case{header + "0,0,0\n1,0,0\n1,0,0\n",
             {":4", "timestamp_s", "expected a time after that of the line above"}},
        Case{header + "1,0,0\n0.5,0,0\n",
             {":3", "timestamp_s", "expected a time after that of the line above"}},
        Case{header + "0,fast,0\n", {":2", "v_m_s", "fast"}},
        Case{header + "0,0,nan\n", {":2", "w_rad_s", "nan"}}, Case{header + "0,0\n", {":2"}}}) {
    const std::string file = run.write("odometry.csv", bad.text);
    std::vector<std::string> parts = bad.parts;
    parts.push_back(file);
    expectRefused({"--run", run.path(), "--odometry", file}, parts);
  }
}

TEST(VlpLocateTracking, OdometryWithoutASequenceIsRefused)
{
  const Recording run;
  run.list({{0, "lamps"}});
  const std::string file = run.write("odometry.csv", "timestamp_s,v_m_s,w_rad_s\n0,0,0\n");
  const std::vector<std::string> parts = {"--odometry", file, "expected a sequence"};
  expectRefused({"--rig", run / "rig.yaml", "--lamps", run / "lamps.yaml", "--image", run / "lamps.png",
                 "--odometry", file},
                parts);
  expectRefused({"--run", run.path(), "--no-track", "--odometry", file}, parts);
  expectRefused({"--run", run.path(), "--solver", "two", "--odometry", file}, parts);
}

TEST(VlpLocateTracking, StateGoesFromFixOverTrackingAndCoastingToNone)
{
  Recording run;
  std::vector<std::pair<double, std::string>> frames;
  for (int k = 0; k < 10; ++k) {
    frames.emplace_back(0.05 * k, "lamps");
  }
  for (int k = 10; k < 16; ++k) { // a robot that stood so far may start at any time
    frames.emplace_back(0.2 * (k - 9) + 0.45, "black");
  }
  frames.emplace_back(4, "black");
  frames.emplace_back(4.05, "lamps");
  frames.emplace_back(4.1, "lamps");
  run.list(frames);
  const vpCsvTable fixes = run.fixes();
  ASSERT_EQ(fixes.rows(), frames.size());
  for (size_t row = 0; row < frames.size(); ++row) {
    const std::string state = fixes.text(row, 13);
    EXPECT_EQ(fixes.number(row, 0), frames[row].first);
    if (row == 0 || row == 17) {
      EXPECT_EQ(state, "fix") << row;
    } else if (row < 10 || row == 18) {
      EXPECT_TRUE(state == "tracking" || (row < 3 && state == "coasting")) << row << ": " << state;
    } else if (row == 16) {
      EXPECT_EQ(state, "none");
      EXPECT_EQ(fixes.text(row, 1), "");
      continue;
    } else {
      EXPECT_TRUE(state == "coasting" || (row < 12 && state == "tracking")) << row << ": " << state;
    }
    EXPECT_EQ(fixes.text(row, 12).empty(), frames[row].second == "black") << row;
    EXPECT_NEAR(fixes.number(row, 1), 0.06, 3 * fixes.number(row, 7) + 5e-4) << row;
    EXPECT_NEAR(fixes.number(row, 2), -0.04, 3 * fixes.number(row, 8) + 5e-4) << row;
    EXPECT_EQ(state == "tracking", state != "fix" &&
                                       std::max(fixes.number(row, 7), fixes.number(row, 8)) < 0.02 &&
                                       fixes.number(row, 10) < 0.05)
        << row;
  }
  EXPECT_EQ(fixes.text(15, 13), "coasting");
}

// So few lamps may have given way to copies as well, the more probably the farther it seems to be.
TEST(VlpLocateTracking, RelocationIsToldUntilAThirdLampBearsItOut)
{
  const std::vector<vpLocateScene::Lamp> two(vpLocateScene::lamps.begin(), vpLocateScene::lamps.begin() + 2);
  for (const auto &[x, expected] : {std::pair(0.12, "relocated"), std::pair(0.26, "ambiguous")}) {
    Recording run;
    const vpHomogeneousMatrix there = vpLocateScene::robot(x, -0.04, 0.5);
    run.write("two.png",
              encoded(".png", vpLocateScene::picture(vpLocateScene::robot(0.06, -0.04, 0.5), two)));
    run.write("away.png", encoded(".png", vpLocateScene::picture(there, two)));
    run.write("all.png", encoded(".png", vpLocateScene::picture(there)));
    std::vector<std::pair<double, std::string>> frames;
    for (int k = 0; k < 18; ++k) {
      frames.emplace_back(0.1 * k, k < 8 ? "two" : (k < 13 ? "away" : "all"));
    }
    run.list(frames);
    const vpCsvTable fixes = run.fixes();
    ASSERT_EQ(fixes.rows(), frames.size());
    for (size_t row = 3; row < frames.size(); ++row) {
      EXPECT_EQ(fixes.text(row, 13), frames[row].second == "away" ? expected : "tracking") << row;
    }
    const std::string place = vpNumberText(x) + "0, y -0.040 m: ";
    EXPECT_EQ(count(run.said, "warning: 0.800 s: x " + place + "relocated: "), 1u) << run.said;
    EXPECT_EQ(count(run.said, "1.300 s: x " + place + "borne out by 3 lamps"), 1u) << run.said;
    EXPECT_EQ(count(run.said, "relocated"), 1u) << run.said;
    EXPECT_EQ(vpFixLog::load(run / "fixes.csv").fixes[12].hasPosition(),
              expected == std::string("relocated"));
  }
}

TEST(VlpLocateTracking, WithoutTrackingEachFrameIsAsIfItWereAlone)
{
  Recording run;
  const std::vector<std::pair<double, std::string>> frames = {
      {0, "lamps"}, {0.05, "there"}, {0.1, "black"}, {0.15, "lamps"}, {0.2, "there"}};
  run.list(frames);
  const vpCsvTable all = run.fixes({"--no-track"});
  ASSERT_EQ(all.rows(), frames.size());
  for (size_t row = 0; row < frames.size(); ++row) {
    run.list({frames[row]});
    vpProcess locate("vlp-locate", {"--run", run.path(), "--no-track", "--fixes", run / "one.csv"});
    EXPECT_EQ(locate.wait(), frames[row].second == "black" ? 3 : 0);
    EXPECT_EQ(poseIn(vpCsvTable::load(run / "one.csv", fixColumns), 0), poseIn(all, row)) << row;
    EXPECT_EQ(all.text(row, 13), frames[row].second == "black" ? "none" : "fix");
  }
}

TEST(VlpLocateTracking, FramesThatRepeatATimeOrComeLateGiveNothingAndTheRestGoesOn)
{
  Recording run;
  const std::vector<std::pair<double, std::string>> frames = {
      {10, "lamps"},   {10.05, "lamps"}, {10.05, "there"}, {10.1, "lamps"}, {9.9, "lamps"},
      {9.95, "there"}, {10.1, "lamps"},  {10.15, "lamps"}, {10.2, "lamps"}};
  run.list(frames);
  const vpCsvTable fixes = run.fixes();
  expectLate(fixes, frames, {2, 4, 5, 6});
  EXPECT_EQ(fixes.text(8, 13), "tracking");
  EXPECT_EQ(count(run.said, "warning"), 1u) << run.said;
  EXPECT_NE(run.said.find("warning: " + (run / "frames.csv:4: timestamp_s: 10.05, not after the 10.05 of ") +
                          "the line above (the first of 2 such lines); a frame that is up to a second late"),
            std::string::npos)
      << run.said;
  EXPECT_NE(run.said.find("the frame is not later than the one before it (4)"), std::string::npos)
      << run.said;
  EXPECT_EQ(vpTrajectory::load(run / "poses.tum").size(), 5u);
  EXPECT_EQ(vpFixLog::load(run / "fixes.csv").trajectory().size(), 5u);
}

TEST(VlpLocateTracking, ClockThatIsSetBackBeginsAnewAndThePosesStayInOrder)
{
  Recording run;
  const std::vector<std::pair<double, std::string>> frames = {
      {10, "lamps"},  {10.05, "lamps"}, {10.1, "lamps"}, {0.05, "there"},
      {0.1, "there"}, {0.15, "there"},  {10.2, "lamps"}, {10.25, "lamps"}};
  run.list(frames);
  const vpCsvTable fixes = run.fixes();
  expectLate(fixes, frames, {});
  EXPECT_EQ(fixes.text(3, 13), "fix");
  EXPECT_EQ(fixes.text(6, 13), "fix");
  EXPECT_EQ(count(run.said, "warning"), 1u) << run.said;
  EXPECT_NE(run.said.find(":5: timestamp_s: 0.05, not after the 10.1"), std::string::npos) << run.said;
  EXPECT_NE(run.said.find("3 positions are not among the poses"), std::string::npos) << run.said;
  EXPECT_EQ(vpTrajectory::load(run / "poses.tum").size(), 5u);
  EXPECT_EQ(vpFixLog::load(run / "fixes.csv").count(), 8u);
}

TEST(VlpLocateTracking, LateFramesAreLocatedWhereEachIsByItself)
{
  Recording run;
  const std::vector<std::pair<double, std::string>> frames = {
      {10, "lamps"}, {9.9, "there"}, {10, "there"}, {10.1, "lamps"}};
  run.list(frames);
  expectLate(run.fixes({"--no-track"}), frames, {});
  EXPECT_EQ(count(run.said, "warning"), 1u) << run.said;
  EXPECT_NE(run.said.find("each frame is located by itself all the same"), std::string::npos) << run.said;
  EXPECT_EQ(vpTrajectory::load(run / "poses.tum").size(), 2u);
}

TEST(VlpLocateTracking, TimeThatIsNoNumberIsRefused)
{
  const Recording run;
  for (const std::string time : {"soon", "nan", "inf", ""}) {
    run.write("frames.csv", "timestamp_s,file\n10,lamps.png\n" + time + ",lamps.png\n");
    expectRefused({"--run", run.path()}, {run / "frames.csv:3", "timestamp_s", "expected a finite number"});
  }
}

// The robot stands, is elsewhere after a gap, and stands again.
TEST(VlpLocateTracking, GapsOfASecondAndOfAMinute)
{
  for (const double gap : {1.0, 60.0}) {
    for (const std::string after : {"lamps", "there"}) {
      SCOPED_TRACE(std::to_string(gap) + " s, then " + after);
      Recording run;
      std::vector<std::pair<double, std::string>> frames;
      for (int k = 0; k < 16; ++k) {
        frames.emplace_back(0.0625 * k + (k < 8 ? 0 : gap), k < 8 ? "lamps" : after);
      }
      run.list(frames);
      const vpCsvTable fixes = run.fixes();
      expectLate(fixes, frames, {});
      EXPECT_EQ(run.said.find("warning"), std::string::npos) << run.said;
      EXPECT_EQ(fixes.text(15, 13), "tracking");
    }
  }
}

// A grabber that hands over one picture several times: nothing new, at new times.
TEST(VlpLocateTracking, PictureThatIsRepeatedIsARobotThatStands)
{
  Recording run;
  std::vector<std::pair<double, std::string>> frames;
  for (int k = 0; k < 30; ++k) {
    frames.emplace_back(0.05 * k, "lamps");
  }
  run.list(frames);
  const vpCsvTable fixes = run.fixes();
  expectLate(fixes, frames, {});
  EXPECT_LT(fixes.number(29, 7), 2 * fixes.number(0, 7) + 1e-3);
}

TEST(VlpLocateTracking, PicturesThatChangeTheirSizeAreRefusedEachAndTheRestGoesOn)
{
  Recording run;
  const cv::Mat small(240, 320, CV_8UC1, cv::Scalar(4)), large(960, 1280, CV_8UC1, cv::Scalar(4));
  run.write("small.png", encoded(".png", small));
  run.write("large.png", encoded(".png", large));
  run.list({{0, "lamps"}, {0.05, "lamps"}, {0.1, "small"}, {0.15, "lamps"}, {0.2, "large"}, {0.25, "lamps"}});
  const vpCsvTable fixes = run.fixes();
  expectLate(fixes, {{0, "lamps"}, {0.05, "lamps"}, {0.15, "lamps"}, {0.25, "lamps"}}, {});
  for (const std::string line : {"small.png: 320 x 240 pixels", "large.png: 1280 x 960 pixels"}) {
    EXPECT_EQ(count(run.said, "error: " + (run / line) + ", expected 640 x 480 pixels"), 1u) << run.said;
  }
  EXPECT_NE(run.said.find("2 other frames could not be used"), std::string::npos) << run.said;
}

// A robot that stands in the dark: what its wheels say keeps the pose far surer than a guess of its speed.
TEST(VlpLocateTracking, OdometryCarriesThePoseThroughTheDark)
{
  Recording run;
  std::vector<std::pair<double, std::string>> frames;
  for (int k = 0; k < 50; ++k) {
    frames.emplace_back(0.1 * k, k < 6 || k == 49 ? "lamps" : "black");
  }
  run.list(frames);
  std::string odometry = "timestamp_s,v_m_s,w_rad_s\n";
  for (int k = 0; k < 260; ++k) {
    odometry += vpNumberText(0.02 * k) + ",0,0\n";
  }
  const std::string file = run.write("odometry.csv", odometry);
  const vpCsvTable with = run.fixes({"--odometry", file}), without = run.fixes();
  ASSERT_EQ(with.rows(), 50u);
  for (size_t row = 1; row < 50; ++row) {
    EXPECT_EQ(with.text(row, 13), "tracking") << row;
    EXPECT_NEAR(with.number(row, 1), 0.06, 3 * with.number(row, 7) + 5e-4) << row;
    EXPECT_NEAR(with.number(row, 6), 0.5, 3 * with.number(row, 10) + 5e-4) << row;
  }
  EXPECT_EQ(without.text(48, 13), "none");
}

// One time stamp from elsewhere takes up all odometry there is: it has to come again for the frames behind
// it.
TEST(VlpLocateTracking, OdometryIsThereAgainBehindAWildTimeStamp)
{
  Recording run;
  std::vector<std::pair<double, std::string>> frames;
  for (int k = 0; k < 26; ++k) {
    frames.emplace_back(k == 6 ? 1e6 : 0.1 * k, k < 12 ? "lamps" : "black");
  }
  run.list(frames);
  std::string odometry = "timestamp_s,v_m_s,w_rad_s\n";
  for (int k = 0; k < 130; ++k) {
    odometry += vpNumberText(0.02 * k) + ",0,0\n";
  }
  const vpCsvTable fixes = run.fixes({"--odometry", run.write("odometry.csv", odometry)});
  ASSERT_EQ(fixes.rows(), frames.size());
  for (size_t row = 8; row < frames.size(); ++row) {
    EXPECT_EQ(fixes.text(row, 13), "tracking") << row;
    EXPECT_NEAR(fixes.number(row, 1), 0.06, 3 * fixes.number(row, 7) + 5e-4) << row;
  }
}

// Where their discs touch, outlines are off by tenths of a pixel, many times what they state.
TEST(VlpLocateTracking, LampsThatPassEachOtherMoveNoPoseFartherThanItSays)
{
  const vpTemporaryFolder folder;
  const std::string run = folder / "run", fixes = folder / "fixes.csv";
  vpProcess simulate("vlp-simulate", {"--scenario", std::string(VLP_DATA_DIR) + "/scenarios/crossing.yaml",
                                      "--seed", "5", "--frames", "25", "--format", "pgm", "--out", run});
  ASSERT_EQ(simulate.wait(), 0) << simulate.err();
  vpProcess locate("vlp-locate", {"--run", run, "--fixes", fixes});
  ASSERT_EQ(locate.wait(), 0) << locate.err();
  const vpCsvTable table = vpCsvTable::load(fixes, fixColumns);
  ASSERT_EQ(table.rows(), 25u);
  for (size_t row = 0; row < table.rows(); ++row) {
    const double x = -0.3 + 0.1 * table.number(row, 0); // as the scenario drives
    EXPECT_NEAR(table.number(row, 1), x, 5 * table.number(row, 7)) << row;
    EXPECT_NEAR(table.number(row, 2), 0, 5 * table.number(row, 8)) << row;
    EXPECT_NEAR(table.number(row, 3), 0, 5 * table.number(row, 9)) << row;
  }
}

TEST(VlpLocateTracking, LampThatHangsElsewhereIsNamed)
{
  const vpTemporaryFolder folder;
  const std::string run = folder / "run";
  vpProcess simulate("vlp-simulate", {"--scenario", std::string(VLP_DATA_DIR) + "/scenarios/paper-still.yaml",
                                      "--frames", "20", "--format", "pgm", "--out", run});
  ASSERT_EQ(simulate.wait(), 0) << simulate.err();
  vpLampMap map = vpLampMap::load(run + "/lamps.yaml");
  map.lamps[1].position.x() += 0.05;
  map.save(run + "/lamps.yaml");
  vpProcess locate("vlp-locate", {"--run", run, "--fixes", folder / "fixes.csv"});
  ASSERT_EQ(locate.wait(), 0) << locate.err();
  EXPECT_NE(locate.err().find("lamp " + map.lamps[1].id + " is not where the map has it"), std::string::npos)
      << locate.err();
}
