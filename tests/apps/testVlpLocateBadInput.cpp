/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vlp-locate on what is no good: one clear line, the right exit code, outputs whole or absent.

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "apps/vpExpectRefused.h"
#include "apps/vpLocateScene.h"
#include "common/vpProcess.h"

namespace
{
using vpLocateScene::encoded;
using vpLocateScene::with;

using namespace vpStatus;

//! Runs vlp-locate and expects one line on stderr with all of \e parts, and no stdout but a comment.
void expectLocateRefuses(const std::vector<std::string> &arguments, int code,
                         const std::vector<std::string> &parts)
{
  const std::string out = vpExpectRefused("vlp-locate", arguments, code, parts);
  EXPECT_TRUE(out.empty() || (out[0] == '#' && out.find('\n') == out.size() - 1))
      << out << testing::PrintToString(arguments);
}

struct Case {
  std::string name; // of the picture's file
  std::string bytes;
  int code;
  std::vector<std::string> parts; // of the line
};

std::vector<Case> badPictures()
{
  const cv::Mat good = vpLocateScene::picture();
  const std::string png = encoded(".png", good), jpeg = encoded(".jpg", good),
                    size = "expected 640 x 480 pixels";
  const auto plain = [](int width, int height, int grey) {
    return encoded(".png", cv::Mat(height, width, CV_8UC1, cv::Scalar(grey)));
  };
  return {{"short.png", png.substr(0, png.size() / 2), badInput, {"the picture is cut short"}},
          {"short.jpg", jpeg.substr(0, jpeg.size() / 2), badInput, {"the picture is cut short"}},
          {"text.png", "These are no pixels.\n", badInput, {"no picture"}},
          {"empty.png", "", badInput, {"an empty file, expected a picture"}},
          {"pixel.png", plain(1, 1, 0), badInput, {"1 x 1 pixels", size, "camera test", "rig.yaml"}},
          {"row.png", plain(640, 1, 0), badInput, {"640 x 1 pixels", size}},
          {"large.png", plain(800, 600, 0), badInput, {"800 x 600 pixels", size}},
          {"upright.png", plain(480, 640, 0), badInput, {"480 x 640 pixels", size}},
          {"black.png", plain(640, 480, 0), nothingFound, {"no position"}},
          {"white.png", plain(640, 480, 255), nothingFound, {"no position"}},
          {"deep.png",
           encoded(".png", cv::Mat(480, 640, CV_16UC1, cv::Scalar(3000))),
           nothingFound,
           {"no position"}},
          {"alpha.png",
           encoded(".png", cv::Mat(480, 640, CV_8UC4, cv::Scalar(9, 9, 9, 0))),
           nothingFound,
           {"no position"}}};
}
} // namespace

TEST(VlpLocateBadInput, BadPictureIsOneClearLine)
{
  for (const Case &bad : badPictures()) {
    const vpTemporaryFolder folder;
    const auto rig = vpLocateScene::writeRig(folder);
    const std::string picture = folder.write(bad.name, bad.bytes);
    expectLocateRefuses(with(rig, {"--image", picture}), bad.code, with(bad.parts, {picture}));
  }
}

TEST(VlpLocateBadInput, OutputsAreWholeWhereNothingIsFoundAndAbsentWhereNothingIsRead)
{
  for (const Case &bad : badPictures()) {
    SCOPED_TRACE(bad.name);
    const vpTemporaryFolder folder, outputs;
    const auto rig = vpLocateScene::writeRig(folder);
    const std::string picture = folder.write(bad.name, bad.bytes);
    vpProcess locate("vlp-locate", with(rig, {"--image", picture, "--poses", outputs / "poses.tum", "--fixes",
                                              outputs / "fixes.csv", "--seen", outputs / "seen.csv"}));
    EXPECT_EQ(locate.wait(), bad.code);
    if (bad.code == badInput) {
      EXPECT_EQ(outputs.count(), 0u); // no temporary files either
      continue;
    }
    EXPECT_EQ(outputs.count(), 3u);
    EXPECT_EQ(outputs.read("poses.tum").find('\n'), outputs.read("poses.tum").size() - 1);
    EXPECT_NE(outputs.read("fixes.csv").find("\n0,,,,,,,,,,,,,none,"), std::string::npos)
        << outputs.read("fixes.csv");
    EXPECT_EQ(outputs.read("seen.csv").rfind("timestamp_s,file,", 0), 0u);
  }
}

TEST(VlpLocateBadInput, PicturesOfOneRowOrPixelThatTheRigAsksForHoldNothing)
{
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(640, 1), cv::Size(1, 480)}) {
    const vpTemporaryFolder folder;
    const auto rig = vpLocateScene::writeRig(folder, size.width, size.height);
    const std::string picture =
        folder.write("a.png", encoded(".png", cv::Mat(size, CV_8UC1, cv::Scalar(200))));
    expectLocateRefuses(with(rig, {"--image", picture}), nothingFound, {picture, "no position"});
    expectLocateRefuses(with(rig, {"--image", picture, "--overlay", folder / "overlay"}), nothingFound,
                        {picture});
    EXPECT_TRUE(std::filesystem::exists(folder / "overlay/000000-a.png"));
  }
}

