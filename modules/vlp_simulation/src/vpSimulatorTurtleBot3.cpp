/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_simulation/vpSimulatorTurtleBot3.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <string>

#include <Eigen/Dense>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "vpNormalNoise.h"
#include "vpWheelDrive.h"

BEGIN_VISP_NAMESPACE

namespace
{
constexpr double stepTime = 1e-3; // s
// Times that are sums of many terms miss the step that they mean by a little, and by 2e-4 of a step on a
// clock that counts from 1970. So much of a step counts as nothing.
constexpr double tolerance = 1e-3;
constexpr double longestRun = 6 * 3600; // s

enum NoiseStream : std::uint32_t { slipStream, encoderStream, gyroStream };

//! Planar pose on the floor: m, m, rad.
struct FloorPose {
  double x = 0;
  double y = 0;
  double yaw = 0;
};

//! One step: where it begins and the arc that it drives.
struct Step {
  FloorPose begin;
  double length = 0; // m
  double turn = 0;   // rad
};

//! The pose after \e share of the step's arc.
FloorPose along(const Step &step, double share)
{
  const double half = step.turn * share / 2;
  const double sinc = std::abs(half) < 1e-4 ? 1 - half * half / 6 : std::sin(half) / half;
  const double chord = step.length * share * sinc; // of an arc, in the direction midway
  return {step.begin.x + chord * std::cos(step.begin.yaw + half),
          step.begin.y + chord * std::sin(step.begin.yaw + half), step.begin.yaw + 2 * half};
}

//! Turns the map's axes into the floor's.
Eigen::Matrix3d floorAxes(double tiltX, double tiltY)
{
  const Eigen::Vector3d vector(tiltX, tiltY, 0);
  const double angle = vector.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix()
                   : Eigen::Matrix3d::Identity().eval();
}
} // namespace

class vpSimulatorTurtleBot3::Impl
{
public:
  explicit Impl(const vpSimulatorTurtleBot3Settings &settings);

  void command(const vpBaseVelocity &velocity);
  void advance(double untilTime);
  vpHomogeneousMatrix pose(const FloorPose &floor) const;
  //! The step that \e time falls into, and in \e share how far into it.
  const Step &stepAt(double time, const char *what, double &share) const;
  double sinceStart(double time) const { return time - m_settings.startTime; }
  double shareOfLastStep(double sinceStart) const;
  vpWheels anglesInLastStep(double share) const;

  vpSimulatorTurtleBot3Settings m_settings;
  vpTurtleBot3 m_model;
  vpVelocityRounding m_rounding;
  double m_time;
  std::vector<vpOdometry> m_odometry;
  vpWheels m_beginSpeeds, m_speeds; // of the last step and now, rad/s

private:
  struct Command {
    std::int64_t step = 0; // the first in which it is in force
    vpWheels speeds;       // rad/s
  };

  void drive();
  double slipped(double rolled, double &deviation);
  void sampleUntil(double untilTime);
  void sample(double sinceStart);
  double encoder(double angle, double phase);

  Eigen::Matrix3d m_wRf;     // axes of the floor in the map
  std::vector<Step> m_steps; // all since the start, then what has not been driven yet
  std::deque<Command> m_commands;
  vpWheels m_goal; // rad/s
  vpWheelDrive m_left, m_right;
  vpWheels m_beginAngles, m_angles; // of the last step, rad
  vpWheels m_slipDeviation;
  vpNormalNoise m_slipNoise, m_encoderNoise, m_gyroNoise;
  vpWheels m_encoderPhase;    // rad, where the ticks lie
  vpWheels m_lastReading;     // rad
  double m_lastYaw;           // rad, at the last sample
  std::int64_t m_samples = 0; // beyond the first
};

vpSimulatorTurtleBot3::Impl::Impl(const vpSimulatorTurtleBot3Settings &settings)
    : m_settings(settings), m_model(settings.model), m_rounding(m_model.limits(), settings.dither),
      m_time(settings.startTime), m_wRf(floorAxes(settings.floorTiltX, settings.floorTiltY)),
      m_left(settings.motorLag, settings.acceleration / m_model.wheelRadius), m_right(m_left),
      m_slipNoise(settings.seed, slipStream), m_encoderNoise(settings.seed, encoderStream),
      m_gyroNoise(settings.seed, gyroStream), m_lastYaw(settings.startYaw)
{
  const Eigen::Vector2d start =
      m_wRf.topLeftCorner<2, 2>().inverse() * Eigen::Vector2d(settings.startX, settings.startY);
  m_steps.push_back({{start.x(), start.y(), settings.startYaw}, 0, 0});
  m_slipDeviation.left = settings.slipSigma * m_slipNoise();
  m_slipDeviation.right = settings.slipSigma * m_slipNoise();
  m_encoderPhase.left = vpTurtleBot3::tick * m_encoderNoise.uniform();
  m_encoderPhase.right = vpTurtleBot3::tick * m_encoderNoise.uniform();
  m_lastReading = {encoder(0, m_encoderPhase.left), encoder(0, m_encoderPhase.right)};
  m_odometry.push_back({settings.startTime, 0, 0});
}

