/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "common/vpExpectError.h"
#include "opencr/vpEmulatedTurtleBot3.h"

using Table = vpOpenCrTable;

TEST(RobotTurtleBot3, DrivesAndReadsItsOdometry)
{
  vpEmulatedTurtleBot3 emulated;
  const auto base = emulated.driver();
  EXPECT_EQ(base->model(), vpTurtleBot3::Model::burger);
  EXPECT_EQ(base->firmwareVersion(), 5);
  EXPECT_EQ(base->odometry().v, 0);
  EXPECT_EQ(emulated.board.table().get(Table::torqueEnable), 1);

  const vpBaseVelocity sum = vpDrive(emulated, *base, {0.1, 0.5}, 4);
  EXPECT_NEAR(emulated.velocity().v, 0.1, 1e-9);
  EXPECT_NEAR(emulated.velocity().w, 0.5, 1e-9);
  const vpWheels angles = emulated.robot.wheelAngles();
  EXPECT_NEAR(sum.v, 0.033 * (angles.left + angles.right) / 2, 0.0025); // at 0.1 m/s, up to 25 ms old
  EXPECT_NEAR(sum.w,
              std::atan2(emulated.robot.wMb(emulated.robot.time())[1][0],
                         emulated.robot.wMb(emulated.robot.time())[0][0]),
              0.01);
  EXPECT_EQ(base->statistics().attempts, base->statistics().transactions);
}

TEST(RobotTurtleBot3, FirstHeartbeatIsAChange)
{
  for (const int before : {0, 1, 254, 255}) {
    vpEmulatedTurtleBot3 emulated;
    emulated.board.table().set(Table::heartbeat, static_cast<std::uint8_t>(before));
    emulated.line->advance(1); // by now it is no sign of life
    EXPECT_FALSE(emulated.board.alive());
    const auto base = emulated.driver();
    EXPECT_FALSE(emulated.board.alive()); // opening alone is none either
    base->setVelocity(0.1, 0);
    EXPECT_NE(emulated.board.table().get(Table::heartbeat), before);
    EXPECT_NE(emulated.board.table().get(Table::heartbeat), 0);
    vpDrive(emulated, *base, {0.1, 0}, 6); // it rolls over
    EXPECT_NEAR(emulated.velocity().v, 0.1, 1e-9);
  }
}

TEST(RobotTurtleBot3, SaturatesPerWheelSoThatTheMotorsRejectNothing)
{
  vpEmulatedTurtleBot3 emulated;
  const auto base = emulated.driver();
  for (const vpBaseVelocity asked : {vpBaseVelocity{0.22, 2.84}, {0.3, 0}, {0, -9}, {-0.2, 1.5}}) {
    const vpBaseVelocity told = base->setVelocity(asked.v, asked.w);
    vpDrive(emulated, *base, asked, 0.5);
    EXPECT_NEAR(emulated.velocity().v, told.v, 0.011) << asked.v;
    EXPECT_NEAR(emulated.velocity().w, told.w, 0.011) << asked.w;
    if (asked.v != 0 && asked.w != 0) {
      EXPECT_NEAR(told.w / told.v, asked.w / asked.v,
                  0.15 * std::abs(asked.w / asked.v)); // a quantum is coarse
    }
  }
  EXPECT_EQ(emulated.board.rejectedWheelGoals(), 0u);
  vpExpectError([&] { base->setVelocity(std::nan(""), 0); }, {"velocity: v nan m/s"});
  EXPECT_TRUE(base->connected());
}

TEST(RobotTurtleBot3, PaperSpeedIsRightInTheMean)
{
  vpEmulatedTurtleBot3 emulated;
  const auto base = emulated.driver();
  vpDrive(emulated, *base, {0.004, 0}, 100);
  EXPECT_NEAR(emulated.robot.wMb(emulated.robot.time())[0][3], 0.4, 0.002);
}

