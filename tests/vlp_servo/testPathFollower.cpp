/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The reference and the visual task: what is left of errors once pose and base are perfect.

#include <algorithm>

#include <gtest/gtest.h>
#include <visp3/vlp_servo/vpPathFollower.h>

#include "common/vpExpectError.h"
#include "vpPerfectBase.h"

namespace
{
const vpPath longLine = vpPath::polyline({{0, 0}, {3, 0}});
const vpPath square = vpPath::polyline({{0, 0}, {0.7, 0}, {0.7, 0.7}, {0, 0.7}}, true);

//! Follows to the end. \return The largest distance from the path.
double follow(const vpPath &path, vpPerfectBase &base, vpPathFollower &follower, double seconds = 200)
{
  double worst = 0;
  while (base.now() < seconds && !follower.arrived()) {
    const vpBaseVelocity velocity = follower.follow(base.wMb, 1, base.period());
    base.setVelocity(velocity.v, velocity.w);
    base.next();
    const double s = follower.reference().s;
    worst = std::max(worst, std::abs(path.offset({base.x(), base.y()},
                                                 path.closest({base.x(), base.y()}, s - 0.2, s + 0.2))));
  }
  return worst;
}

//! s until the error across is a tenth of what it was, on a line along x.
double timeToConverge(double gain)
{
  vpPathFollowerSettings settings;
  settings.servo.gain = settings.servo.gainFar = gain;
  settings.servo.integralGain = 0;
  vpPerfectBase base;
  vpPathFollower follower(longLine, base.limits(), settings);
  base.wMb = vpStanding(0, 0.005, 0);
  // Of the control point: the base itself swings in behind it, at a rate that is the look-ahead's.
  for (const double ahead = settings.servo.lookAhead; base.y() + ahead * std::sin(base.yaw()) > 0.0005;) {
    const vpBaseVelocity velocity = follower.follow(base.wMb, 1, base.period());
    base.setVelocity(velocity.v, velocity.w);
    base.next();
  }
  return base.now();
}
} // namespace

TEST(PointServo, ErrorsFadeAsLambdaSays)
{
  for (const double gain : {0.5, 1.0, 2.0, 4.0}) {
    EXPECT_NEAR(timeToConverge(gain), std::log(10) / gain, 0.15 * std::log(10) / gain) << gain;
  }
}

TEST(PointServo, OnTheReferenceItIsTheFeedForward)
{
  vpPointServo servo({});
  vpReference reference;
  reference.place = {1, 2};
  reference.heading = 0.7;
  reference.v = 0.1;
  reference.w = 0.3;
  const vpBaseVelocity velocity = servo.velocity(vpStanding(1, 2, 0.7), reference, 0.02);
  EXPECT_NEAR(velocity.v, 0.1, 1e-9);
  EXPECT_NEAR(velocity.w, 0.3, 1e-9);
}

TEST(PointServo, AStandingReferenceDoesNotTwistTheBase)
{
  vpPointServoSettings settings;
  vpPointServo servo(settings);
  const vpBaseVelocity velocity = servo.velocity(vpStanding(0, -0.2, 0), vpReference(), 0.02);
  EXPECT_LE(std::abs(velocity.w), settings.slowest / settings.lookAhead + 1e-9);
}

TEST(PointServo, IntegralFindsWhatTheWheelsDo)
{
  for (const double curvature : {-0.2, 0.2}) {
    vpPerfectBase base;
    base.curvature = curvature;
    base.scale = 0.97;
    vpPathFollower follower(longLine, base.limits(), {});
    follow(longLine, base, follower, 20);
    const Eigen::Vector2d found = follower.servo().disturbance();
    EXPECT_NEAR(found.y(), -curvature, 0.01);
    EXPECT_NEAR(found.x(), 1 / base.scale - 1, 0.003);
    EXPECT_LT(std::abs(base.y()), 1e-4); // without the integral: curvature d / lambda v = 0.6 mm
  }
}

