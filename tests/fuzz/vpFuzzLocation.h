/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpFuzzLocation_h
#define vpFuzzLocation_h

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include "fuzz/vpFuzzTarget.h"

//! What holds of each location, whatever was seen.
inline void vpFuzzExpectSound(const vpVlpLocation &location, const vpVlpFilter &filter)
{
  const vpVlpFix &fix = location.fix;
  vpFuzzExpect(fix.refusal.find('\n') == std::string::npos, "a refusal of one line");
  vpFuzzExpect(fix.valid == fix.refusal.empty(), "a pose or a reason");
  vpFuzzExpect(!location.tracked || (fix.valid && filter.started()), "a tracked pose to be one");
  vpFuzzExpect(!location.relocated || fix.valid, "a relocated pose to be one");
  const auto accepted = std::count_if(location.observations.begin(), location.observations.end(),
                                      [](const vpLampObservation &one) { return one.accepted; });
  vpFuzzExpect(std::all_of(location.observations.begin(), location.observations.end(),
                           [](const vpLampObservation &one) { return !one.accepted || !one.id.empty(); }),
               "a lamp that counts to have an id");
  vpFuzzExpect(fix.valid || accepted == 0, "no lamp that counts for no pose");
  if (!fix.valid) {
    return;
  }
  vpFuzzExpect(location.tracked || fix.lamps.size() >= 2, "a first pose of two lamps");
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 4; ++k) {
      vpFuzzExpect(std::isfinite(fix.wMb[i][k]) && std::isfinite(fix.wMc[i][k]), "a finite pose");
    }
  }
  const Eigen::Matrix<double, 6, 6> &P = fix.covariance;
  vpFuzzExpect(P.allFinite(), "a finite covariance");
  const double scale = P.diagonal().cwiseAbs().maxCoeff();
  vpFuzzExpect((P - P.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * scale, "a symmetric covariance");
  // Roll and pitch are known where the rig states no deviation of them.
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(P).eigenvalues().minCoeff();
  vpFuzzExpect(least >= -1e-9 * scale, "a covariance without a negative variance");
  vpFuzzExpect(P(0, 0) > 0 && P(1, 1) > 0 && P(2, 2) > 0 && P(5, 5) > 0,
               "variances of x, y, z and yaw above 0");
}

#endif
