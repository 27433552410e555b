/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// A robot that somebody carries elsewhere between two frames, where lamps hardly tell where that is.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/vpSeenLamps.h"

namespace
{
const double frameTime = 0.1;      // s
const int carried = 12, back = 20; // frames, from which on it is elsewhere, and all lamps shine again
const double most = 5;             // standard deviations
const double right = 0.01;         // m
const unsigned int jumps = 60;     // seeds
const vpPlannedDrive standing({0, 0, 0}, {{4, 0, 0}});

//! Carried by up to 35 cm and 90 degrees.
vpPlannedPlace elsewhere(std::mt19937_64 &generator)
{
  std::uniform_real_distribution<double> far(0.05, 0.35), where(-M_PI, M_PI), turn(-M_PI / 2, M_PI / 2);
  const double way = far(generator), heading = where(generator);
  return {way * std::cos(heading), way * std::sin(heading), turn(generator)};
}

/*!
  Follows it under two lamps. \param left How many of them shine from then on, until all do again.
  \param wheels Say that it stands. \param each Called with each frame's number, location and true place.
*/
template <class Each>
void carry(unsigned int seed, size_t left, bool wheels, const Each &each)
{
  std::mt19937_64 generator(seed);
  const vpSeenLamps world(2);
  vpVlpLocalizer localizer(world.rig, world.map);
  const vpPlannedPlace there = elsewhere(generator);
  const std::vector<vpOdometry> samples = standing.odometry(0.02);
  size_t given = 0;
  for (int k = 0; k < back + 4; ++k) {
    const double t = k * frameTime;
    for (; wheels && samples[given].timestamp <= t; ++given) {
      localizer.filter.addOdometry(samples[given]);
    }
    const vpPlannedPlace place = k < carried ? vpPlannedPlace() : there;
    const bool all = k < carried || k >= back || left == 2;
    each(k, localizer.locate(t, world.see(t, [&place](double) { return place; }, generator, {true, all})),
         place);
  }
}
} // namespace

TEST(CarriedRobot, WheelsThatStandDoNotSpeakAgainstIt)
{
  unsigned int undecided = 0; // lamps that were copied are about as likely
  for (unsigned int seed = 1; seed <= jumps; ++seed) {
    bool isRight = true;
    carry(seed, 2, true, [&](int k, const vpVlpLocation &location, const vpPlannedPlace &place) {
      ASSERT_TRUE(location.fix.valid);
      EXPECT_LT(vpSigmasOff(location.fix, place), most) << "seed " << seed << ", frame " << k;
      EXPECT_EQ(location.fix.ambiguous || location.relocated, k >= carried);
      isRight = isRight && (k < carried + 2 || vpErrorOf(location.fix, place) < right);
    });
    undecided += !isRight;
  }
  EXPECT_LE(undecided, jumps / 20);
}

// The same is seen where it drives on and two other lamps are as far apart. It is one or the other, and its
// covariance holds both, though one may have a few hundredths of the probability.
TEST(CarriedRobot, WheelsThatRollOnLeaveBothPlacesOpen)
{
  const vpPlannedDrive drive({0, 0, 0}, {{2, 0.2, 0}, {1, 0, 0}}); // brakes after the jump
  const std::vector<vpOdometry> samples = drive.odometry(0.02);
  unsigned int carriedMissed = 0, copiesMissed = 0;
  for (unsigned int seed = 1; seed <= jumps; ++seed) {
    double offCarried = 0, offCopied = 0; // standard deviations
    std::mt19937_64 generator(seed);
    const vpSeenLamps world(2);
    vpVlpLocalizer localizer(world.rig, world.map);
    const vpPlannedPlace jump = elsewhere(generator);
    const auto carriedOn = [&](double t) {
      const vpPlannedPlace on = drive.at(t), from = drive.at(carried * frameTime);
      const double c = std::cos(jump.yaw), s = std::sin(jump.yaw), x = on.x - from.x, y = on.y - from.y;
      return vpPlannedPlace{from.x + jump.x + c * x - s * y, from.y + jump.y + s * x + c * y,
                            on.yaw + jump.yaw};
    };
    size_t given = 0;
    for (int k = 0; k < 28; ++k) {
      const double t = k * frameTime;
      for (; samples[given].timestamp <= t + frameTime; ++given) { // which come before the picture is read
        localizer.filter.addOdometry(samples[given]);
      }
      const auto place = [&](double time) { return k < carried ? drive.at(time) : carriedOn(time); };
      const vpVlpLocation location = localizer.locate(t, world.see(t, place, generator));
      ASSERT_TRUE(location.fix.valid);
      offCarried = std::max(offCarried, vpSigmasOff(location.fix, place(t)));
      offCopied = std::max(offCopied, vpSigmasOff(location.fix, drive.at(t)));
    }
    carriedMissed += offCarried > 2 * most;
    copiesMissed += offCopied > 2 * most;
  }
  EXPECT_LE(carriedMissed, jumps / 20);
  EXPECT_LE(copiesMissed, jumps / 5); // as it brakes, wheels tell the way less exactly than strangers show it
}

// But for the few places from which that lamp looks as a robot might have driven, which nobody can tell.
TEST(CarriedRobot, OneLampThatIsLeftDoesNotTellWhere)
{
  for (const bool wheels : {false, true}) {
    unsigned int mistaken = 0;
    for (unsigned int seed = 1; seed <= jumps; ++seed) {
      bool isOff = false;
      carry(seed, 1, wheels, [&](int k, const vpVlpLocation &location, const vpPlannedPlace &place) {
        isOff = isOff || vpSigmasOff(location.fix, place) > most ||
                (k >= back + 2 && vpErrorOf(location.fix, place) > right);
      });
      mistaken += isOff;
    }
    EXPECT_LE(mistaken, jumps / 10);
  }
}

TEST(CarriedRobot, LampThatIsHiddenInPartIsNoReasonToThinkSo)
{
  std::mt19937_64 generator(1);
  const vpSeenLamps world(2);
  vpVlpLocalizer localizer(world.rig, world.map);
  const auto place = [](double) { return vpPlannedPlace(); };
  for (int k = 0; k < back; ++k) {
    const double t = k * frameTime;
    std::vector<vpLampObservation> seen = world.see(t, place, generator, {true, k < carried});
    if (k >= carried) { // its right half
      vpLampOutline &outline = seen[0].outline;
      outline.centre.x() += 0.5 * outline.a;
      outline.a *= 0.5;
      std::swap(outline.a, outline.b);
      outline.angle = M_PI / 2;
      seen[0].point = outline.centre;
    }
    const vpVlpLocation location = localizer.locate(t, std::move(seen));
    EXPECT_LT(vpErrorOf(location.fix, vpPlannedPlace()), right) << k;
    EXPECT_NE(location.state, vpVlpFilter::State::lost) << k;
  }
}
