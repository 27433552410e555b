/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_robot/vpRobotTurtleBot3.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

namespace
{
using Table = vpOpenCrTable;

constexpr double openingTime = 1;           // s, for each step of it
constexpr double calibrationTime = 6;       // s; the board takes up to 5
constexpr double datingTime = 0.06;         // s, three times that in which the board measures anew
constexpr double longestGyroInterval = 0.1; // s; over longer ones two readings of a rate say too little
constexpr double speedMargin = 5;           // times the top speed that a hand may push the wheels to
constexpr double tickMargin = 10;
constexpr int mostContradictions = 3; // more is no chance of a wrong CRC, 1 in 65536 corrupted answers
constexpr double largestGyro = 40;    // rad/s; the sensor ends at 35

//! The next value of a heartbeat. 0 is what a board starts with.
std::uint8_t following(std::uint8_t heartbeat)
{
  return heartbeat == 255 ? 1 : static_cast<std::uint8_t>(heartbeat + 1);
}

//! Ticks from one position to the other, both modulo 2^32.
double ticksBetween(std::int32_t from, std::int32_t to)
{
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(to) - static_cast<std::uint32_t>(from));
}

//! Whether the gyro may have measured that, rad/s.
bool isRate(double gyro)
{
  return std::abs(gyro) <= largestGyro; // false for what is no number
}
} // namespace

void vpRobotTurtleBot3Settings::check() const
{
  const auto expect = [](bool good, const char *field, double value, const char *expected) {
    if (!good) {
      throw vpException(vpException::badValue, std::string("TurtleBot3: ") + field + ": " +
                                                   vpNumberText(value) + ", expected " + expected);
    }
  };
  expect(acceleration >= 0 && acceleration <= 100, "acceleration", acceleration, "0 to 100 m/s^2");
  const std::pair<const char *, double> times[] = {{"commandDeadline", commandDeadline},
                                                   {"stopDeadline", stopDeadline},
                                                   {"odometryDeadline", odometryDeadline},
                                                   {"odometryAge", odometryAge}};
  for (const auto &[field, time] : times) {
    expect(time >= 0.001 && time <= 10, field, time, "0.001 to 10 s");
  }
  expect(odometryPeriod >= 0 && odometryPeriod <= 1, "odometryPeriod", odometryPeriod, "0 to 1 s");
}

vpRobotTurtleBot3::vpRobotTurtleBot3(std::unique_ptr<vpByteTransport> transport,
                                     const vpRobotTurtleBot3Settings &settings)
    : m_settings(settings), m_bus(std::move(transport)), m_rounding(m_geometry.limits(), settings.dither)
{
  settings.check();
  begin();
}

vpRobotTurtleBot3::~vpRobotTurtleBot3()
{
  try {
    stop();
  } catch (const vpException &) { // the board's own watchdog is all that is left
  }
}

void vpRobotTurtleBot3::begin()
{
  identify();
  prepareMotors();
  m_clockOffset = m_settings.clock ? m_settings.clock() - now() : 0;
  dateBoard();
  m_last = readingOf(readTable(now() + openingTime));
  if (!isRate(m_last.gyro)) {
    throw vpException(vpException::ioError, m_bus.name() + ": gyro " + vpNumberText(m_last.gyro) +
                                                " rad/s, expected at most " + vpNumberText(largestGyro));
  }
  m_odometry = {m_last.time + m_clockOffset, 0, 0};
  m_connected = true;
}

//! Asks for the board's counter again and again, until one was noted just before it was read.
void vpRobotTurtleBot3::dateBoard()
{
  m_bus.settle();
  m_clock.reset();
  const double deadline = now() + openingTime;
  for (const double end = now() + datingTime; now() < end;) {
    const vpControlBlock note(Table::millis.address,
                              m_bus.read(Table::id, Table::millis.address, Table::millis.length, deadline));
    m_clock.hostTime(note.get(Table::millis), m_bus.answered());
  }
}

