/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The loop as a whole, on a base that does what it is told: it drives, and it stops in every case.

#include <stdexcept>

#include <gtest/gtest.h>
#include <visp3/vlp_servo/vpServoLog.h>
#include <visp3/vlp_servo/vpServoLoop.h>

#include "common/vpExpectError.h"
#include "common/vpTemporaryFolder.h"
#include "vpPerfectBase.h"

namespace
{
const vpPath line = vpPath::polyline({{0, 0}, {1, 0}});

vpServoLoop loopOf(vpPerfectBase &base, const vpServoLoopSettings &settings = {})
{
  return vpServoLoop(base, base, base, line, settings);
}

//! s from \e from until the base was first told to stand and stood ever after.
double untilStand(const vpServoRun &run, double from, double to = 1e9)
{
  double last = from;
  for (const vpServoStep &step : run.steps) {
    last = step.time > from && step.time < to && (step.told.v != 0 || step.told.w != 0) ? step.time : last;
  }
  return last - from;
}
} // namespace

TEST(ServoLoop, DrivesToTheEndAndStands)
{
  vpPerfectBase base;
  const vpServoRun run = loopOf(base).run();
  EXPECT_EQ(run.end, vpServoRun::End::arrived);
  EXPECT_EQ(run.reason, "");
  EXPECT_NEAR(base.x(), 1, 0.004);
  EXPECT_EQ(base.velocity().v, 0);
  EXPECT_EQ(base.stops, 1u);
  EXPECT_EQ(base.told.size(), run.steps.size()); // each period fed the base's watchdog
}

TEST(ServoLoop, UncertainPoseBringsItToAStandWithin300MsAndItGoesOn)
{
  vpPerfectBase base;
  base.each = [&base](double time) { base.sigma = time > 3 && time < 5 ? 0.06 : 1e-3; };
  vpServoLoopSettings settings;
  settings.follower.reference.speed = 0.2;
  const vpServoRun run = loopOf(base, settings).run();
  EXPECT_LT(untilStand(run, 3, 5), 0.3);
  EXPECT_EQ(run.end, vpServoRun::End::arrived);
  EXPECT_NEAR(base.x(), 1, 0.004);
}

TEST(ServoLoop, LostPoseForGoodEndsTheRun)
{
  vpPerfectBase base;
  base.each = [&base](double time) { base.known = time < 2; };
  const vpServoRun run = loopOf(base).run();
  EXPECT_LT(untilStand(run, 2), 0.3);
  EXPECT_EQ(run.end, vpServoRun::End::failed);
  EXPECT_NE(run.reason.find("nothing to see"), std::string::npos) << run.reason;
}

TEST(ServoLoop, ErrorOfTheBaseEndsTheRunAndIsToldToStop)
{
  vpPerfectBase base;
  base.each = [&base](double time) { base.reachable = time < 2; };
  const vpServoRun run = loopOf(base).run();
  EXPECT_EQ(run.end, vpServoRun::End::failed);
  EXPECT_NE(run.reason.find("the cable is out"), std::string::npos);
  EXPECT_EQ(base.stops, 1u); // though nobody hears it
}

TEST(ServoLoop, ExceptionStopsTheBaseAndPasses)
{
  vpPerfectBase base;
  vpServoLoop loop = loopOf(base);
  loop.watch = [&base](const vpServoStep &, const auto &) {
    return base.now() < 2 ? true : throw std::runtime_error("out of paper");
  };
  EXPECT_THROW(loop.run(), std::runtime_error);
  EXPECT_EQ(base.velocity().v, 0);
  EXPECT_EQ(base.stops, 1u);
  EXPECT_GT(base.x(), 0.1);
}

TEST(ServoLoop, SomebodyEndsIt)
{
  vpPerfectBase base;
  vpServoLoop loop = loopOf(base);
  loop.watch = [&base](const vpServoStep &, const auto &) { return base.now() < 2; };
  const vpServoRun run = loop.run();
  EXPECT_EQ(run.end, vpServoRun::End::stopped);
  EXPECT_EQ(base.velocity().v, 0);
  EXPECT_NEAR(base.now(), 2, 0.021);
}

TEST(ServoLoop, LowBatteryEndsTheRun)
{
  vpPerfectBase base;
  vpServoLoop loop = loopOf(base);
  loop.battery = [&base] { return base.now() < 2 ? 12.0 : 10.0; };
  const vpServoRun run = loop.run();
  EXPECT_EQ(run.end, vpServoRun::End::failed);
  EXPECT_NE(run.reason.find("battery"), std::string::npos);
  EXPECT_EQ(base.velocity().v, 0);
  EXPECT_LT(base.x(), 0.4);
}