TEST(PointServo, BadSettingsAreNamed)
{
  vpPointServoSettings settings;
  settings.lookAhead = 0;
  vpExpectError([&settings] { vpPointServo servo(settings); }, {"look-ahead: 0", "above 0"});
  settings = {};
  settings.gainFar = 10;
  vpExpectError([&settings] { vpPointServo servo(settings); }, {"gain of large errors: 10"});
  settings = {};
  settings.integralGain = NAN;
  vpExpectError([&settings] { vpPointServo servo(settings); }, {"integral gain: nan"});
}

TEST(PathReference, KeepsItsLimits)
{
  const vpBaseLimits limits = vpTurtleBot3().limits();
  const vpPath paths[] = {square, vpPath::circle({0, 0}, 0.3), vpPath::lemniscate({0, 0}, 0.7), longLine};
  for (const vpPath &path : paths) {
    vpReferenceSettings settings;
    settings.speed = 0.2;
    vpPathReference reference(path, limits, settings);
    const double dt = 0.02;
    vpReference before = reference.now();
    for (int i = 0; i < 20000 && !reference.arrived(); ++i) {
      const vpReference now = reference.advance(dt, 1);
      EXPECT_LE(limits.share({now.v, now.w}), 1.001 * settings.share);
      EXPECT_LE(std::abs(now.v - before.v), settings.acceleration * dt * 1.01 + 1e-9) << now.s;
      EXPECT_LE((now.place - before.place).norm(), settings.speed * dt + 1e-9);
      EXPECT_GE(now.s, before.s);
      if (now.turning) {
        EXPECT_EQ(now.v, 0);
        EXPECT_LE(std::abs(now.w - before.w), settings.turnAcceleration * dt * 1.01 + 1e-9);
        reference.leaveCorner();
      }
      before = now;
    }
    EXPECT_TRUE(reference.arrived());
    EXPECT_NEAR(reference.now().s, path.length(), 1e-9);
  }
}

TEST(PathReference, StopsAtEachCornerUntilSomebodyHasTurned)
{
  vpReferenceSettings settings;
  settings.laps = 3;
  vpPathReference reference(square, vpTurtleBot3().limits(), settings);
  int corners = 0;
  for (int i = 0; i < 100000 && !reference.arrived(); ++i) {
    reference.advance(0.02, 1);
    if (reference.turned()) {
      const double s = reference.now().s;
      for (int wait = 0; wait < 10; ++wait) {
        EXPECT_EQ(reference.advance(0.02, 1).s, s);
      }
      reference.leaveCorner();
      ++corners;
    }
  }
  EXPECT_EQ(corners, 11); // 3 laps of 4, and at the last one it has arrived
}

TEST(PathReference, WaitsWhereItIsTold)
{
  vpPathReference reference(longLine, vpTurtleBot3().limits(), {});
  for (int i = 0; i < 100; ++i) {
    reference.advance(0.02, 1);
  }
  const double s = reference.now().s;
  for (int i = 0; i < 100; ++i) {
    reference.advance(0.02, 0);
  }
  EXPECT_EQ(reference.now().v, 0);
  EXPECT_LT(reference.now().s, s + 0.01); // 0.1 m/s, braked with 1.5 m/s^2
}

TEST(PathFollower, PerfectBaseStaysOnAnyPath)
{
  for (const vpPath &path : {square, vpPath::circle({0, 0}, 0.3), vpPath::lemniscate({0, 0}, 0.7),
                             vpPath::arc({0, 0}, 0.5, 1, -1), longLine}) {
    vpPathFollowerSettings settings;
    settings.reference.speed = 0.15;
    vpPerfectBase base;
    const vpPathPoint begin = path.at(0);
    base.wMb = vpStanding(begin.place.x(), begin.place.y(), begin.heading);
    vpPathFollower follower(path, base.limits(), settings);
    EXPECT_LT(follow(path, base, follower), 2e-3); // at most: what turnTolerance leaves at a corner
    EXPECT_TRUE(follower.arrived());
    const Eigen::Vector2d end = path.at(path.length()).place;
    EXPECT_LT(std::hypot(base.x() - end.x(), base.y() - end.y()), 0.005);
  }
}

