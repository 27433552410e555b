/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What the estimator takes for granted is known to a factor of two at best: each of its settings is moved by
// that factor both ways, a probability by its odds, and poses have to stay what they were.

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/vpSeenLamps.h"

namespace
{
const double frameTime = 0.1; // s

using Set = std::function<void(vpVlpLocalizer &)>;

struct Setting {
  std::string name;
  std::function<void(vpVlpLocalizer &, double factor)> scale;
};

Setting hypothesis(const std::string &name, double vpVlpHypotheses::*member)
{
  return {name,
          [member](vpVlpLocalizer &localizer, double factor) { localizer.hypotheses.*member *= factor; }};
}

Setting likely(const std::string &name, double vpVlpHypotheses::*member)
{
  return {name, [member](vpVlpLocalizer &localizer, double factor) {
            double &probability = localizer.hypotheses.*member;
            const double odds = factor * probability / (1 - probability);
            probability = odds / (1 + odds);
          }};
}

Setting filtered(const std::string &name, double vpVlpFilter::*member)
{
  return {name, [member](vpVlpLocalizer &localizer, double factor) { localizer.filter.*member *= factor; }};
}

std::vector<Setting> settings()
{
  using H = vpVlpHypotheses;
  using F = vpVlpFilter;
  return {
      hypothesis("steady", &H::steady),
      hypothesis("gentle", &H::gentle),
      hypothesis("lively", &H::lively),
      hypothesis("onWheels", &H::onWheels),
      hypothesis("change", &H::change),
      hypothesis("settling", &H::settling),
      likely("right", &H::right),
      hypothesis("slip", &H::slip),
      hypothesis("grip", &H::grip),
      hypothesis("relocation", &H::relocation),
      hypothesis("rolling", &H::rolling),
      hypothesis("reach", &H::reach),
      hypothesis("turn", &H::turn),
      hypothesis("floorStep", &H::floorStep),
      hypothesis("displaced", &H::displaced),
      hypothesis("stranger", &H::stranger),
      likely("staying", &H::staying),
      hypothesis("copy", &H::copy),
      hypothesis("copyReach", &H::copyReach),
      hypothesis("claimsOff", &H::claimsOff),
      hypothesis("negligible", &H::negligible),
      likely("decided", &H::decided),
      filtered("acceleration", &F::acceleration),
      filtered("turnAcceleration", &F::turnAcceleration),
      filtered("drift", &F::drift),
      filtered("startPlace", &F::startPlace),
      filtered("startTurn", &F::startTurn),
      filtered("startVelocity", &F::startVelocity),
      filtered("startTurnRate", &F::startTurnRate),
      filtered("odometrySpeed", &F::odometrySpeed),
      filtered("odometryShare", &F::odometryShare),
      filtered("odometryTurnRate", &F::odometryTurnRate),
      filtered("odometryScale", &F::odometryScale),
      filtered("odometryTurnScale", &F::odometryTurnScale),
      filtered("odometryTurnBias", &F::odometryTurnBias),
      filtered("odometryHeading", &F::odometryHeading),
      filtered("claimedTilt", &F::claimedTilt),
      filtered("claimedPlace", &F::claimedPlace),
      {"mapTolerance", [](vpVlpLocalizer &localizer, double factor) { localizer.mapTolerance *= factor; }}};
}

//! What a drive's poses are like. Those that are told as relocated or ambiguous do not count.
struct Poses {
  double mean = 0;   // m, of the horizontal error
  double sigmas = 0; // root mean square of what is farthest off, x, y or yaw, in its standard deviations
};

using Path = std::function<vpPlannedPlace(double)>;

//! \param world What shines at a time, s. \param odometry Nothing: none.
Poses follow(const vpSeenLamps &claimed, const std::function<const vpSeenLamps &(double)> &world,
             const Path &path, double duration, const std::vector<vpOdometry> &odometry, const Set &set)
{
  Poses poses;
  int frames = 0;
  for (unsigned int seed = 1; seed <= 3; ++seed) {
    std::mt19937_64 generator(seed);
    vpVlpLocalizer localizer(claimed.rig, claimed.map);
    set(localizer);
    size_t given = 0;
    for (double t = 0; t < duration - 1e-9; t += frameTime) {
      static const double read = 0.08; // s after the time stamp: by then the frame is there
      for (; given < odometry.size() && odometry[given].timestamp <= t + read; ++given) {
        localizer.filter.addOdometry(odometry[given]);
      }
      const vpVlpLocation location = localizer.locate(t, world(t).see(t, path, generator));
      EXPECT_TRUE(location.fix.valid) << "at " << t << " s";
      if (t > 0 && !location.relocated &&
          !location.fix.ambiguous) { // a first frame does not know the velocity
        poses.mean += vpErrorOf(location.fix, path(t));
        poses.sigmas += std::pow(vpSigmasOff(location.fix, path(t)), 2);
        ++frames;
      }
    }
  }
  poses.mean /= frames;
  poses.sigmas = std::sqrt(poses.sigmas / frames);
  return poses;
}

const vpPlannedDrive plannedDrive({-0.2, 0, 0}, {{1, 0, 0}, {2, 0.1, 0.3}, {2, 0.15, -0.3}, {1, 0, 0}});

vpPlannedPlace driven(double t)
{
  return plannedDrive.at(t);
}

//! Put 12 cm and 40 degrees elsewhere after two seconds.
vpPlannedPlace jumped(double t)
{
  vpPlannedPlace place = plannedDrive.at(t);
  if (t > 2.05) {
    place.x += 0.1;
    place.y -= 0.07;
    place.yaw += 0.7;
  }
  return place;
}

std::vector<vpOdometry> scaled(double scale)
{
  std::vector<vpOdometry> samples = plannedDrive.odometry(0.02);
  for (vpOdometry &sample : samples) {
    sample.v *= scale;
    sample.w *= scale;
  }
  return samples;
}

//! The drives that a setting has to leave as they are, by name.
std::vector<std::pair<std::string, Poses>> drives(const Set &set)
{
  const vpSeenLamps two(2), three(3);
  vpSeenLamps oneAside(4), copies(2);
  oneAside.hung(2) += Eigen::Vector3d(0.012, -0.015, 0);
  for (size_t k = 0; k < 2; ++k) {
    copies.hung(k).y() += 0.36;
  }
  const auto always = [](const vpSeenLamps &world) {
    return [&world](double) -> const vpSeenLamps & { return world; };
  };
  const auto lampsGiveWay = [&](double t) -> const vpSeenLamps & { return t < 2 ? two : copies; };
  const double duration = plannedDrive.duration();
  return {{"three lamps", follow(three, always(three), driven, duration, {}, set)},
          {"two lamps and wheels", follow(two, always(two), driven, duration, scaled(1), set)},
          {"two lamps and wheels that are off by a fifth",
           follow(two, always(two), driven, duration, scaled(1.2), set)},
          {"one lamp of four hangs 2 cm elsewhere",
           follow(oneAside, always(oneAside), driven, duration, {}, set)},
          {"three lamps, put elsewhere", follow(three, always(three), jumped, duration, {}, set)},
          {"two lamps and wheels, false lamps", follow(two, lampsGiveWay, driven, 4, scaled(1), set)}};
}
} // namespace

TEST(Hypotheses, EachSettingMayBeOffByAFactorOfTwo)
{
  const auto nominal = drives([](vpVlpLocalizer &) {});
  for (const Setting &setting : settings()) {
    for (const double factor : {0.5, 2.0}) {
      SCOPED_TRACE(setting.name + " times " + std::to_string(factor));
      const auto moved = drives([&](vpVlpLocalizer &localizer) { setting.scale(localizer, factor); });
      for (size_t k = 0; k < moved.size(); ++k) {
        SCOPED_TRACE(moved[k].first);
        EXPECT_LT(moved[k].second.mean, 1.5 * nominal[k].second.mean);
        EXPECT_LT(moved[k].second.sigmas, 2);
      }
    }
  }
}
