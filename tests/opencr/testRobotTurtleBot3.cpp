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

namespace
{
//! Drives for \e duration at 50 Hz as a control loop does. \return The sum of the odometry: m, rad.
vpBaseVelocity drive(vpEmulatedTurtleBot3 &emulated, vpRobotTurtleBot3 &base, const vpBaseVelocity &velocity,
                     double duration)
{
  vpBaseVelocity sum;
  double last = base.odometry().timestamp;
  for (const double end = emulated.line->now() + duration; emulated.line->now() < end;) {
    const double period = emulated.line->now() + 0.02;
    base.setVelocity(velocity.v, velocity.w);
    emulated.line->advance(period);
    const vpOdometry odometry = base.odometry();
    sum.v += odometry.v * (odometry.timestamp - last);
    sum.w += odometry.w * (odometry.timestamp - last);
    last = odometry.timestamp;
  }
  return sum;
}

vpBaseVelocity trueVelocity(const vpEmulatedTurtleBot3 &emulated)
{
  return emulated.robot.twist(emulated.robot.time());
}

bool stands(const vpEmulatedTurtleBot3 &emulated)
{
  const vpBaseVelocity velocity = trueVelocity(emulated);
  return std::abs(velocity.v) < 1e-6 && std::abs(velocity.w) < 1e-6;
}

//! s after \e time at which the robot stood for good.
double standstillAfter(const vpEmulatedTurtleBot3 &emulated, double time)
{
  double last = time;
  for (double t = time; t <= emulated.robot.time(); t += 1e-3) {
    const vpBaseVelocity velocity = emulated.robot.twist(t);
    last = std::abs(velocity.v) > 1e-3 || std::abs(velocity.w) > 1e-2 ? t : last;
  }
  return last - time;
}
} // namespace

TEST(RobotTurtleBot3, DrivesAndReadsItsOdometry)
{
  vpEmulatedTurtleBot3 emulated;
  const auto base = emulated.driver();
  EXPECT_EQ(base->model(), vpTurtleBot3::Model::burger);
  EXPECT_EQ(base->firmwareVersion(), 5);
  EXPECT_EQ(base->odometry().v, 0);
  EXPECT_EQ(emulated.board.table().get(Table::torqueEnable), 1);

  const vpBaseVelocity sum = drive(emulated, *base, {0.1, 0.5}, 4);
  EXPECT_NEAR(trueVelocity(emulated).v, 0.1, 1e-9);
  EXPECT_NEAR(trueVelocity(emulated).w, 0.5, 1e-9);
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
    drive(emulated, *base, {0.1, 0}, 6); // it rolls over
    EXPECT_NEAR(trueVelocity(emulated).v, 0.1, 1e-9);
  }
}