TEST(RobotTurtleBot3, WheelsMayWrapAndTheCounterMayRollOver)
{
  vpOpenCrEmulator::Settings settings;
  settings.firstTicks = std::numeric_limits<std::int32_t>::max() - 100;
  settings.firstMillis = 0u - 1000;
  settings.clockError = 1e-4;
  vpEmulatedTurtleBot3 emulated(settings);
  const auto base = emulated.driver();
  const vpBaseVelocity sum = vpDrive(emulated, *base, {0.2, 0}, 10);
  EXPECT_LT(emulated.board.table().get(Table::positionLeft), 0);
  EXPECT_LT(emulated.board.table().get(Table::millis), 20000u);
  const double last = base->odometry().timestamp;            // on the robot's own clock
  EXPECT_NEAR(sum.v, emulated.robot.wMb(last)[0][3], 0.001); // dated up to 5 ms late
  EXPECT_NEAR(last, emulated.line->now(), 0.03);
}

//! The board measures every 20 ms, some versions of its firmware whenever they are asked.
TEST(RobotTurtleBot3, EachSampleIsDatedWhenTheBoardMeasured)
{
  for (const bool always : {false, true}) {
    vpOpenCrEmulator::Settings settings;
    settings.measuresAlways = always;
    vpEmulatedTurtleBot3 emulated(settings);
    const auto base = emulated.driver();
    double way = 0, last = base->odometry().timestamp, fastest = 0;
    for (int i = 0; i < 500; ++i) {
      const double period = emulated.line->now() + 0.017; // falls into step with nothing
      base->setVelocity(0.2, 0);
      emulated.line->advance(period);
      const vpOdometry odometry = base->odometry();
      ASSERT_GE(odometry.timestamp, last);
      fastest = i > 10 ? std::max(fastest, odometry.v) : 0;
      way += odometry.v * (odometry.timestamp - last);
      last = odometry.timestamp;
      ASSERT_NEAR(way, emulated.robot.wMb(last)[0][3], 0.001) << i; // dated up to 5 ms late
    }
    EXPECT_LT(fastest, 0.22) << always; // the same table twice is no standstill, and makes the next no leap
  }
}

TEST(RobotTurtleBot3, TurnIsTheGyrosOrTheWheels)
{
  vpOpenCrEmulator::Settings settings;
  settings.gyroBias = 0.1f;
  vpRobotTurtleBot3Settings wheels;
  wheels.turnSource = vpRobotTurtleBot3Settings::TurnSource::wheels;
  vpEmulatedTurtleBot3 one(settings), other(settings);
  const auto withGyro = one.driver(), withWheels = other.driver(wheels);
  EXPECT_NEAR(vpDrive(one, *withGyro, {0, 0.5}, 2).w - vpDrive(other, *withWheels, {0, 0.5}, 2).w, 0.2, 0.01);
  one.line->advance(one.line->now() +
                    0.3); // too long for two readings of a rate; the wheels turned by 0.15 rad
  EXPECT_NEAR(withGyro->odometry().w, 0.5, 0.02);
}

TEST(RobotTurtleBot3, TimeStampsAreOnTheFramesClock)
{
  vpEmulatedTurtleBot3 emulated;
  vpRobotTurtleBot3Settings settings;
  settings.clock = [&] { return 1.7e9 + emulated.line->now(); };
  const auto base = emulated.driver(settings);
  vpDrive(emulated, *base, {0.1, 0}, 1);
  const vpOdometry odometry = base->odometry();
  EXPECT_NEAR(odometry.timestamp, 1.7e9 + emulated.line->now(), 0.03);
  EXPECT_NEAR(odometry.v, 0.1, 0.01);
  EXPECT_EQ(base->odometry().timestamp, odometry.timestamp); // within odometryPeriod the same again
}

TEST(RobotTurtleBot3, SaysHowItIs)
{
  vpEmulatedTurtleBot3 emulated;
  const auto base = emulated.driver();
  emulated.board.table().set(Table::batteryVoltage, 1105);
  emulated.board.table().set(Table::batteryCharge, 1550);
  emulated.board.table().set(Table::button2, 1);
  emulated.board.table().set(Table::bumper1, 1);
  vpDrive(emulated, *base, {0.1, 0}, 0.2);
  const vpTurtleBot3Status status = base->status();
  EXPECT_NEAR(status.batteryVoltage, 11.05, 1e-12);
  EXPECT_NEAR(status.batteryCharge, 0.155, 1e-12);
  EXPECT_TRUE(status.motorsAnswer);
  EXPECT_TRUE(status.torque);
  EXPECT_EQ(status.buttons, (std::array<bool, 2>{false, true}));
  EXPECT_EQ(status.bumpers, (std::array<bool, 2>{true, false}));
  EXPECT_NEAR(status.wheelSpeeds.left, 0.1 / 0.033, vpTurtleBot3::velocityUnit);
  EXPECT_NEAR(status.acceleration[2], 9.81, 1e-5);
}

