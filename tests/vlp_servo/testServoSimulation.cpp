/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The loop with camera, lamps and localizer: on the line, and to a stand where pictures or lamps fail.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <visp3/vlp_servo/vpServoLoop.h>
#include <visp3/vlp_servo/vpServoSimulation.h>

#include "spoofedPair.h"

namespace
{
vpScenario world()
{
  return vpScenario::load(std::string(VLP_DATA_DIR) + "/scenarios/servo.yaml");
}

const vpPath slantedLine = vpPath::polyline({{-0.3, 0}, {0.3, 0.1}});

vpServoSimulationSettings onStartOf(const vpPath &path)
{
  const vpPathPoint begin = path.at(0);
  vpServoSimulationSettings settings;
  settings.start = {begin.place.x(), begin.place.y(), begin.heading};
  return settings;
}

double rms(const std::vector<vpTrackError> &errors)
{
  double sum = 0;
  for (const vpTrackError &error : errors) {
    sum += error.across * error.across;
  }
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

//! Hands on pictures up to some time.
class StallingFeed : public vpPictureFeed
{
public:
  StallingFeed(vpPictureFeed &feed, double from, double until) : m_feed(feed), m_from(from), m_until(until) {}
  void addOdometry(const vpOdometry &sample) override { m_feed.addOdometry(sample); }
  std::optional<vpLocatedPicture> next(double now) override
  {
    std::optional<vpLocatedPicture> picture = m_feed.next(now);
    return now > m_from && now < m_until ? std::nullopt : std::move(picture);
  }

private:
  vpPictureFeed &m_feed;
  double m_from, m_until; // s
};

//! By the lamps and the wheels, which say nothing for a while.
class OdometryThatFails : public vpVlpPose
{
public:
  OdometryThatFails(vpPictureFeed &feed, double from, double until)
      : vpVlpPose(feed), m_from(from), m_until(until)
  {
  }
  void addOdometry(const vpOdometry &sample) override
  {
    if (sample.timestamp < m_from || sample.timestamp > m_until) {
      vpVlpPose::addOdometry(sample);
    }
  }

private:
  double m_from, m_until; // s
};

//! The world, all of its lamps dark for a while.
vpScenario darkened(double from, double until)
{
  vpScenario scenario = world();
  for (vpScenario::Lamp &lamp : scenario.lamps) {
    lamp.dark.emplace_back(from, until);
  }
  return scenario;
}

//! Largest true speed from \e from to \e to, m/s.
double fastest(vpServoSimulation &world, double from, double to)
{
  double most = 0;
  for (double time = from; time < std::min(to, world.now()); time += 0.01) {
    most = std::max(most, std::abs(world.robot().twist(time).v));
  }
  return most;
}

constexpr double standing = 0.002; // m/s

//! s, from then on until it stands for good.
double standsAfter(double from, vpServoSimulation &lamps)
{
  double stood = 0;
  for (double time = from; time < lamps.now(); time += 0.01) {
    stood = std::abs(lamps.robot().twist(time).v) < standing ? stood : time + 0.01 - from;
  }
  return stood;
}
} // namespace

TEST(ServoSimulation, StaysOnTheLineWhereOdometryAloneDoesNot)
{
  vpServoLoopSettings settings;
  settings.follower.reference.speed = 0.2;
  vpServoSimulation lamps(world(), 7, onStartOf(slantedLine));
  vpVlpPose poses(lamps);
  const vpServoRun run = vpServoLoop(lamps.robot(), poses, lamps, slantedLine, settings).run();
  EXPECT_EQ(run.end, vpServoRun::End::arrived) << run.reason;
  EXPECT_LT(rms(vpTrackErrorsOf(slantedLine, run, [&](double time) { return lamps.wMb(time); })), 0.005);
  EXPECT_EQ(std::count_if(run.pictures.begin(), run.pictures.end(), [](auto &one) { return one.fix; }),
            static_cast<std::ptrdiff_t>(run.pictures.size()));

  vpScenario wheels = world();
  wheels.motion.robot.turnSource = vpSimulatorTurtleBot3Settings::TurnSource::wheels;
  vpServoSimulation alone(wheels, 7, onStartOf(slantedLine));
  vpOdometryPose odometry(alone.wMb(0), 0);
  const vpServoRun blind = vpServoLoop(alone.robot(), odometry, alone, slantedLine, settings).run();
  EXPECT_GT(rms(vpTrackErrorsOf(slantedLine, blind, [&](double time) { return alone.wMb(time); })), 0.015);
}

TEST(ServoSimulation, SameSeedSameRun)
{
  std::vector<double> ends;
  for (int i = 0; i < 2; ++i) {
    vpServoSimulation lamps(world(), 3, onStartOf(slantedLine));
    vpVlpPose poses(lamps);
    vpServoLoop loop(lamps.robot(), poses, lamps, slantedLine, {});
    loop.watch = [](const vpServoStep &step, const auto &) { return step.time < 2; };
    ends.push_back(loop.run().steps.back().wMb[0][3]);
  }
  EXPECT_EQ(ends[0], ends[1]);
}

TEST(ServoSimulation, APictureIsKnownOnlyAfterReadoutAndLocalizer)
{
  vpServoSimulationSettings settings = onStartOf(slantedLine);
  settings.computeDelay = 0.05;
  vpServoSimulation lamps(world(), 1, settings);
  const vpVlpRig &rig = lamps.simulation().rig();
  const double readout = rig.lineTiming().middle(rig.lineTiming().lines() - 1);
  vpVlpPose poses(lamps);
  vpServoLoop loop(lamps.robot(), poses, lamps, slantedLine, {});
  loop.watch = [](const vpServoStep &step, const auto &) { return step.time < 1; };
  const vpServoRun run = loop.run();
  ASSERT_GT(run.pictures.size(), 5u);
  for (const vpPictureDelay &picture : run.pictures) {
    EXPECT_GE(picture.command - picture.timestamp, readout + settings.computeDelay);
    EXPECT_LE(picture.command - picture.timestamp, readout + settings.computeDelay + 0.03);
  }
}

TEST(ServoSimulation, CameraThatStallsBringsItToAStandAndItGoesOn)
{
  vpServoLoopSettings settings;
  settings.follower.reference.speed = 0.2;
  vpServoSimulation lamps(world(), 2, onStartOf(slantedLine));
  StallingFeed feed(lamps, 1.5, 4);
  vpVlpPose poses(feed);
  const vpServoRun run = vpServoLoop(lamps.robot(), poses, lamps, slantedLine, settings).run();
  EXPECT_GT(fastest(lamps, 1.4, 1.5), 0.1);
  EXPECT_LT(fastest(lamps, 1.5 + settings.safety.pictureTimeout + 0.3, 4), standing);
  EXPECT_EQ(run.end, vpServoRun::End::arrived) << run.reason;
}

TEST(ServoSimulation, LampsThatGoOutAreCoastedOverOnOdometry)
{
  const vpPath slow = vpPath::polyline({{-0.3, 0}, {0.3, 0}});
  vpServoSimulation lamps(darkened(2, 6), 2, onStartOf(slow));
  vpVlpPose poses(lamps);
  const vpServoRun run = vpServoLoop(lamps.robot(), poses, lamps, slow, {}).run();
  for (double time = 2; time < 6; time += 0.1) {
    EXPECT_GT(std::abs(lamps.robot().twist(time).v), 0.05) << time;
  }
  EXPECT_EQ(run.end, vpServoRun::End::arrived) << run.reason;
  EXPECT_LT(rms(vpTrackErrorsOf(slow, run, [&](double time) { return lamps.wMb(time); })), 0.005);
}

TEST(ServoSimulation, LampsAndOdometryThatFailBringItToAStandWithin300MsAndItGoesOn)
{
  vpServoLoopSettings settings;
  settings.follower.reference.speed = 0.2;
  vpServoSimulation lamps(darkened(1.5, 6), 2, onStartOf(slantedLine));
  OdometryThatFails poses(lamps, 1.5, 6);
  const vpServoRun run = vpServoLoop(lamps.robot(), poses, lamps, slantedLine, settings).run();
  double crossed = 0; // s, when the covariance did not allow any more
  for (const vpServoStep &step : run.steps) {
    crossed = crossed == 0 && step.time > 1.5 && step.share == 0 ? step.time : crossed;
  }
  ASSERT_GT(crossed, 1.5);
  ASSERT_LT(crossed, 2.5);
  EXPECT_GT(fastest(lamps, 1.4, crossed), 0.1);
  EXPECT_LT(fastest(lamps, crossed + 0.3, 6), standing);
  EXPECT_EQ(run.end, vpServoRun::End::arrived) << run.reason;
}

// It may as well have been carried there, its wheels rolling.
TEST(ServoSimulation, SpoofedPairBesideOdometryIsNotBelievedAndBringsItToAStandWithin300Ms)
{
  vpServoLoopSettings settings;
  settings.safety.giveUp = 4; // s, longer than the place before stays known
  for (const std::uint64_t seed : {2, 3, 4}) {
    settings.follower.reference.speed = seed == 2 ? 0.1 : 0.2;
    vpServoSimulation lamps(spoofedPair::spoofed(world(), 1.5), seed, onStartOf(slantedLine));
    vpVlpPose poses(lamps);
    vpServoLoop loop(lamps.robot(), poses, lamps, slantedLine, settings);
    double farthest = 0; // m
    loop.watch = [&](const vpServoStep &, const std::vector<vpLocatedPicture> &pictures) {
      for (const vpLocatedPicture &picture : pictures) {
        const vpVlpLocation &location = picture.location;
        const vpHomogeneousMatrix &wMb = location.fix.wMb, truth = lamps.wMb(picture.timestamp);
        const double off = std::hypot(wMb[0][3] - truth[0][3], wMb[1][3] - truth[1][3]);
        farthest = location.fix.ambiguous || location.relocated ? farthest : std::max(farthest, off);
      }
      return true;
    };
    const vpServoRun run = loop.run();
    EXPECT_LT(standsAfter(1.5, lamps), 0.3);
    EXPECT_EQ(run.end, vpServoRun::End::failed);
    EXPECT_NE(run.reason.find("place"), std::string::npos) << run.reason;
    EXPECT_LT(farthest, 0.01);
  }
}

TEST(ServoSimulation, SpoofedPairWithoutOdometryBringsItToAStandWithin300MsAndItSaysWhy)
{
  vpServoLoopSettings settings;
  settings.follower.reference.speed = 0.2;
  settings.safety.giveUp = 4;                   // s, longer than the place before stays known
  for (const double from : {1.5, 1.52, 1.54}) { // s, before a picture and in the midst of one
    vpServoSimulation lamps(spoofedPair::spoofed(world(), from), 2, onStartOf(slantedLine));
    spoofedPair::NoOdometry feed(lamps);
    vpVlpPose poses(feed);
    const vpServoRun run = vpServoLoop(lamps.robot(), poses, lamps, slantedLine, settings).run();
    EXPECT_GT(fastest(lamps, 1.4, from), 0.15);
    EXPECT_LT(standsAfter(from, lamps), 0.3) << from;
    EXPECT_EQ(run.end, vpServoRun::End::failed);
    EXPECT_NE(run.reason.find("another place"), std::string::npos) << run.reason;
  }
}

TEST(ServoSimulation, DarkRoomNeverMoves)
{
  vpServoLoopSettings settings;
  settings.safety.giveUp = 2;
  vpServoSimulation lamps(darkened(-1, 1e9), 1, onStartOf(slantedLine));
  vpVlpPose poses(lamps);
  const vpServoRun run = vpServoLoop(lamps.robot(), poses, lamps, slantedLine, settings).run();
  EXPECT_EQ(run.end, vpServoRun::End::failed);
  EXPECT_EQ(fastest(lamps, 0, 1e9), 0);
}

TEST(ServoSimulation, InRealTimeItDrivesWithItsThreads)
{
  const vpPath brief = vpPath::polyline({{-0.05, 0}, {0.05, 0}});
  vpSteadyClock clock(0.02);
  vpLiveSimulation live(world(), 1, onStartOf(brief).start, [&clock] { return clock.now(); });
  vpLivePictures pictures(live, vpVlpLocalizer(live.rig(), live.map()), [&clock] { return clock.now(); });
  vpVlpPose poses(pictures);
  vpServoLoopSettings settings;
  settings.safety.pictureTimeout = 5; // of a machine that is busy with other tests
  const vpServoRun run = vpServoLoop(live, poses, clock, brief, settings).run();
  EXPECT_EQ(run.end, vpServoRun::End::arrived) << run.reason;
  EXPECT_GT(run.pictures.size(), 3u);
}
