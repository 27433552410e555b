/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vlp-locate on pictures of a known scene: poses, tables and overlays.

#include <chrono>
#include <filesystem>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#include <visp3/vlp_core/vpCsvTable.h>
#include <visp3/vlp_core/vpModulation.h>
#include <visp3/vlp_core/vpTrajectory.h>
#include <visp3/vlp_core/vpVlpRig.h>

#include "apps/vpLocateScene.h"
#include "common/vpProcess.h"

namespace
{
using vpLocateScene::encoded;
using vpLocateScene::with;

const double x = 0.06, y = -0.04, yaw = 0.5; // m, rad; where the robot of the scene's picture stands

using vpLocateScene::fixColumns;
const std::vector<std::string> seenColumns = {"timestamp_s", "file",        "lamp_id",      "u",
                                              "v",           "diameter_px", "frequency_hz", "duty",
                                              "confidence",  "accepted",    "symbols"};

//! Rows of a TUM trajectory as numbers, without its comments.
std::vector<std::vector<double>> tumRows(const std::string &text)
{
  std::vector<std::vector<double>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') {
      continue;
    }
    std::istringstream words(line);
    rows.emplace_back();
    for (double value; words >> value;) {
      rows.back().push_back(value);
    }
    EXPECT_TRUE(words.eof()) << line;
  }
  return rows;
}

//! One row, at the scene's pose.
void expectTumPose(const std::string &text, double timestamp)
{
  const auto rows = tumRows(text);
  ASSERT_EQ(rows.size(), 1u) << text;
  ASSERT_EQ(rows[0].size(), 8u) << text;
  EXPECT_EQ(rows[0][0], timestamp);
  EXPECT_NEAR(rows[0][1], x, 2e-3);
  EXPECT_NEAR(rows[0][2], y, 2e-3);
  EXPECT_NEAR(rows[0][3], 0, 5e-3);
  EXPECT_NEAR(rows[0][4], 0, 1e-9);
  EXPECT_NEAR(rows[0][5], 0, 1e-9);
  EXPECT_NEAR(rows[0][6], std::sin(yaw / 2), 1e-3);
  EXPECT_NEAR(rows[0][7], std::cos(yaw / 2), 1e-3);
}

std::string stdoutOf(const std::vector<std::string> &arguments)
{
  vpProcess locate("vlp-locate", arguments);
  EXPECT_EQ(locate.wait(), 0) << locate.err();
  return locate.out();
}
} // namespace

TEST(VlpLocate, SamePictureOnEveryWayInGivesTheSamePose)
{
  const vpTemporaryFolder folder;
  const auto rig = vpLocateScene::writeRig(folder);
  const std::string file = folder.write("f0000.png", encoded(".png", vpLocateScene::picture()));
  folder.write("frames.csv", "timestamp_s,file\n0,f0000.png\n");
  const cv::Mat grey = vpLocateScene::picture();
  const std::string video = folder.write("a.y4m", "YUV4MPEG2 W640 H480 F25:1 Ip A1:1 Cmono\nFRAME\n" +
                                                      std::string(grey.data, grey.data + grey.total()));

  const std::string pose = stdoutOf(with(rig, {"--image", file}));
  expectTumPose(pose, 0);
  EXPECT_EQ(pose.rfind("# timestamp tx ty tz qx qy qz qw", 0), 0u) << pose;
  EXPECT_EQ(stdoutOf(with(rig, {"--image", file})), pose);
  EXPECT_EQ(stdoutOf(with(rig, {"--image", file, "--no-track"})), pose);
  EXPECT_EQ(stdoutOf(with(rig, {"--images", folder / "f%04d.png"})), pose);
  EXPECT_EQ(stdoutOf(with(rig, {"--run", folder.path()})), pose);
  EXPECT_EQ(stdoutOf({"--run", folder.path()}), pose);
  EXPECT_EQ(stdoutOf(with(rig, {"--video", video})), pose);
  EXPECT_EQ(stdoutOf(with(rig, {"--image", file, "--poses", folder / "poses.tum"})), "");
  EXPECT_EQ(folder.read("poses.tum"), pose);
}

