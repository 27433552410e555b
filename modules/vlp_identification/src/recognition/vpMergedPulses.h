/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpMergedPulses_h
#define vpMergedPulses_h

#include <algorithm>
#include <optional>

#include <visp3/vlp_core/vpModulation.h>

BEGIN_VISP_NAMESPACE

//! Two pulses in each period with a gap so short that stripes may show one: the duties which that may seem to
//! have.
struct vpMergedPulses {
  double leastDuty = 0, mostDuty = 1;

  //! None where the exposure (s) is short enough for the gap to show.
  static std::optional<vpMergedPulses> of(const vpModulation &sent, double exposure)
  {
    if (sent.kind != vpModulation::Kind::twoPulse) {
      return std::nullopt;
    }
    const double gap = sent.phaseDifference - 0.5 * sent.duty.value_or(0); // periods
    if (!(gap < exposure * sent.frequency)) {
      return std::nullopt;
    }
    if (!sent.duty) {
      return vpMergedPulses();
    }
    // As far as rendered lamps were read at gaps of 0.15 to 0.9 exposures.
    static const double less = 1, more = 2.25; // gaps
    return vpMergedPulses{std::max(0.0, *sent.duty - less * gap), std::min(1.0, *sent.duty + more * gap)};
  }

  //! How far other duties lie outside.
  double distance(const vpMergedPulses &other) const
  {
    return std::max({0.0, leastDuty - other.mostDuty, other.leastDuty - mostDuty});
  }
};

END_VISP_NAMESPACE

#endif