TEST(VlpLocateBadInput, BadFramesInTheMiddleLeaveTheRest)
{
  const vpTemporaryFolder folder;
  const auto rig = vpLocateScene::writeRig(folder);
  std::string list = "timestamp_s,file\n10,0.png\n";
  folder.write("0.png", encoded(".png", vpLocateScene::picture()));
  int bad = 0;
  for (const Case &each : badPictures()) {
    if (each.code == badInput) {
      folder.write(each.name, each.bytes);
      list += std::to_string(11 + bad++) + "," + each.name + "\n";
    }
  }
  folder.write("frames.csv", list + "30,missing.png\n40,0.png\n");
  ++bad;

  vpProcess locate("vlp-locate", {"--run", folder.path(), "--poses", folder / "poses.tum", "--fixes",
                                  folder / "fixes.csv", "--overlay", folder / "overlay"});
  EXPECT_EQ(locate.wait(), 0) << locate.err();
  const std::string poses = folder.read("poses.tum"), fixes = folder.read("fixes.csv"), err = locate.err();
  EXPECT_EQ(std::count(poses.begin(), poses.end(), '\n'), 3) << poses; // the comment and two poses
  EXPECT_NE(poses.find("\n10 "), std::string::npos) << poses;
  EXPECT_NE(poses.find("\n40 "), std::string::npos) << poses;
  EXPECT_EQ(std::count(fixes.begin(), fixes.end(), '\n'), 3) << fixes;
  int lines = 0;
  for (size_t i = err.find("error: "); i != std::string::npos; i = err.find("error: ", i + 1)) {
    ++lines;
  }
  EXPECT_EQ(lines, bad) << err;
  EXPECT_NE(err.find(folder / "missing.png: cannot be opened"), std::string::npos) << err;
  EXPECT_NE(err.find("2 frames, 2 positions"), std::string::npos) << err;
  EXPECT_NE(err.find(std::to_string(bad) + " other frames could not be used"), std::string::npos) << err;
}

TEST(VlpLocateBadInput, EveryFrameBadIsAnError)
{
  const vpTemporaryFolder folder;
  const auto rig = vpLocateScene::writeRig(folder);
  folder.write("frames.csv", "timestamp_s,file\n0,no.png\n1,none.png\n");
  vpProcess locate("vlp-locate", {"--run", folder.path(), "--fixes", folder / "fixes.csv"});
  EXPECT_EQ(locate.wait(), badInput);
  EXPECT_NE(locate.err().find(folder.path() + ": none of the 2 frames could be used"), std::string::npos)
      << locate.err();
  EXPECT_FALSE(std::filesystem::exists(folder / "fixes.csv"));
}

TEST(VlpLocateBadInput, LampMapThatCanGiveNoPosition)
{
  const vpTemporaryFolder folder;
  auto rig = vpLocateScene::writeRig(folder);
  const std::string picture = folder.write("a.png", encoded(".png", vpLocateScene::picture()));
  folder.write("lamps.yaml", vpLocateScene::lampsText({vpLocateScene::lamps[0]}));
  expectLocateRefuses(with(rig, {"--image", picture}), badInput,
                      {folder / "lamps.yaml: 1 lamp, expected 2 or more"});
  folder.write("lamps.yaml", vpLocateScene::lampsText({vpLocateScene::lamps[0], vpLocateScene::lamps[1]}));
  expectLocateRefuses(with(rig, {"--image", picture, "--attitude", "free"}), badInput,
                      {folder / "lamps.yaml: 2 lamps, expected 3 or more"});

  // Lamps can be looked at without a position.
  folder.write("lamps.yaml", vpLocateScene::lampsText({vpLocateScene::lamps[0]}));
  vpProcess locate("vlp-locate", with(rig, {"--image", picture, "--seen", folder / "seen.csv"}));
  EXPECT_EQ(locate.wait(), nothingFound);
  EXPECT_NE(folder.read("seen.csv").find(",A,"), std::string::npos) << folder.read("seen.csv");
}

