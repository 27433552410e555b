/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "simulatedDrive.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
using Settings = vpSimulatorTurtleBot3Settings;

//! Everything that a run gives, as numbers to compare bit by bit.
std::vector<double> trace(const vpSimulatorTurtleBot3 &robot)
{
  std::vector<double> numbers;
  for (const vpOdometry &sample : robot.odometrySamples()) {
    numbers.insert(numbers.end(), {sample.timestamp, sample.v, sample.w});
  }
  for (double t = 12.5; t <= robot.time(); t += 0.00137) {
    const vpHomogeneousMatrix wMb = robot.wMb(t);
    numbers.insert(numbers.end(), wMb.data, wMb.data + 12);
    numbers.insert(numbers.end(), {robot.twist(t).v, robot.twist(t).w});
  }
  numbers.insert(numbers.end(), {robot.wheelAngles().left, robot.wheelSpeeds().right});
  return numbers;
}

//! A drive of 6 s with a command every 0.1 s, cut into `pieces` between the commands.
std::vector<double> drive(const Settings &settings, int pieces)
{
  vpSimulatorTurtleBot3 robot(settings);
  for (int i = 0; i < 60; ++i) {
    robot.setVelocity(0.004 + 0.003 * i, std::sin(0.3 * i));
    const double begin = robot.time();
    for (int piece = 1; piece < pieces; ++piece) {
      robot.advance(begin + 0.1 * piece / pieces);
    }
    robot.advance(12.5 + (i + 1) * 0.1);
    robot.advance(robot.time());
  }
  return trace(robot);
}

bool sameBytes(const std::vector<double> &a, const std::vector<double> &b)
{
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

//! Expects the standard deviation of \e values about 0 to be \e sigma, 4.5 of its own deviations allowed.
void expectSigma(const std::vector<double> &values, double sigma)
{
  double squares = 0, sum = 0;
  for (const double value : values) {
    squares += value * value;
    sum += value;
  }
  const double count = static_cast<double>(values.size());
  EXPECT_NEAR(std::sqrt(squares / count) / sigma, 1, 4.5 / std::sqrt(2 * count));
  EXPECT_NEAR(sum / count / sigma, 0, 4.5 / std::sqrt(count));
}
} // namespace

TEST(SimulatorNoise, RunsRepeatBitByBitHoweverTheyAreSliced)
{
  const std::vector<double> whole = drive(roughSettings(), 1);
  ASSERT_GT(whole.size(), 10000u);
  EXPECT_TRUE(sameBytes(whole, drive(roughSettings(), 1)));
  EXPECT_TRUE(sameBytes(whole, drive(roughSettings(), 7)));
  EXPECT_TRUE(sameBytes(whole, drive(roughSettings(), 1013)));
  Settings other = roughSettings();
  other.seed = 6;
  EXPECT_FALSE(sameBytes(whole, drive(other, 1)));
  other.seed = roughSettings().seed + (std::uint64_t(1) << 32); // the seed counts to its last bit
  EXPECT_FALSE(sameBytes(whole, drive(other, 1)));
}

TEST(SimulatorNoise, OfEverySourceComesFromTheSeed)
{
  std::vector<Settings> sources(4);
  sources[0].slipSigma = 0.02;
  sources[1].encoderSigma = 0.001;
  sources[2].encoderTicks = true; // where the ticks lie
  sources[3].turnSource = Settings::TurnSource::gyro;
  sources[3].gyroNoiseDensity = 1e-3;
  for (Settings &settings : sources) {
    settings.startTime = 12.5;
    const std::vector<double> one = drive(settings, 1);
    EXPECT_TRUE(sameBytes(one, drive(settings, 1)));
    settings.seed = 2;
    EXPECT_FALSE(sameBytes(one, drive(settings, 1)));
  }
}

TEST(SimulatorNoise, OfOneSourceStaysWhenAnotherChanges)
{
  Settings settings = roughSettings();
  vpSimulatorTurtleBot3 a(settings);
  settings.encoderTicks = false;
  settings.encoderSigma = 0.5;
  settings.gyroBias = 0;
  settings.odometryRate = 20;
  vpSimulatorTurtleBot3 b(settings);
  for (vpSimulatorTurtleBot3 *robot : {&a, &b}) {
    robot->setVelocity(0.1, 0.3);
    robot->advance(20);
  }
  EXPECT_EQ(a.wMb(20)[0][3], b.wMb(20)[0][3]);
  EXPECT_EQ(a.wMb(20)[1][3], b.wMb(20)[1][3]);
}

TEST(SimulatorNoise, SamplesComeAtTheirRate)
{
  for (const double rate : {50.0, 60.0, 1000.0, 0.3}) {
    Settings settings;
    settings.startTime = 3;
    settings.odometryRate = rate;
    vpSimulatorTurtleBot3 robot(settings);
    EXPECT_EQ(robot.odometry().timestamp, 3);
    EXPECT_EQ(robot.odometry().v, 0);
    robot.advance(13);
    const std::vector<vpOdometry> &samples = robot.odometrySamples();
    ASSERT_EQ(samples.size(), static_cast<size_t>(std::floor(10 * rate + 1e-9)) + 1);
    for (size_t i = 0; i < samples.size(); ++i) {
      EXPECT_NEAR(samples[i].timestamp, 3 + static_cast<double>(i) / rate, 1e-9);
    }
    EXPECT_EQ(robot.odometry().timestamp, samples.back().timestamp);
  }
}

