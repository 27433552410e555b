/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpServoOverBoard_h
#define vpServoOverBoard_h

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <visp3/vlp_robot/vpOpenTurtleBot3.h>
#include <visp3/vlp_servo/vpServoLoop.h>
#include <visp3/vlp_simulation/vpSimulation.h>

#include "opencr/vpRealTimeBoard.h"

//! The camera on a robot in real time: a picture is there once its last line was read, and drawn. Those that
//! a slow machine does not fetch in time are gone.
class vpBoardCamera : public vpFrameSource
{
public:
  //! \param begin s, on the robot's clock, where the scenario's is 0. Clock and board outlive this.
  vpBoardCamera(vpRealTimeBoard &board, const vpScenario &scenario, double begin, vpServoClock &clock)
      : m_board(board), m_begin(begin), m_clock(clock), m_frameTime(1 / scenario.frameRate),
        m_simulation(endless(scenario), 1, std::make_unique<Motion>(board, begin))
  {
  }

  bool next(vpVlpFrame &frame) override
  {
    constexpr double readout = 0.035; // s, more than the rig's 600 lines of 43 us take
    const double late = m_clock.now() - (m_begin + static_cast<double>(m_pictures) * m_frameTime + readout);
    std::this_thread::sleep_for(std::chrono::duration<double>(std::max(-late, 0.0)));
    for (double behind = late; behind > m_frameTime; behind -= m_frameTime, ++m_pictures) {
      m_simulation.skip();
    }
    ++m_pictures;
    m_simulation.next(frame);
    frame.timestamp += m_begin;
    return true;
  }

private:
  struct Motion : vpRobotMotion {
    Motion(vpRealTimeBoard &itsBoard, double itsBegin) : board(itsBoard), begin(itsBegin) {}
    vpHomogeneousMatrix wMb(double time) override
    {
      return board.with([&](vpSimulatorTurtleBot3 &robot, vpOpenCrEmulator &) {
        return robot.wMb(begin + std::max(time, 0.0));
      });
    }
    double duration() const override { return std::numeric_limits<double>::infinity(); }
    vpRealTimeBoard &board;
    double begin; // s
  };

  static vpScenario endless(vpScenario scenario)
  {
    scenario.frames = std::numeric_limits<size_t>::max();
    return scenario;
  }

  vpRealTimeBoard &m_board;
  double m_begin; // s
  vpServoClock &m_clock;
  double m_frameTime; // s
  vpSimulation m_simulation;
  size_t m_pictures = 0;
};

/*!
  The whole of it in real time: the paper's lamps, the simulated TurtleBot3 with its emulated board, the
  driver on whatever line leads there, camera, localizer and control loop, on the paper's line A.
*/
class vpServoOverBoard
{
public:
  vpServoOverBoard()
      : m_scenario(vpScenario::load(VLP_DATA_DIR "/scenarios/servo.yaml")), m_begin(m_clock.now()),
        board(worldOf(m_scenario, m_begin), boardOf(m_scenario))
  {
  }

  //! Drives the line over the line that \e uri names, at 0.15 m/s.
  vpServoRun drive(const std::string &uri)
  {
    vpRobotTurtleBot3Settings settings;
    settings.clock = [this] { return m_clock.now(); };
    const auto base = vpOpenTurtleBot3(uri, settings);
    vpBoardCamera camera(board, m_scenario, m_begin, m_clock);
    vpLivePictures pictures(camera, vpVlpLocalizer(m_scenario.rig, m_scenario.map),
                            [this] { return m_clock.now(); });
    vpVlpPose poses(pictures);
    vpServoLoopSettings servo;
    servo.follower.reference.speed = 0.15;
    vpServoLoop loop(*base, poses, m_clock, path(), servo);
    loop.battery = [&] { return base->status().batteryVoltage; };
    const vpServoRun run = loop.run();
    statistics = base->statistics();
    return run;
  }

  //! m, RMS of the true track across the path.
  double rmsAcross(const vpServoRun &run)
  {
    const std::vector<vpTrackError> errors = vpTrackErrorsOf(path(), run, [this](double time) {
      return board.with([time](vpSimulatorTurtleBot3 &robot, vpOpenCrEmulator &) { return robot.wMb(time); });
    });
    double sum = 0;
    for (const vpTrackError &error : errors) {
      sum += error.across * error.across;
    }
    return std::sqrt(sum / static_cast<double>(errors.size()));
  }

  static vpPath path() { return vpPath::polyline({{-0.2, 0}, {0.2, -0.003}}); }

private:
  static vpSimulatorTurtleBot3Settings worldOf(const vpScenario &scenario, double begin)
  {
    vpSimulatorTurtleBot3Settings world = scenario.motion.robot;
    const vpPathPoint start = path().at(0);
    world.startTime = begin;
    world.startX = start.place.x();
    world.startY = start.place.y();
    world.startYaw = start.heading;
    return world;
  }

  static vpOpenCrEmulator::Settings boardOf(const vpScenario &scenario)
  {
    vpOpenCrEmulator::Settings board;
    board.gyroBias = static_cast<float>(scenario.motion.robot.gyroBias);
    return board;
  }

  vpScenario m_scenario;
  vpSteadyClock m_clock{0.02};
  double m_begin; // s

public:
  vpRealTimeBoard board;
  vpDynamixelStatistics statistics; // of the last drive
};

#endif