TEST(VlpLocate, DeepAndColourPicturesGiveTheSamePose)
{
  const vpTemporaryFolder folder;
  const auto rig = vpLocateScene::writeRig(folder);
  const cv::Mat grey = vpLocateScene::picture();
  const std::string pose = stdoutOf(with(rig, {"--image", folder.write("grey.png", encoded(".png", grey))}));
  cv::Mat deep, alpha;
  grey.convertTo(deep, CV_16U, 257);
  cv::cvtColor(grey, alpha, cv::COLOR_GRAY2BGRA);
  EXPECT_EQ(stdoutOf(with(rig, {"--image", folder.write("deep.png", encoded(".png", deep))})), pose);
  EXPECT_EQ(stdoutOf(with(rig, {"--image", folder.write("alpha.png", encoded(".png", alpha))})), pose);
  expectTumPose(stdoutOf(with(rig, {"--image", folder.write("grey.jpg", encoded(".jpg", grey))})), 0);
}

TEST(VlpLocate, SolversAndAttitudesAgree)
{
  const vpTemporaryFolder folder;
  const auto rig = vpLocateScene::writeRig(folder);
  const std::string file = folder.write("a.png", encoded(".png", vpLocateScene::picture()));
  expectTumPose(stdoutOf(with(rig, {"--image", file, "--solver", "two"})), 0);

  // Lamps this close together tell a tilt only roughly: the rig says how far the robot may lean.
  vpLocateScene::writeRig(folder, 640, 480, ", rotation_sigma_deg: [1, 1, 1]");
  const auto free = tumRows(stdoutOf(with(rig, {"--image", file, "--attitude", "free"})));
  ASSERT_EQ(free.size(), 1u);
  EXPECT_NEAR(free[0][1], x, 0.05);
  EXPECT_NEAR(free[0][2], y, 0.05);
  EXPECT_NEAR(free[0][6], std::sin(yaw / 2), 5e-3);
}

// The middle of a disc lies elsewhere in its ellipse than the rig's attitude has it, by 2 mm here.
TEST(VlpLocate, FreeAttitudePlacesTheMiddlesOfDiscsUnderTheLeanThatItFinds)
{
  const vpTemporaryFolder folder;
  const std::string data = VLP_DATA_DIR, run = folder / "run", poses = folder / "poses.tum";
  std::string lamps = "lamps:\n";
  for (const char *lamp : {"A, position_m: [-0.5, 0.5, 1.5], frequency_hz: 1000",
                           "B, position_m: [-0.46, -0.42, 1.8], frequency_hz: 1400",
                           "C, position_m: [0.46, 0.49, 1.5], frequency_hz: 1900",
                           "D, position_m: [0.5, -0.43, 1.3], frequency_hz: 2500"})
    lamps += std::string("  - {id: ") + lamp + ", diameter_m: 0.3, duty: 0.5}\n";
  folder.write("lamps.yaml", lamps);
  const std::string scenario = folder.write(
      "scenario.yaml", "rig: " + data +
                           "/rigs/ub300-800x600.yaml\nlamps: lamps.yaml\n"
                           "frames: {rate_hz: 12}\nmotion: {type: stations, points: [{at_m: [0, 0]}, "
                           "{at_m: [0.02, -0.03], yaw_deg: 170}], frames_each: 2}\n"
                           "truth: {tilt_deg: [4, -3]}\n");
  vpProcess simulate("vlp-simulate", {"--scenario", scenario, "--out", run});
  ASSERT_EQ(simulate.wait(), 0) << simulate.err();
  stdoutOf({"--run", run, "--attitude", "free", "--no-track", "--poses", poses});
  const vpTrajectory found = vpTrajectory::load(poses), truth = vpTrajectory::load(run + "/truth.tum");
  const vpHomogeneousMatrix bMc = vpVlpRig::load(run + "/rig.yaml").bMc;
  ASSERT_EQ(found.size(), 4u);
  for (const vpTimedPose &pose : found.poses()) {
    const vpHomogeneousMatrix wMc = pose.wMb * bMc, level = *truth.at(pose.timestamp) * bMc;
    EXPECT_LT(std::hypot(wMc[0][3] - level[0][3], wMc[1][3] - level[1][3]), 0.0005);
  }
}

