/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpOpenCrEmulator_h
#define vpOpenCrEmulator_h

#include <cstdint>
#include <vector>

#include <visp3/vlp_robot/vpDynamixelPacket.h>
#include <visp3/vlp_robot/vpOpenCrTable.h>
#include <visp3/vlp_simulation/vpSimulatorTurtleBot3.h>

/*!
  The OpenCR board of a simulated TurtleBot3: control table, watchdog, command limits and the answers of
  ROBOTIS' firmware for ROS 2. All of it runs in the simulated robot's time.
*/
class vpOpenCrEmulator
{
public:
  struct Settings {
    std::uint16_t modelNumber = vpOpenCrTable::openCrModel;
    std::uint32_t modelInfo = vpOpenCrTable::burger;
    std::int8_t deviceStatus = 0;
    std::uint8_t debugMode = 0;
    std::uint32_t firstMillis = 1000; // of the counter at the robot's start
    double clockError = 0;            // share by which the counter is fast
    std::int32_t firstTicks = 0;      // of both wheels' positions
    float gyroBias = 0;               // rad/s
    double calibrationTime = 2;       // s that imu_recalibrate blocks the board
    bool measuresAlways = false;      // else every 20 ms, as the firmware does
    bool reportsCrcErrors = false;    // answers a corrupted request with error 3 instead of nothing
  };

  //! What the board sends, and when its first byte leaves.
  struct Answer {
    double due = 0; // s
    std::vector<std::uint8_t> bytes;
  };

  //! A request that the board carried out.
  struct Request {
    vpDynamixelPacket packet;
    std::vector<std::uint8_t> answer; // its parameters
  };

  vpOpenCrEmulator(vpSimulatorTurtleBot3 &robot, const Settings &settings);

  //! Runs firmware and robot up to \e time, s.
  void advance(double time);

  //! Takes bytes that arrive at \e time, which advance() has reached.
  std::vector<Answer> receive(const std::vector<std::uint8_t> &bytes);

  //! The next request is answered with this error and not carried out.
  void failNext(std::uint8_t error) { m_failNext = error; }
  //! As a board whose reset button was pressed: all that it was told is forgotten, positions begin anew.
  void restart();

  vpControlBlock &table() { return m_table; }
  bool alive() const { return m_alive; }
  //! All requests carried out since clearRequests().
  const std::vector<Request> &requests() const { return m_requests; }
  void clearRequests() { m_requests.clear(); }
  std::uint64_t rejectedWheelGoals() const { return m_rejected; }
  std::uint64_t crcErrors() const { return m_parser.crcErrors(); }

private:
  void tick();
  void measure();
  vpDynamixelPacket answerTo(const vpDynamixelPacket &request);
  void write(std::uint16_t address, const std::uint8_t *bytes, size_t size);
  void written(std::uint16_t address);
  double driven(double goal, double before);

  vpSimulatorTurtleBot3 &m_robot;
  Settings m_settings;
  vpTurtleBot3 m_geometry;
  double m_startTime; // s of the robot when the board started
  vpControlBlock m_table{0, vpOpenCrTable::size};
  vpDynamixelParser m_parser;
  std::vector<Request> m_requests;

  std::int64_t m_ticks = 0;   // of the control loop, done
  double m_blockedUntil = -1; // s, by a calibration
  std::uint8_t m_seenHeartbeat = 0;
  double m_heartbeatTime = 0; // s
  bool m_alive = false;
  double m_goalV = 0, m_goalW = 0; // of the last command that came while alive
  vpWheels m_wheelGoals;           // rad/s, that the motors took
  vpWheels m_positionOffset;       // rad
  std::uint8_t m_failNext = 0;
  std::uint64_t m_rejected = 0;
};

#endif