TEST(VlpLocateBadInput, BadRigLampsAndListsOfFrames)
{
  const vpTemporaryFolder folder;
  const auto rig = vpLocateScene::writeRig(folder);
  const std::string picture = folder.write("a.png", encoded(".png", vpLocateScene::picture()));
  const std::string lamps = rig[3], text = folder.write("text.txt", "nothing of use\n");
  expectLocateRefuses({"--rig", folder / "none.yaml", "--lamps", lamps, "--image", picture}, badInput,
                      {folder / "none.yaml: cannot be opened: No such file"});
  expectLocateRefuses({"--rig", rig[1], "--lamps", text, "--image", picture}, badInput,
                      {text, "expected a mapping"});
  expectLocateRefuses({"--rig", lamps, "--lamps", lamps, "--image", picture}, badInput, {lamps, "camera"});
  expectLocateRefuses(with(rig, {"--run", folder / "nowhere"}), badInput,
                      {folder / "nowhere/frames.csv: cannot be opened"});
  expectLocateRefuses(with(rig, {"--images", folder / "b%d.png"}), badInput,
                      {folder / "b%d.png", "no such file"});
  expectLocateRefuses(with(rig, {"--images", folder / "a.png"}), badInput,
                      {"expected one number as %d or %04d"});
  expectLocateRefuses(with(rig, {"--video", folder / "no.avi"}), badInput,
                      {folder / "no.avi: cannot be opened"});
  expectLocateRefuses(with(rig, {"--video", text}), badInput, {text + ": no"});
  folder.write("frames.csv", "time,file\n0,a.png\n");
  expectLocateRefuses({"--run", folder.path()}, badInput,
                      {folder / "frames.csv:1", "expected timestamp_s,file"});
}

TEST(VlpLocateBadInput, OutputThatCannotBeWrittenIsAnErrorBeforeTheWork)
{
  const vpTemporaryFolder folder;
  const auto rig = vpLocateScene::writeRig(folder);
  const std::string picture = folder.write("a.png", encoded(".png", vpLocateScene::picture()));
  for (const std::string option : {"--poses", "--fixes", "--seen"}) {
    expectLocateRefuses(with(rig, {"--image", picture, option, folder / "no/out"}), badInput,
                        {folder / "no/out: cannot be written: No such file or directory"});
    expectLocateRefuses(with(rig, {"--image", picture, option, folder.path()}), badInput,
                        {folder.path() + ": cannot be written: Is a directory"});
  }
  expectLocateRefuses(with(rig, {"--image", picture, "--overlay", picture}), badInput,
                      {picture + ": the folder cannot be made"});
  expectLocateRefuses(with(rig, {"--image", picture, "--overlay", "/proc/overlay"}), badInput,
                      {"/proc/overlay"});
  // An error of one output leaves nothing of the others.
  const vpTemporaryFolder outputs;
  expectLocateRefuses(
      with(rig, {"--image", picture, "--poses", outputs / "poses.tum", "--seen", outputs / "no/seen.csv"}),
      badInput, {"no/seen.csv"});
  EXPECT_EQ(outputs.count(), 0u);

  vpProcess full("vlp-locate", with(rig, {"--image", picture}), "/dev/full");
  EXPECT_EQ(full.wait(), badInput);
  EXPECT_NE(full.err().find("stdout: cannot be written"), std::string::npos) << full.err();
}

TEST(VlpLocateBadInput, BadUsage)
{
  const vpTemporaryFolder folder;
  const auto rig = vpLocateScene::writeRig(folder);
  const std::string picture = folder.write("a.png", encoded(".png", vpLocateScene::picture()));
  const std::vector<std::string> good = with(rig, {"--image", picture});
  expectLocateRefuses({}, badInput, {"--run, --images, --image, --video and --camera", "--help"});
  expectLocateRefuses({"--image", picture}, badInput, {"--rig"});
  expectLocateRefuses({"--rig", rig[1], "--image", picture}, badInput, {"--lamps"});
  expectLocateRefuses(with(good, {"--run", folder.path()}), badInput, {"more than one source"});
  expectLocateRefuses(with(good, {"--nonsense"}), badInput, {"--nonsense"});
  expectLocateRefuses(with(good, {"--frames", "0"}), badInput,
                      {"--frames: 0, expected a whole number from 1"});
  expectLocateRefuses({"a.png"}, badInput, {"a.png"});
  expectLocateRefuses(with(good, {"--solver", "three"}), badInput, {"--solver: three", "all|two"});
  expectLocateRefuses(with(good, {"--attitude", ""}), badInput, {"--attitude", "mount|free"});
  expectLocateRefuses(with(good, {"--solver", "two", "--attitude", "free"}), badInput,
                      {"--attitude: free", "mount"});
  expectLocateRefuses(with(good, {"--poses", ""}), badInput, {"--poses", "empty"});
  expectLocateRefuses(with(good, {"--poses", folder / "o", "--fixes", folder / "./o"}), badInput,
                      {"--fixes", "--poses"});
  expectLocateRefuses(with(good, {"--poses", picture}), badInput, {"--poses", "--image"});
  expectLocateRefuses(with(good, {"--seen", rig[1]}), badInput, {"--seen", "--rig"});
  expectLocateRefuses(with(rig, {"--image"}), badInput, {"--image"});
  expectLocateRefuses(with(rig, {"--image", "two\nlines.png"}), badInput, {"two\\x0alines.png"});
}
