/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_calibration/vpLampBundle.h>

#include <visp3/core/vpException.h>

#include "vpBundleProblem.h"

BEGIN_VISP_NAMESPACE

vpBundleResult vpLampBundle::solve(const std::vector<vpLampRun> &runs, const vpVlpRig &rig,
                                   const vpLampMap &map) const
{
  if (lampSigma.size() != map.lamps.size()) {
    throw vpException(vpException::badValue, "lampSigma: " + std::to_string(lampSigma.size()) +
                                                 " values, expected one for each of the map's " +
                                                 std::to_string(map.lamps.size()) + " lamps");
  }
  vpBundleResult result;
  vpBundleStart start(*this, runs, rig, map);
  if (!start.refusal.empty()) {
    result.refusal = start.refusal;
    return result;
  }
  vpBundleProblem problem(*this, runs, rig, map, start);
  static const int rounds = 12; // in which the weights settle
  bool settled = false;
  for (int round = 0; round < rounds && !settled; ++round) {
    if (!problem.solve()) {
      result.refusal = "the adjustment comes to no end; check that lamps and rig are near what the files say";
      return result;
    }
    settled = problem.weigh();
    settled = problem.dropOutliers() == 0 && settled;
  }
  if (!problem.solve()) {
    result.refusal = "the adjustment comes to no end without the image points that were left out";
    return result;
  }
  return problem.result();
}

END_VISP_NAMESPACE