TEST(RobotTurtleBot3, AccelerationIsTheBoards)
{
  vpEmulatedTurtleBot3 emulated;
  vpRobotTurtleBot3Settings settings;
  settings.acceleration = 1;
  const auto base = emulated.driver(settings);
  // 1 m/s^2 / (2 pi 0.033 m) = 4.823 rev/s^2 = 17363 rev/min^2 = 80.9 units
  EXPECT_EQ(emulated.board.table().get(Table::profileLeft), 81u);
  EXPECT_EQ(emulated.board.table().get(Table::profileRight), 81u);
}

TEST(RobotTurtleBot3, GyroIsCalibratedOnlyAtStandstill)
{
  vpOpenCrEmulator::Settings settings;
  settings.gyroBias = 0.02f;
  vpEmulatedTurtleBot3 emulated(settings);
  const auto base = emulated.driver();
  vpDrive(emulated, *base, {0.1, 0}, 0.5);
  vpExpectError([&] { base->recalibrateImu(); },
                {"gyro calibration asked for at wheel speeds", "that stands"});
  EXPECT_TRUE(base->connected());
  base->stop();
  emulated.line->advance(emulated.line->now() + 0.2);
  emulated.board.clearRequests();
  base->recalibrateImu();
  int asked = 0;
  for (const vpOpenCrEmulator::Request &request : emulated.board.requests()) {
    asked += request.packet.parameters[0] == Table::imuRecalibrate.address;
  }
  EXPECT_EQ(asked, 1);
  for (int i = 0; i < 2; ++i) {
    emulated.line->advance(emulated.line->now() + 0.05);
    base->odometry();
  }
  EXPECT_NEAR(base->odometry().w, 0, 1e-6);
  EXPECT_NEAR(vpDrive(emulated, *base, {0.1, 0}, 2).v, 0.2, 0.004);
}

TEST(RobotTurtleBot3, RefusesBoardsThatItCannotDrive)
{
  using Settings = vpOpenCrEmulator::Settings;
  const std::vector<std::pair<std::function<void(Settings &)>, std::string>> all = {
      {[](Settings &s) { s.modelNumber = 1060; }, "model number 1060, expected 20480, an OpenCR board"},
      {[](Settings &s) { s.modelInfo = 3; }, "model information 3, expected 1 (Burger) or 2 (Waffle)"},
      {[](Settings &s) { s.deviceStatus = -1; }, "device status -1, expected 0 (-1: no motors"},
      {[](Settings &s) { s.debugMode = 1; }, "debug mode 1, expected 0: without its watchdog"},
  };
  for (const auto &[spoil, part] : all) {
    Settings settings;
    spoil(settings);
    vpEmulatedTurtleBot3 emulated(settings);
    vpExpectError([&] { emulated.driver(); }, {"emulated board: " + part});
  }
  Settings settings;
  settings.debugMode = 1;
  vpEmulatedTurtleBot3 emulated(settings);
  vpRobotTurtleBot3Settings driver;
  driver.allowDebugMode = true;
  EXPECT_TRUE(emulated.driver(driver)->connected());
}

TEST(RobotTurtleBot3, KnowsAWaffle)
{
  vpOpenCrEmulator::Settings settings;
  settings.modelInfo = Table::waffle;
  vpSimulatorTurtleBot3Settings world;
  world.model = vpTurtleBot3::Model::waffle;
  vpEmulatedTurtleBot3 emulated(settings, world);
  const auto base = emulated.driver();
  EXPECT_EQ(base->model(), vpTurtleBot3::Model::waffle);
  EXPECT_NEAR(base->limits().v, 0.26, 1e-12);
  vpDrive(emulated, *base, {0.1, -0.3}, 1);
  EXPECT_NEAR(emulated.velocity().w, -0.3, 1e-9);
}
