/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Detection in windows: what the whole picture gives, of the lamps that the windows show.

#include <algorithm>
#include <random>

#include <gtest/gtest.h>
#include <visp3/core/vpRect.h>
#include <visp3/vlp_identification/vpLedDetector.h>

#include "common/paintedLamps.h"
#include "common/vpExpectError.h"

using namespace paintedLamps;

namespace
{
const cv::Rect frame(0, 0, 400, 320);

//! Five lamps of several sizes, one of them cut by the picture's border, in either readout.
vpLampPicture pictureWith(bool columns = false)
{
  vpLampPicture picture =
      pictureOf({disc(80.3, 70.6, 30, 150, 9, 0.5, 0.3), disc(300.7, 90.2, 24, 60, 7, 0.4, 0.1),
                 disc(120.4, 240.8, 34, 200, 12, 0.6, 0.7), disc(310, 230, 18, 120, 6, 0.5, 0.5),
                 disc(395, 160, 20, 150, 8, 0.5, 0.2)},
                frame.width, frame.height);
  if (columns) {
    picture.columns = true;
    std::swap(picture.width, picture.height);
    for (vpPaintedLamp &lamp : picture.lamps) {
      std::swap(lamp.centre.x(), lamp.centre.y());
    }
  }
  return picture;
}

std::vector<cv::Rect> randomWindows(unsigned int seed, int count, int least, int most)
{
  std::mt19937 generator(seed);
  auto draw = [&generator](int from, int to) {
    return std::uniform_int_distribution<int>(from, to)(generator);
  };
  std::vector<cv::Rect> windows;
  for (int k = 0; k < count; ++k) {
    windows.emplace_back(draw(-40, frame.width), draw(-40, frame.height), draw(least, most),
                         draw(least, most));
  }
  return windows;
}

bool same(const vpLedRoi &a, const vpLedRoi &b)
{
  const cv::Rect box = a.box, other = b.box;
  return std::abs(box.x - other.x) <= 2 && std::abs(box.y - other.y) <= 2 &&
         std::abs(box.br().x - other.br().x) <= 2 && std::abs(box.br().y - other.br().y) <= 2 &&
         a.cutAcross == b.cutAcross && a.cutAlong == b.cutAlong;
}

vpRect rectOf(const cv::Rect &window)
{
  return {double(window.x), double(window.y), double(window.width), double(window.height)};
}

vpVlpRig rigFor(const vpLampPicture &picture)
{
  vpVlpRig rig;
  rig.width = static_cast<unsigned int>(picture.width);
  rig.height = static_cast<unsigned int>(picture.height);
  rig.camera.initPersProjWithoutDistortion(500, 500, 0.5 * picture.width, 0.5 * picture.height);
  rig.shutter.rowTime = rig.shutter.exposure = picture.rowTime;
  rig.shutter.rowTimeSigma = 4e-9;
  if (picture.columns) {
    rig.shutter.readout = vpRollingShutter::Readout::columns;
  }
  return rig;
}

vpLampMap mapOf(const vpLampPicture &picture)
{
  vpLampMap map;
  for (const vpPaintedLamp &painted : picture.lamps) {
    vpLamp lamp;
    lamp.id = "L" + std::to_string(map.lamps.size());
    lamp.modulation.kind = vpModulation::Kind::pwm;
    lamp.modulation.frequency = painted.frequency;
    lamp.modulation.duty = painted.pulses[0].length;
    map.lamps.push_back(lamp);
  }
  return map;
}
} // namespace

// What a window shows of a lamp is enough where it is as large as the smallest lamp and holds two stripes.
TEST(DetectorWindows, GiveTheWholePicturesRegionsThatTheyShow)
{
  const vpImage<unsigned char> I = pictureWith().render();
  const vpLinePicture lines(I, false);
  const vpLedRoiDetector detector;
  const std::vector<vpLedRoi> whole = detector.detect(lines.grey);
  ASSERT_EQ(whole.size(), 5u) << boxes(whole);
  int cut = 0;
  for (const cv::Rect &window : randomWindows(1, 250, 20, 200)) {
    const std::vector<vpLedRoi> rois = detector.detect(lines.grey, window);
    for (const vpLedRoi &roi : rois) {
      EXPECT_TRUE(
          std::any_of(whole.begin(), whole.end(), [&](const vpLedRoi &each) { return same(each, roi); }))
          << roi.box << " in window " << window << " is none of " << boxes(whole);
      EXPECT_GT((roi.box & window).area(), 0) << "a neighbour outside of " << window;
    }
    for (const vpLedRoi &roi : whole) {
      const cv::Rect part = roi.box & window;
      const auto found =
          std::count_if(rois.begin(), rois.end(), [&](const vpLedRoi &each) { return same(each, roi); });
      EXPECT_LE(found, 1);
      if (part.width >= 16 && part.height >= 24) {
        EXPECT_EQ(found, 1) << roi.box << " in window " << window << ": " << boxes(rois);
        cut += part != roi.box ? 1 : 0;
      }
    }
  }
  EXPECT_GT(cut, 50); // lamps cut by a side of the window were among them
}

