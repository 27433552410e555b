/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEmulatedTurtleBot3_h
#define vpEmulatedTurtleBot3_h

#include <cmath>
#include <memory>

#include <visp3/vlp_robot/vpRobotTurtleBot3.h>

#include "opencr/vpEmulatedTransport.h"

//! A simulated TurtleBot3, its emulated board and the line to it, all in simulated time.
struct vpEmulatedTurtleBot3 {
  explicit vpEmulatedTurtleBot3(const vpOpenCrEmulator::Settings &settings = vpOpenCrEmulator::Settings(),
                                const vpSimulatorTurtleBot3Settings &world = vpSimulatorTurtleBot3Settings())
      : robot(world), board(robot, settings), line(new vpEmulatedTransport(robot, board)), m_line(line)
  {
  }

  //! The driver, which owns the line from then on.
  std::unique_ptr<vpRobotTurtleBot3>
  driver(const vpRobotTurtleBot3Settings &settings = vpRobotTurtleBot3Settings())
  {
    return std::make_unique<vpRobotTurtleBot3>(std::move(m_line), settings);
  }

  //! True velocity now.
  vpBaseVelocity velocity() const { return robot.twist(robot.time()); }
  bool stands() const { return std::abs(velocity().v) < 1e-6 && std::abs(velocity().w) < 1e-6; }

  //! The line alone.
  std::unique_ptr<vpByteTransport> takeLine() { return std::move(m_line); }

  vpSimulatorTurtleBot3 robot;
  vpOpenCrEmulator board;
  vpEmulatedTransport *line; // lives as long as who took it

private:
  std::unique_ptr<vpByteTransport> m_line;
};

//! Drives for \e duration at 50 Hz as a control loop does. \return The sum of the odometry: m, rad.
inline vpBaseVelocity vpDrive(vpEmulatedTurtleBot3 &emulated, vpRobotTurtleBot3 &base,
                              const vpBaseVelocity &velocity, double duration)
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

#endif
