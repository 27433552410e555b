/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "common/vpExpectError.h"
#include "simulatedDrive.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

TEST(SimulatorTurtleBot3, IdealRobotDrivesTheArcOfItsCommand)
{
  vpSimulatorTurtleBot3Settings settings;
  settings.startX = 0.5;
  settings.startY = -1;
  settings.startYaw = 0.7;
  for (const vpBaseVelocity command :
       {vpBaseVelocity{0.1, 0.5}, {-0.15, 0.2}, {0.2, 0}, {0, -1}, {0.1, 1e-6}}) {
    vpSimulatorTurtleBot3 robot(settings);
    robot.setVelocity(command.v, command.w);
    robot.advance(10);
    for (double t = 0; t < 10; t += 0.0003719) { // in the steps, not only at their ends
      const double yaw = 0.7 + command.w * t;
      double x = 0.5 + command.v * t * std::cos(0.7), y = -1 + command.v * t * std::sin(0.7);
      if (std::abs(command.w) > 1e-3) {
        x = 0.5 + command.v / command.w * (std::sin(yaw) - std::sin(0.7));
        y = -1 - command.v / command.w * (std::cos(yaw) - std::cos(0.7));
      }
      const vpHomogeneousMatrix wMb = robot.wMb(t);
      const double bend = std::abs(command.w) > 1e-3 ? 0 : std::abs(command.v * command.w) * t * t / 2;
      ASSERT_NEAR(wMb[0][3], x, 1e-12 + bend) << t;
      ASSERT_NEAR(wMb[1][3], y, 1e-12 + bend) << t;
      ASSERT_EQ(wMb[2][3], 0);
      ASSERT_NEAR(std::remainder(yawOf(wMb) - yaw, 2 * M_PI), 0, 1e-11);
      ASSERT_NEAR(robot.twist(t).v, command.v, 1e-12);
      ASSERT_NEAR(robot.twist(t).w, command.w, 1e-12);
    }
  }
}

TEST(SimulatorTurtleBot3, MotorLagReaches63PercentAfterItsTimeConstant)
{
  vpSimulatorTurtleBot3Settings settings;
  settings.motorLag = 0.03;
  vpSimulatorTurtleBot3 robot(settings);
  robot.setVelocity(0.2, 0);
  robot.advance(0.03);
  EXPECT_NEAR(robot.wheelSpeeds().left, 0.2 / 0.033 * (1 - std::exp(-1)), 1e-12);
  EXPECT_NEAR(robot.wMb(0.03)[0][3], 0.2 * (0.03 - 0.03 * (1 - std::exp(-1))), 1e-14);
  robot.advance(1);
  EXPECT_NEAR(robot.wMb(1)[0][3], 0.2 * (1 - 0.03), 1e-12); // in the end it is behind by speed times lag
  robot.stop();
  robot.advance(3);
  EXPECT_NEAR(robot.wMb(3)[0][3], 0.2, 1e-12);
  EXPECT_EQ(robot.wheelSpeeds().left, 0);
}

TEST(SimulatorTurtleBot3, RampAndLagAgreeWithSmallSteps)
{
  vpSimulatorTurtleBot3Settings settings;
  settings.motorLag = 0.05;
  settings.acceleration = 0.5;
  settings.commandDelay = 0.02;
  vpSimulatorTurtleBot3 robot(settings);
  const vpTurtleBot3 model(settings.model);
  robot.setVelocity(0.2, 0.0);
  robot.advance(0.3);
  robot.setVelocity(-0.05, 1.0);
  robot.advance(1);

  // Euler's method at 2 microseconds, written without the closed forms.
  constexpr double dt = 2e-6;
  double x = 0, y = 0, yaw = 0, reference[2] = {0, 0}, speed[2] = {0, 0}; // rim, m/s
  for (int i = 0; i < 500000; ++i) {
    const double t = i * dt + dt / 2;
    const vpWheels goal = model.wheelSpeeds(t < 0.02   ? vpBaseVelocity{0, 0}
                                            : t < 0.32 ? vpBaseVelocity{0.2, 0}
                                                       : vpBaseVelocity{-0.05, 1});
    for (int side = 0; side < 2; ++side) {
      const double missing = 0.033 * (side == 0 ? goal.left : goal.right) - reference[side];
      reference[side] += std::clamp(missing, -0.5 * dt, 0.5 * dt);
      speed[side] += (reference[side] - speed[side]) * dt / 0.05;
    }
    x += (speed[0] + speed[1]) / 2 * std::cos(yaw) * dt;
    y += (speed[0] + speed[1]) / 2 * std::sin(yaw) * dt;
    yaw += (speed[1] - speed[0]) / 0.16 * dt;
  }
  EXPECT_NEAR(robot.wMb(1)[0][3], x, 2e-6);
  EXPECT_NEAR(robot.wMb(1)[1][3], y, 2e-6);
  EXPECT_NEAR(yawOf(robot.wMb(1)), yaw, 2e-5);
}