TEST(PathFollower, ComesInFromBesideTheLine)
{
  for (const double side : {-0.1, 0.1}) {
    for (const double turned : {-30., 0., 30.}) {
      vpPerfectBase base;
      base.wMb = vpStanding(0, side, turned * M_PI / 180);
      vpPathFollower follower(longLine, base.limits(), {});
      double last = 0; // x where it was last off
      while (base.x() < 2) {
        const vpBaseVelocity velocity = base.limits().saturated(follower.follow(base.wMb, 1, base.period()));
        base.setVelocity(velocity.v, velocity.w);
        base.next();
        const bool near = std::abs(base.y()) < 0.01 && std::abs(base.yaw()) < 3 * M_PI / 180;
        last = near ? last : base.x();
      }
      EXPECT_LT(last, 0.5) << side << " " << turned;
    }
  }
}

TEST(PathFollower, TurnsFirstWhereItFacesAway)
{
  vpPerfectBase base;
  base.wMb = vpStanding(0, 0, M_PI - 0.1);
  vpPathFollower follower(longLine, base.limits(), {});
  double back = 0;
  while (base.x() < 0.3 && base.now() < 30) {
    const vpBaseVelocity velocity = follower.follow(base.wMb, 1, base.period());
    base.setVelocity(velocity.v, velocity.w);
    base.next();
    back = std::min(back, base.x());
  }
  EXPECT_GT(back, -0.02);
  EXPECT_LT(std::abs(base.y()), 0.01);
}

TEST(PathFollower, GoesOnFromWhereItIsAfterAWait)
{
  vpPerfectBase base;
  vpPathFollower follower(longLine, base.limits(), {});
  follow(longLine, base, follower, 5);
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(follower.follow(base.wMb, 0, base.period()).v, 0);
  }
  base.wMb = vpStanding(base.x() + 0.1, 0, 0); // coasted, or was pushed
  for (int i = 0; i < 50; ++i) {
    const vpBaseVelocity velocity = follower.follow(base.wMb, 1, base.period());
    EXPECT_GE(velocity.v, 0); // not back to where the reference was
    base.setVelocity(velocity.v, velocity.w);
    base.next();
  }
}

TEST(PathFollower, BadSettingsAreNamed)
{
  vpPathFollowerSettings settings;
  settings.reference.speed = -1;
  vpExpectError([&settings] { vpPathFollower follower(longLine, vpTurtleBot3().limits(), settings); },
                {"speed: -1", "above 0"});
  settings = {};
  settings.reference.laps = 0;
  vpExpectError([&settings] { vpPathFollower follower(longLine, vpTurtleBot3().limits(), settings); },
                {"laps: 0"});
  settings = {};
  settings.errorSlowest = 0.01;
  vpExpectError([&settings] { vpPathFollower follower(longLine, vpTurtleBot3().limits(), settings); },
                {"error slowest: 0.01"});
}

//! A base whose pose turns out to be past the end is not there before it has driven back.
TEST(PathFollower, DrivesBackFromBeyondTheEnd)
{
  const vpPathFollowerSettings settings;
  vpPerfectBase base;
  vpPathFollower follower(longLine, base.limits(), settings);
  while (!follower.atEnd()) {
    const vpBaseVelocity velocity = follower.follow(base.wMb, 1, base.period());
    base.setVelocity(velocity.v, velocity.w);
    base.next();
  }
  base.wMb = vpStanding(3.06, 0, 0);
  EXPECT_LT(follower.follow(base.wMb, 1, base.period()).v, 0);
  EXPECT_FALSE(follower.arrived());
  follow(longLine, base, follower);
  EXPECT_TRUE(follower.arrived());
  EXPECT_NEAR(base.x(), 3, settings.endTolerance);
}
