/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Light that cannot be a lamp's, since it shines for longer than the slowest lamp's period.

#include <gtest/gtest.h>

#include "common/paintedLamps.h"

using namespace paintedLamps;

namespace
{
const double slowest = 24; // lines, of a period

std::vector<vpLedRoi> found(const vpLampPicture &picture)
{
  const vpImage<unsigned char> I = picture.render();
  vpLedRoiDetector detector;
  detector.longestPeriod = 1.2 * slowest;
  return detector.detect(vpLinePicture(I, picture.columns).grey);
}

vpPaintedLamp panel(double u, double v, double width, double height, double amplitude)
{
  vpPaintedLamp panel = disc(u, v, 10, amplitude, 10, 0.5, 0);
  panel.rectangle(width, height);
  panel.pulses = {{0, 1}};
  return panel;
}
} // namespace

TEST(SteadyLight, PanelsAndTubesAreSteadyAndLampsAreNot)
{
  for (const double noise : {0.5, 2.0, 8.0})
    for (const double amplitude : {40.0, 150.0, 400.0})
      for (const bool columns : {false, true}) {
        vpLampPicture picture = pictureOf(
            {panel(90, 90, 120, 60, amplitude), panel(300, 60, 40, 90, amplitude),
             disc(90, 300, 40, amplitude, slowest, 0.8, 0.3), disc(300, 300, 45, amplitude, 7, 0.3, 0.1)},
            400, 400);
        picture.columns = columns;
        picture.noise = noise;
        for (const vpLedRoi &roi : found(picture)) {
          const bool lamp = (columns ? roi.box.x : roi.box.y) > 200;
          EXPECT_FALSE(roi.steady && lamp) << "noise " << noise << ", amplitude " << amplitude;
          EXPECT_TRUE(roi.steady || lamp || noise > 2) << "noise " << noise << ", amplitude " << amplitude;
        }
      }
}

// Wherever it hangs, at any phase: its stripes run together with the panel's light.
TEST(SteadyLight, LampBeforeAPanelIsFound)
{
  for (const double u : {110.0, 150.0, 203.0, 281.0})
    for (const double phase : {0.0, 0.3, 0.6, 0.9}) {
      const vpPaintedLamp lamp = disc(u, 170.4, 25, 120, 9, 0.5, phase);
      const std::vector<vpLedRoi> rois = found(pictureOf({panel(200, 200, 240, 200, 60), lamp}, 400, 400));
      EXPECT_TRUE(std::any_of(rois.begin(), rois.end(),
                              [&](const vpLedRoi &roi) {
                                return !roi.steady && std::abs(roi.box.x + roi.box.width / 2. - u) < 4 &&
                                       roi.box.width < 60;
                              }))
          << "at " << u << ", phase " << phase;
    }
}

// One stripe tells no period, and is no steady light either: more of them may be near.
TEST(SteadyLight, OneStripeIsEvenAndALampIsNot)
{
  for (const double noise : {0.5, 2.0}) {
    vpLampPicture picture =
        pictureOf({panel(90, 90, 120, 14, 150), disc(200, 200, 30, 150, 10, 0.6, 0.2)}, 300, 300);
    picture.noise = noise;
    const std::vector<vpLedRoi> rois = found(picture);
    ASSERT_EQ(rois.size(), 2u) << "noise " << noise;
    for (const vpLedRoi &roi : rois) {
      EXPECT_EQ(roi.even, roi.box.y < 150) << roi.box;
      EXPECT_FALSE(roi.steady) << roi.box;
    }
  }
}

TEST(SteadyLight, OneStripeOfALampIsNone)
{
  for (const double duty : {0.2, 0.5, 0.8})
    for (const double phase : {0.0, 0.25, 0.5, 0.75}) {
      const vpPaintedLamp lamp = disc(100, 100, 14, 150, slowest, duty, phase);
      for (const vpLedRoi &roi : found(pictureOf({lamp}, 200, 200))) {
        EXPECT_FALSE(roi.steady) << "duty " << duty << ", phase " << phase;
      }
    }
}
