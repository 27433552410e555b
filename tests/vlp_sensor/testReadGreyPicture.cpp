/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <visp3/vlp_sensor/vpReadGreyPicture.h>

#include "common/vpExpectError.h"
#include "common/vpTemporaryFolder.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
//! A smooth grey picture, so that a JPEG is close to it.
cv::Mat smooth(int width = 60, int height = 40)
{
  cv::Mat picture(height, width, CV_8UC1);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      picture.at<uchar>(v, u) = static_cast<uchar>(128 + 60 * std::sin(u / 9.0) + 50 * std::cos(v / 7.0));
    }
  }
  return picture;
}

std::string encoded(const std::string &extension, const cv::Mat &picture,
                    const std::vector<int> &options = {})
{
  std::vector<uchar> bytes;
  EXPECT_TRUE(cv::imencode(extension, picture, bytes, options));
  return std::string(bytes.begin(), bytes.end());
}

vpImage<unsigned char> read(const std::string &file)
{
  vpImage<unsigned char> I;
  vpReadGreyPicture(file, I);
  return I;
}

//! Largest difference between a picture read and what it should be.
double difference(const vpImage<unsigned char> &I, const cv::Mat &expected)
{
  const cv::Mat came(static_cast<int>(I.getRows()), static_cast<int>(I.getCols()), CV_8UC1, I.bitmap);
  EXPECT_EQ(came.size(), expected.size());
  return came.size() == expected.size() ? cv::norm(came, expected, cv::NORM_INF) : 1e9;
}

void expectCutShort(const std::string &name, const std::string &bytes)
{
  const vpTemporaryFolder folder;
  for (size_t length = 12; length < bytes.size(); length += length + 40 < bytes.size() ? 7 : 1) {
    SCOPED_TRACE(name + ", the first " + std::to_string(length) + " of " + std::to_string(bytes.size()) +
                 " bytes");
    const std::string file = folder.write(name, bytes.substr(0, length));
    vpExpectError([&] { read(file); }, {file + ": the picture is cut short"});
  }
}

//! \e bytes of a JPEG with one more segment behind its start marker.
std::string withSegment(const std::string &bytes, unsigned char marker, const std::string &payload)
{
  const size_t length = payload.size() + 2;
  return bytes.substr(0, 2) + '\xff' + static_cast<char>(marker) + static_cast<char>(length / 256) +
         static_cast<char>(length % 256) + payload + bytes.substr(2);
}
} // namespace

TEST(ReadGreyPicture, GreyIsTakenAsItIs)
{
  const vpTemporaryFolder folder;
  for (const std::string extension : {".png", ".bmp", ".pgm", ".tiff"}) {
    for (const cv::Mat &picture : {smooth(), smooth(1, 1), smooth(17, 1), smooth(1, 9)}) {
      EXPECT_EQ(difference(read(folder.write("a" + extension, encoded(extension, picture))), picture), 0)
          << extension;
    }
  }
  EXPECT_LE(difference(read(folder.write("a.jpg", encoded(".jpg", smooth()))), smooth()), 6);
}

TEST(ReadGreyPicture, WhatTheFileIsCalledDoesNotMatter)
{
  const vpTemporaryFolder folder;
  EXPECT_EQ(difference(read(folder.write("a.jpg", encoded(".png", smooth()))), smooth()), 0);
}

TEST(ReadGreyPicture, ColourIsConvertedAndAlphaLeftOut)
{
  const vpTemporaryFolder folder;
  const cv::Mat colour(3, 4, CV_8UC3, cv::Scalar(200, 100, 50)); // blue, green, red
  const cv::Mat grey(3, 4, CV_8UC1, cv::Scalar(96));             // 0.114 * 200 + 0.587 * 100 + 0.299 * 50
  EXPECT_EQ(difference(read(folder.write("a.png", encoded(".png", colour))), grey), 0);
  const cv::Mat alpha(3, 4, CV_8UC4, cv::Scalar(200, 100, 50, 0));
  EXPECT_EQ(difference(read(folder.write("b.png", encoded(".png", alpha))), grey), 0);
}