TEST(SimulatorTurtleBot3, LimitsAreNeverPassed)
{
  vpSimulatorTurtleBot3Settings settings = roughSettings();
  settings.startTime = 0;
  settings.leftRadiusError = settings.rightRadiusError = 0;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> v(-1, 1), w(-10, 10);
  for (const bool quantum : {false, true}) {
    settings.velocityQuantum = quantum;
    vpSimulatorTurtleBot3 robot(settings);
    const vpTurtleBot3 model(settings.model);
    vpWheels before;
    for (int i = 1; i <= 20000; ++i) {
      if (i % 50 == 0) {
        const vpBaseVelocity given = robot.setVelocity(v(random), w(random));
        ASSERT_LE(robot.limits().share(given), 1 + 1e-9);
      }
      robot.advance(i * 1e-3);
      const vpWheels speeds = robot.wheelSpeeds();
      ASSERT_LE(std::max(std::abs(speeds.left), std::abs(speeds.right)), model.wheelSpeedLimit + 1e-9);
      const double change =
          std::max(std::abs(speeds.left - before.left), std::abs(speeds.right - before.right));
      ASSERT_LE(change * model.wheelRadius, settings.acceleration * 1e-3 + 1e-12);
      before = speeds;
    }
  }
}

TEST(SimulatorTurtleBot3, CommandsArriveLateAndStayInForce)
{
  vpSimulatorTurtleBot3Settings settings;
  settings.commandDelay = 0.1;
  vpSimulatorTurtleBot3 robot(settings);
  robot.setVelocity(0.1, 0);
  robot.advance(0.05);
  robot.stop();
  robot.advance(0.1);
  EXPECT_EQ(robot.wMb(0.1)[0][3], 0);
  robot.advance(5);
  EXPECT_NEAR(robot.wMb(5)[0][3], 0.1 * 0.05, 1e-14);
  robot.setVelocity(0.1, 0);
  robot.advance(100);
  EXPECT_NEAR(robot.wMb(100)[0][3], 0.1 * 0.05 + 0.1 * 94.9, 1e-10);
}

TEST(SimulatorTurtleBot3, SlipAndGeometryChangeThePathAsComputed)
{
  vpSimulatorTurtleBot3Settings settings;
  settings.slip = 0.01;
  vpSimulatorTurtleBot3 slipping(settings);
  slipping.setVelocity(0.1, 0.5);
  slipping.advance(10);
  EXPECT_NEAR(slipping.twist(5).v, 0.1 * 0.99, 1e-12);
  EXPECT_NEAR(slipping.twist(5).w, 0.5 * 0.99, 1e-12);
  EXPECT_NEAR(slipping.odometry().v, 0.1, 1e-12); // the wheels do not know

  settings = vpSimulatorTurtleBot3Settings();
  settings.leftRadiusError = -0.015;
  settings.rightRadiusError = 0.015;
  settings.separationError = 0.02;
  vpSimulatorTurtleBot3 bent(settings);
  bent.setVelocity(0.1, 0);
  bent.advance(10);
  EXPECT_NEAR(bent.twist(5).v, 0.1, 1e-12);
  EXPECT_NEAR(bent.twist(5).w, 0.1 * 0.03 / (0.16 * 1.02), 1e-12);
  EXPECT_NEAR(bent.odometry().w, 0, 1e-12);
}

