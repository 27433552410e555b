/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Trackers on pictures, windows and times that they are not made for: what they say stays finite, and they go
// on.

#include <functional>
#include <limits>
#include <random>

#include <visp3/vlp_tracking/vpLampTracker.h>

#include "common/vpExpectError.h"
#include "common/vpUpwardRig.h"
#include "trackedScenes.h"

using namespace trackedScenes;

namespace
{
const double noNumber = std::numeric_limits<double>::quiet_NaN(),
             infinite = std::numeric_limits<double>::infinity();

//! What a lens cap, a lamp straight ahead, a broken cable and a window blind look like.
std::vector<std::function<unsigned char(int k, int y, int x)>> strangePictures()
{
  return {[](int, int, int) { return 0; },
          [](int, int, int) { return 255; },
          [](int k, int, int) { return k % 2 == 0 ? 0 : 255; },
          [](int k, int y, int x) { return (x + y + k) % 2 == 0 ? 255 : 0; },
          [](int k, int y, int) { return (y + k) % 2 == 0 ? 255 : 0; },
          [](int k, int, int x) { return (x / 7 + k) % 2 == 0 ? 255 : 0; },
          [](int k, int y, int x) { return 37 * x + 101 * y + 53 * k; },
          [](int k, int y, int x) {
            return static_cast<int>(std::minstd_rand(1 + 7919 * y + x + 31 * k)() >> 8);
          },
          [](int k, int y, int x) { return y == 10 * k % 300 && x == 20 ? 255 : 0; }};
}

template <class Pixel>
vpImage<Pixel> painted(const std::function<unsigned char(int, int, int)> &grey, int k, int height, int width)
{
  vpImage<Pixel> I(static_cast<unsigned int>(height), static_cast<unsigned int>(width));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if constexpr (std::is_same_v<Pixel, vpRGBa>)
        I[y][x] = vpRGBa(grey(k, y, x), grey(k, x, y), grey(k + 1, y, x));
      else
        I[y][x] = grey(k, y, x);
    }
  return I;
}

//! A red thing before a background of the same grey.
vpTargetScene red(unsigned int seed)
{
  vpTargetScene made = scene(seed);
  made.square = true;
  made.background = {cv::Scalar(110, 125, 120), 25, 12};
  made.target = {cv::Scalar(200, 90, 70), 15, 6};
  return made;
}

//! A camera of the pictures of trackedScenes, whose map knows the striped lamp of seed 1.
vpVlpRig rig(unsigned int width = 400, unsigned int height = 300)
{
  return vpUpwardRig(width, height);
}

vpLampMap map()
{
  vpLamp lamp;
  lamp.id = "A";
  lamp.modulation.kind = vpModulation::Kind::pwm;
  lamp.modulation.frequency = 1 / (stripedLamp(1).stripePeriod * rig().shutter.rowTime);
  return {{lamp}};
}

void expectFinite(const std::vector<vpLampObservation> &observations)
{
  for (const vpLampObservation &seen : observations) {
    EXPECT_TRUE(seen.point.allFinite());
    EXPECT_TRUE(seen.covariance.allFinite());
    EXPECT_TRUE(seen.outline.box().allFinite());
    EXPECT_TRUE(std::isfinite(seen.time));
    EXPECT_TRUE(std::isfinite(seen.confidence));
  }
}
} // namespace

TEST(StrangePictures, CamshiftStaysFiniteAndFindsItsTargetAgain)
{
  const vpTargetScene made = scene(1);
  for (size_t i = 0; i < strangePictures().size(); ++i) {
    SCOPED_TRACE(i);
    const auto picture = strangePictures()[i];
    vpCamshiftKalmanTracker inGrey, inColour;
    run(inGrey, made, 5);
    run(inColour, red(1), 5, true);
    for (int k = 5; k < 15; ++k) {
      inGrey.track(painted<unsigned char>(picture, k, made.height, made.width));
      inColour.track(painted<vpRGBa>(picture, k, made.height, made.width));
      expectFinite(inGrey);
      expectFinite(inColour);
    }
    for (int k = 15; k < 25; ++k) {
      inGrey.track(made.grey(k));
      inColour.track(red(1).colour(k));
    }
    EXPECT_LT(errorOf(inGrey, made, 24), 3);
    EXPECT_LT(errorOf(inColour, red(1), 24), 3);
  }
}

TEST(StrangePictures, CamshiftBeginsWithAnyAndStaysFinite)
{
  for (const auto &picture : strangePictures())
    for (const cv::Size size : {cv::Size(4, 4), cv::Size(4, 300), cv::Size(300, 5), cv::Size(160, 120)}) {
      vpCamshiftKalmanTracker inGrey, inColour;
      const vpRect whole(0, 0, size.width, size.height), corner(size.width - 4, size.height - 4, 4, 4);
      for (const vpRect &window : {whole, corner}) {
        inGrey.initTracking(painted<unsigned char>(picture, 0, size.height, size.width), window);
        inColour.initTracking(painted<vpRGBa>(picture, 0, size.height, size.width), window);
        for (int k = 1; k < 8; ++k) {
          inGrey.track(painted<unsigned char>(picture, k, size.height, size.width));
          inColour.track(painted<vpRGBa>(picture, k, size.height, size.width));
          expectFinite(inGrey);
          expectFinite(inColour);
        }
      }
    }
}

