/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "common/vpExpectError.h"
#include "opencr/vpEmulatedTurtleBot3.h"
#include "opencr/vpStandstill.h"

using Table = vpOpenCrTable;

TEST(RobotTurtleBot3Faults, StandsWhenItsDriverEnds)
{
  vpEmulatedTurtleBot3 emulated;
  auto base = emulated.driver();
  vpDrive(emulated, *base, {0.1, 0.5}, 1);
  EXPECT_FALSE(emulated.stands());
  base.reset();
  emulated.board.advance(emulated.robot.time() + 0.011); // one turn of the board's loop
  EXPECT_TRUE(emulated.stands());
}

//! A loop that hangs, a process killed, a cable pulled: nobody changes the heartbeat.
TEST(RobotTurtleBot3Faults, StandsWhenNobodyDrives)
{
  vpSimulatorTurtleBot3Settings world;
  world.motorLag = 0.03;
  vpEmulatedTurtleBot3 emulated(vpOpenCrEmulator::Settings(), world);
  const auto base = emulated.driver();
  vpDrive(emulated, *base, {0.2, 0}, 1);
  double time = emulated.line->now();
  emulated.line->advance(time + 2);
  EXPECT_GT(vpStandstillAfter(emulated.robot, time), 0.3);
  EXPECT_LT(vpStandstillAfter(emulated.robot, time), 0.65 + 6 * world.motorLag); // to 1 mm/s of 0.2 m/s

  vpDrive(emulated, *base, {0.2, 0}, 1); // and goes on at the next command
  EXPECT_NEAR(emulated.velocity().v, 0.2, 0.001);
  time = emulated.line->now();
  emulated.line->pullCable();
  vpExpectError([&] { base->setVelocity(0.2, 0); }, {"emulated board: is gone"});
  vpExpectError([&] { base->odometry(); }, {"emulated board: the connection was given up"});
  vpExpectError([&] { base->stop(); }, {"emulated board: is gone"});
  vpExpectError([&] { base->reconnect(); }, {"emulated board: is gone"});
  emulated.line->advance(time + 2);
  EXPECT_LT(vpStandstillAfter(emulated.robot, time), 0.65 + 6 * world.motorLag);
}

TEST(RobotTurtleBot3Faults, ComesBackAfterACableWasPulled)
{
  vpEmulatedTurtleBot3 emulated;
  const auto base = emulated.driver();
  vpDrive(emulated, *base, {0.2, 0}, 1);
  emulated.line->pullCable();
  vpExpectError([&] { base->setVelocity(0.2, 0); }, {"is gone"});
  emulated.line->advance(emulated.line->now() + 3);
  emulated.line->plugCable();
  emulated.board.restart(); // it lives on the cable: counter and positions begin anew
  EXPECT_FALSE(base->connected());
  base->reconnect();
  EXPECT_EQ(base->odometry().v, 0);
  const double before = emulated.robot.wMb(base->odometry().timestamp)[0][3];
  const vpBaseVelocity sum = vpDrive(emulated, *base, {0.1, 0}, 1);
  EXPECT_NEAR(sum.v, emulated.robot.wMb(base->odometry().timestamp)[0][3] - before, 0.0003);
}

TEST(RobotTurtleBot3Faults, ARestartedBoardIsNoticed)
{
  vpEmulatedTurtleBot3 emulated;
  const auto base = emulated.driver();
  vpDrive(emulated, *base, {0.1, 0}, 1);
  emulated.board.restart();
  std::string problem;
  for (int i = 0; i < 50 && problem.empty(); ++i) {
    emulated.line->advance(emulated.line->now() + 0.02);
    try {
      base->odometry();
    } catch (const vpException &error) {
      problem = error.getStringMessage();
    }
  }
  EXPECT_NE(problem.find("it restarted, or another program uses it"), std::string::npos) << problem;
  EXPECT_TRUE(emulated.stands());
}