void vpRobotTurtleBot3::identify()
{
  const auto refuse = [this](const std::string &problem) {
    throw vpException(vpException::ioError, m_bus.name() + ": " + problem);
  };
  const vpDynamixelBus::Identity identity = m_bus.ping(Table::id, now() + openingTime);
  if (identity.model != Table::openCrModel) {
    refuse("model number " + std::to_string(identity.model) + ", expected " +
           std::to_string(Table::openCrModel) + ", an OpenCR board with the TurtleBot3 firmware for ROS 2");
  }
  m_firmware = identity.firmware;

  const vpControlBlock info(
      Table::modelInfo.address,
      m_bus.read(Table::id, Table::modelInfo.address, Table::modelInfo.length, now() + openingTime));
  const std::uint32_t model = info.get(Table::modelInfo);
  if (model != Table::burger && model != Table::waffle) {
    refuse("model information " + std::to_string(model) + ", expected 1 (Burger) or 2 (Waffle)");
  }
  m_model = model == Table::burger ? vpTurtleBot3::Model::burger : vpTurtleBot3::Model::waffle;
  m_geometry = vpTurtleBot3(m_model);
  m_rounding = vpVelocityRounding(m_geometry.limits(), m_settings.dither);

  const vpControlBlock table = readTable(now() + openingTime);
  const std::int8_t device = table.get(Table::deviceStatus);
  if (device != 0) {
    refuse("device status " + std::to_string(device) + ", expected 0 (-1: no motors; is their power on?)");
  }
  if (table.get(Table::debugMode) != 0 && !m_settings.allowDebugMode) {
    refuse("debug mode " + std::to_string(table.get(Table::debugMode)) +
           ", expected 0: without its watchdog the base drives on when this program dies");
  }
  m_heartbeat = table.get(Table::heartbeat);
  m_heartbeatKnown = true;
}

void vpRobotTurtleBot3::prepareMotors()
{
  tell({0, 0}, false, now() + openingTime); // before the torque is on
  write(Table::torqueEnable, 1, now() + openingTime);
  std::uint32_t profile = 0;
  if (m_settings.acceleration > 0) {
    const double revolutions =
        m_settings.acceleration / (2 * M_PI * m_geometry.wheelRadius) * 3600; // per min^2
    profile = static_cast<std::uint32_t>(std::max(std::lround(revolutions / Table::profileUnit), 1L));
    write(Table::profileLeft, profile, now() + openingTime);
    write(Table::profileRight, profile, now() + openingTime);
  }
  const vpControlBlock table = readTable(now() + openingTime); // what it does not know it confirms, too
  const bool profiles = table.get(Table::profileLeft) == profile && table.get(Table::profileRight) == profile;
  if (table.get(Table::torqueEnable) != 1 || (profile > 0 && !profiles)) {
    throw vpException(vpException::ioError,
                      m_bus.name() + ": torque " + std::to_string(table.get(Table::torqueEnable)) +
                          " and profile acceleration " + std::to_string(table.get(Table::profileLeft)) +
                          ", expected 1 and " + std::to_string(profile) + " as written");
  }
}

void vpRobotTurtleBot3::reconnect()
{
  m_connected = m_heartbeatKnown = false;
  m_rounding.reset();
  m_bus.reopen();
  begin();
}

vpBaseVelocity vpRobotTurtleBot3::setVelocity(double v, double w)
{
  requireConnection();
  const vpBaseVelocity told = m_rounding.next({v, w});
  guarded([&] { tell(told, true, now() + m_settings.commandDeadline); });
  return told;
}

void vpRobotTurtleBot3::stop()
{
  m_rounding.reset();
  try {
    tell({0, 0}, false, now() + m_settings.stopDeadline);
  } catch (...) {
    m_connected = m_heartbeatKnown = false;
    throw;
  }
}

vpOdometry vpRobotTurtleBot3::odometry()
{
  requireConnection();
  if (now() - m_sampled >= m_settings.odometryPeriod) {
    guarded([this] {
      std::string problem = m_bus.name() + ": the board measures nothing new";
      try {
        sample(now() + m_settings.odometryDeadline);
      } catch (const vpException &error) {
        problem = error.getStringMessage();
      }
      if (now() - m_last.time > m_settings.odometryAge) {
        throw vpException(vpException::ioError,
                          "no odometry for " + vpNumberText(m_settings.odometryAge) + " s: " + problem);
      }
    });
  }
  return m_odometry;
}

