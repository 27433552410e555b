/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>

#include <visp3/core/vpException.h>
#include <visp3/core/vpRotationMatrix.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "vpScenarioYaml.h"

BEGIN_VISP_NAMESPACE

namespace
{
using vpScenarioYaml::degree;
using Range = vpYamlNode::Range;
using Motion = vpScenario::Motion;

vpHomogeneousMatrix place(double x, double y, double yaw)
{
  return {vpTranslationVector(x, y, 0), vpRotationMatrix(0, 0, yaw)};
}

void readStations(const vpYamlNode &node, double frameRate, Motion &motion)
{
  const double yaw = degree * node.number("yaw_deg", Range::any, 0);
  if (node.has("points")) {
    for (const vpYamlNode &point : node.mappings("points")) {
      const std::vector<double> at = point.numbers("at_m", 2);
      vpScenarioYaml::expectNear(point, "at_m", at);
      motion.stations.push_back(
          place(at[0], at[1], degree * point.number("yaw_deg", Range::any, yaw / degree)));
      point.finish();
    }
    if (motion.stations.empty()) {
      node.fail("points", "an empty list, expected one point or more");
    }
  } else {
    const vpYamlNode grid = node.mapping("grid");
    const std::vector<double> x = grid.numbers("x_m", 2), y = grid.numbers("y_m", 2);
    vpScenarioYaml::expectNear(grid, "x_m", x);
    vpScenarioYaml::expectNear(grid, "y_m", y);
    const unsigned int columns = grid.wholeNumber("columns", 1), rows = grid.wholeNumber("rows", 1);
    grid.finish();
    if (static_cast<double>(columns) * rows > vpScenarioYaml::mostFrames) {
      node.fail("grid", vpNumberText(static_cast<double>(columns) * rows) + " points, expected at most " +
                            vpNumberText(vpScenarioYaml::mostFrames));
    }
    auto between = [](const std::vector<double> &ends, unsigned int k, unsigned int count) {
      return count == 1 ? 0.5 * (ends[0] + ends[1]) : ends[0] + k * (ends[1] - ends[0]) / (count - 1);
    };
    for (unsigned int row = 0; row < rows; ++row) {
      for (unsigned int column = 0; column < columns; ++column) {
        motion.stations.push_back(place(between(x, column, columns), between(y, row, rows), yaw));
      }
    }
  }
  motion.hold = node.wholeNumber("frames_each", 1) / frameRate;
}

//! Speed with a sign, never 0.
double speedOf(const vpYamlNode &node, const std::string &key)
{
  const double speed = node.number(key);
  if (speed == 0) {
    node.fail(key, "0, expected a speed that leads somewhere");
  }
  return speed;
}

void readStart(const vpYamlNode &node, Motion &motion)
{
  const std::vector<double> start = node.numbers("start_m", 2);
  motion.robot.startX = start[0];
  motion.robot.startY = start[1];
  motion.robot.startYaw = degree * node.number("start_yaw_deg", Range::any, 0);
}

void readLine(const vpYamlNode &node, Motion &motion)
{
  const std::vector<double> from = node.numbers("from_m", 2), to = node.numbers("to_m", 2);
  const double length = std::hypot(to[0] - from[0], to[1] - from[1]);
  if (!(length > 0)) {
    node.fail("to_m", "the same place as from_m, expected another one");
  }
  const double speed = node.number("speed_m_s", Range::positive);
  motion.robot.startX = from[0];
  motion.robot.startY = from[1];
  motion.robot.startYaw = std::atan2(to[1] - from[1], to[0] - from[0]);
  motion.commands = {{{speed, 0}, length / speed}};
}

void readCommands(const vpYamlNode &node, Motion &motion)
{
  readStart(node, motion);
  for (const vpYamlNode &entry : node.mappings("commands")) {
    const double v = entry.number("v_m_s", Range::any, 0), w = entry.number("w_rad_s", Range::any, 0);
    motion.commands.push_back({{v, w}, entry.number("duration_s", Range::positive)});
    entry.finish();
  }
  if (motion.commands.empty()) {
    node.fail("commands", "an empty list, expected one command or more");
  }
}

void readArc(const vpYamlNode &node, Motion &motion)
{
  readStart(node, motion);
  const double speed = speedOf(node, "speed_m_s"), radius = speedOf(node, "radius_m");
  motion.commands = {{{speed, speed / radius}, node.number("duration_s", Range::positive)}};
}

void readSpin(const vpYamlNode &node, Motion &motion)
{
  readStart(node, motion);
  const double rate = speedOf(node, "rate_rad_s");
  motion.commands = {{{0, rate}, node.number("duration_s", Range::positive)}};
}

//! Keys and settings that are plain numbers.
struct Number {
  const char *key;
  double vpSimulatorTurtleBot3Settings::*member;
  double unit = 1;
};

void readRobot(const vpYamlNode &node, vpSimulatorTurtleBot3Settings &robot)
{
  using S = vpSimulatorTurtleBot3Settings;
  static const Number numbers[] = {{"left_radius_error", &S::leftRadiusError},
                                   {"right_radius_error", &S::rightRadiusError},
                                   {"separation_error", &S::separationError},
                                   {"slip", &S::slip},
                                   {"slip_sigma", &S::slipSigma},
                                   {"slip_length_m", &S::slipLength},
                                   {"command_delay_s", &S::commandDelay},
                                   {"acceleration_m_s2", &S::acceleration},
                                   {"motor_lag_s", &S::motorLag},
                                   {"odometry_rate_hz", &S::odometryRate},
                                   {"encoder_sigma_rad", &S::encoderSigma},
                                   {"gyro_noise_density_deg_s_sqrt_hz", &S::gyroNoiseDensity, degree},
                                   {"gyro_bias_deg_s", &S::gyroBias, degree}};
  for (const Number &number : numbers) {
    if (node.has(number.key)) {
      robot.*number.member = number.unit * node.number(number.key);
    }
  }
  if (node.has("model")) {
    robot.model = node.choice("model", {"burger", "waffle"}) == 0 ? vpTurtleBot3::Model::burger
                                                                  : vpTurtleBot3::Model::waffle;
  }
  if (node.has("turn_from")) {
    robot.turnSource =
        node.choice("turn_from", {"wheels", "gyro"}) == 0 ? S::TurnSource::wheels : S::TurnSource::gyro;
  }
  robot.velocityQuantum = node.has("velocity_quantum") && node.boolean("velocity_quantum");
  robot.motorUnit = node.has("motor_unit") && node.boolean("motor_unit");
  robot.encoderTicks = node.has("encoder_ticks") && node.boolean("encoder_ticks");
  if (node.has("floor_tilt_deg")) {
    const std::vector<double> tilt = node.numbers("floor_tilt_deg", 2);
    robot.floorTiltX = degree * tilt[0];
    robot.floorTiltY = degree * tilt[1];
  }
  node.finish();
  try {
    robot.check();
  } catch (const vpException &error) {
    node.fail("", error.getStringMessage());
  }
}
} // namespace

