/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <visp3/vlp_sensor/vpPictureSequence.h>
#include <visp3/vlp_sensor/vpVideoSource.h>

#include "common/vpExpectError.h"
#include "common/vpTemporaryFolder.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
//! A 4 x 3 picture of one grey.
std::string picture(const vpTemporaryFolder &folder, const std::string &name, int grey)
{
  EXPECT_TRUE(cv::imwrite(folder / name, cv::Mat(3, 4, CV_8UC1, cv::Scalar(grey))));
  return folder / name;
}

//! Name and grey of each frame; the message of a frame that cannot be read.
std::vector<std::string> all(vpFrameSource &source)
{
  std::vector<std::string> frames;
  vpVlpFrame frame;
  for (bool more = true; more;) {
    try {
      more = source.next(frame);
      if (more) {
        frames.push_back(frame.name + " " + std::to_string(frame.I[0][0]) + " " +
                         std::to_string(frame.timestamp));
      }
    } catch (const vpException &error) {
      frames.push_back(error.getStringMessage());
    }
  }
  EXPECT_FALSE(source.next(frame)); // and stays at its end
  return frames;
}
} // namespace

TEST(PictureSequence, FilesInTheirOrderWithTheirIndexAsTime)
{
  const vpTemporaryFolder folder;
  const std::string b = picture(folder, "b.png", 20), a = picture(folder, "a.png", 10);
  vpPictureSequence sequence({b, a, b});
  EXPECT_EQ(sequence.size(), 3u);
  EXPECT_EQ(all(sequence),
            (std::vector<std::string>{b + " 20 0.000000", a + " 10 1.000000", b + " 20 2.000000"}));
  vpExpectError([] { vpPictureSequence(std::vector<std::string>()); }, {"picture files: none"});
}

TEST(PictureSequence, GoesOnBehindAFrameThatCannotBeRead)
{
  const vpTemporaryFolder folder;
  const std::string a = picture(folder, "a.png", 10), bad = folder.write("bad.png", "no picture");
  vpPictureSequence sequence({a, bad, folder / "none.png", a});
  const std::vector<std::string> frames = all(sequence);
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_EQ(frames[1].find(bad + ": "), 0u);
  EXPECT_EQ(frames[2].find(folder / "none.png: cannot be opened"), 0u);
  EXPECT_EQ(frames[3], a + " 10 3.000000"); // its own index: the others were there too
}

TEST(PictureSequence, PatternFromTheFirstNumberToTheFirstMissing)
{
  const vpTemporaryFolder folder;
  for (const int number : {3, 4, 5, 7, 12345}) {
    char name[32];
    std::snprintf(name, sizeof name, "100%%_%04d.png", number);
    picture(folder, name, number % 100);
  }
  picture(folder, "100%_2.png", 99); // not of four digits
  picture(folder, "100%_0001.jpg", 99);
  vpPictureSequence sequence = vpPictureSequence::fromPattern(folder / "100%%_%04d.png");
  EXPECT_EQ(sequence.size(), 3u);
  const std::vector<std::string> frames = all(sequence);
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[0], folder / "100%_0003.png 3 0.000000");
  EXPECT_EQ(frames[2], folder / "100%_0005.png 5 2.000000");
  EXPECT_EQ(sequence.remark(),
            folder / "100%_0006.png: missing, expected numbers without gaps; pictures from " +
                (folder / "100%_0007.png on are left out, 2"));

  picture(folder, "9.png", 9);
  picture(folder, "10.png", 10);
  EXPECT_EQ(vpPictureSequence::fromPattern(folder / "%d.png").size(), 2u);
  EXPECT_EQ(vpPictureSequence::fromPattern(folder / "%d.png").remark(), "");
}

TEST(PictureSequence, BadPatternsAreRefused)
{
  const vpTemporaryFolder folder;
  for (const std::string pattern :
       {"a.png", "%s.png", "%n%d.png", "%d%d.png", "%.4d.png", "%-4d.png", "%4d.png", "%", "%04", "%f", "%ld",
        "%00004d.png", "a%%.png", "%*d.png", "%1$d.png"}) {
    SCOPED_TRACE(pattern);
    vpExpectError([&] { vpPictureSequence::fromPattern(folder / pattern); },
                  {pattern + ": ", "expected one number as %d or %04d"});
  }
  vpExpectError([&] { vpPictureSequence::fromPattern(folder / "run%d/a.png"); },
                {"the number is in the folder's name"});
  vpExpectError([&] { vpPictureSequence::fromPattern(folder / "a%d.png"); }, {"a%d.png: no such file"});
  vpExpectError([&] { vpPictureSequence::fromPattern(folder / "none/a%d.png"); }, {"a%d.png: no such file"});
}

