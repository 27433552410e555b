/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_simulation/vpRobotMotion.h>

#include <cmath>

#include <gtest/gtest.h>
#include <visp3/core/vpRotationMatrix.h>

#include "common/vpExpectError.h"
#include "simulatedDrive.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
vpHomogeneousMatrix place(double x, double yaw)
{
  return {vpTranslationVector(x, 0, 0), vpRotationMatrix(0, 0, yaw)};
}
} // namespace

TEST(StationMotion, EachPlaceIsHeldInTurn)
{
  const double hold = 1 / 12.0;
  vpStationMotion motion({place(1, 0), place(2, 0.5), place(3, 1)}, hold);
  EXPECT_DOUBLE_EQ(motion.duration(), 0.25);
  EXPECT_TRUE(motion.odometry().empty());
  for (int frame = 0; frame < 3; ++frame) { // a frame begins with its place, whatever the last digit says
    EXPECT_EQ(motion.wMb(frame / 12.0)[0][3], frame + 1);
    EXPECT_EQ(motion.wMb(frame / 12.0 + 0.999 * hold)[0][3], frame + 1);
  }
  EXPECT_NEAR(yawOf(motion.wMb(hold)), 0.5, 1e-12);
  EXPECT_EQ(motion.wMb(-5)[0][3], 1); // before the start and after the end it stands
  EXPECT_EQ(motion.wMb(1e300)[0][3], 3);
}

TEST(StationMotion, LongRunsBeginEachPlaceOnTime)
{
  std::vector<vpHomogeneousMatrix> places;
  for (int k = 0; k < 20000; ++k) {
    places.push_back(place(k, 0));
  }
  for (const double rate : {3.0, 7.0, 12.0, 29.97}) {
    vpStationMotion motion(places, 1 / rate);
    for (int k = 0; k < 20000; k += 7) {
      EXPECT_EQ(motion.wMb(k / rate)[0][3], k) << rate << " Hz";
    }
  }
}

TEST(StationMotion, NoPlaceOrNoTimeIsRefused)
{
  vpExpectError([] { vpStationMotion({}, 1); }, {"stations", "expected one place or more"});
  for (const double hold : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    vpExpectError([&] { vpStationMotion({place(0, 0)}, hold); }, {"stations", "expected a number above 0"});
  }
}

TEST(DrivenMotion, CommandsFollowOneAnotherAndThenItStands)
{
  vpSimulatorTurtleBot3Settings robot;
  robot.startX = 0.5;
  vpDrivenMotion motion(robot, {{{0.1, 0}, 2}, {{0, M_PI / 4}, 2}, {{0.05, 0}, 1}});
  EXPECT_DOUBLE_EQ(motion.duration(), 5);
  EXPECT_NEAR(motion.wMb(1)[0][3], 0.6, 1e-9);
  EXPECT_NEAR(motion.wMb(2)[0][3], 0.7, 1e-9);
  EXPECT_NEAR(yawOf(motion.wMb(3)), M_PI / 4, 1e-9);
  EXPECT_NEAR(yawOf(motion.wMb(4)), M_PI / 2, 1e-9);
  EXPECT_NEAR(motion.wMb(5)[1][3], 0.05, 1e-9);
  EXPECT_NEAR(motion.wMb(100)[1][3], 0.05, 1e-9);
  EXPECT_NEAR(motion.wMb(0.5)[0][3], 0.55, 1e-9); // the past is not forgotten
  EXPECT_EQ(motion.wMb(-1)[0][3], 0.5);
}

TEST(DrivenMotion, IsTheSameInWhateverOrderItIsAsked)
{
  const std::vector<vpTimedVelocity> commands = {
      {{0.1, 0.3}, 0.777}, {{0.05, -0.5}, 1.2345}, {{0.1, 0}, 0.5}};
  vpSimulatorTurtleBot3Settings robot = roughSettings();
  robot.startTime = 0;
  vpDrivenMotion once(robot, commands), often(robot, commands);
  const vpHomogeneousMatrix end = once.wMb(3);
  for (double t = 0; t < 3; t += 0.013) {
    often.wMb(t);
  }
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      EXPECT_EQ(often.wMb(3)[row][column], end[row][column]);
    }
  }
  const std::vector<vpOdometry> one = once.odometry(), other = often.odometry();
  ASSERT_EQ(one.size(), other.size());
  for (size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].timestamp, other[k].timestamp);
    EXPECT_EQ(one[k].v, other[k].v);
    EXPECT_EQ(one[k].w, other[k].w);
  }
}

TEST(DrivenMotion, OdometryTellsNothingOfTheFuture)
{
  vpDrivenMotion motion(vpSimulatorTurtleBot3Settings(), {{{0.1, 0}, 10}});
  EXPECT_EQ(motion.odometry().size(), 1u); // that of the start
  for (const double time : {0.001, 0.02, 0.05, 0.5, 1.0}) {
    motion.wMb(time);
    const std::vector<vpOdometry> samples = motion.odometry();
    EXPECT_EQ(samples.size(), static_cast<size_t>(std::floor(50 * time + 1e-9)) + 1) << time;
    EXPECT_LE(samples.back().timestamp, time);
  }
  motion.wMb(0.1); // the past once more
  EXPECT_EQ(motion.odometry().size(), 51u);
}

TEST(DrivenMotion, RobotWhoseClockStartsLaterStandsThereBefore)
{
  vpSimulatorTurtleBot3Settings robot;
  robot.startTime = 12.5;
  robot.startX = 0.3;
  vpDrivenMotion motion(robot, {{{0.1, 0}, 2}});
  EXPECT_EQ(motion.wMb(0)[0][3], 0.3);
  EXPECT_EQ(motion.wMb(12.5)[0][3], 0.3);
  EXPECT_NEAR(motion.wMb(13.5)[0][3], 0.4, 1e-9);
}

TEST(DrivenMotion, NoCommandOrNoTimeIsRefused)
{
  const vpSimulatorTurtleBot3Settings robot;
  vpExpectError([&] { vpDrivenMotion(robot, {}); }, {"drive", "expected one or more"});
  for (const double duration : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    vpExpectError(
        [&] {
          vpDrivenMotion(robot, {{{0.1, 0}, duration}});
        },
        {"drive", "expected a number above 0"});
  }
}