vpTurtleBot3Status vpRobotTurtleBot3::status()
{
  requireConnection();
  vpTurtleBot3Status status;
  guarded([&] {
    const vpControlBlock table = readCurrentTable(now() + m_settings.odometryDeadline);
    status.batteryVoltage = 0.01 * table.get(Table::batteryVoltage);
    status.batteryCharge = 1e-4 * table.get(Table::batteryCharge);
    status.motorsAnswer = table.get(Table::deviceStatus) == 0;
    status.torque = table.get(Table::torqueEnable) != 0;
    status.buttons = {table.get(Table::button1) != 0, table.get(Table::button2) != 0};
    status.bumpers = {table.get(Table::bumper1) != 0, table.get(Table::bumper2) != 0};
    status.wheelSpeeds = {vpTurtleBot3::velocityUnit * table.get(Table::velocityLeft),
                          vpTurtleBot3::velocityUnit * table.get(Table::velocityRight)};
    status.gyro = {table.get(Table::gyroX), table.get(Table::gyroY), table.get(Table::gyroZ)};
    status.acceleration = {table.get(Table::accelX), table.get(Table::accelY), table.get(Table::accelZ)};
  });
  return status;
}

void vpRobotTurtleBot3::recalibrateImu()
{
  const vpWheels speeds = status().wheelSpeeds;
  if (m_commandV != 0 || m_commandW != 0 || speeds.left != 0 || speeds.right != 0) {
    throw vpException(vpException::badValue, m_bus.name() + ": gyro calibration asked for at wheel speeds " +
                                                 vpNumberText(speeds.left) + " and " +
                                                 vpNumberText(speeds.right) +
                                                 " rad/s, expected a base that stands and was told to");
  }
  guarded([this] {
    m_bus.writeOnce(Table::id, Table::imuRecalibrate.address, {1}, now() + calibrationTime);
    sample(now() + openingTime); // so that the interval that it took has ended
  });
}

void vpRobotTurtleBot3::requireConnection() const
{
  if (!m_connected) {
    throw vpException(vpException::ioError,
                      m_bus.name() +
                          ": the connection was given up, expected reconnect() before the next use");
  }
}

//! Whatever fails in \e act: the base is told to stand, and nothing more until reconnect().
void vpRobotTurtleBot3::guarded(const std::function<void()> &act)
{
  try {
    act();
  } catch (...) {
    m_connected = m_heartbeatKnown = false;
    try {
      stop();
    } catch (const vpException &) { // the first one says more
    }
    throw;
  }
}

//! Writes a command, and before it a heartbeat if that is asked for, until the board has surely taken both.
void vpRobotTurtleBot3::tell(const vpBaseVelocity &velocity, bool heartbeat, double deadline)
{
  m_heartbeat = heartbeat ? following(m_heartbeat) : m_heartbeat;
  m_commandV = static_cast<std::int32_t>(std::lround(velocity.v * vpTurtleBot3::commandCounts));
  m_commandW = static_cast<std::int32_t>(std::lround(velocity.w * vpTurtleBot3::commandCounts));
  vpControlBlock command(Table::commandAddress, Table::commandLength);
  command.set(Table::commandV, m_commandV);
  command.set(Table::commandW, m_commandW);
  do {
    if (heartbeat) {
      write(Table::heartbeat, m_heartbeat, deadline);
    }
    m_bus.write(Table::id, command.address(), command.bytes(), deadline);
    if (!m_bus.answerMayBeStale() || (m_heartbeatKnown && holdsCommand(readTable(deadline)))) {
      return;
    }
  } while (now() < deadline);
  throw vpException(vpException::ioError, m_bus.name() + ": command not confirmed for certain, expected the "
                                                         "board to hold it at the deadline");
}

bool vpRobotTurtleBot3::holdsCommand(const vpControlBlock &table) const
{
  return table.get(Table::heartbeat) == m_heartbeat && table.get(Table::commandV) == m_commandV &&
         table.get(Table::commandW) == m_commandW;
}