TEST(StrangePictures, WindowsThatCamshiftRefusesLeaveItAsItWas)
{
  const vpTargetScene made = scene(1);
  vpCamshiftKalmanTracker tracker, other;
  run(tracker, made, 5);
  run(other, made, 5);
  for (const vpRect &window :
       {vpRect(60, 120, 1, 40), vpRect(60, 120, 40, 1), vpRect(-20, 120, 40, 40), vpRect(500, 120, 40, 40),
        vpRect(380, 280, 40, 40), vpRect(60, 120, 0, 0), vpRect(noNumber, 120, 40, 40),
        vpRect(60, 120, 40, noNumber), vpRect(60, 120, infinite, 40), vpRect(-infinite, 120, infinite, 40),
        vpRect(1e300, 120, 40, 40)}) {
    vpExpectError([&] { tracker.correct(made.grey(4), window); }, {"window is", "expected"});
    vpCamshiftKalmanTracker fresh;
    vpExpectError([&] { fresh.initTracking(made.grey(4), window); }, {"window is", "expected"});
    vpExpectError([&] { fresh.initTracking(made.colour(4), window); }, {"window is", "expected"});
  }
  for (int k = 5; k < 10; ++k) {
    tracker.track(made.grey(k));
    other.track(made.grey(k));
    EXPECT_EQ(tracker.center(), other.center());
  }
}

TEST(StrangePictures, ColourTargetLeavesOverEachSideAndComesBack)
{
  for (const Eigen::Vector2d &way : {Eigen::Vector2d(1, 0), Eigen::Vector2d(-1, 0), Eigen::Vector2d(0, 1),
                                     Eigen::Vector2d(0, -1), Eigen::Vector2d(1, 1)}) {
    vpTargetScene made = red(2);
    made.path = [way](int k) { // away for about 60 frames
      const double far = k < 90 ? 5 * k : 900 - 5 * k;
      return Eigen::Vector2d(200 + far * way.x(), 150 + far * way.y());
    };
    vpCamshiftKalmanTracker tracker;
    tracker.initTracking(made.colour(0), made.firstWindow());
    for (int k = 1; k < 180; ++k) {
      const bool seen = tracker.track(made.colour(k));
      expectFinite(tracker);
      EXPECT_FALSE(seen && k > 60 && k < 120) << "way " << way.transpose() << ", frame " << k;
    }
    EXPECT_LT(errorOf(tracker, made, 179), 2) << "way " << way.transpose();
  }
}

// Hours of waiting: what is raised to the power of the frames since, and the sigma, stay finite.
TEST(StrangePictures, TargetThatNeverComesBackIsWaitedForWithoutEnd)
{
  vpTargetScene made = scene(1);
  made.width = 80;
  made.height = 60;
  made.size = 20;
  made.path = [](int k) { return Eigen::Vector2d(30 + 0.3 * k, 30); };
  vpCamshiftKalmanTracker tracker;
  run(tracker, made, 20);
  const vpImage<unsigned char> empty(60, 80, 60);
  for (int k = 0; k < 20000; ++k) {
    ASSERT_FALSE(tracker.track(empty));
    expectFinite(tracker);
  }
  bool seen = false;
  for (int k = 0; k < 10; ++k)
    seen = tracker.track(made.grey(20));
  EXPECT_TRUE(seen);
  EXPECT_LT(errorOf(tracker, made, 20), 2);
}

TEST(StrangePictures, LampTrackerStaysFiniteAndFindsItsLampAgain)
{
  const vpTargetScene made = stripedLamp(1);
  for (size_t i = 0; i < strangePictures().size(); ++i) {
    SCOPED_TRACE(i);
    vpLampTracker tracker(rig(), map());
    for (int k = 0; k < 12; ++k) {
      const bool strange = k % 4 == 3;
      const vpVlpFrame frame = {
          strange ? painted<unsigned char>(strangePictures()[i], k, made.height, made.width) : made.grey(k),
          0.04 * k, ""};
      const std::vector<vpLampObservation> &all = tracker.track(frame);
      expectFinite(all);
      if (!strange) {
        ASSERT_EQ(all.size(), 1u) << k;
        EXPECT_EQ(all[0].id, "A") << k;
        EXPECT_LT((all[0].point - made.path(k)).norm(), 2) << k;
      }
    }
  }
}