TEST(ServoLoop, FenceEndsTheRunInside)
{
  vpPerfectBase base;
  vpServoLoopSettings settings;
  settings.follower.reference.speed = 0.2;
  settings.safety.fence = Eigen::AlignedBox2d(Eigen::Vector2d(-0.1, -0.1), Eigen::Vector2d(0.5, 0.1));
  const vpServoRun run = loopOf(base, settings).run();
  EXPECT_EQ(run.end, vpServoRun::End::failed);
  EXPECT_NE(run.reason.find("fence"), std::string::npos);
  EXPECT_LT(base.x(), 0.5);
  EXPECT_GT(base.x(), 0.4);
}

TEST(ServoLoop, CommandsKeepTheirLimitsThroughAllOfIt)
{
  vpPerfectBase base;
  base.each = [&base](double time) {
    base.sigma = time > 3 && time < 4 ? 0.06 : 1e-3;
    base.known = !(time > 6 && time < 7);
  };
  vpServoLoopSettings settings;
  settings.follower.reference.speed = 0.2;
  loopOf(base, settings).run();
  for (size_t i = 1; i < base.told.size(); ++i) {
    EXPECT_LE(base.limits().share(base.told[i]), 1 + 1e-9);
    const double change = base.told[i].v - base.told[i - 1].v;
    EXPECT_LE(change, settings.safety.acceleration * base.period() + 1e-9);
    if (base.told[i].v != 0) { // without a permit it stands at once
      EXPECT_GE(change, -settings.safety.braking * base.period() - 1e-9);
    }
  }
}

TEST(ServoLoop, BaseThatDoesNotMoveEndsTheRun)
{
  for (const double length : {1.0, 0.1}) { // far off, and never at the end
    const vpPath path = vpPath::polyline({{0, 0}, {length, 0}});
    vpPerfectBase base;
    base.scale = 0;
    const vpServoRun run = vpServoLoop(base, base, base, path, {}).run();
    EXPECT_EQ(run.end, vpServoRun::End::failed);
    EXPECT_NE(run.reason.find("does not follow"), std::string::npos) << run.reason;
  }
}

TEST(ServoLoop, TrackErrorsAreOfTheTruth)
{
  vpPerfectBase base;
  vpServoLoopSettings settings;
  const vpServoRun run = loopOf(base, settings).run();
  const auto errors = vpTrackErrorsOf(line, run, [](double) { return vpStanding(0.05, -0.02, 0.1); });
  ASSERT_FALSE(errors.empty());
  EXPECT_NEAR(errors[0].across, -0.02, 1e-9);
  EXPECT_NEAR(errors[0].heading, 0.1, 1e-9);
  EXPECT_NEAR(errors[0].s, 0.05, 1e-6);
}

TEST(ServoLog, ReadsBackWhatItWrote)
{
  vpPerfectBase base;
  base.each = [&base](double time) { base.known = time > 0.5; };
  vpServoLog log{line, loopOf(base).run(), {}, {}};
  for (const vpServoStep &step : log.run.steps) {
    log.truth.add(step.time, vpStanding(0.1 * step.time, 0.01, 0));
  }
  const vpTemporaryFolder folder;
  log.save(folder.path());
  const vpServoLog read = vpServoLog::load(folder.path());
  ASSERT_EQ(read.run.steps.size(), log.run.steps.size());
  for (size_t i = 0; i < read.run.steps.size(); ++i) {
    EXPECT_EQ(read.run.steps[i].time, log.run.steps[i].time);
    EXPECT_EQ(read.run.steps[i].told.v, log.run.steps[i].told.v);
    EXPECT_EQ(read.run.steps[i].located, log.run.steps[i].located);
    EXPECT_EQ(read.run.steps[i].waiting, log.run.steps[i].waiting);
  }
  const auto before = log.trueErrors(), after = read.trueErrors();
  ASSERT_EQ(before.size(), after.size());
  for (size_t i = 0; i < before.size(); ++i) {
    EXPECT_NEAR(before[i].across, after[i].across, 1e-9);
    EXPECT_NEAR(before[i].heading, after[i].heading, 1e-9);
  }
  EXPECT_EQ(read.estimatedErrors().size(), log.estimatedErrors().size());
  EXPECT_EQ(vpReadOdometry(folder / "odometry.csv").size(), log.run.odometry.size());
}

TEST(ServoLog, BadRowsAreNamed)
{
  const vpTemporaryFolder folder;
  line.save(folder / "path.yaml");
  folder.write("poses.tum", "");
  folder.write("commands.csv", vpServoLog::columns + "\n0.1,x,0,0,0,0,0,0,0,0,,,,,\n");
  vpExpectError([&folder] { vpServoLog::load(folder.path()); }, {"commands.csv:2", "v_m_s: x"});
}
