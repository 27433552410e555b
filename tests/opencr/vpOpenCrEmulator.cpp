/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "opencr/vpOpenCrEmulator.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace
{
using Table = vpOpenCrTable;

constexpr double tickTime = 0.02;    // s, of the firmware's control loop and its measurements
constexpr double watchdogTime = 0.5; // s
constexpr double answerTime = 2e-4;  // s that the firmware takes for a request

//! The speed of a motor that the firmware derives its limits from.
double motorSpeed(bool waffle)
{
  return (waffle ? 77 : 61) * 2 * M_PI / 60; // rad/s
}

//! The items that the host may write.
constexpr std::array<std::pair<std::uint16_t, std::uint16_t>, 11> writable = {{{19, 1},
                                                                               {59, 1},
                                                                               {149, 1},
                                                                               {150, 4},
                                                                               {154, 4},
                                                                               {158, 4},
                                                                               {162, 4},
                                                                               {166, 4},
                                                                               {170, 4},
                                                                               {174, 4},
                                                                               {178, 4}}};

std::int32_t wrapped(double count)
{
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(count))));
}
} // namespace

vpOpenCrEmulator::vpOpenCrEmulator(vpSimulatorTurtleBot3 &robot, const Settings &settings)
    : m_robot(robot), m_settings(settings),
      m_geometry(settings.modelInfo == Table::waffle ? vpTurtleBot3::Model::waffle
                                                     : vpTurtleBot3::Model::burger),
      m_startTime(robot.time())
{
  m_table.set(Table::modelNumber, settings.modelNumber);
  m_table.set(Table::modelInfo, settings.modelInfo);
  m_table.set(Table::firmwareVersion, 5);
  m_table.set(Table::debugMode, settings.debugMode);
  m_table.set(Table::deviceStatus, settings.deviceStatus);
  m_table.set(Table::batteryVoltage, 1180);
  m_table.set(Table::batteryCharge, 8200);
  m_table.set(Table::accelZ, 9.81f);
  measure();
}

void vpOpenCrEmulator::restart()
{
  const double ticks = m_settings.firstTicks * vpTurtleBot3::tick;
  m_positionOffset = {-m_robot.wheelAngles().left - ticks, -m_robot.wheelAngles().right - ticks};
  m_settings.firstMillis = 0;
  m_startTime = m_robot.time();
  m_ticks = 0;
  for (const auto &[address, length] : writable) {
    std::fill_n(m_table.bytes().begin() + address, length, std::uint8_t(0));
  }
  m_seenHeartbeat = 0;
  m_alive = false;
  m_goalV = m_goalW = 0;
  m_wheelGoals = {};
  m_parser.reset();
  m_robot.setVelocity(0, 0);
  measure();
}

void vpOpenCrEmulator::advance(double time)
{
  for (double due; due = m_startTime + static_cast<double>(m_ticks + 1) * tickTime, due <= time;) {
    ++m_ticks;
    m_robot.advance(std::max(due, m_robot.time()));
    if (due >= m_blockedUntil) {
      tick();
      measure();
    }
  }
  m_robot.advance(std::max(time, m_robot.time()));
  if (m_settings.measuresAlways && time >= m_blockedUntil) {
    measure();
  }
}

//! One turn of the firmware's control loop.
void vpOpenCrEmulator::tick()
{
  const double time = m_robot.time();
  const std::uint8_t heartbeat = m_table.get(Table::heartbeat);
  if (heartbeat != m_seenHeartbeat) {
    m_seenHeartbeat = heartbeat;
    m_heartbeatTime = time;
    m_alive = true;
  } else if (time - m_heartbeatTime > watchdogTime) {
    m_alive = false;
  }
  if (!m_alive && m_table.get(Table::debugMode) == 0) {
    m_goalV = m_goalW = 0;
  }
  const double largestV = m_geometry.wheelRadius * motorSpeed(m_table.get(Table::modelInfo) == Table::waffle);
  const double largestW = largestV / (m_geometry.wheelSeparation / 2);
  const bool torque = m_table.get(Table::torqueEnable) != 0;
  const vpWheels goals = m_geometry.wheelSpeeds(
      {std::clamp(m_goalV, -largestV, largestV), std::clamp(m_goalW, -largestW, largestW)});
  m_wheelGoals.left = torque ? driven(goals.left, m_wheelGoals.left) : 0;
  m_wheelGoals.right = torque ? driven(goals.right, m_wheelGoals.right) : 0;
  const vpBaseVelocity velocity = m_geometry.velocity(m_wheelGoals);
  m_robot.setVelocity(velocity.v, velocity.w);
}

//! What a motor that drives at \e before makes of a new goal: it rejects one beyond its limit.
double vpOpenCrEmulator::driven(double goal, double before)
{
  const double limit = m_settings.modelInfo == Table::waffle ? 330 : 265; // units
  if (std::trunc(std::abs(goal) / vpTurtleBot3::velocityUnit) > limit) {
    ++m_rejected;
    return before;
  }
  return goal;
}

