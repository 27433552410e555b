/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_calibration/vpLampSurvey.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>
#include <visp3/core/vpException.h>

#include "vpRunChecks.h"

BEGIN_VISP_NAMESPACE

namespace
{
using State = vpSurveyedLamp::State;

size_t displacedOf(const std::vector<vpSurveyedLamp> &lamps)
{
  return static_cast<size_t>(std::count_if(lamps.begin(), lamps.end(), [](const vpSurveyedLamp &lamp) {
    return lamp.state == State::displaced;
  }));
}
} // namespace

vpBundleResult vpLampSurvey::adjusted(const std::vector<vpLampRun> &runs, const vpVlpRig &rig,
                                      const vpLampMap &map) const
{
  vpLampBundle own = bundle;
  own.distance = distance;
  own.lampSigma.assign(map.lamps.size(), vpLampBundle::free);
  for (const size_t lamp : measured) {
    own.lampSigma.at(lamp) = 0;
  }
  return own.solve(runs, rig, map);
}

std::vector<vpSurveyedLamp> vpLampSurvey::heldAgainst(const vpLampMap &map, const vpBundleResult &result) const
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
  result.bundle = adjusted(runs, rig, map);
  if (!result.bundle.valid) {
    return result;
  }
  if (const std::string still = vpStandsStill(result.bundle.poses); !still.empty()) {
    result.bundle.valid = false;
    result.bundle.refusal = still;
    return result;
  }
  result.lamps = heldAgainst(map, result.bundle);

  // With two measured lamps exchanged all is turned by half a turn, and explains the pictures as well.
  const size_t others = map.lamps.size() - measured.size(), displaced = displacedOf(result.lamps);
  if (measured.size() == 2 && others > 0 && 2 * displaced > others) {
    vpLampMap exchanged = map;
    std::swap(exchanged.lamps[measured[0]].position, exchanged.lamps[measured[1]].position);
    const vpBundleResult other = adjusted(runs, rig, exchanged);
    if (other.valid && 2 * displacedOf(heldAgainst(exchanged, other)) < displaced) {
      result.bundle.valid = false;
      result.bundle.refusal = "lamps " + map.lamps[measured[0]].id + " and " + map.lamps[measured[1]].id +
                              " are swapped: with their places exchanged the other lamps are where the map has "
                              "them; correct position_m";
      return result;
    }
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