TEST(SimulatorNoise, OdometryOfAnIdealRobotIsItsTruth)
{
  Settings settings;
  settings.motorLag = 0.05;
  settings.odometryRate = 60; // not in step with the milliseconds
  vpSimulatorTurtleBot3 robot(settings);
  robot.setVelocity(0.1, 0.8);
  robot.advance(5);
  double yaw = 0, length = 0;
  for (const vpOdometry &sample : robot.odometrySamples()) {
    yaw += sample.w / 60;
    length += sample.v / 60;
    ASSERT_NEAR(std::remainder(yaw - yawOf(robot.wMb(sample.timestamp)), 2 * M_PI), 0, 1e-9);
  }
  EXPECT_NEAR(length, 0.1 * (5 - 0.05), 1e-9);
}

TEST(SimulatorNoise, EncoderTicksAreNotLost)
{
  Settings settings;
  settings.encoderTicks = true;
  vpSimulatorTurtleBot3 robot(settings);
  robot.setVelocity(0.0123, 0);
  robot.advance(60);
  double length = 0;
  bool uneven = false;
  for (size_t i = 1; i < robot.odometrySamples().size(); ++i) {
    const vpOdometry &sample = robot.odometrySamples()[i];
    length += sample.v * 0.02;
    ASSERT_NEAR(length, 0.0123 * sample.timestamp, 0.033 * vpTurtleBot3::tick + 1e-9);
    uneven = uneven || std::abs(sample.v - 0.0123) > 1e-4;
  }
  EXPECT_TRUE(uneven);
}

TEST(SimulatorNoise, GyroSeesTheTrueTurnAndItsBias)
{
  Settings settings;
  settings.turnSource = Settings::TurnSource::gyro;
  settings.gyroBias = 0.02;
  settings.rightRadiusError = 0.03;
  vpSimulatorTurtleBot3 robot(settings);
  robot.setVelocity(0.1, 0);
  robot.advance(30);
  double yaw = 0;
  for (size_t i = 1; i < robot.odometrySamples().size(); ++i) {
    yaw += robot.odometrySamples()[i].w * 0.02;
  }
  EXPECT_NEAR(std::remainder(yaw - yawOf(robot.wMb(30)) - 0.02 * 30, 2 * M_PI), 0, 1e-9);
  EXPECT_NEAR(robot.odometry().w, 0.02 + 0.1 * 0.03 / 0.16, 1e-9);
}

TEST(SimulatorNoise, GyroAndEncoderHaveTheStatedDeviation)
{
  Settings settings;
  settings.turnSource = Settings::TurnSource::gyro;
  settings.gyroNoiseDensity = 2e-3;
  settings.encoderSigma = 1e-3;
  settings.odometryRate = 100;
  vpSimulatorTurtleBot3 robot(settings);
  robot.advance(200);
  std::vector<double> gyro, wheels;
  for (size_t i = 1; i < robot.odometrySamples().size(); ++i) {
    gyro.push_back(robot.odometrySamples()[i].w);
    if (i % 2 == 0) { // neighbours share a reading
      wheels.push_back(robot.odometrySamples()[i].v);
    }
  }
  ASSERT_EQ(gyro.size(), 20000u);
  expectSigma(gyro, 2e-3 / std::sqrt(0.01));
  expectSigma(wheels, 0.033 * 1e-3 / 0.01); // of two wheels' mean, each the difference of two readings
}

TEST(SimulatorNoise, RandomSlipGrowsWithTheRootOfTheDistance)
{
  Settings settings;
  settings.slipSigma = 0.05;
  settings.slipLength = 0.02;
  std::vector<double> errors;
  for (settings.seed = 1; settings.seed <= 300; ++settings.seed) {
    vpSimulatorTurtleBot3 robot(settings);
    robot.setVelocity(0.2, 0);
    robot.advance(10);
    double length = 0; // the path bends
    for (int i = 0; i < 10000; ++i) {
      length += robot.twist((i + 0.5) * 1e-3).v * 1e-3;
    }
    errors.push_back(length - 2);
  }
  // Two wheels halve the variance. Exact for any distance: 2 L D becomes 2 L (D - L (1 - exp(-D / L))).
  expectSigma(errors, 0.05 * std::sqrt(2 * 0.02 * (2 - 0.02) / 2));
}

TEST(SimulatorNoise, StandingStillNothingMoves)
{
  vpSimulatorTurtleBot3 robot(roughSettings());
  robot.advance(20);
  EXPECT_EQ(distance(robot, 12.5, 20), 0);
  EXPECT_EQ(robot.twist(15).v, 0);
}
