/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <csignal>

#include <gtest/gtest.h>

#include "common/vpProcess.h"
#include "common/vpTemporaryFolder.h"
#include "opencr/vpDrivenLoop.h"
#include "opencr/vpServedTerminal.h"

namespace
{
constexpr double motorLag = 0.03; // s
const double decay = motorLag * std::log(0.16 / 0.001);

vpSimulatorTurtleBot3Settings world()
{
  vpSimulatorTurtleBot3Settings settings;
  settings.motorLag = motorLag;
  return settings;
}

//! vlp-servo at 0.16 m/s by odometry, on a board behind a pseudo-terminal.
struct ServoOnBoard : testing::Test {
  ServoOnBoard() { terminal.serve(); }

  std::vector<std::string> arguments(double length)
  {
    const std::string path = folder.write("path.yaml", "type: polyline\npoints_m: [[0, 0], [" +
                                                           std::to_string(length) + ", 0]]\nclosed: false\n");
    return {"--robot",   "opencr:" + terminal.device(), "--path", path, "--odometry-only", "--speed", "0.16",
            "--headless"};
  }

  vpTemporaryFolder folder;
  vpRealTimeBoard board{world()};
  vpServedTerminal terminal{board};
};
using VlpServoOpenCr = ServoOnBoard;
} // namespace

TEST_F(VlpServoOpenCr, DrivesToTheEnd)
{
  vpProcess servo("vlp-servo", arguments(0.5));
  EXPECT_EQ(servo.wait(), 0) << servo.err();
  const double end = vpTimeOf(board);
  EXPECT_LT(vpStandstillAfter(board, end), decay);
  EXPECT_NEAR(vpWayOf(board), 0.5, 0.02);
}

TEST_F(VlpServoOpenCr, StandsOnSignals)
{
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    vpProcess servo("vlp-servo", arguments(100));
    ASSERT_TRUE(vpWaitUntilItDrives(board, 0.15)) << servo.err();
    servo.signal(signal);
    const double sent = vpTimeOf(board);
    const double standstill = vpStandstillAfter(board, sent);
    EXPECT_GT(standstill, 0);
    // Told, within a period or two; killed, by the watchdog and one turn of the board's loop.
    EXPECT_LT(standstill, (signal == SIGKILL ? 0.65 : 0.3) + decay) << signal;
    EXPECT_EQ(servo.wait(), signal == SIGKILL ? -SIGKILL : 0) << servo.err();
  }
}

TEST_F(VlpServoOpenCr, StandsWhenTheCableIsPulledAndSaysSo)
{
  vpProcess servo("vlp-servo", arguments(100));
  ASSERT_TRUE(vpWaitUntilItDrives(board, 0.15)) << servo.err();
  const std::string device = terminal.device();
  const double pulled = vpTimeOf(board);
  terminal.pullCable();
  EXPECT_LT(vpStandstillAfter(board, pulled), 0.65 + decay);
  EXPECT_EQ(servo.wait(), 3);
  EXPECT_NE(servo.err().find(device + ": "), std::string::npos) << servo.err();
}

TEST(VlpServoOpenCrOpening, NoBoardIsOneLine)
{
  const vpTemporaryFolder folder;
  const std::string path = folder.write("path.yaml", "type: polyline\npoints_m: [[0, 0], [1, 0]]\n");
  vpProcess servo("vlp-servo",
                  {"--robot", "opencr:/dev/none", "--path", path, "--odometry-only", "--headless"});
  EXPECT_EQ(servo.wait(), 2);
  EXPECT_NE(servo.err().find("/dev/none: cannot be opened"), std::string::npos) << servo.err();
}
