/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <visp3/vlp_robot/vpTurtleBot3.h>

#include "common/vpExpectError.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
//! Speed of the faster wheel's rim, m/s.
double rimSpeed(const vpTurtleBot3 &robot, const vpBaseVelocity &velocity)
{
  const vpWheels speeds = robot.wheelSpeeds(velocity);
  return robot.wheelRadius * std::max(std::abs(speeds.left), std::abs(speeds.right));
}
} // namespace

TEST(TurtleBot3, IsTheRobotOfItsDataSheet)
{
  const vpTurtleBot3 burger(vpTurtleBot3::Model::burger), waffle(vpTurtleBot3::Model::waffle);
  EXPECT_NEAR(vpTurtleBot3::tick, 0.001533981, 1e-9);
  EXPECT_EQ(burger.wheelRadius, 0.033);
  EXPECT_EQ(burger.wheelSeparation, 0.160);
  EXPECT_NEAR(burger.limits().v, 0.2097, 5e-5);
  EXPECT_NEAR(burger.limits().w, 0.2097 / 0.08, 5e-4);
  EXPECT_EQ(waffle.wheelSeparation, 0.287);
  EXPECT_NEAR(waffle.limits().v, 0.26, 1e-12);
  EXPECT_LT(waffle.limits().w, 1.82);
}

TEST(TurtleBot3, WheelsAndVelocityAreInverse)
{
  for (const auto model : {vpTurtleBot3::Model::burger, vpTurtleBot3::Model::waffle}) {
    const vpTurtleBot3 robot(model);
    const vpBaseVelocity back = robot.velocity(robot.wheelSpeeds({0.123, -0.7}));
    EXPECT_NEAR(back.v, 0.123, 1e-15);
    EXPECT_NEAR(back.w, -0.7, 1e-14);
    const vpWheels left = robot.wheelSpeeds({0, 1}); // a turn to the left: the right wheel goes forward
    EXPECT_GT(left.right, 0);
    EXPECT_EQ(left.left, -left.right);
  }
}

TEST(TurtleBot3, SaturationKeepsTheCurvature)
{
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> v(-0.6, 0.6), w(-6, 6);
  const vpTurtleBot3 robot(vpTurtleBot3::Model::burger);
  int within = 0;
  for (int i = 0; i < 10000; ++i) {
    const vpBaseVelocity asked{v(random), w(random)};
    const vpBaseVelocity given = robot.limits().saturated(asked);
    EXPECT_NEAR(given.v * asked.w, given.w * asked.v, 1e-14); // same curvature, either way round
    EXPECT_GE(given.v * asked.v, 0);
    EXPECT_LE(rimSpeed(robot, given), robot.limits().v + 1e-12);
    if (rimSpeed(robot, asked) <= robot.limits().v) {
      EXPECT_TRUE(given.v == asked.v && given.w == asked.w);
      ++within;
    } else {
      EXPECT_NEAR(rimSpeed(robot, given), robot.limits().v, 1e-12); // no slower than need be
    }
  }
  EXPECT_GT(within, 500);
}

TEST(TurtleBot3, VelocitiesThatAreNoNumbersAreRefused)
{
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const vpBaseLimits limits = vpTurtleBot3().limits();
  vpVelocityRounding rounding(limits, true);
  vpExpectError([&] { limits.saturated({nan, 1}); }, {"velocity: v nan m/s, w 1 rad/s, expected finite"});
  vpExpectError([&] { limits.saturated({0.1, -infinity}); }, {"w -inf rad/s"});
  vpExpectError([&] { rounding.next({0, nan}); }, {"w nan rad/s"});
  EXPECT_EQ(rounding.next({0.1, 0.5}).v, 0.1); // and nothing of them stays behind
}

TEST(VelocityRounding, RoundsToTheNearestHundredth)
{
  vpVelocityRounding rounding(vpTurtleBot3().limits(), false);
  for (int count = -20; count <= 20; ++count) {
    EXPECT_EQ(std::lround(rounding.next({count / 100.0, 0}).v * vpTurtleBot3::commandCounts), count);
  }
  EXPECT_EQ(std::lround(rounding.next({0, 0.29}).w * vpTurtleBot3::commandCounts),
            29); // int(0.29 * 100) is 28
  EXPECT_EQ(rounding.next({0.0151, 0}).v, 0.02);
  EXPECT_EQ(rounding.next({-0.0149, 0}).v, -0.01);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(rounding.next({0.004, -0.004}).v, 0); // nothing is carried over
  }
}

TEST(VelocityRounding, DitheringIsRightInTheMean)
{
  for (const vpBaseVelocity asked :
       {vpBaseVelocity{0.004, 0}, {-0.004, 0.003}, {0.0333, -0.777}, {0.1, 0.5}, {0, 0.001}}) {
    vpVelocityRounding rounding(vpTurtleBot3().limits(), true);
    double v = 0, w = 0;
    for (int i = 1; i <= 2000; ++i) {
      const vpBaseVelocity given = rounding.next(asked);
      EXPECT_NEAR(given.v * 100, std::round(given.v * 100), 1e-12);
      EXPECT_LT(std::abs(given.v - asked.v), 0.01);
      v += given.v;
      w += given.w;
      ASSERT_NEAR(v, i * asked.v, 0.005 + 1e-9); // at any time, not only in the end
      ASSERT_NEAR(w, i * asked.w, 0.005 + 1e-9);
    }
  }
}

TEST(VelocityRounding, ZeroIsAlwaysZero)
{
  std::mt19937_64 random(2);
  std::uniform_int_distribution<int> halves(-8, 8); // many ties among them
  vpVelocityRounding rounding(vpTurtleBot3().limits(), true);
  for (int i = 0; i < 1000; ++i) {
    rounding.next({halves(random) * 0.005, halves(random) * 0.0025});
    const vpBaseVelocity stopped = rounding.next({0, 0});
    ASSERT_EQ(stopped.v, 0);
    ASSERT_EQ(stopped.w, 0);
  }
  rounding.next({0.004, 0});
  rounding.reset();
  EXPECT_EQ(rounding.next({0.004, 0}).v, 0);
  EXPECT_EQ(rounding.next({0.004, 0}).v, 0.01);
}

TEST(VelocityRounding, NeverPassesTheLimits)
{
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> v(-0.4, 0.4), w(-4, 4);
  for (const auto model : {vpTurtleBot3::Model::burger, vpTurtleBot3::Model::waffle}) {
    const vpTurtleBot3 robot(model);
    for (const bool dither : {false, true}) {
      vpVelocityRounding rounding(robot.limits(), dither);
      for (int i = 0; i < 10000; ++i) {
        const vpBaseVelocity asked = robot.limits().saturated({v(random), w(random)});
        const vpBaseVelocity given = rounding.next(asked);
        ASSERT_LE(rimSpeed(robot, given), robot.limits().v + 1e-9);
        ASSERT_NEAR(given.v, asked.v, 0.0200001);
        ASSERT_NEAR(given.w, asked.w, 0.0200001);
      }
    }
    // At the limit the mean falls short by less than a quantum, and is made up for no longer than that.
    vpVelocityRounding rounding(robot.limits(), true);
    for (int i = 0; i < 100; ++i) {
      ASSERT_GT(rounding.next({1, 0}).v, robot.limits().v - 0.01 - 1e-9);
    }
    EXPECT_EQ(rounding.next({0, 0}).v, 0);
  }
}
