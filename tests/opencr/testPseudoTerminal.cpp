/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <csignal>

#include <sys/wait.h>

#include <gtest/gtest.h>
#include <visp3/vlp_robot/vpOpenTurtleBot3.h>

#include "common/vpExpectError.h"
#include "common/vpTemporaryFolder.h"
#include "opencr/vpDrivenLoop.h"
#include "opencr/vpServedTerminal.h"

namespace
{
constexpr double motorLag = 0.03; // s
// The board's watchdog at 0.5 s, one turn of its loop, and until 0.2 m/s have decayed to 1 mm/s.
const double longest = 0.65 + motorLag * std::log(0.2 / 0.001);

vpSimulatorTurtleBot3Settings world()
{
  vpSimulatorTurtleBot3Settings settings;
  settings.motorLag = motorLag;
  return settings;
}
} // namespace

TEST(PseudoTerminal, DrivesOverASerialDevice)
{
  vpRealTimeBoard board(world());
  vpServedTerminal terminal(board);
  terminal.serve();
  const auto base = vpOpenTurtleBot3("opencr:" + terminal.device());
  vpOdometryWay way = vpDriveInRealTime(*base, {0.2, 0}, 1);
  base->stop();
  EXPECT_LT(vpStandstillAfter(board, vpTimeOf(board)), motorLag * std::log(0.2 / 0.001) + 0.021);
  way.add(base->odometry()); // one sample of all the time since
  EXPECT_GT(way.metres, 0.1);
  EXPECT_NEAR(way.metres, vpWayOf(board), 0.0002); // a tick is 0.05 mm
}

TEST(PseudoTerminal, LosesNoTickOnABadLine)
{
  vpRealTimeBoard board(world());
  vpServedTerminal terminal(board);
  terminal.serve();
  const auto base = vpOpenTurtleBot3("opencr:" + terminal.device());
  vpExpectNoTickLost(board, *base, motorLag);
}

TEST(PseudoTerminal, StandsWhenItsProcessIsKilled)
{
  vpRealTimeBoard board(world());
  vpServedTerminal terminal(board);
  const pid_t child = fork(); // as yet there is no other thread
  if (child == 0) {
    try {
      const auto base = vpOpenTurtleBot3("opencr:" + terminal.device());
      vpDriveInRealTime(*base, {0.2, 0}, 60);
    } catch (...) {
    }
    _exit(1);
  }
  terminal.serve();
  ASSERT_TRUE(vpWaitUntilItDrives(board, 0.19));
  ASSERT_EQ(kill(child, SIGKILL), 0);
  const double killed = vpTimeOf(board);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  const double standstill = vpStandstillAfter(board, killed);
  RecordProperty("standstill_s", std::to_string(standstill));
  EXPECT_GT(standstill, 0.1); // else it did not drive
  EXPECT_LT(standstill, longest);

  const auto base = vpOpenTurtleBot3("opencr:" + terminal.device()); // the next process finds it usable
  vpDriveInRealTime(*base, {0.1, 0}, 0.5);
  EXPECT_NEAR(vpSpeedOf(board), 0.1, 0.005);
}

TEST(PseudoTerminal, StandsWhenTheCableIsPulled)
{
  vpTemporaryFolder folder;
  const std::string device = folder / "board"; // a name that stays, as those of udev
  vpRealTimeBoard board(world());
  auto terminal = std::make_unique<vpServedTerminal>(board);
  terminal->serve();
  ASSERT_EQ(symlink(terminal->device().c_str(), device.c_str()), 0);
  const auto base = vpOpenTurtleBot3("opencr:" + device);
  vpDriveInRealTime(*base, {0.2, 0}, 0.5);
  const double pulled = vpTimeOf(board);
  terminal->pullCable();
  vpExpectError([&] { vpDriveInRealTime(*base, {0.2, 0}, 1); }, {device + ": "});
  EXPECT_FALSE(base->connected());
  EXPECT_LT(vpStandstillAfter(board, pulled), longest);

  unlink(device.c_str());
  terminal = std::make_unique<vpServedTerminal>(board);
  terminal->serve();
  ASSERT_EQ(symlink(terminal->device().c_str(), device.c_str()), 0);
  base->reconnect();
  vpDriveInRealTime(*base, {0.1, 0}, 0.5);
  EXPECT_NEAR(vpSpeedOf(board), 0.1, 0.005);
}