vpControlBlock vpRobotTurtleBot3::readTable(double deadline)
{
  return vpControlBlock(Table::snapshotAddress,
                        m_bus.read(Table::id, Table::snapshotAddress, Table::snapshotLength, deadline));
}

//! The table as of now: what came late, or passed its CRC by chance, is read again.
vpControlBlock vpRobotTurtleBot3::readCurrentTable(double deadline)
{
  vpControlBlock table;
  for (int contradictions = 0; contradictions < mostContradictions && now() < deadline;) {
    table = readTable(deadline);
    if (holdsCommand(table) && plausible(table)) {
      return table;
    }
    contradictions += !m_bus.answerMayBeStale();
  }
  throw vpException(
      vpException::ioError,
      m_bus.name() + ": the board holds heartbeat " + std::to_string(table.get(Table::heartbeat)) +
          " and command " + std::to_string(table.get(Table::commandV)) + ", " +
          std::to_string(table.get(Table::commandW)) + " after " + std::to_string(table.get(Table::millis)) +
          " ms, expected " + std::to_string(m_heartbeat) + " and " + std::to_string(m_commandV) + ", " +
          std::to_string(m_commandW) + " (it restarted, or another program uses it)");
}

bool vpRobotTurtleBot3::plausible(const vpControlBlock &table) const
{
  // A wrong counter must not shorten what the mean velocity is over. One that stands yields no velocity.
  const double counted = 1e-3 * static_cast<std::int32_t>(table.get(Table::millis) - m_last.millis),
               since = now() - m_last.time, elapsed = counted > 0 ? std::min(counted, since) : since;
  const double most = speedMargin * m_geometry.wheelSpeedLimit * elapsed / vpTurtleBot3::tick;
  const auto turned = [&](std::int32_t from, std::int32_t to) {
    return std::abs(ticksBetween(from, to)) <= most + tickMargin;
  };
  return m_clock.sinceLast(table.get(Table::millis)) >= 0 &&
         turned(m_last.left, table.get(Table::positionLeft)) &&
         turned(m_last.right, table.get(Table::positionRight)) && isRate(table.get(Table::gyroZ));
}

//! What the table says that was read last.
vpRobotTurtleBot3::Reading vpRobotTurtleBot3::readingOf(const vpControlBlock &table)
{
  Reading reading;
  reading.millis = table.get(Table::millis);
  reading.time = m_clock.hostTime(reading.millis, m_bus.answered());
  reading.left = table.get(Table::positionLeft);
  reading.right = table.get(Table::positionRight);
  reading.gyro = table.get(Table::gyroZ);
  return reading;
}

void vpRobotTurtleBot3::sample(double deadline)
{
  const Reading reading = readingOf(readCurrentTable(deadline));
  m_sampled = m_bus.answered();
  if (reading.millis != m_last.millis &&
      reading.time > m_last.time) { // else the board has measured nothing since
    const vpBaseVelocity mean = meanVelocity(m_last, reading);
    m_odometry = {reading.time + m_clockOffset, mean.v, mean.w};
    m_last = reading;
  }
}

vpBaseVelocity vpRobotTurtleBot3::meanVelocity(const Reading &from, const Reading &to) const
{
  const double interval = to.time - from.time;
  const double speed = vpTurtleBot3::tick / interval; // rad/s per tick
  vpBaseVelocity mean = m_geometry.velocity(
      {ticksBetween(from.left, to.left) * speed, ticksBetween(from.right, to.right) * speed});
  if (m_settings.turnSource == vpRobotTurtleBot3Settings::TurnSource::gyro &&
      interval <= longestGyroInterval) {
    mean.w = (from.gyro + to.gyro) / 2;
  }
  return mean;
}

template <class T>
void vpRobotTurtleBot3::write(const vpControlItem<T> &item, std::common_type_t<T> value, double deadline)
{
  vpControlBlock block(item.address, sizeof(T));
  block.set(item, value);
  m_bus.write(Table::id, block.address(), block.bytes(), deadline);
}

END_VISP_NAMESPACE
