/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_calibration/vpMountCalibration.h>

#include <cmath>
#include <utility>

#include <visp3/vlp_core/vpNumberText.h>

#include "vpInflatedMap.h"
#include "vpRunChecks.h"

BEGIN_VISP_NAMESPACE

namespace
{
const double unexplained = 3; // px, root mean square: beyond any detector's errors
const double manyOutliers = 0.2;

std::string listed(const std::vector<std::string> &texts)
{
  std::string all;
  for (const std::string &text : texts) {
    all += (all.empty() ? "" : "; ") + text;
  }
  return all;
}

bool explains(const vpBundleResult &result)
{
  return result.valid && result.rms < unexplained && vpOutlierShare(result) < manyOutliers;
}
} // namespace

/*!
  The two lamps of the map that had better be exchanged, in one line; empty where no two are. Each pair is
  tried on a few frames, each of which has a pose of its own.
*/
std::string vpMountCalibration::swappedLamps(const std::vector<vpLampRun> &runs, const vpVlpRig &rig,
                                             const vpLampMap &map) const
{
  static const size_t views = 12;
  static const size_t mostLamps = 12; // 66 pairs
  if (map.lamps.size() > mostLamps) {
    return "";
  }
  std::vector<vpLampRun> some = vpThinned(runs, views);
  for (vpLampRun &run : some) {
    run.motion = vpLampRun::Motion::unknown;
  }
  vpLampBundle trial;
  trial.lampSigma.assign(map.lamps.size(), 0);
  trial.rigSigma(static_cast<int>(vpRigParameter::roll)) = vpLampBundle::free;
  trial.rigSigma(static_cast<int>(vpRigParameter::pitch)) = vpLampBundle::free;
  trial.outlier = 1e9;
  for (size_t a = 0; a < map.lamps.size(); ++a) {
    for (size_t b = a + 1; b < map.lamps.size(); ++b) {
      vpLampMap exchanged = map;
      std::swap(exchanged.lamps[a].position, exchanged.lamps[b].position);
      if (explains(trial.solve(some, rig, exchanged))) {
        return "lamps " + map.lamps[a].id + " and " + map.lamps[b].id +
               " are swapped: with their places exchanged the map explains the pictures; correct position_m";
      }
    }
  }
  return "";
}

vpBundleResult vpMountCalibration::solve(const std::vector<vpLampRun> &runs, const vpVlpRig &rig,
                                         const vpLampMap &map) const
{
  vpBundleResult result;
  result.refusal = vpTooFewViews(runs, 2, fewestViews);
  if (!result.refusal.empty()) {
    return result;
  }
  vpLampBundle own = bundle;
  own.lampSigma.clear();
  for (const vpLamp &lamp : map.lamps) {
    own.lampSigma.push_back(lamp.positionSigma);
  }
  result = own.solve(runs, rig, map);
  if (!explains(result)) {
    const std::string swapped = swappedLamps(runs, rig, map);
    const std::string plain =
        result.valid
            ? "the map does not explain the pictures: " + vpNumberText(std::round(10 * result.rms) / 10) +
                  " px rms and " + vpNumberText(std::round(100 * vpOutlierShare(result))) +
                  " % outliers remain; check places and ids of the lamps in the map"
            : result.refusal;
    result.valid = false;
    result.refusal = swapped.empty() ? plain : swapped;
    return result;
  }
  if (const std::string still = vpStandsStill(result.poses); !still.empty()) {
    result.valid = false;
    result.refusal = still;
    return result;
  }
  if (const std::string other = vpOdometryMismatch(runs, result.poses); !other.empty()) {
    result.valid = false;
    result.refusal = other;
    return result;
  }
  result = vpSolveWithInflatedMap(result, own, runs, rig, map);
  // What priors hold is told, not refused.
  std::vector<std::string> open;
  for (const std::string &names : result.unseparated) {
    bool free = false, held = false; // any of them; by a prior
    for (int i = 0; i < vpRigParameterCount; ++i) {
      const std::string &name = vpRigParameterInfo::all()[static_cast<size_t>(i)].name;
      if ((" " + names + " ").find(" " + name + " ") != std::string::npos) {
        (std::isinf(bundle.rigSigma(i)) ? free : held) = true;
      }
    }
    if (free && !held) {
      open.push_back(names);
    }
  }
  if (open.empty()) {
    result.refusal = vpNoMinimum(result);
    result.valid = result.refusal.empty();
  } else {
    result.valid = false;
    result.refusal =
        "the pictures do not tell apart " + listed(open) +
        "; hold what is known (--fix u0,v0,focal after vlp-calibrate camera), give a prior (--prior "
        "u0=1), hang a lamp at another height, or spin and drive more";
  }
  return result;
}

END_VISP_NAMESPACE
