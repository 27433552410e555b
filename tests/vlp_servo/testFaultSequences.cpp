/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What must hold of a drive whatever goes wrong on it. bench_faultSequences runs many more of these.

#include <gtest/gtest.h>

#include "vlp_servo/vpFaultSequence.h"

TEST(FaultSequences, WithoutAFaultItArrives)
{
  const vpFaultSequence sequence(std::vector<vpServoFault>{}, 1);
  EXPECT_EQ(sequence.run.end, vpServoRun::End::arrived) << sequence.run.reason;
  EXPECT_EQ(sequence.broken, "");
  EXPECT_LT(sequence.missedBy(), 0.01);
}

// Each kind at some time of the drive: the test's own world does what it says.
TEST(FaultSequences, EachFaultIsSeen)
{
  using Kind = vpServoFault::Kind;
  const std::vector<std::pair<vpServoFault, std::string>> cases = {
      {{Kind::frameLate, 1, 9, 1.0}, "s old"},
      {{Kind::frameLost, 1, 9, 0}, "no picture for"},
      {{Kind::frameRepeated, 1, 9, 0}, "otherwise than the wheels"},
      {{Kind::frameTorn, 1, 9, 0.05}, "otherwise than the wheels"},
      {{Kind::cameraClock, 1, 9, 0.3}, "ahead of the clock"},
      {{Kind::cameraClock, 1, 9, -5}, "uncertain by"},
      {{Kind::clock, 1, 9, -10}, "set back by"},
      {{Kind::odometryFrozen, 1, 9, 0}, "otherwise than the wheels"},
      {{Kind::odometryAbsent, 1, 9, 0}, "no answer"},
      {{Kind::bus, 1, 9, 0}, "no answer"},
      {{Kind::pose, 1, 9, 0.3}, "otherwise than the wheels"}};
  for (const auto &[fault, reason] : cases) {
    const vpFaultSequence sequence({fault}, 1);
    EXPECT_EQ(sequence.run.end, vpServoRun::End::failed) << reason;
    EXPECT_NE(sequence.run.reason.find(reason), std::string::npos) << sequence.run.reason;
    EXPECT_EQ(sequence.broken, "");
  }
}

// The path leaves the fence by 5 mm and comes back half a second later.
TEST(FaultSequences, FenceHoldsBetweenTwoPictures)
{
  vpFaultyWorld world({}, 1);
  vpFaultyPose poses(world);
  vpServoLoopSettings settings;
  settings.follower.reference.speed = 0.2;
  settings.safety.fence = Eigen::AlignedBox2d(Eigen::Vector2d(-0.2, -0.2), Eigen::Vector2d(0.325, 0.2));
  const vpPath path = vpPath::arc({0.165, 0}, 0.165, 0.9 * M_PI, 2.5 * M_PI);
  const vpServoRun run = vpServoLoop(world, poses, world, path, settings).run();
  EXPECT_EQ(run.end, vpServoRun::End::failed);
  EXPECT_NE(run.reason.find("fence"), std::string::npos) << run.reason;
  double farthest = 0; // m
  for (double time = 0; time < world.world(); time += 0.01) {
    farthest = std::max(farthest, world.robot().wMb(time)[0][3]);
  }
  EXPECT_LT(farthest, 0.325);
  EXPECT_GT(farthest, 0.2); // else the test tests nothing
}

// Torn pictures while the camera's clock jumps there and back: a first pose of two lamps that are not where
// the picture has them, and sizes of lamps as seen from there.
TEST(FaultSequences, AWrongFirstPoseIsNotKept)
{
  const vpFaultSequence sequence(14591);
  EXPECT_EQ(sequence.broken, "");
}

// A part of each picture is what the robot saw before pictures were lost, and then pictures are whole again:
// all four lamps speak for the right place, one for the wrong one, which expects it the more exactly.
TEST(FaultSequences, APlaceThatOneLampSpeaksForIsNotKept)
{
  std::mt19937_64 random(1);
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const vpFaultSequence sequence(vpFaultSequence::lostThenTorn(random), seed);
    EXPECT_EQ(sequence.broken, "") << "seed " << seed;
  }
}

TEST(FaultSequences, NoneMovesTheRobotBeyondItsLimits)
{
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const vpFaultSequence sequence(seed);
    EXPECT_EQ(sequence.broken, "") << "seed " << seed;
  }
}