TEST(ReadGreyPicture, SixteenBitsAreScaledToEight)
{
  const vpTemporaryFolder folder;
  cv::Mat deep(1, 6, CV_16UC1), expected(1, 6, CV_8UC1);
  const int values[] = {0, 128, 129, 257, 32896, 65535}, scaled[] = {0, 0, 1, 1, 128, 255};
  for (int i = 0; i < 6; ++i) {
    deep.at<ushort>(i) = static_cast<ushort>(values[i]);
    expected.at<uchar>(i) = static_cast<uchar>(scaled[i]);
  }
  EXPECT_EQ(difference(read(folder.write("a.png", encoded(".png", deep))), expected), 0);
  EXPECT_EQ(difference(read(folder.write("a.tiff", encoded(".tiff", deep))), expected), 0);
  const cv::Mat colour(3, 4, CV_16UC3, cv::Scalar(200 * 257, 100 * 257, 50 * 257));
  EXPECT_EQ(difference(read(folder.write("b.png", encoded(".png", colour))),
                       cv::Mat(3, 4, CV_8UC1, cv::Scalar(96))),
            0);
}

TEST(ReadGreyPicture, ExifRotationIsNotApplied)
{
  const vpTemporaryFolder folder;
  const std::string exif("Exif\0\0MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0", 32);
  const std::string file = folder.write("a.jpg", withSegment(encoded(".jpg", smooth()), 0xe1, exif));
  ASSERT_EQ(cv::imread(file, cv::IMREAD_COLOR).size(), cv::Size(40, 60)); // the test's own tag works
  EXPECT_LE(difference(read(file), smooth()), 6);
}

TEST(ReadGreyPicture, CutShortIsAnErrorAtEveryLength)
{
  expectCutShort("a.png", encoded(".png", smooth()));
  expectCutShort("a.jpg", encoded(".jpg", smooth()));
  expectCutShort("progressive.jpg", encoded(".jpg", smooth(), {cv::IMWRITE_JPEG_PROGRESSIVE, 1}));
  expectCutShort("restarts.jpg", encoded(".jpg", smooth(), {cv::IMWRITE_JPEG_RST_INTERVAL, 2}));
  expectCutShort("preview.jpg",
                 withSegment(encoded(".jpg", smooth()), 0xe1, encoded(".jpg", smooth(16, 16))));
}

TEST(ReadGreyPicture, BytesBehindThePictureDoNoHarm)
{
  const vpTemporaryFolder folder;
  EXPECT_LE(difference(read(folder.write("a.jpg", encoded(".jpg", smooth()) + "more")), smooth()), 6);
  EXPECT_EQ(difference(read(folder.write("a.png", encoded(".png", smooth()) + "more")), smooth()), 0);
}

TEST(ReadGreyPicture, WhatIsNoPictureIsAnError)
{
  const vpTemporaryFolder folder;
  vpExpectError([&] { read(folder / "none.png"); },
                {folder / "none.png: cannot be opened: No such file or directory"});
  vpExpectError([&] { read(folder.path()); }, {folder.path() + ": cannot be read: Is a directory"});
  vpExpectError([&] { read(folder.write("a.png", "")); },
                {folder / "a.png: an empty file, expected a picture"});
  vpExpectError([&] { read(folder.write("b.png", "not a picture")); }, {folder / "b.png: no picture"});
  vpExpectError([&] { read(folder.write("c.jpg", "\xff\xd8\xff")); },
                {folder / "c.jpg: the picture is cut short"});
  vpExpectError([&] { read(folder.write("d.png", std::string(5000, '\0'))); },
                {folder / "d.png: no picture"});
  vpExpectError([&] { read(folder.write("e.png", std::string(128, '\0') + "DICM")); },
                {folder / "e.png: a DICOM file, expected"});
}

TEST(ReadGreyPicture, OtherDepthsAreAnError)
{
  const vpTemporaryFolder folder;
  const std::string file = folder.write("a.tiff", encoded(".tiff", cv::Mat(3, 4, CV_32FC1, cv::Scalar(0.5))));
  vpExpectError([&] { read(file); }, {file + ": pixels of type CV_32F", "expected 8 or 16 bits"});
}

TEST(ReadGreyPicture, AnErrorLeavesThePictureAsItWas)
{
  const vpTemporaryFolder folder;
  vpImage<unsigned char> I(2, 3, 7);
  EXPECT_THROW(vpReadGreyPicture(folder.write("a.png", "not a picture"), I), vpException);
  EXPECT_EQ(I.getRows(), 2u);
  EXPECT_EQ(I[1][2], 7);
}