TEST(PictureSequence, RunFolder)
{
  const vpTemporaryFolder folder;
  picture(folder, "a.png", 10);
  picture(folder, "b.png", 20);
  folder.write("frames.csv", "timestamp_s,file\n1.5,a.png\n1.75,b.png\n1.75,a.png\n");
  vpPictureSequence sequence = vpPictureSequence::fromRun(folder.path());
  EXPECT_EQ(all(sequence),
            (std::vector<std::string>{folder / "a.png 10 1.500000", folder / "b.png 20 1.750000",
                                      folder / "a.png 10 1.750000"}));
  folder.write("frames.csv", "timestamp_s,file\n-1.5,a.png\n60,b.png\n");
  EXPECT_EQ(vpPictureSequence::fromRun(folder.path()).remark(), "");
  EXPECT_EQ(vpPictureSequence({folder / "a.png", folder / "a.png"}).remark(), "");
}

TEST(PictureSequence, FramesThatComeLateKeepTheirPlaceAndAreRemarkedOnOnce)
{
  const vpTemporaryFolder folder;
  picture(folder, "a.png", 10);
  picture(folder, "b.png", 20);
  const std::string list = folder.write("frames.csv", "timestamp_s,file\n1,a.png\n0.50,b.png\n2,a.png\n");
  vpPictureSequence sequence = vpPictureSequence::fromRun(folder.path());
  EXPECT_EQ(sequence.remark(), list + ":3: timestamp_s: 0.50, not after the 1 of the line above");
  EXPECT_EQ(all(sequence),
            (std::vector<std::string>{folder / "a.png 10 1.000000", folder / "b.png 20 0.500000",
                                      folder / "a.png 10 2.000000"}));

  folder.write("frames.csv", "timestamp_s,file\n1,a.png\n1,b.png\n2,a.png\n-7,a.png\n");
  EXPECT_EQ(vpPictureSequence::fromRun(folder.path()).remark(),
            list + ":3: timestamp_s: 1, not after the 1 of the line above (the first of 2 such lines)");
}

TEST(PictureSequence, BadRunFoldersAreRefusedWithFileAndLine)
{
  const vpTemporaryFolder folder;
  const std::string list = folder / "frames.csv";
  const auto expectBad = [&](const std::string &text, const std::string &part) {
    SCOPED_TRACE(text);
    folder.write("frames.csv", text);
    vpExpectError([&] { vpPictureSequence::fromRun(folder.path()); }, {list + part});
  };
  vpExpectError([&] { vpPictureSequence::fromRun(folder.path()); },
                {list + ": cannot be opened: No such file"});
  expectBad("", ":1: header: nothing, expected timestamp_s,file");
  expectBad("0,a.png\n", ":1: header: 0,a.png, expected timestamp_s,file");
  expectBad("timestamp_s,file\n", ": no frames, expected one or more");
  expectBad("timestamp_s,file\n0,a.png\nsoon,b.png\n", ":3: timestamp_s: soon, expected a finite number");
  expectBad("timestamp_s,file\n0,a.png\nnan,b.png\n", ":3: timestamp_s: nan, expected a finite number");
  expectBad("timestamp_s,file\n0,a.png\n,b.png\n", ":3: timestamp_s: nothing, expected a finite number");
  expectBad("timestamp_s,file\n0,a.png\n1,\n", ":3: file: nothing, expected a file's name");
  expectBad("timestamp_s,file\n0,a.png\n1\n", ":3: 1 field, expected 2");
}

TEST(VideoSource, FramesWithTheStreamsOwnTimes)
{
  const vpTemporaryFolder folder;
  std::string bytes = "YUV4MPEG2 W64 H48 F25:1 Ip A1:1 Cmono\n"; // the simplest lossless video
  for (int i = 0; i < 5; ++i) {
    bytes += "FRAME\n" + std::string(64 * 48, static_cast<char>(40 * i));
  }
  const std::string file = folder.write("a.y4m", bytes);
  vpVideoSource source(file);
  EXPECT_EQ(source.size(), 5u);
  vpVlpFrame frame;
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(source.next(frame));
    EXPECT_EQ(frame.I.getRows(), 48u);
    EXPECT_EQ(frame.I.getCols(), 64u);
    EXPECT_NEAR(frame.I[20][30], 40 * i, 3);
    EXPECT_NEAR(frame.timestamp, i / 25.0, 1e-3);
    EXPECT_EQ(frame.name, file + "#" + std::to_string(i));
  }
  EXPECT_FALSE(source.next(frame));
  EXPECT_FALSE(source.next(frame));
  EXPECT_EQ(frame.name, file + "#4");
}

TEST(VideoSource, WhatIsNoVideoIsAnError)
{
  const vpTemporaryFolder folder;
  const auto expectBad = [](const std::string &file, const std::string &problem) {
    vpExpectError([&] { vpVideoSource source(file); }, {file + problem});
  };
  expectBad(folder / "none.avi", ": cannot be opened: No such file or directory");
  expectBad(folder.path(), ": cannot be opened: Is a directory");
  expectBad(folder.write("empty.avi", ""), ": no video that OpenCV can read");
  expectBad(folder.write("text.avi", "not a video"), ": no video that OpenCV can read");
}
