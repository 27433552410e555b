/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpSteadyLight.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <visp3/vlp_identification/vpLedIdPlanner.h>

BEGIN_VISP_NAMESPACE

namespace
{
const double never = std::numeric_limits<double>::infinity();

//! By how much longer a stretch of light or dark may look, as a share of it: by blur, and by the row time's
//! error.
double slack(const vpRollingShutter &shutter)
{
  static const double blur = 0.2, sigmas = 5;
  return blur + sigmas * shutter.rowTimeSigma / shutter.rowTime;
}

//! s, for how long a lamp is dark on end, once a period at least.
double darkTime(const vpModulation &sent)
{
  static const double longestDuty = 0.8; // the longest that is planned
  const double period = 1 / sent.repetitionFrequency(), lit = sent.duty.value_or(longestDuty);
  switch (sent.kind) {
  case vpModulation::Kind::word:
    return period / static_cast<double>(sent.chips().size());
  case vpModulation::Kind::twoPulse:
    return 0.5 * (1 - lit) * period;
  default:
    return (1 - lit) * period;
  }
}
} // namespace

double vpLongestLit(const vpStripeProfile &profile)
{
  const auto [least, most] = std::minmax_element(profile.light.begin(), profile.light.end());
  const double bright = 0.5 * (*least + *most);
  double longest = 0;
  size_t begun = 0;
  for (size_t i = 0; i < profile.light.size(); ++i) {
    begun = profile.light[i] > bright ? begun : i + 1;
    if (begun <= i) {
      longest = std::max(longest, std::abs(profile.time[i] - profile.time[begun]));
    }
  }
  return longest;
}

double vpLongestPeriodLines(const vpLampMap &map, const vpVlpRig &rig)
{
  double longest = map.lamps.empty() ? never : 1 / vpLedIdPlanner::visibleFlicker; // s
  for (const vpLamp &lamp : map.lamps) {
    const double frequency = lamp.modulation.repetitionFrequency();
    longest = std::max(longest, frequency > 0 ? 1 / frequency : never);
  }
  const double line = std::abs(rig.lineTiming().meanLineTime());
  return line > 0 ? longest * (1 + slack(rig.shutter)) / line : never;
}

double vpLongestPeriod(const vpLampMap &map, const vpVlpRig &rig)
{
  const vpRollingShutter &shutter = rig.shutter;
  if (!(shutter.rowTime > 0)) {
    return never;
  }
  // The darkest line lies half a line off the dark time's middle at most: its whole exposure is dark where
  // that time is longer than both together.
  const vpLineTiming timing = rig.lineTiming();
  const double rows = std::ceil(std::abs(timing.meanLineTime()) / shutter.rowTime), // of the farthest lines
      exposure = std::hypot(timing.exposure(), timing.averaging()) * std::exp(timing.logExposureSigma()),
               shown = rows * shutter.rowTime + exposure;
  double longest = map.lamps.empty() ? never : 0;
  for (const vpLamp &lamp : map.lamps) {
    const double dark = darkTime(lamp.modulation);
    longest = std::max(longest, dark > shown ? 1 / lamp.modulation.repetitionFrequency() : never);
  }
  return longest * (1 + slack(shutter));
}

END_VISP_NAMESPACE