void vpSimulatorTurtleBot3::Impl::command(const vpBaseVelocity &velocity)
{
  const double arrival = (sinceStart(m_time) + m_settings.commandDelay) / stepTime;
  vpWheels speeds = m_model.wheelSpeeds(velocity);
  if (m_settings.motorUnit) {
    speeds.left = vpTurtleBot3::velocityUnit * std::trunc(speeds.left / vpTurtleBot3::velocityUnit);
    speeds.right = vpTurtleBot3::velocityUnit * std::trunc(speeds.right / vpTurtleBot3::velocityUnit);
  }
  m_commands.push_back({static_cast<std::int64_t>(std::ceil(arrival - tolerance)), speeds});
}

void vpSimulatorTurtleBot3::Impl::advance(double untilTime)
{
  if (!(untilTime >= m_time && sinceStart(untilTime) <= longestRun)) {
    throw vpException(vpException::badValue, "simulated TurtleBot3: advance to " + vpNumberText(untilTime) +
                                                 " s, expected " + vpNumberText(m_time) + " s to " +
                                                 vpNumberText(m_settings.startTime + longestRun) + " s");
  }
  // A step begun is driven to its end: no later command can reach into it.
  const double steps = std::ceil(sinceStart(untilTime) / stepTime - tolerance);
  sampleUntil(untilTime); // in what was driven already
  while (static_cast<double>(m_steps.size() - 1) < steps) {
    drive();
    sampleUntil(untilTime);
  }
  m_time = untilTime;
}

//! One step of all that moves.
void vpSimulatorTurtleBot3::Impl::drive()
{
  const std::int64_t number = static_cast<std::int64_t>(m_steps.size()) - 1;
  while (!m_commands.empty() && m_commands.front().step <= number) {
    m_goal = m_commands.front().speeds;
    m_commands.pop_front();
  }
  m_beginAngles = m_angles;
  m_beginSpeeds = m_speeds;
  const vpWheels rolled{m_left.roll(m_goal.left, stepTime), m_right.roll(m_goal.right, stepTime)};
  m_angles.left += rolled.left;
  m_angles.right += rolled.right;
  m_speeds = {m_left.speed(), m_right.speed()};

  const double radius = m_model.wheelRadius;
  const double left = slipped(rolled.left * radius * (1 + m_settings.leftRadiusError), m_slipDeviation.left);
  const double right =
      slipped(rolled.right * radius * (1 + m_settings.rightRadiusError), m_slipDeviation.right);
  Step &step = m_steps.back();
  step.length = (left + right) / 2;
  step.turn = (right - left) / (m_model.wheelSeparation * (1 + m_settings.separationError));
  m_steps.push_back({along(step, 1), 0, 0});
}

//! How far a wheel that rolled \e rolled (m) takes the base, and the wheel's deviation from then on.
double vpSimulatorTurtleBot3::Impl::slipped(double rolled, double &deviation)
{
  const double moved = rolled * (1 - m_settings.slip - deviation);
  if (m_settings.slipSigma > 0) {
    const double kept = std::exp(-std::abs(rolled) / m_settings.slipLength);
    deviation = kept * deviation + std::sqrt(1 - kept * kept) * m_settings.slipSigma * m_slipNoise();
  }
  return moved;
}

//! Takes the samples due up to \e untilTime that lie within the steps driven so far.
void vpSimulatorTurtleBot3::Impl::sampleUntil(double untilTime)
{
  const double driven = static_cast<double>(m_steps.size() - 1) * stepTime;
  const double end = std::min(sinceStart(untilTime), driven) + tolerance * stepTime;
  for (double due; due = static_cast<double>(m_samples + 1) / m_settings.odometryRate, due <= end;) {
    ++m_samples;
    sample(due);
  }
}

void vpSimulatorTurtleBot3::Impl::sample(double sinceStart)
{
  const double interval = 1 / m_settings.odometryRate;
  const double share = shareOfLastStep(sinceStart);
  const vpWheels angles = anglesInLastStep(share);
  const vpWheels reading{encoder(angles.left, m_encoderPhase.left),
                         encoder(angles.right, m_encoderPhase.right)};
  const vpBaseVelocity wheels = m_model.velocity(
      {(reading.left - m_lastReading.left) / interval, (reading.right - m_lastReading.right) / interval});
  const double yaw = along(m_steps[m_steps.size() - 2], share).yaw;
  const double noise = m_settings.gyroNoiseDensity / std::sqrt(interval) * m_gyroNoise();
  const double gyro = (yaw - m_lastYaw) / interval + m_settings.gyroBias + noise;

  const bool fromGyro = m_settings.turnSource == vpSimulatorTurtleBot3Settings::TurnSource::gyro;
  m_odometry.push_back({m_settings.startTime + sinceStart, wheels.v, fromGyro ? gyro : wheels.w});
  m_lastReading = reading;
  m_lastYaw = yaw;
}