vpScenario::Motion vpScenarioYaml::readMotion(const vpYamlNode &top, double frameRate)
{
  Motion motion;
  const vpYamlNode node = top.mapping("motion");
  const size_t type = node.choice("type", {"stations", "line", "arc", "spin", "commands"});
  if (type == 0) {
    readStations(node, frameRate, motion);
    if (top.has("robot")) {
      top.fail("robot", "beside a motion of stations, where nobody drives, expected none");
    }
  } else {
    static void (*const readers[])(const vpYamlNode &, Motion &) = {readLine, readArc, readSpin,
                                                                    readCommands};
    readers[type - 1](node, motion);
  }
  node.finish();
  try {
    motion.robot.check(); // its start
  } catch (const vpException &error) {
    top.fail("motion", error.getStringMessage());
  }
  if (top.has("robot")) {
    readRobot(top.mapping("robot"), motion.robot);
  }
  double duration = 0; // s
  const vpBaseLimits limits = vpTurtleBot3(motion.robot.model).limits();
  for (const vpTimedVelocity &command : motion.commands) {
    if (limits.share(command.velocity) > 1 + 1e-9) {
      top.fail("motion", "v " + vpNumberText(command.velocity.v) + " m/s with w " +
                             vpNumberText(command.velocity.w) +
                             " rad/s is beyond this robot, expected |v| / " + vpNumberText(limits.v) +
                             " + |w| / " + vpNumberText(limits.w) + " of at most 1");
    }
    duration += command.duration;
  }
  if (!(duration <= vpScenarioYaml::longestRun)) {
    top.fail("motion", vpNumberText(duration) + " s of driving, expected at most " +
                           vpNumberText(vpScenarioYaml::longestRun) + " s");
  }
  return motion;
}

END_VISP_NAMESPACE
