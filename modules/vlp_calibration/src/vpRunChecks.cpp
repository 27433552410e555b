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