TEST(SimulatorTurtleBot3, TiltedFloorCarriesTheBase)
{
  vpSimulatorTurtleBot3Settings settings;
  settings.floorTiltX = 0.02;
  settings.floorTiltY = -0.03;
  settings.startX = 1;
  settings.startY = 2;
  settings.startYaw = 0.4;
  vpSimulatorTurtleBot3 robot(settings);
  robot.setVelocity(0.15, 0.4);
  robot.advance(20);
  EXPECT_NEAR(robot.wMb(0)[0][3], 1, 1e-12); // the start is given in the map
  EXPECT_NEAR(robot.wMb(0)[1][3], 2, 1e-12);

  const Eigen::Vector3d axis(0.02, -0.03, 0);
  const Eigen::Vector3d normal = Eigen::AngleAxisd(axis.norm(), axis.normalized()) * Eigen::Vector3d::UnitZ();
  EXPECT_LT(normal.y(), 0); // turned about x the floor rises with y
  for (double t = 0; t <= 20; t += 0.0517) {
    const vpHomogeneousMatrix wMb = robot.wMb(t);
    EXPECT_NEAR(normal.dot(Eigen::Vector3d(wMb[0][3], wMb[1][3], wMb[2][3])), 0, 1e-12);
    EXPECT_NEAR((Eigen::Vector3d(wMb[0][2], wMb[1][2], wMb[2][2]) - normal).norm(), 0, 1e-12);
    EXPECT_TRUE(wMb.isAnHomogeneousMatrix());
    const vpHomogeneousMatrix soon = robot.wMb(t < 19 ? t + 1e-5 : t - 1e-5); // it drives where x points
    const double sign = t < 19 ? 1 : -1;
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR((soon[i][3] - wMb[i][3]) / 1e-5 * sign, 0.15 * wMb[i][0], 1e-5);
    }
  }
  EXPECT_NEAR(distance(robot, 0, 20), 0.15 / 0.4 * 2 * std::abs(std::sin(0.4 * 20 / 2)), 1e-12);
}

TEST(SimulatorTurtleBot3, PaperSpeedNeedsDithering)
{
  for (const bool dither : {true, false}) {
    vpSimulatorTurtleBot3Settings settings;
    settings.velocityQuantum = true;
    settings.dither = dither;
    settings.motorLag = 0.03;
    vpSimulatorTurtleBot3 robot(settings);
    for (int i = 1; i <= 5000; ++i) { // 50 Hz
      robot.setVelocity(0.004, 0);
      robot.advance(i * 0.02);
    }
    EXPECT_NEAR(robot.wMb(100)[0][3], dither ? 0.4 : 0, 0.0005);
  }
  vpSimulatorTurtleBot3Settings settings;
  settings.motorUnit = true; // 0.01 m/s is 12.6 units of the motors, of which 12 are left
  vpSimulatorTurtleBot3 robot(settings);
  robot.setVelocity(0.01, 0);
  robot.advance(1);
  EXPECT_NEAR(robot.twist(0.5).v, 12 * 0.229 * 2 * M_PI / 60 * 0.033, 1e-12);
}

TEST(SimulatorTurtleBot3, TimesOutsideItsHistoryAreRefused)
{
  vpSimulatorTurtleBot3Settings settings;
  settings.startTime = 1.7e9; // a clock that counts from 1970
  vpSimulatorTurtleBot3 robot(settings);
  EXPECT_EQ(robot.wMb(1.7e9)[0][3], 0);
  robot.setVelocity(0.1, 0);
  robot.advance(1.7e9 + 2);
  EXPECT_NEAR(robot.wMb(robot.time())[0][3], 0.2, 1e-9);
  EXPECT_NEAR(robot.wMb(1.7e9 + 1.23456)[0][3], 0.123456, 1e-7);
  vpExpectError([&] { robot.wMb(1.7e9 - 0.001); },
                {"simulated TurtleBot3: wMb at 1699999999.999 s, expected 1.7e+09 s to 1700000002 s"});
  vpExpectError([&] { robot.twist(1.7e9 + 2.001); }, {"twist at 1700000002.001 s"});
  vpExpectError([&] { robot.wMb(std::numeric_limits<double>::quiet_NaN()); }, {"wMb at nan s"});
  vpExpectError([&] { robot.advance(1.7e9 + 1); }, {"advance to 1700000001 s, expected 1700000002 s to"});
  vpExpectError([&] { robot.advance(1.7e9 + 6 * 3600 + 1); }, {"advance to"});
  vpExpectError([&] { robot.setVelocity(0, std::nan("")); }, {"w nan rad/s, expected finite numbers"});
  EXPECT_EQ(robot.time(), 1.7e9 + 2);
}