TEST(RobotTurtleBot3Faults, AnotherProgramsCommandIsNoticed)
{
  vpEmulatedTurtleBot3 emulated;
  const auto base = emulated.driver();
  vpDrive(emulated, *base, {0.1, 0}, 0.5);
  emulated.board.table().set(Table::commandW, 50);
  vpExpectError(
      [&] {
        vpDrive(emulated, *base, {0.1, 0}, 0);
        base->status();
      },
      {"holds heartbeat", "and command 10, 50", "expected", "and 10, 0"});
  emulated.board.advance(emulated.robot.time() + 0.02);
  EXPECT_TRUE(emulated.stands()); // it was told to
}

TEST(RobotTurtleBot3Faults, ACommandThatTheBoardRefusesStopsIt)
{
  vpEmulatedTurtleBot3 emulated;
  const auto base = emulated.driver();
  vpDrive(emulated, *base, {0.1, 0}, 0.5);
  emulated.board.failNext(vpDynamixelPacket::dataLimit);
  vpExpectError([&] { base->setVelocity(0.1, 0); }, {"answered with data limit error"});
  emulated.board.advance(emulated.robot.time() + 0.02);
  EXPECT_TRUE(emulated.stands());
}

//! Late answers look like those of later requests: a command counts only if the board surely holds it.
TEST(RobotTurtleBot3Faults, NoCommandIsTakenForExecutedByALateAnswer)
{
  vpFaultyLine::Faults faults;
  faults.delayed = 0.1;
  faults.delay = 0.05;
  faults.lost = 0.002;
  int confirmed = 0, failed = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    vpEmulatedTurtleBot3 emulated;
    const auto base = emulated.driver();
    faults.seed = seed;
    emulated.line->setFaults(faults);
    for (int i = 0; i < 200 && base->connected(); ++i) {
      const double v = 0.01 * (i % 15);
      try {
        base->setVelocity(v, 0);
        ++confirmed;
        ASSERT_EQ(emulated.board.table().get(Table::commandV), i % 15);
        emulated.line->advance(emulated.line->now() + 0.02);
        const double before = base->odometry().timestamp;
        ASSERT_LE(before, emulated.line->now());
      } catch (const vpException &) {
        ++failed;
      }
    }
  }
  EXPECT_GT(confirmed, 4000);
  EXPECT_GT(failed, 0); // else it was no test
}

TEST(RobotTurtleBot3Faults, StandsWhereTheBusIsTooBad)
{
  for (const double share : {0.03, 0.1, 1.0}) {
    vpSimulatorTurtleBot3Settings world;
    world.motorLag = 0.03;
    vpEmulatedTurtleBot3 emulated(vpOpenCrEmulator::Settings(), world);
    const auto base = emulated.driver();
    vpDrive(emulated, *base, {0.2, 0}, 1);
    vpFaultyLine::Faults faults;
    faults.corrupted = share;
    emulated.line->setFaults(faults);
    EXPECT_THROW(vpDrive(emulated, *base, {0.2, 0}, 60), vpException) << share;
    const double time = emulated.line->now();
    EXPECT_FALSE(base->connected());
    vpExpectError([&] { base->setVelocity(0.2, 0); }, {"the connection was given up, expected reconnect()"});
    emulated.line->advance(time + 2);
    EXPECT_TRUE(emulated.stands()) << share;
    EXPECT_LT(vpStandstillAfter(emulated.robot, time), 0.65) << share;
  }
}

TEST(RobotTurtleBot3Faults, OdometryOfABadBusLosesNoTick)
{
  vpFaultyLine::Faults faults;
  faults.corrupted = 0.002;
  faults.delayed = 0.005;
  vpEmulatedTurtleBot3 emulated;
  const auto base = emulated.driver();
  emulated.line->setFaults(faults);
  double way = vpDrive(emulated, *base, {0.15, 0}, 20).v;
  EXPECT_GT(base->statistics().crcErrors, 50u);
  emulated.line->setFaults({});
  base->stop();
  const double last = base->odometry().timestamp;
  emulated.line->advance(emulated.line->now() + 0.3);
  const vpOdometry odometry = base->odometry();
  way += odometry.v * (odometry.timestamp - last);
  EXPECT_NEAR(way, 0.033 * emulated.robot.wheelAngles().left, 0.0002);
}
