/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_calibration/vpLampSurvey.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>
#include <visp3/core/vpException.h>

#include "vpInflatedMap.h"
#include "vpRunChecks.h"

BEGIN_VISP_NAMESPACE

namespace
{
using State = vpSurveyedLamp::State;

//! m, root mean square distance of the lamps that were found from where the map has them; infinite without
//! any.
double offsetOf(const std::vector<vpSurveyedLamp> &lamps)
{
  double squares = 0;
  size_t count = 0;
  for (const vpSurveyedLamp &lamp : lamps) {
    if (lamp.state == State::found || lamp.state == State::displaced) {
      squares += lamp.offset.squaredNorm();
      ++count;
    }
  }
  return count == 0 ? std::numeric_limits<double>::infinity()
                    : std::sqrt(squares / static_cast<double>(count));
}
} // namespace

vpLampBundle vpLampSurvey::bundleOf(const vpLampMap &map) const
{
  vpLampBundle own = bundle;
  own.distance = distance;
  own.lampSigma.assign(map.lamps.size(), vpLampBundle::free);
  for (const size_t lamp : measured) {
    own.lampSigma.at(lamp) = 0;
  }
  return own;
}

std::vector<vpSurveyedLamp> vpLampSurvey::heldAgainst(const vpLampMap &map,
                                                      const vpBundleResult &result) const
{
  std::vector<vpSurveyedLamp> lamps(map.lamps.size());
  for (size_t k = 0; k < lamps.size(); ++k) {
    vpSurveyedLamp &lamp = lamps[k];
    const Eigen::Matrix3d &covariance = result.lampCovariance[k];
    lamp.images = result.lampImages[k];
    lamp.sigma = covariance.diagonal().cwiseMax(0).cwiseSqrt();
    lamp.offset = result.map.lamps[k].position - map.lamps[k].position;
    if (std::find(measured.begin(), measured.end(), k) != measured.end()) {
      lamp.state = State::measured;
    } else if (lamp.images == 0) {
      lamp.state = State::unseen;
    } else if (!(lamp.sigma.maxCoeff() < worstSigma)) {
      lamp.state = State::undetermined;
    } else {
      const double stated = map.lamps[k].positionSigma > 0 ? map.lamps[k].positionSigma : mapSigma;
      const Eigen::Matrix3d both = covariance + stated * stated * Eigen::Matrix3d::Identity();
      const bool far = lamp.offset.dot(both.inverse() * lamp.offset) > gate * gate;
      lamp.state = far ? State::displaced : State::found;
    }
  }
  return lamps;
}

//! With two measured lamps exchanged all is turned by half a turn, which explains the pictures as well: only
//! the other lamps show it. \param offset m, how far these are from where the map has them.
std::string vpLampSurvey::swappedLamps(const std::vector<vpLampRun> &runs, const vpVlpRig &rig,
                                       const vpLampMap &map, double offset) const
{
  if (measured.size() != 2 || !std::isfinite(offset)) {
    return "";
  }
  const vpLamp &a = map.lamps[measured[0]], &b = map.lamps[measured[1]];
  static const double share = 0.3; // of their distance: what nothing but such an exchange makes of all lamps
  if (offset < share * (a.position - b.position).norm()) {
    return "";
  }
  vpLampMap exchanged = map;
  std::swap(exchanged.lamps[measured[0]].position, exchanged.lamps[measured[1]].position);
  const vpBundleResult other = bundleOf(exchanged).solve(vpThinned(runs, 200), rig, exchanged);
  static const double better = 0.3;
  if (!other.valid || !(offsetOf(heldAgainst(exchanged, other)) < better * offset)) {
    return "";
  }
  return "lamps " + a.id + " and " + b.id +
         " are swapped: with their places exchanged the other lamps are where the map has them; correct "
         "position_m";
}

vpSurveyResult vpLampSurvey::solve(const std::vector<vpLampRun> &runs, const vpVlpRig &rig,
                                   const vpLampMap &map) const
{
  if ((measured.size() < 2) == !distance || (distance && !measured.empty())) {
    throw vpException(vpException::badValue,
                      "measured: " + std::to_string(measured.size()) + " lamps" +
                          (distance ? " beside a distance" : "") +
                          ", expected two or more, or the distance between two instead");
  }
  vpSurveyResult result;
  result.bundle.refusal = vpTooFewViews(runs, 2, fewestViews);
  if (!result.bundle.refusal.empty()) {
    return result;
  }
  result.bundle = bundleOf(map).solve(runs, rig, map);
  if (!result.bundle.valid) {
    return result;
  }
  if (const std::string still = vpStandsStill(result.bundle.poses); !still.empty()) {
    result.bundle.valid = false;
    result.bundle.refusal = still;
    return result;
  }
  if (const std::string other = vpOdometryMismatch(runs, result.bundle.poses); !other.empty()) {
    result.bundle.valid = false;
    result.bundle.refusal = other;
    return result;
  }
  result.lamps = heldAgainst(map, result.bundle);

  if (const std::string swapped = swappedLamps(runs, rig, map, offsetOf(result.lamps)); !swapped.empty()) {
    result.bundle.valid = false;
    result.bundle.refusal = swapped;
    return result;
  }
  result.bundle = vpSolveWithInflatedMap(result.bundle, bundleOf(map), runs, rig, map);
  result.lamps = heldAgainst(map, result.bundle);
  result.bundle.refusal = vpNoMinimum(result.bundle);
  if (!result.bundle.refusal.empty()) {
    result.bundle.valid = false;
    return result;
  }
  for (size_t k = 0; k < result.lamps.size(); ++k) {
    if (result.lamps[k].state == State::undetermined || result.lamps[k].state == State::unseen) {
      result.bundle.map.lamps[k] = map.lamps[k];
      result.lamps[k].offset.setZero();
    }
  }
  return result;
}

END_VISP_NAMESPACE
