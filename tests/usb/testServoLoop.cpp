/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <gtest/gtest.h>

#include "opencr/vpServoOverBoard.h"
#include "usb/vpEmulatedUsbBoard.h"

TEST(ServoOverUsb, FollowsTheLineInRealTime)
{
  vpServoOverBoard servo;
  vpEmulatedUsbBoard usb(servo.board, "FF12");
  usb.plug(7);
  const vpServoRun run = servo.drive("opencr:usb");
  EXPECT_EQ(run.end, vpServoRun::End::arrived) << run.reason;
  const double rms = servo.rmsAcross(run);
  RecordProperty("rms_across_m", std::to_string(rms));
  RecordProperty("missed", std::to_string(run.missed));
  EXPECT_LT(rms, 0.01); // pictures may come late on a machine that has other things to do
  EXPECT_EQ(servo.statistics.failures, 0u);
}