TEST(SimulatorTurtleBot3, BadSettingsAreRefused)
{
  using Settings = vpSimulatorTurtleBot3Settings;
  const std::vector<std::pair<std::function<void(Settings &)>, std::string>> all = {
      {[](Settings &s) { s.motorLag = -0.1; }, "motorLag: -0.1, expected 0 to 60 s"},
      {[](Settings &s) { s.motorLag = std::nan(""); }, "motorLag: nan, expected"},
      {[](Settings &s) { s.acceleration = 0; }, "acceleration: 0, expected 1e-06 or more m/s^2"},
      {[](Settings &s) { s.leftRadiusError = -1; }, "leftRadiusError: -1, expected -0.5 to 0.5, a share"},
      {[](Settings &s) { s.rightRadiusError = 3; }, "rightRadiusError: 3, expected"},
      {[](Settings &s) { s.separationError = 3; }, "separationError: 3, expected"},
      {[](Settings &s) { s.slip = -0.01; }, "slip: -0.01, expected 0 to 1, a share"},
      {[](Settings &s) { s.slipSigma = -1; }, "slipSigma: -1"},
      {[](Settings &s) { s.slipLength = 0; }, "slipLength: 0, expected"},
      {[](Settings &s) { s.commandDelay = -1; }, "commandDelay: -1"},
      {[](Settings &s) { s.odometryRate = 0; }, "odometryRate: 0, expected 0.01 to 1000 Hz"},
      {[](Settings &s) { s.encoderSigma = -1; }, "encoderSigma: -1"},
      {[](Settings &s) { s.gyroNoiseDensity = -1; }, "gyroNoiseDensity: -1"},
      {[](Settings &s) { s.gyroBias = 1 / 0.0; }, "gyroBias: inf, expected -10 to 10 rad/s"},
      {[](Settings &s) { s.floorTiltX = 2; }, "floorTiltX: 2, expected -0.5 to 0.5 rad"},
      {[](Settings &s) { s.floorTiltY = -2; }, "floorTiltY: -2"},
      {[](Settings &s) { s.startTime = 1e12; }, "startTime: "},
      {[](Settings &s) { s.startX = std::nan(""); }, "startX: nan"},
      {[](Settings &s) { s.startY = 1e9; }, "startY: 1e+09"},
      {[](Settings &s) { s.startYaw = std::nan(""); }, "startYaw: nan"},
  };
  for (const auto &[spoil, part] : all) {
    Settings settings;
    spoil(settings);
    vpExpectError([&, &settings = settings] { vpSimulatorTurtleBot3 robot(settings); },
                  {"simulated TurtleBot3: " + part});
  }
}

TEST(SimulatorTurtleBot3, PoseIsCheap)
{
  vpSimulatorTurtleBot3 robot(roughSettings());
  robot.setVelocity(0.1, 0.5);
  robot.advance(robot.time() + 100);
  double least = std::numeric_limits<double>::infinity(), sum = 0;
  for (int batch = 0; batch < 20; ++batch) { // the best of many: the machine is shared
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 1000; ++i) {
      sum += robot.wMb(12.5 + (i * 7919 % 1000) * 0.1 + batch * 1e-3)[0][3];
    }
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  EXPECT_TRUE(std::isfinite(sum));
  RecordProperty("microseconds", std::to_string(least * 1e3));
  EXPECT_LT(least / 1000, 1e-6);
}