TEST(VlpLocate, FixesAndSeenHoldTheirColumns)
{
  const vpTemporaryFolder folder;
  const auto rig = vpLocateScene::writeRig(folder);
  folder.write("lamps.png", encoded(".png", vpLocateScene::picture()));
  folder.write("black.png", encoded(".png", cv::Mat(480, 640, CV_8UC1, cv::Scalar(0))));
  folder.write("frames.csv", "timestamp_s,file\n1700000000.25,lamps.png\n1700000000.5,black.png\n");
  EXPECT_EQ(stdoutOf({"--run", folder.path(), "--no-track", "--fixes", folder / "fixes.csv", "--seen",
                      folder / "seen.csv"}),
            "");

  const vpCsvTable fixes = vpCsvTable::load(folder / "fixes.csv", fixColumns);
  ASSERT_EQ(fixes.rows(), 2u);
  const double expected[] = {1700000000.25, x, y, 0, 0, 0, yaw},
               tolerance[] = {0, 2e-3, 2e-3, 5e-3, 1e-9, 1e-9, 2e-3};
  for (size_t column = 0; column < 7; ++column) {
    EXPECT_NEAR(fixes.number(0, column), expected[column], tolerance[column]) << fixColumns[column];
  }
  for (size_t column = 7; column < 11; ++column) { // sigmas
    EXPECT_GT(fixes.number(0, column), 0) << fixColumns[column];
    EXPECT_LT(fixes.number(0, column), 0.02) << fixColumns[column];
  }
  EXPECT_LT(std::abs(fixes.number(0, 11)), fixes.number(0, 7) * fixes.number(0, 8));
  std::string lamps = fixes.text(0, 12);
  EXPECT_EQ(lamps.size(), 5u) << lamps;
  for (const char id : {'A', 'B', 'C'}) {
    EXPECT_NE(lamps.find(id), std::string::npos) << lamps;
  }
  EXPECT_EQ(fixes.text(0, 13), "fix");
  EXPECT_GT(fixes.number(0, 14), 0);
  EXPECT_EQ(fixes.number(1, 0), 1700000000.5);
  for (size_t column = 1; column < 13; ++column) {
    EXPECT_EQ(fixes.text(1, column), "") << fixColumns[column];
  }
  EXPECT_EQ(fixes.text(1, 13), "none");

  const vpCsvTable seen = vpCsvTable::load(folder / "seen.csv", seenColumns);
  ASSERT_EQ(seen.rows(), 3u);
  for (size_t row = 0; row < 3; ++row) {
    const auto lamp = std::find_if(vpLocateScene::lamps.begin(), vpLocateScene::lamps.end(),
                                   [&](const auto &each) { return each.id == seen.text(row, 2); });
    ASSERT_NE(lamp, vpLocateScene::lamps.end()) << seen.text(row, 2);
    EXPECT_EQ(seen.number(row, 0), 1700000000.25);
    EXPECT_EQ(seen.text(row, 1), folder / "lamps.png");
    const vpHomogeneousMatrix cMw = (vpLocateScene::robot(x, y, yaw) * vpLocateScene::bMc).inverse();
    const vpColVector c = cMw * vpColVector(std::vector<double>{lamp->x, lamp->y, lamp->z, 1});
    EXPECT_NEAR(seen.number(row, 3), vpLocateScene::u0 + vpLocateScene::focal * c[0] / c[2], 0.5);
    EXPECT_NEAR(seen.number(row, 4), vpLocateScene::v0 + vpLocateScene::focal * c[1] / c[2], 0.5);
    EXPECT_NEAR(seen.number(row, 5), vpLocateScene::focal * vpLocateScene::diameter / c[2], 1);
    EXPECT_NEAR(seen.number(row, 6), lamp->frequency, 0.01 * lamp->frequency);
    EXPECT_NEAR(seen.number(row, 7), 0.5, 0.1);
    EXPECT_GT(seen.number(row, 8), 0.9);
    EXPECT_EQ(seen.text(row, 9), "1");
    EXPECT_EQ(seen.text(row, 10), ""); // no lamp of the scene sends a word
  }
}

