/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// A lamp that was seen before is reacquired where it is the same, and only there.

#include <cmath>
#include <functional>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <visp3/core/vpRect.h>
#include <visp3/vlp_identification/vpLedDetector.h>

#include "common/vpLampPicture.h"
#include "common/vpUpwardRig.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
const double radius = 36; // px

vpPaintedLamp smallLamp(double u = 120.3, double v = 110.6)
{
  vpPaintedLamp lamp;
  lamp.centre = {u, v};
  lamp.a = lamp.b = radius;
  lamp.frequency = 2000;
  lamp.phase = 0.3;
  lamp.pwm(0.5);
  return lamp;
}

vpLampPicture picture(const std::vector<vpPaintedLamp> &lamps, unsigned int seed = 1)
{
  vpLampPicture picture;
  picture.width = 320;
  picture.height = 240;
  picture.rowTime = picture.exposure = 40e-6;
  picture.blur = 0.7;
  picture.noise = 1;
  picture.seed = seed;
  picture.lamps = lamps;
  return picture;
}

//! A detector and a lamp that it has seen.
class Reacquisition : public testing::Test
{
protected:
  void SetUp() override
  {
    ASSERT_TRUE(detector.detect(picture({smallLamp()}).render()));
    ASSERT_EQ(detector.observations().size(), 1u);
    before = detector.observations().front();
  }

  //! What reacquire() makes of a picture.
  bool finds(const vpImage<unsigned char> &I, const Eigen::Vector2d &expected)
  {
    now = before;
    now.outline.centre = expected;
    return detector.reacquire(I, now);
  }
  //! ... of one with that lamp alone, where it is expected.
  bool finds(const vpPaintedLamp &other) { return finds(picture({other}, 2).render(), other.centre); }

  vpLedDetector detector{vpUpwardRig(320, 240), vpLampMap()};
  vpLampObservation before, now;
};

TEST_F(Reacquisition, SeesWhatTheDetectorSees)
{
  for (unsigned int seed = 1; seed < 20; ++seed) {
    vpPaintedLamp moved = smallLamp(120.3 + 2.3 * seed, 110.6 - 0.7 * seed);
    moved.phase = 0.17 * seed;
    const vpImage<unsigned char> I = picture({moved}, seed).render();
    const double angle = seed; // rad, any
    ASSERT_TRUE(finds(I, moved.centre + 0.8 * Eigen::Vector2d(std::cos(angle), std::sin(angle)))) << seed;
    ASSERT_TRUE(detector.detect(I));
    const vpLampObservation &careful = detector.observations().front();
    EXPECT_LT((now.point - careful.point).norm(), 0.01) << seed;
    EXPECT_NEAR(now.outline.a, careful.outline.a, 0.01);
    EXPECT_NEAR(now.blur, careful.blur, 0.02);
    EXPECT_NEAR(now.time, careful.time, 1e-6);
    EXPECT_NEAR(std::sqrt(now.covariance.trace() / careful.covariance.trace()), 1, 0.2);
    EXPECT_NEAR(now.features.area, careful.features.area, 0.15 * careful.features.area);
  }
}

//! A robot that turns or brakes: lamps are not where they were expected. Whatever lines are lit.
TEST_F(Reacquisition, FindsItsWayFromPixelsAway)
{
  for (const double frequency : {1042., 2000., 5200.}) {
    for (unsigned int seed = 1; seed < 12; ++seed) {
      vpPaintedLamp moved = smallLamp();
      moved.frequency = frequency;
      moved.phase = 0.09 * seed;
      moved.pwm(seed % 2 == 0 ? 0.5 : 0.25);
      const vpImage<unsigned char> I = picture({moved}, seed).render();
      ASSERT_TRUE(detector.detect(I));
      before = detector.observations().front();
      ASSERT_TRUE(finds(I, moved.centre)) << frequency << ", " << seed;
      const Eigen::Vector2d near = now.outline.centre;
      for (const double away : {1., 2., 3., 4.}) { // px
        const double angle = 2.4 * seed + away;
        ASSERT_TRUE(finds(I, moved.centre + away * Eigen::Vector2d(std::cos(angle), std::sin(angle))))
            << frequency << ", " << seed << ", " << away;
        // A step of 0.02 px is its last one.
        EXPECT_LT((now.outline.centre - near).norm(), 0.006) << frequency << ", " << seed << ", " << away;
      }
    }
  }
}