TEST(RobotTurtleBot3, SaturatesPerWheelSoThatTheMotorsRejectNothing)
{
  vpEmulatedTurtleBot3 emulated;
  const auto base = emulated.driver();
  for (const vpBaseVelocity asked : {vpBaseVelocity{0.22, 2.84}, {0.3, 0}, {0, -9}, {-0.2, 1.5}}) {
    const vpBaseVelocity told = base->setVelocity(asked.v, asked.w);
    drive(emulated, *base, asked, 0.5);
    EXPECT_NEAR(trueVelocity(emulated).v, told.v, 0.011) << asked.v;
    EXPECT_NEAR(trueVelocity(emulated).w, told.w, 0.011) << asked.w;
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
  drive(emulated, *base, {0.004, 0}, 100);
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
  const vpBaseVelocity sum = drive(emulated, *base, {0.2, 0}, 10);
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
  EXPECT_NEAR(drive(one, *withGyro, {0, 0.5}, 2).w - drive(other, *withWheels, {0, 0.5}, 2).w, 0.2, 0.01);
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
  drive(emulated, *base, {0.1, 0}, 1);
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
  drive(emulated, *base, {0.1, 0}, 0.2);
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
  drive(emulated, *base, {0.1, 0}, 0.5);
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
  EXPECT_NEAR(drive(emulated, *base, {0.1, 0}, 2).v, 0.2, 0.004);
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
  drive(emulated, *base, {0.1, -0.3}, 1);
  EXPECT_NEAR(trueVelocity(emulated).w, -0.3, 1e-9);
}

TEST(RobotTurtleBot3, StandsWhenItsDriverEnds)
{
  vpEmulatedTurtleBot3 emulated;
  auto base = emulated.driver();
  drive(emulated, *base, {0.1, 0.5}, 1);
  EXPECT_FALSE(stands(emulated));
  base.reset();
  emulated.board.advance(emulated.robot.time() + 0.011); // one turn of the board's loop
  EXPECT_TRUE(stands(emulated));
}

//! A loop that hangs, a process killed, a cable pulled: nobody changes the heartbeat.
TEST(RobotTurtleBot3, StandsWhenNobodyDrives)
{
  vpSimulatorTurtleBot3Settings world;
  world.motorLag = 0.03;
  vpEmulatedTurtleBot3 emulated(vpOpenCrEmulator::Settings(), world);
  const auto base = emulated.driver();
  drive(emulated, *base, {0.2, 0}, 1);
  double time = emulated.line->now();
  emulated.line->advance(time + 2);
  EXPECT_GT(standstillAfter(emulated, time), 0.3);
  EXPECT_LT(standstillAfter(emulated, time), 0.65 + 6 * world.motorLag); // to 1 mm/s of 0.2 m/s

  drive(emulated, *base, {0.2, 0}, 1); // and goes on at the next command
  EXPECT_NEAR(trueVelocity(emulated).v, 0.2, 0.001);
  time = emulated.line->now();
  emulated.line->pullCable();
  vpExpectError([&] { base->setVelocity(0.2, 0); }, {"emulated board: is gone"});
  vpExpectError([&] { base->odometry(); }, {"emulated board: the connection was given up"});
  vpExpectError([&] { base->stop(); }, {"emulated board: is gone"});
  vpExpectError([&] { base->reconnect(); }, {"emulated board: is gone"});
  emulated.line->advance(time + 2);
  EXPECT_LT(standstillAfter(emulated, time), 0.65 + 6 * world.motorLag);
}

TEST(RobotTurtleBot3, ComesBackAfterACableWasPulled)
{
  vpEmulatedTurtleBot3 emulated;
  const auto base = emulated.driver();
  drive(emulated, *base, {0.2, 0}, 1);
  emulated.line->pullCable();
  vpExpectError([&] { base->setVelocity(0.2, 0); }, {"is gone"});
  emulated.line->advance(emulated.line->now() + 3);
  emulated.line->plugCable();
  emulated.board.restart(); // it lives on the cable: counter and positions begin anew
  EXPECT_FALSE(base->connected());
  base->reconnect();
  EXPECT_EQ(base->odometry().v, 0);
  const double before = emulated.robot.wMb(base->odometry().timestamp)[0][3];
  const vpBaseVelocity sum = drive(emulated, *base, {0.1, 0}, 1);
  EXPECT_NEAR(sum.v, emulated.robot.wMb(base->odometry().timestamp)[0][3] - before, 0.0003);
}

TEST(RobotTurtleBot3, ARestartedBoardIsNoticed)
{
  vpEmulatedTurtleBot3 emulated;
  const auto base = emulated.driver();
  drive(emulated, *base, {0.1, 0}, 1);
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
  EXPECT_TRUE(stands(emulated));
}

TEST(RobotTurtleBot3, AnotherProgramsCommandIsNoticed)
{
  vpEmulatedTurtleBot3 emulated;
  const auto base = emulated.driver();
  drive(emulated, *base, {0.1, 0}, 0.5);
  emulated.board.table().set(Table::commandW, 50);
  vpExpectError(
      [&] {
        drive(emulated, *base, {0.1, 0}, 0);
        base->status();
      },
      {"holds heartbeat", "and command 10, 50", "expected", "and 10, 0"});
  emulated.board.advance(emulated.robot.time() + 0.02);
  EXPECT_TRUE(stands(emulated)); // it was told to
}

TEST(RobotTurtleBot3, ACommandThatTheBoardRefusesStopsIt)
{
  vpEmulatedTurtleBot3 emulated;
  const auto base = emulated.driver();
  drive(emulated, *base, {0.1, 0}, 0.5);
  emulated.board.failNext(vpDynamixelPacket::dataLimit);
  vpExpectError([&] { base->setVelocity(0.1, 0); }, {"answered with data limit error"});
  emulated.board.advance(emulated.robot.time() + 0.02);
  EXPECT_TRUE(stands(emulated));
}

//! Late answers look like those of later requests: a command counts only if the board surely holds it.
TEST(RobotTurtleBot3, NoCommandIsTakenForExecutedByALateAnswer)
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

TEST(RobotTurtleBot3, StandsWhereTheBusIsTooBad)
{
  for (const double share : {0.03, 0.1, 1.0}) {
    vpSimulatorTurtleBot3Settings world;
    world.motorLag = 0.03;
    vpEmulatedTurtleBot3 emulated(vpOpenCrEmulator::Settings(), world);
    const auto base = emulated.driver();
    drive(emulated, *base, {0.2, 0}, 1);
    vpFaultyLine::Faults faults;
    faults.corrupted = share;
    emulated.line->setFaults(faults);
    EXPECT_THROW(drive(emulated, *base, {0.2, 0}, 60), vpException) << share;
    const double time = emulated.line->now();
    EXPECT_FALSE(base->connected());
    vpExpectError([&] { base->setVelocity(0.2, 0); }, {"the connection was given up, expected reconnect()"});
    emulated.line->advance(time + 2);
    EXPECT_TRUE(stands(emulated)) << share;
    EXPECT_LT(standstillAfter(emulated, time), 0.65) << share;
  }
}

TEST(RobotTurtleBot3, OdometryOfABadBusLosesNoTick)
{
  vpFaultyLine::Faults faults;
  faults.corrupted = 0.002;
  faults.delayed = 0.005;
  vpEmulatedTurtleBot3 emulated;
  const auto base = emulated.driver();
  emulated.line->setFaults(faults);
  double way = drive(emulated, *base, {0.15, 0}, 20).v;
  EXPECT_GT(base->statistics().crcErrors, 50u);
  emulated.line->setFaults({});
  base->stop();
  const double last = base->odometry().timestamp;
  emulated.line->advance(emulated.line->now() + 0.3);
  const vpOdometry odometry = base->odometry();
  way += odometry.v * (odometry.timestamp - last);
  EXPECT_NEAR(way, 0.033 * emulated.robot.wheelAngles().left, 0.0002);
}
