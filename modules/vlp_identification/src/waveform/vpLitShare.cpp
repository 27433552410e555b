/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLitShare.h"

#include <cmath>

#include "vpPulseWave.h"

BEGIN_VISP_NAMESPACE

std::vector<float> vpLitShareOf(const vpStripeFeatures &seen, const vpLineTiming &timing)
{
  if (std::isnan(seen.phase)) {
    return {};
  }
  Eigen::ArrayXd time(timing.lines());
  for (unsigned int line = 0; line < timing.lines(); ++line) {
    time(line) = timing.middle(line);
  }
  const bool two = seen.signal == vpStripeFeatures::Signal::twoPulse;
  const double width = seen.exposure * seen.frequency, own = two ? 0.5 * seen.duty : seen.duty;
  Eigen::ArrayXd lit = Eigen::ArrayXd::Zero(time.size());
  vpPulseWave::addValue(time, seen.frequency, seen.phase, width, own, lit);
  if (two) {
    vpPulseWave::addValue(time, seen.frequency, seen.phase - seen.phaseDifference, width, own, lit);
  }
  return {lit.data(), lit.data() + lit.size()};
}

END_VISP_NAMESPACE
