/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpInflatedMap.h"

#include <algorithm>
#include <cmath>

BEGIN_VISP_NAMESPACE

namespace
{
/*!
  Standard deviation of the places, m, by how far they moved from where the map has them: the sum of squares
  over its redundancy (Foerstner 1979). \param sigma m, that they were solved with.
*/
double shown(const vpBundleResult &result, const vpLampMap &map, const std::vector<size_t> &lamps,
             double sigma)
{
  static const double least = 0.5, smallest = 1e-4, largest = 0.1; // values; m
  double squares = 0, redundancy = 0;
  for (const size_t k : lamps) {
    if (result.lampImages[k] > 0) {
      squares += (result.map.lamps[k].position - map.lamps[k].position).squaredNorm();
      redundancy += 3 - result.lampCovariance[k].trace() / (sigma * sigma);
    }
  }
  return std::clamp(std::sqrt(squares / std::max(least, redundancy)), smallest, largest);
}
} // namespace

vpBundleResult vpSolveWithInflatedMap(const vpBundleResult &found, const vpLampBundle &bundle,
                                      const std::vector<vpLampRun> &runs, const vpVlpRig &rig,
                                      const vpLampMap &map)
{
  std::vector<size_t> held;
  for (size_t k = 0; k < bundle.lampSigma.size(); ++k) {
    if (!(bundle.lampSigma[k] > 0)) {
      held.push_back(k);
    }
  }
  static const double explained = 2; // times as uncertain as the detector says
  if (!found.valid || found.imageFactor < explained || held.empty() || bundle.distance) {
    return found;
  }
  static const int rounds = 8;
  static const double first = 0.005, nearly = 0.2; // m; a share
  vpBundleResult result = found;
  vpLampBundle inflated = bundle;
  double sigma = first;
  for (int round = 0; round < rounds; ++round) {
    for (const size_t k : held) {
      inflated.lampSigma[k] = sigma;
    }
    vpBundleResult solution = inflated.solve(runs, rig, map);
    if (!solution.valid) {
      break;
    }
    result = solution;
    result.inflatedLampSigma = sigma;
    result.inflatedLamps = held;
    const double next = shown(result, map, held, sigma);
    if (std::abs(std::log(next / sigma)) < nearly) {
      break;
    }
    sigma = next;
  }
  return result;
}

END_VISP_NAMESPACE