TEST(DetectorWindows, WhatIsKnownIsLeftOutAndNothingElse)
{
  const vpImage<unsigned char> I = pictureWith().render();
  const vpLinePicture lines(I, false);
  const vpLedRoiDetector detector;
  const std::vector<vpLedRoi> whole = detector.detect(lines.grey);
  const cv::Rect all(0, 0, lines.grey.cols, lines.grey.rows);
  const cv::Size more(8, 8);
  for (size_t k = 0; k < whole.size(); ++k) {
    const cv::Rect known(whole[k].box.tl() - cv::Point(more / 2), whole[k].box.size() + more);
    const std::vector<vpLedRoi> rest = detector.detect(lines.grey, all, {known});
    EXPECT_EQ(rest.size(), whole.size() - 1) << known << ": " << boxes(rest);
    for (size_t i = 0; i < whole.size(); ++i) {
      const bool found =
          std::any_of(rest.begin(), rest.end(), [&](const vpLedRoi &each) { return same(each, whole[i]); });
      EXPECT_EQ(found, i != k) << whole[i].box;
    }
    // Half of a lamp is not known.
    const cv::Rect half(known.x, known.y, known.width, known.height / 2);
    EXPECT_EQ(detector.detect(lines.grey, all, {half}).size(), whole.size()) << half;
  }
}

TEST(DetectorWindows, WindowInsideALampGivesAllOfIt)
{
  const vpLampPicture picture = pictureWith();
  const vpImage<unsigned char> I = picture.render();
  const vpLinePicture lines(I, false);
  for (const vpPaintedLamp &lamp : picture.lamps) {
    const cv::Rect window(cvRound(lamp.centre.x()) - 12, cvRound(lamp.centre.y()) - 12, 24, 24);
    const std::vector<vpLedRoi> rois = vpLedRoiDetector().detect(lines.grey, window);
    ASSERT_EQ(rois.size(), 1u) << window;
    EXPECT_TRUE(holds(rois, picture, lamp));
  }
}

TEST(DetectorWindows, OfNoPartOfThePictureGiveNothing)
{
  const vpImage<unsigned char> I = pictureWith().render();
  const vpLinePicture lines(I, false);
  const vpLedRoiDetector detector;
  vpLedDetector whole(rigFor(pictureWith()), mapOf(pictureWith()));
  for (const cv::Rect &window : {cv::Rect(-200, 50, 150, 60), cv::Rect(50, -200, 60, 150),
                                 cv::Rect(400, 0, 300, 320), cv::Rect(0, 320, 400, 9), cv::Rect(80, 70, 0, 0),
                                 cv::Rect(5000, 5000, 10, 10), cv::Rect(190, 140, 30, 30)}) {
    EXPECT_TRUE(detector.detect(lines.grey, window).empty()) << window;
    if (window.area() > 0) {
      EXPECT_FALSE(whole.detect(I, {rectOf(window)})) << window;
      EXPECT_TRUE(whole.observations().empty());
      EXPECT_EQ(whole.getNbObjects(), 0u);
    }
  }
  EXPECT_FALSE(whole.detect(I, std::vector<vpRect>()));
  EXPECT_TRUE(detector.detect(cv::Mat_<unsigned char>(), cv::Rect(0, 0, 10, 10)).empty());
}

TEST(DetectorWindows, ThatOverlapGiveEachLampOnceAsTheWholePictureDoes)
{
  for (const bool columns : {false, true}) {
    const vpLampPicture picture = pictureWith(columns);
    const vpImage<unsigned char> I = picture.render();
    vpLedDetector whole(rigFor(picture), mapOf(picture)), windowed = whole;
    whole.detect(I);
    ASSERT_EQ(whole.observations().size(), 5u);
    for (unsigned int seed = 1; seed <= 12; ++seed) {
      std::vector<vpRect> windows;
      for (cv::Rect window : randomWindows(seed, 12, 40, 120)) {
        if (columns) {
          std::swap(window.x, window.y);
          std::swap(window.width, window.height);
        }
        windows.push_back(rectOf(window));
      }
      windowed.detect(I, windows);
      std::vector<size_t> times(whole.observations().size(), 0);
      for (const vpLampObservation &seen : windowed.observations()) {
        for (size_t k = 0; k < times.size(); ++k) {
          const vpLampObservation &same = whole.observations()[k];
          if ((same.point - seen.point).norm() < 0.5) {
            ++times[k];
            EXPECT_EQ(seen.id, same.id) << "seed " << seed;
            EXPECT_EQ(seen.cut, same.cut);
            EXPECT_NEAR(seen.time, same.time, 0.5 * picture.rowTime);
            EXPECT_NEAR(seen.features.frequency, same.features.frequency, 3 * same.features.frequencySigma);
          }
        }
      }
      size_t all = 0;
      for (const size_t each : times) {
        EXPECT_LE(each, 1u) << "seed " << seed;
        all += each;
      }
      EXPECT_EQ(all, windowed.observations().size()) << "seed " << seed << ": a lamp that the whole has not";
    }
    windowed.detect(I, {vpRect(0, 0, picture.width, picture.height)});
    EXPECT_EQ(windowed.observations().size(), 5u);
  }
}

TEST(DetectorWindows, PictureOfAnotherSizeIsRefused)
{
  const vpLampPicture picture = pictureWith();
  vpLedDetector detector(rigFor(picture), mapOf(picture));
  const vpImage<unsigned char> other(100, 200, 0);
  vpExpectError([&] { detector.detect(other, {vpRect(0, 0, 50, 50)}); }, {"200 x 100", "400 x 320"});
  vpExpectError([&] { detector.detect(other, std::vector<vpRect>()); }, {"200 x 100", "400 x 320"});
}
