/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEmulatedTurtleBot3_h
#define vpEmulatedTurtleBot3_h

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

  //! The line alone.
  std::unique_ptr<vpByteTransport> takeLine() { return std::move(m_line); }

  vpSimulatorTurtleBot3 robot;
  vpOpenCrEmulator board;
  vpEmulatedTransport *line; // lives as long as who took it

private:
  std::unique_ptr<vpByteTransport> m_line;
};

#endif
