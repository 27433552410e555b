/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_identification/vpLitShare.h>

#include <cmath>

#include "vpPulseWave.h"

BEGIN_VISP_NAMESPACE

std::vector<double> vpLitShareOf(const vpStripeFeatures &seen, const std::vector<double> &time)
{
  if (std::isnan(seen.phase)) {
    return {};
  }
  const Eigen::ArrayXd middle =
      Eigen::Map<const Eigen::ArrayXd>(time.data(), static_cast<Eigen::Index>(time.size()));
  const bool two = seen.signal == vpStripeFeatures::Signal::twoPulse;
  const double width = seen.exposure * seen.frequency, own = two ? 0.5 * seen.duty : seen.duty;
  Eigen::ArrayXd lit = Eigen::ArrayXd::Zero(middle.size());
  vpPulseWave::addValue(middle, seen.frequency, seen.phase, width, own, lit);
  if (two) {
    vpPulseWave::addValue(middle, seen.frequency, seen.phase - seen.phaseDifference, width, own, lit);
  }
  return {lit.data(), lit.data() + lit.size()};
}

std::vector<float> vpLitShareOf(const vpStripeFeatures &seen, const vpLineTiming &timing)
{
  std::vector<double> time;
  for (unsigned int line = 0; line < timing.lines(); ++line) {
    time.push_back(timing.middle(line));
  }
  const std::vector<double> lit = vpLitShareOf(seen, time);
  return {lit.begin(), lit.end()};
}

END_VISP_NAMESPACE
