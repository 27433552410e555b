/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpRunChecks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpPoseText.h>

#include "vpOdometryPath.h"

BEGIN_VISP_NAMESPACE

std::string vpTooFewViews(const std::vector<vpLampRun> &runs, size_t lamps, size_t fewest)
{
  size_t count = 0, all = 0;
  for (const vpLampRun &run : runs) {
    for (const vpLampView &view : run.views) {
      ++all;
      count += view.images.size() >= lamps ? 1 : 0;
    }
  }
  if (count >= fewest) {
    return "";
  }
  return "too few pictures: " + std::to_string(count) + " of " + std::to_string(all) + " frames show " +
         std::to_string(lamps) + " lamps or more, expected " + std::to_string(fewest) +
         "; record longer under the lamps, and check with vlp-locate --overlay that they are recognised";
}

std::string vpStandsStill(const std::vector<vpTrajectory> &poses)
{
  Eigen::AlignedBox2d box;
  double least = std::numeric_limits<double>::infinity(), most = -least, yaw = 0;
  bool first = true;
  for (const vpTrajectory &trajectory : poses) {
    for (const vpTimedPose &pose : trajectory.poses()) {
      box.extend(Eigen::Vector2d(pose.wMb[0][3], pose.wMb[1][3]));
      const double now = vpRollPitchYaw(pose.wMb).z();
      yaw = first ? now : yaw + std::remainder(now - yaw, 2 * M_PI);
      first = false;
      least = std::min(least, yaw);
      most = std::max(most, yaw);
    }
  }
  static const double nearest = 0.05, turn = 0.5; // m, rad
  const double way = box.isEmpty() ? 0 : box.diagonal().norm(), turned = first ? 0 : most - least;
  if (way > nearest || turned > turn) {
    return "";
  }
  return "the robot stands still: all pictures are from within " + vpNumberText(std::round(1000 * way)) +
         " mm and " + vpNumberText(std::round(turned * 180 / M_PI)) +
         " degrees; spin it once round on the spot, then drive a square of half a metre";
}

namespace
{
//! Steps of the odometry held against those of the pictures.
struct Held {
  double squares = 0; // of the pictures' steps
  double rest = 0;    // of what the odometry's, times the factor, leave of them
  double factor = 1;  // least squares
};

//! \param late s, by which the odometry's time stamps are taken for too late. \param turns Turns, not ways.
Held heldAgainst(const vpOdometryPath &path, const std::vector<vpTimedPose> &poses, double late, bool turns)
{
  double odometry = 0, both = 0;
  Held held;
  for (size_t i = 1; i < poses.size(); ++i) {
    const double from = poses[i - 1].timestamp, until = poses[i].timestamp;
    const auto step = path.step(from + late, until + late);
    static const double longest = 0.5; // s
    if (!step || until - from > longest) {
      continue;
    }
    const vpHomogeneousMatrix way = poses[i - 1].wMb.inverse() * poses[i].wMb;
    const double turn = std::atan2(way[1][0], way[0][0]);
    const double seen = turns ? turn : std::cos(0.5 * turn) * way[0][3] + std::sin(0.5 * turn) * way[1][3],
                 said = turns ? step->turn : step->along;
    held.squares += seen * seen;
    odometry += said * said;
    both += seen * said;
  }
  held.factor = odometry > 0 ? both / odometry : 1;
  held.rest = held.squares - held.factor * both;
  return held;
}
} // namespace

std::string vpOdometryMismatch(const std::vector<vpLampRun> &runs, const std::vector<vpTrajectory> &poses)
{
  for (size_t run = 0; run < runs.size() && run < poses.size(); ++run) {
    if (runs[run].odometry.empty()) {
      continue;
    }
    const vpOdometryPath path(runs[run].odometry);
    for (const bool turns : {true, false}) {
      const Held now = heldAgainst(path, poses[run].poses(), 0, turns);
      static const double most = 1.5, interval = 0.05; // s
      double best = 0;
      Held least = now;
      for (double late = -most; late < most + 0.5 * interval; late += interval) {
        const Held other = heldAgainst(path, poses[run].poses(), late, turns);
        if (other.squares > 0.8 * now.squares && other.rest < least.rest) {
          least = other, best = late;
        }
      }
      static const double notable = 0.02, better = 0.3, soonest = 0.1; // shares; s
      if (now.rest > notable * now.squares && least.rest < better * now.rest && std::abs(best) > soonest) {
        return "the odometry's time stamps are about " +
               vpNumberText(std::round(100 * std::abs(best)) / 100) + " s too " +
               (best > 0 ? "late" : "early") + " for the pictures: bring both on one clock (timestamp_s)";
      }
      static const double half = 0.5; // and twice
      if (now.rest < half * now.squares && !(now.factor > half && now.factor < 1 / half)) {
        return std::string("the odometry's ") + (turns ? "turn rate" : "speed") +
               " has to be multiplied by " + vpNumberText(std::round(1000 * now.factor) / 1000) +
               " to be that of the pictures; expected " +
               (turns ? "w_rad_s in rad/s, to the left" : "v_m_s in m/s, forwards");
      }
    }
  }
  return "";
}

std::string vpNoMinimum(const vpBundleResult &result)
{
  return result.converged
             ? ""
             : "the adjustment comes to no end; check that lamps and rig are near what the files say, "
               "and that odometry and pictures are of the same run";
}

std::vector<vpLampRun> vpThinned(const std::vector<vpLampRun> &runs, size_t views)
{
  std::vector<vpLampRun> thinned;
  for (const vpLampRun &run : runs) {
    vpLampRun some = run;
    some.views.clear();
    const size_t step = std::max<size_t>(1, run.views.size() / std::max<size_t>(1, views));
    for (size_t i = 0; i < run.views.size(); i += step) {
      some.views.push_back(run.views[i]);
    }
    thinned.push_back(some);
  }
  return thinned;
}

double vpOutlierShare(const vpBundleResult &result)
{
  const auto out = std::count_if(result.residuals.begin(), result.residuals.end(),
                                 [](const vpBundleResidual &residual) { return !residual.used; });
  return result.residuals.empty() ? 1
                                  : static_cast<double>(out) / static_cast<double>(result.residuals.size());
}

END_VISP_NAMESPACE
