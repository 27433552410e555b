/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <limits>

#include "trackedScenes.h"

using namespace trackedScenes;

namespace
{
//! All of the window is inside the picture.
void expectInside(const vpRect &window, const vpTargetScene &made)
{
  EXPECT_GE(window.getLeft(), 0);
  EXPECT_GE(window.getTop(), 0);
  EXPECT_LE(window.getLeft() + window.getWidth(), made.width + 1e-9);
  EXPECT_LE(window.getTop() + window.getHeight(), made.height + 1e-9);
}
} // namespace

TEST(CamshiftKalmanLimits, TheLessAlikeTheNoisier)
{
  const vpTargetScene made = scene(1);
  vpCamshiftKalmanTracker tracker;
  tracker.initTracking(made.grey(0), made.firstWindow());
  EXPECT_DOUBLE_EQ(tracker.measurementSigma(1), tracker.noiseFloor);
  double before = std::numeric_limits<double>::infinity();
  for (double rho = tracker.threshold; rho <= 1; rho += 0.01) {
    EXPECT_LT(tracker.measurementSigma(rho), before) << rho;
    EXPECT_GE(tracker.measurementSigma(rho), tracker.noiseFloor) << rho;
    before = tracker.measurementSigma(rho);
  }
  const double none = std::numeric_limits<double>::infinity();
  EXPECT_EQ(tracker.measurementSigma(tracker.threshold - 1e-6), none);
  EXPECT_EQ(tracker.measurementSigma(0), none);
  EXPECT_EQ(tracker.measurementSigma(std::numeric_limits<double>::quiet_NaN()), none);
}

TEST(CamshiftKalmanLimits, UniformPictures)
{
  for (const int grey : {0, 7, 128, 255}) {
    const vpImage<unsigned char> I(120, 160, static_cast<unsigned char>(grey));
    const vpImage<vpRGBa> C(120, 160, vpRGBa(static_cast<unsigned char>(grey), 0, 0));
    vpCamshiftKalmanTracker inGrey, inColour;
    inGrey.initTracking(I, vpRect(60, 50, 20, 30));
    inColour.initTracking(C, vpRect(60, 50, 20, 30));
    for (int k = 0; k < 30; ++k) {
      inGrey.track(I);
      inColour.track(C);
      expectFinite(inGrey);
      expectFinite(inColour);
    }
    EXPECT_NEAR(inGrey.center().get_u(), 69.5, 2);
    EXPECT_NEAR(inGrey.center().get_v(), 64.5, 2);
  }
}

TEST(CamshiftKalmanLimits, TheTargetGoesAndAllIsUniform)
{
  const vpTargetScene made = scene(1);
  vpCamshiftKalmanTracker tracker;
  run(tracker, made, 10);
  for (const int grey : {0, 60, 255})
    for (int k = 0; k < 50; ++k) {
      EXPECT_FALSE(tracker.track(vpImage<unsigned char>(300, 400, static_cast<unsigned char>(grey))));
      expectFinite(tracker);
    }
}

TEST(CamshiftKalmanLimits, TheSmallestWindowAndTheWholePicture)
{
  const vpTargetScene made = scene(1);
  for (const vpRect &window : {vpRect(0, 0, 4, 4), vpRect(396, 296, 4, 4), vpRect(0, 0, 400, 300),
                               vpRect(10, 20, 380, 4), vpRect(58.5, 118.5, 4, 4)}) {
    vpCamshiftKalmanTracker tracker;
    tracker.initTracking(made.grey(0), window);
    for (int k = 1; k < 10; ++k) {
      tracker.track(made.grey(k));
      expectFinite(tracker);
      expectInside(tracker.window(), made);
    }
  }
}

TEST(CamshiftKalmanLimits, NoiseAlone)
{
  vpTargetScene made = scene(1);
  made.noise = 60;
  vpCamshiftKalmanTracker tracker;
  run(tracker, made, 5);
  made.path = [](int) { return Eigen::Vector2d(-1000, -1000); };
  for (int k = 0; k < 40; ++k) {
    tracker.track(made.grey(k));
    expectFinite(tracker);
    expectInside(tracker.window(), made);
  }
}

// Out over each side and back, at a steady pace.
TEST(CamshiftKalmanLimits, LeavesThePictureAndComesBack)
{
  for (const Eigen::Vector2d &way : {Eigen::Vector2d(1, 0), Eigen::Vector2d(-1, 0), Eigen::Vector2d(0, 1),
                                     Eigen::Vector2d(0, -1), Eigen::Vector2d(1, 1)}) {
    vpTargetScene made = scene(2);
    made.path = [way](int k) {
      const double far = k < 60 ? 5 * k : 600 - 5 * k;
      return Eigen::Vector2d(200 + far * way.x(), 150 + far * way.y());
    };
    vpCamshiftKalmanTracker tracker;
    tracker.initTracking(made.grey(0), made.firstWindow());
    for (int k = 1; k < 120; ++k) {
      const bool seen = tracker.track(made.grey(k));
      expectFinite(tracker);
      expectInside(tracker.window(), made);
      const vpRect truth = made.window(k);
      const bool gone = truth.getRight() < 0 || truth.getBottom() < 0 || truth.getLeft() >= made.width ||
                        truth.getTop() >= made.height;
      const bool whole = truth.getLeft() >= 0 && truth.getTop() >= 0 && truth.getRight() < made.width &&
                         truth.getBottom() < made.height;
      if (gone) {
        EXPECT_FALSE(seen) << "way " << way.transpose() << ", frame " << k;
      }
      if (whole && k < 60) {
        EXPECT_TRUE(seen) << "way " << way.transpose() << ", frame " << k;
        EXPECT_LT(errorOf(tracker, made, k), 3) << "way " << way.transpose() << ", frame " << k;
      }
    }
    EXPECT_LT(errorOf(tracker, made, 119), 2) << "way " << way.transpose();
  }
}

// Half outside all the time: its middle lies on the border, and so does the window's.
TEST(CamshiftKalmanLimits, AlongTheBorder)
{
  vpTargetScene made = scene(1);
  made.path = [](int k) { return Eigen::Vector2d(60 + 4 * k, std::max(0.0, 40.0 - k)); };
  vpCamshiftKalmanTracker tracker;
  const Track track = run(tracker, made, 75);
  EXPECT_TRUE(track.alwaysSeen());
  EXPECT_LT(track.meanError(), 3);
  EXPECT_LT(track.errors.back(), 6);
  EXPECT_NEAR(tracker.window().getTop(), 0, 1e-9);
  EXPECT_LT(tracker.window().getHeight(), 0.7 * made.size);
}

TEST(CamshiftKalmanLimits, StartsAnewWithAnotherPicture)
{
  vpCamshiftKalmanTracker tracker;
  const vpTargetScene small = scene(1);
  vpTargetScene large = scene(2);
  large.width = 500;
  run(tracker, small, 10);
  EXPECT_LT(run(tracker, large, 20, true).worstError(), 3);
  EXPECT_LT(run(tracker, small, 20).worstError(), 3);
}