TEST_F(Reacquisition, ErrorsAreAsLargeAsTheySay)
{
  double squares = 0;
  static const int trials = 100;
  for (unsigned int seed = 1; seed <= trials; ++seed) {
    vpPaintedLamp moved = smallLamp(100 + 0.37 * seed, 100 + 0.23 * seed);
    moved.phase = 0.11 * seed;
    ASSERT_TRUE(finds(picture({moved}, seed).render(), moved.centre + Eigen::Vector2d(0.4, -0.3)));
    const Eigen::Vector2d error = now.outline.centre - moved.centre;
    squares += error.dot(now.outline.centreCovariance.inverse() * error) / trials;
  }
  // Chi-square of 200 degrees of freedom over 100: within 1.4 and 2.7 but once in 1000; the covariance holds
  // what other cameras and lenses do worse, too.
  EXPECT_LT(squares, 2.7);
  EXPECT_GT(squares, 0.3);
}

TEST_F(Reacquisition, TakesNoOtherLampForIt)
{
  vpPaintedLamp other = smallLamp();
  other.frequency = 2000 + 40; // an eighth of a period over the lamp
  EXPECT_FALSE(finds(other));
  other = smallLamp();
  other.frequency = 3500;
  EXPECT_FALSE(finds(other));
  other = smallLamp();
  other.pwm(0.6);
  EXPECT_FALSE(finds(other));
  other = smallLamp();
  other.twoPulse(0.5, 0.3);
  EXPECT_FALSE(finds(other));
  other = smallLamp();
  other.frequency = 0; // steady
  EXPECT_FALSE(finds(other));
  other = smallLamp();
  other.a = other.b = 1.1 * radius;
  EXPECT_FALSE(finds(other));
}

TEST_F(Reacquisition, SeesNothingWhereThereIsNothing)
{
  EXPECT_FALSE(finds(picture({}, 3).render(), before.outline.centre));
  EXPECT_FALSE(finds(picture({smallLamp(240, 150)}).render(), before.outline.centre));
}

TEST_F(Reacquisition, LeavesPartsOfALampToTheDetector)
{
  // Somebody's head: dark, across a third of the lamp.
  vpImage<unsigned char> I = picture({smallLamp()}).render();
  for (unsigned int v = 60; v < 160; ++v) {
    for (unsigned int u = 84; u < 108; ++u) {
      I[v][u] = 10;
    }
  }
  EXPECT_FALSE(finds(I, before.outline.centre));
  EXPECT_FALSE(finds(smallLamp(radius - 2, 110)));
  EXPECT_FALSE(finds(smallLamp(120, 239 - radius)));
}

TEST_F(Reacquisition, LampsThatLeaveThePictureAreNotFollowedOutOfIt)
{
  for (double v = 239 - 1.3 * radius; v < 250; v += 1) {
    const vpImage<unsigned char> I = picture({smallLamp(120, v)}).render();
    for (double expected = v - 15; expected < v; expected += 5) {
      EXPECT_FALSE(finds(I, {120, expected}) && v > 239 - radius - 4) << v << " expected at " << expected;
    }
  }
}

TEST_F(Reacquisition, TakesOnlyWhatWasUnderstood)
{
  const vpLampObservation understood = before;
  const std::vector<std::function<void()>> spoilers = {
      [this] { before.cut = true; }, [this] { before.outline.shape = vpLampOutline::Shape::region; },
      [this] { before.features.signal = vpStripeFeatures::Signal::coded; }, [this] { before.blur = 0; },
      [this] { before.features.frequencySigma = 100; }};
  EXPECT_TRUE(finds(smallLamp()));
  for (size_t i = 0; i < spoilers.size(); ++i) {
    before = understood;
    spoilers[i]();
    EXPECT_FALSE(finds(smallLamp())) << i;
  }
}

} // namespace