TEST(VlpLocate, SymbolsAreTheChipsOfALampThatSendsAWord)
{
  const vpTemporaryFolder folder;
  const auto rig = vpLocateScene::writeRig(folder);
  const std::string bits = "0111101100"; // of which Manchester makes 20 chips
  vpModulation word;
  word.kind = vpModulation::Kind::word;
  word.bits = bits;
  const std::string chips = word.chips();
  std::string greatest;
  for (size_t turn = 0; turn < chips.size(); ++turn) {
    greatest = std::max(greatest, chips.substr(turn) + chips.substr(0, turn));
  }
  folder.write("lamps.yaml", "lamps:\n  - {id: W, position_m: [0, 0, 1.6], diameter_m: 0.3, word: {bits: \"" +
                                 bits + "\", chip_rate_hz: 8000, code: manchester}}\n");
  vpLampPicture scene;
  scene.blur = 0.7;
  scene.background = 4;
  scene.noise = 1;
  vpPaintedLamp lamp;
  lamp.centre = {vpLocateScene::u0, vpLocateScene::v0};
  lamp.a = lamp.b = 60;
  lamp.frequency = 8000. / static_cast<double>(chips.size());
  lamp.chips(chips);
  scene.lamps.push_back(lamp);
  const vpImage<unsigned char> I = scene.render();
  const std::string file =
      folder.write("a.png", encoded(".png", cv::Mat(scene.height, scene.width, CV_8UC1, I.bitmap)));
  vpProcess locate("vlp-locate", with(rig, {"--image", file, "--seen", folder / "seen.csv"}));
  EXPECT_EQ(locate.wait(), 3) << locate.err(); // one lamp is no position
  const vpCsvTable seen = vpCsvTable::load(folder / "seen.csv", seenColumns);
  ASSERT_EQ(seen.rows(), 1u);
  EXPECT_EQ(seen.text(0, 2), "W");
  EXPECT_EQ(seen.text(0, 10), greatest);
}

TEST(VlpLocate, LampThatTheMapDoesNotKnowIsSeenAndDoesNotCount)
{
  const vpTemporaryFolder folder;
  const auto rig = vpLocateScene::writeRig(folder);
  folder.write("lamps.yaml",
               vpLocateScene::lampsText({vpLocateScene::lamps[0], vpLocateScene::lamps[1]})); // without C
  const std::string file = folder.write("a.png", encoded(".png", vpLocateScene::picture()));
  stdoutOf(with(rig, {"--image", file, "--seen", folder / "seen.csv"}));
  const vpCsvTable seen = vpCsvTable::load(folder / "seen.csv", seenColumns);
  ASSERT_EQ(seen.rows(), 3u);
  int unknown = 0;
  for (size_t row = 0; row < 3; ++row) {
    unknown += seen.text(row, 2).empty() ? 1 : 0;
    EXPECT_EQ(seen.text(row, 9), seen.text(row, 2).empty() ? "0" : "1");
  }
  EXPECT_EQ(unknown, 1);
}