TEST(StrangePictures, LampTrackerTakesEveryMethodAndPictureOfAFewPixels)
{
  using Method = vpTargetTracker::Method;
  for (const Method method : {Method::camshiftKalman, Method::dot2, Method::meEllipse})
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(640, 1), cv::Size(1, 480), cv::Size(9, 7)})
      for (const auto &picture : strangePictures()) {
        vpLampTracker tracker(
            rig(static_cast<unsigned int>(size.width), static_cast<unsigned int>(size.height)), map());
        tracker.method = method;
        for (int k = 0; k < 5; ++k)
          expectFinite(
              tracker.track({painted<unsigned char>(picture, k, size.height, size.width), 0.04 * k, ""}));
      }
}

// Out over a side and back. ViSP's own methods hold on to a stripe, or to nothing: the search finds the lamp.
TEST(StrangePictures, LampLeavesThePictureAndComesBack)
{
  using Method = vpTargetTracker::Method;
  for (const Method method : {Method::camshiftKalman, Method::dot2, Method::meEllipse})
    for (const Eigen::Vector2d &way :
         {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, -1), Eigen::Vector2d(1, 1)}) {
      SCOPED_TRACE("method " + std::to_string(static_cast<int>(method)));
      vpTargetScene made = stripedLamp(1);
      made.path = [way](int k) {
        const double far = k < 30 ? 10 * k : 600 - 10 * k;
        return Eigen::Vector2d(200 + far * way.x(), 150 + far * way.y());
      };
      vpLampTracker tracker(rig(), map());
      tracker.method = method;
      std::vector<vpLampObservation> all;
      for (int k = 0; k < 60; ++k) {
        all = tracker.track({made.grey(k), 0.04 * k, ""});
        expectFinite(all);
        EXPECT_LE(all.size(), 1u) << k;
        EXPECT_LE(tracker.tracks(), method == Method::camshiftKalman ? 1u : 2u) << k;
      }
      ASSERT_EQ(all.size(), 1u);
      EXPECT_EQ(all[0].id, "A");
      EXPECT_GT(all[0].track, 0u);
      EXPECT_LT((all[0].point - made.path(59)).norm(), 2);
    }
}

// A grabber that hands over one picture again and again: what it says of the lamp does not become surer.
TEST(StrangePictures, PictureThatComesAgainCountsOnce)
{
  const vpTargetScene made = stripedLamp(1);
  vpLampTracker tracker(rig(), map());
  const vpStripeFeatures first = tracker.track({made.grey(0), 0, ""})[0].features;
  for (int k = 1; k < 10; ++k) {
    const std::vector<vpLampObservation> &all = tracker.track({made.grey(0), 0.04 * k, ""});
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].features.frequencySigma, first.frequencySigma) << k;
    EXPECT_EQ(all[0].id, "A") << k;
    EXPECT_EQ(all[0].track, 1u) << k;
  }
  const std::vector<vpLampObservation> &all = tracker.track({made.grey(1), 0.4, ""});
  ASSERT_EQ(all.size(), 1u);
  EXPECT_LT(all[0].features.frequencySigma, 0.8 * first.frequencySigma);
}

TEST(StrangePictures, TimesFarApartAndCloseTogether)
{
  const vpTargetScene made = stripedLamp(1);
  vpLampTracker tracker(rig(), map());
  for (const double time : {-1e9, 0.0, 1e-12, 0.04, 1.04, 61.04, 1e9, 1e15}) {
    const std::vector<vpLampObservation> &all = tracker.track({made.grey(0), time, ""});
    ASSERT_EQ(all.size(), 1u) << time;
    EXPECT_EQ(all[0].id, "A") << time;
    EXPECT_GT(all[0].track, 0u) << time;
  }
}

TEST(StrangePictures, ExpectedWindowsFarOutsideAreTakenAndThoseThatAreNoneRefused)
{
  const vpTargetScene made = stripedLamp(1);
  vpLampTracker tracker(rig(), map());
  tracker.needed = 0; // windows from the first frame on
  tracker.searchShare = 0.01;
  int k = 0;
  for (const vpRect &window : {vpRect(-1e300, -1e300, 2e300, 2e300), vpRect(1e12, 1e12, 4, 4),
                               vpRect(-1e10, 0, 1e10 + 1, 300), vpRect(50, 100, -5, 10)}) {
    expectFinite(tracker.track({made.grey(0), 0.04 * ++k, ""}, {window}));
    EXPECT_EQ(tracker.tracks(), 1u); // since the first, which covers all
  }
  for (const vpRect &window : {vpRect(noNumber, 0, 4, 4), vpRect(0, 0, noNumber, 4),
                               vpRect(0, -infinite, 4, 4), vpRect(0, 0, 4, infinite)}) {
    vpExpectError(
        [&] {
          tracker.track({made.grey(0), 0.04 * ++k, ""}, {vpRect(0, 0, 9, 9), window});
        },
        {"windows", "expected finite numbers"});
    EXPECT_EQ(tracker.track({made.grey(0), 0.04 * ++k, ""}).size(), 1u);
  }
  tracker.searchShare = noNumber;
  EXPECT_EQ(tracker.track({made.grey(0), 0.04 * ++k, ""}).size(), 1u);
}
