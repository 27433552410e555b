/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpDrivenLoop_h
#define vpDrivenLoop_h

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include <gtest/gtest.h>
#include <visp3/vlp_robot/vpRobotTurtleBot3.h>

#include "opencr/vpRealTimeBoard.h"
#include "opencr/vpStandstill.h"

//! A control loop's period at 50 Hz.
inline void vpWaitPeriod()
{
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

//! The way that samples of odometry sum up to, from the first one on.
struct vpOdometryWay {
  explicit vpOdometryWay(const vpOdometry &first) : last(first.timestamp) {}
  void add(const vpOdometry &sample)
  {
    metres += sample.v * (sample.timestamp - last);
    last = sample.timestamp;
  }

  double metres = 0;
  double last; // s
};

//! Drives for \e duration, s, as a control loop does. \return The way so far.
inline vpOdometryWay vpDriveInRealTime(vpRobotTurtleBot3 &base, const vpBaseVelocity &velocity,
                                       double duration)
{
  using Clock = std::chrono::steady_clock;
  vpOdometryWay way(base.odometry());
  for (const auto end = Clock::now() + std::chrono::duration<double>(duration); Clock::now() < end;) {
    way.add(base.odometry());
    base.setVelocity(velocity.v, velocity.w);
    vpWaitPeriod();
  }
  return way;
}

inline double vpTimeOf(vpRealTimeBoard &board)
{
  return board.with([](vpSimulatorTurtleBot3 &robot, vpOpenCrEmulator &) { return robot.time(); });
}

inline double vpSpeedOf(vpRealTimeBoard &board)
{
  return board.with(
      [](vpSimulatorTurtleBot3 &robot, vpOpenCrEmulator &) { return robot.twist(robot.time()).v; });
}

//! Waits until the robot drives. \return False where it does not within 10 s.
inline bool vpWaitUntilItDrives(vpRealTimeBoard &board, double speed)
{
  for (int i = 0; i < 500; ++i) {
    if (vpSpeedOf(board) > speed) {
      return true;
    }
    vpWaitPeriod();
  }
  return false;
}

//! Lets 1.2 s pass. \return vpStandstillAfter(), in the robot's time: how late the machine is does not count.
inline double vpStandstillAfter(vpRealTimeBoard &board, double time)
{
  std::this_thread::sleep_for(std::chrono::duration<double>(std::max(time + 1.2 - vpTimeOf(board), 0.0)));
  return board.with(
      [time](vpSimulatorTurtleBot3 &robot, vpOpenCrEmulator &) { return vpStandstillAfter(robot, time); });
}

//! The way that the robot's wheels rolled, m.
inline double vpWayOf(vpRealTimeBoard &board)
{
  return board.with([](vpSimulatorTurtleBot3 &robot, vpOpenCrEmulator &) {
    return vpTurtleBot3().wheelRadius * (robot.wheelAngles().left + robot.wheelAngles().right) / 2;
  });
}

//! Drives over a line that spoils and loses some of the bytes: what the wheels turned is all there in the
//! end.
inline void vpExpectNoTickLost(vpRealTimeBoard &board, vpRobotTurtleBot3 &base, double motorLag)
{
  vpFaultyLine::Faults faults;
  faults.corrupted = 0.0003;
  faults.lost = 0.0001;
  faults.delayed = 0.005;
  board.setFaults(faults);
  vpOdometryWay way = vpDriveInRealTime(base, {0.1, 0}, 1.5);
  EXPECT_GT(base.statistics().timeouts + base.statistics().crcErrors, 0u);
  board.setFaults({});
  base.stop();
  EXPECT_LT(vpStandstillAfter(board, vpTimeOf(board)), motorLag * std::log(0.1 / 0.001) + 0.021);
  way.add(base.odometry());
  EXPECT_NEAR(way.metres, vpWayOf(board), 0.0002);
}

#endif