double vpSimulatorTurtleBot3::Impl::encoder(double angle, double phase)
{
  const double seen = angle + m_settings.encoderSigma * m_encoderNoise();
  return m_settings.encoderTicks ? vpTurtleBot3::tick * std::floor((seen + phase) / vpTurtleBot3::tick)
                                 : seen;
}

double vpSimulatorTurtleBot3::Impl::shareOfLastStep(double sinceStart) const
{
  return std::clamp(sinceStart / stepTime - static_cast<double>(m_steps.size()) + 2, 0.0, 1.0);
}

vpWheels vpSimulatorTurtleBot3::Impl::anglesInLastStep(double share) const
{
  return {m_beginAngles.left + share * (m_angles.left - m_beginAngles.left),
          m_beginAngles.right + share * (m_angles.right - m_beginAngles.right)};
}

const Step &vpSimulatorTurtleBot3::Impl::stepAt(double time, const char *what, double &share) const
{
  const double position = sinceStart(time) / stepTime;
  const double most = sinceStart(m_time) / stepTime;
  if (!(position >= -tolerance && position <= most + tolerance)) {
    throw vpException(vpException::badValue, std::string("simulated TurtleBot3: ") + what + " at " +
                                                 vpNumberText(time) + " s, expected " +
                                                 vpNumberText(m_settings.startTime) + " s to " +
                                                 vpNumberText(m_time) + " s");
  }
  // The end belongs to the last step driven, which the tolerance may leave just before it.
  const size_t last = m_steps.size() < 2 ? 0 : m_steps.size() - 2;
  const size_t index = std::min(static_cast<size_t>(std::max(position, 0.0)), last);
  share = position - static_cast<double>(index);
  return m_steps[index];
}

vpHomogeneousMatrix vpSimulatorTurtleBot3::Impl::pose(const FloorPose &floor) const
{
  const double c = std::cos(floor.yaw);
  const double s = std::sin(floor.yaw);
  vpHomogeneousMatrix wMb;
  for (unsigned int row = 0; row < 3; ++row) {
    const double x = m_wRf(row, 0), y = m_wRf(row, 1);
    double *const out = wMb[row];
    out[0] = c * x + s * y;
    out[1] = c * y - s * x;
    out[2] = m_wRf(row, 2);
    out[3] = floor.x * x + floor.y * y;
  }
  return wMb;
}

vpSimulatorTurtleBot3::vpSimulatorTurtleBot3(const vpSimulatorTurtleBot3Settings &settings)
{
  settings.check();
  m_impl = std::make_unique<Impl>(settings);
}

vpSimulatorTurtleBot3::~vpSimulatorTurtleBot3() = default;

vpBaseVelocity vpSimulatorTurtleBot3::setVelocity(double v, double w)
{
  const vpBaseVelocity asked{v, w};
  const vpBaseVelocity told =
      m_impl->m_settings.velocityQuantum ? m_impl->m_rounding.next(asked) : limits().saturated(asked);
  m_impl->command(told);
  return told;
}

void vpSimulatorTurtleBot3::stop()
{
  m_impl->m_rounding.reset();
  m_impl->command({0, 0});
}

vpBaseLimits vpSimulatorTurtleBot3::limits() const
{
  return m_impl->m_model.limits();
}

void vpSimulatorTurtleBot3::advance(double untilTime)
{
  m_impl->advance(untilTime);
}

double vpSimulatorTurtleBot3::time() const
{
  return m_impl->m_time;
}

vpHomogeneousMatrix vpSimulatorTurtleBot3::wMb(double time) const
{
  double share = 0;
  const Step &step = m_impl->stepAt(time, "wMb", share);
  return m_impl->pose(along(step, share));
}

vpBaseVelocity vpSimulatorTurtleBot3::twist(double time) const
{
  double share = 0;
  const Step &step = m_impl->stepAt(time, "twist", share);
  return {step.length / stepTime, step.turn / stepTime};
}

const std::vector<vpOdometry> &vpSimulatorTurtleBot3::odometrySamples() const
{
  return m_impl->m_odometry;
}

vpWheels vpSimulatorTurtleBot3::wheelAngles() const
{
  return m_impl->anglesInLastStep(m_impl->shareOfLastStep(m_impl->sinceStart(m_impl->m_time)));
}

vpWheels vpSimulatorTurtleBot3::wheelSpeeds() const
{
  const double share = m_impl->shareOfLastStep(m_impl->sinceStart(m_impl->m_time));
  const vpWheels &begin = m_impl->m_beginSpeeds, &end = m_impl->m_speeds;
  return {begin.left + share * (end.left - begin.left), begin.right + share * (end.right - begin.right)};
}

END_VISP_NAMESPACE