TEST(VlpLocate, SaysWhereNothingStatesASigma)
{
  const vpTemporaryFolder folder;
  const auto rig = vpLocateScene::writeRig(folder);
  const std::string file = folder.write("a.png", encoded(".png", vpLocateScene::picture()));
  const std::string remark = "state no position_sigma_m";
  for (const bool stated : {false, true}) {
    if (stated) {
      std::string lamps = folder.read("lamps.yaml");
      lamps.replace(lamps.find("id:"), 3, "position_sigma_m: 0.002, id:");
      folder.write("lamps.yaml", lamps);
    }
    vpProcess locate("vlp-locate", with(rig, {"--image", file}));
    EXPECT_EQ(locate.wait(), 0) << locate.err();
    EXPECT_EQ(locate.err().find(remark) == std::string::npos, stated) << locate.err();
  }
}

// An exposure that the rig misstates costs no id and is told, once.
TEST(VlpLocate, TellsTheExposureThatTheStripesShow)
{
  const vpTemporaryFolder folder;
  const auto rig = vpLocateScene::writeRig(folder);
  const std::string file = folder.write("f.png", encoded(".png", vpLocateScene::picture())),
                    right = folder.read("rig.yaml"), stated = "exposure_s: 43.1e-6";
  for (const std::string wrong : {"6e-6", "43.1e-6", "3e-4"}) {
    std::string text = right;
    folder.write("rig.yaml", text.replace(text.find(stated), stated.size(), "exposure_s: " + wrong));
    vpProcess locate("vlp-locate", with(rig, {"--image", file}));
    EXPECT_EQ(locate.wait(), 0) << locate.err();
    expectTumPose(locate.out(), 0);
    EXPECT_EQ(locate.err().find("shutter.exposure_s: ") != std::string::npos, wrong != "43.1e-6")
        << locate.err();
  }
}

TEST(VlpLocate, TwoLampsAtTwoHeightsCanBeAmbiguous)
{
  const vpTemporaryFolder folder;
  const auto rig = vpLocateScene::writeRig(folder);
  // In a hall: lamps that hang a few centimetres off then change little. Their sizes would tell the poses
  // apart.
  const std::vector<vpLocateScene::Lamp> lamps = {{"low", 0, 0, 5.2, 2000}, {"high", 0.6, 0, 9.2, 3000}};
  folder.write("lamps.yaml", vpLocateScene::lampsText(lamps, false));
  const cv::Mat picture = vpLocateScene::picture(vpLocateScene::robot(1.6, 1.2, 0), lamps, 0.64);
  const std::string file = folder.write("a.png", encoded(".png", picture));
  vpProcess locate("vlp-locate", with(rig, {"--image", file, "--poses", folder / "poses.tum", "--fixes",
                                            folder / "fixes.csv", "--overlay", folder / "overlay"}));
  EXPECT_EQ(locate.wait(), 0) << locate.err();
  EXPECT_NE(locate.err().find("1 position (1 ambiguous)"), std::string::npos) << locate.err();
  const vpCsvTable fixes = vpCsvTable::load(folder / "fixes.csv", fixColumns);
  ASSERT_EQ(fixes.rows(), 1u);
  EXPECT_EQ(fixes.text(0, 13), "ambiguous");
  EXPECT_NEAR(fixes.number(0, 1), 1.6, 0.05); // the base nearer to the floor
  EXPECT_NEAR(fixes.number(0, 2), 1.2, 0.05);
  EXPECT_TRUE(tumRows(folder.read("poses.tum")).empty());
}