//! What the board measures, into its table.
void vpOpenCrEmulator::measure()
{
  const double since = m_robot.time() - m_startTime;
  const double millis = std::floor(since * (1 + m_settings.clockError) * 1e3);
  m_table.set(Table::millis, m_settings.firstMillis + static_cast<std::uint32_t>(millis));
  const vpWheels angles = m_robot.wheelAngles(), speeds = m_robot.wheelSpeeds();
  const double first = m_settings.firstTicks;
  m_table.set(Table::positionLeft,
              wrapped(first + (angles.left + m_positionOffset.left) / vpTurtleBot3::tick));
  m_table.set(Table::positionRight,
              wrapped(first + (angles.right + m_positionOffset.right) / vpTurtleBot3::tick));
  m_table.set(Table::velocityLeft, static_cast<std::int32_t>(speeds.left / vpTurtleBot3::velocityUnit));
  m_table.set(Table::velocityRight, static_cast<std::int32_t>(speeds.right / vpTurtleBot3::velocityUnit));
  m_table.set(Table::gyroZ, static_cast<float>(m_robot.twist(m_robot.time()).w) + m_settings.gyroBias);
}

std::vector<vpOpenCrEmulator::Answer> vpOpenCrEmulator::receive(const std::vector<std::uint8_t> &bytes)
{
  std::vector<Answer> answers;
  const std::uint64_t crcErrors = m_parser.crcErrors();
  m_parser.push(bytes.data(), bytes.size());
  while (const std::optional<vpDynamixelPacket> request = m_parser.next()) {
    if (request->id == Table::id && request->instruction != vpDynamixelPacket::status) {
      const vpDynamixelPacket answer = answerTo(*request);
      answers.push_back({std::max(m_robot.time(), m_blockedUntil) + answerTime, answer.encoded()});
    }
  }
  if (m_settings.reportsCrcErrors && m_parser.crcErrors() != crcErrors) {
    vpDynamixelPacket answer;
    answer.id = Table::id;
    answer.instruction = vpDynamixelPacket::status;
    answer.error = vpDynamixelPacket::crcError;
    answers.push_back({m_robot.time() + answerTime, answer.encoded()});
  }
  return answers;
}

vpDynamixelPacket vpOpenCrEmulator::answerTo(const vpDynamixelPacket &request)
{
  vpDynamixelPacket answer;
  answer.id = Table::id;
  answer.instruction = vpDynamixelPacket::status;
  const std::vector<std::uint8_t> &given = request.parameters;
  const std::uint16_t address = given.size() < 2 ? 0 : static_cast<std::uint16_t>(given[0] + 256 * given[1]);
  answer.error = m_failNext;
  m_failNext = 0;
  if ((answer.error & 0x7F) != 0) {
    return answer;
  }
  if (request.instruction == vpDynamixelPacket::ping) {
    const std::uint16_t model = m_table.get(Table::modelNumber);
    answer.parameters = {static_cast<std::uint8_t>(model & 0xFF), static_cast<std::uint8_t>(model >> 8),
                         m_table.get(Table::firmwareVersion)};
  } else if (request.instruction == vpDynamixelPacket::read && given.size() == 4) {
    const size_t length = given[2] + 256u * given[3];
    if (address + length > Table::size) {
      answer.error = vpDynamixelPacket::dataRange;
      return answer;
    }
    answer.parameters.assign(m_table.bytes().begin() + address,
                             m_table.bytes().begin() + address + static_cast<std::ptrdiff_t>(length));
  } else if (request.instruction == vpDynamixelPacket::write && given.size() > 2) {
    write(address, given.data() + 2, given.size() - 2);
  } else {
    answer.error = vpDynamixelPacket::instructionError;
    return answer;
  }
  m_requests.push_back({request, answer.parameters});
  return answer;
}

//! Whole items only; what else is in the range is ignored and answered with OK.
void vpOpenCrEmulator::write(std::uint16_t address, const std::uint8_t *bytes, size_t size)
{
  for (const auto &[item, length] : writable) {
    if (item >= address && item + length <= address + size) {
      std::copy_n(bytes + (item - address), length, m_table.bytes().begin() + item);
      written(item);
    }
  }
}

void vpOpenCrEmulator::written(std::uint16_t address)
{
  if (address == Table::commandV.address) {
    m_goalV = m_table.get(Table::commandV) / vpTurtleBot3::commandCounts;
  } else if (address == Table::commandW.address) {
    m_goalW = m_table.get(Table::commandW) / vpTurtleBot3::commandCounts;
  } else if (address == Table::imuRecalibrate.address && m_table.get(Table::imuRecalibrate) != 0) {
    m_blockedUntil = m_robot.time() + m_settings.calibrationTime;
    m_settings.gyroBias = 0;
    m_table.set(Table::imuRecalibrate, 0);
  }
}