TEST(VlpLocate, OverlayIsAColourPictureOfEachFrame)
{
  const vpTemporaryFolder folder;
  const auto rig = vpLocateScene::writeRig(folder);
  const std::string bytes = encoded(".png", vpLocateScene::picture() / 8); // as dark as the seed rig's
  std::filesystem::create_directories(folder / "one");
  std::filesystem::create_directories(folder / "two");
  const std::string first = folder.write("one/a.png", bytes), second = folder.write("two/a.png", bytes);
  EXPECT_EQ(stdoutOf(with(rig, {"--image", first, second, "--overlay", folder / "deep/overlay"})), "");
  for (const std::string name : {"000000-a.png", "000001-a.png"}) { // one name, two pictures
    const cv::Mat whole = cv::imread(folder / "deep/overlay/" + name, cv::IMREAD_UNCHANGED);
    ASSERT_FALSE(whole.empty()) << name;
    EXPECT_EQ(whole.size(), cv::Size(1280 + 640, 960)); // the frame, and beside it pose and map
    EXPECT_EQ(whole.type(), CV_8UC3);
    const cv::Mat overlay = whole(cv::Rect(0, 0, 1280, 960));
    double brightest = 0;
    cv::Mat blue;
    cv::extractChannel(overlay, blue, 0);
    cv::minMaxLoc(blue, nullptr, &brightest);
    EXPECT_GT(brightest,
              200); // brightened: the lamps themselves, since all drawing is without blue
    cv::Mat green;
    cv::inRange(overlay, cv::Scalar(60, 200, 30), cv::Scalar(120, 255, 90), green);
    EXPECT_GT(cv::countNonZero(green), 500);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "deep/overlay"), {}), 2);
}

TEST(VlpLocate, InterruptFinishesWhatWasDone)
{
  const vpTemporaryFolder folder;
  const auto rig = vpLocateScene::writeRig(folder);
  const std::string file = folder.write("a.png", encoded(".png", vpLocateScene::picture()));
  std::string list = "timestamp_s,file\n";
  for (int i = 0; i < 5000; ++i) {
    list += std::to_string(i) + ",a.png\n";
  }
  folder.write("frames.csv", list);
  vpProcess locate("vlp-locate", {"--run", folder.path(), "--poses", folder / "poses.tum", "--fixes",
                                  folder / "fixes.csv", "--overlay", folder / "overlay"});
  while (!std::filesystem::exists(folder / "overlay/000001-a.png") && !locate.ended()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ASSERT_FALSE(locate.ended());
  EXPECT_FALSE(std::filesystem::exists(folder / "poses.tum")); // whole or not at all
  locate.signal(SIGINT);
  EXPECT_EQ(locate.wait(), 0) << locate.err();
  EXPECT_NE(locate.err().find("stopped after "), std::string::npos) << locate.err();
  EXPECT_NE(locate.err().find(" of 5000 frames"), std::string::npos) << locate.err();

  const size_t frames = tumRows(folder.read("poses.tum")).size();
  EXPECT_GE(frames, 2u);
  EXPECT_LT(frames, 5000u);
  EXPECT_EQ(vpCsvTable::load(folder / "fixes.csv", fixColumns).rows(), frames);
  size_t pictures = 0;
  for (const auto &entry : std::filesystem::directory_iterator(folder / "overlay")) {
    EXPECT_EQ(entry.path().extension(), ".png") << entry.path(); // no temporary files
    EXPECT_FALSE(cv::imread(entry.path().string()).empty()) << entry.path();
    ++pictures;
  }
  EXPECT_EQ(pictures, frames);
}

TEST(VlpLocate, HelpNamesEveryOptionAndColumn)
{
  const std::string help = stdoutOf({"--help"});
  for (const std::string word :
       {"--rig", "--lamps", "--run", "--images", "--image", "--video", "--attitude", "--solver", "--no-track",
        "--poses", "--fixes", "--seen", "--overlay", "--display", "Example", "Exit code"}) {
    EXPECT_NE(help.find(word), std::string::npos) << word;
  }
  for (const auto &columns : {fixColumns, seenColumns}) {
    std::string joined;
    for (const std::string &column : columns) {
      joined += (joined.empty() ? "" : ",") + column;
    }
    EXPECT_NE(help.find(joined), std::string::npos) << joined;
  }
}
