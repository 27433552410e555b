/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpWordFormats.h"

#include <algorithm>
#include <cmath>

BEGIN_VISP_NAMESPACE

std::vector<vpWordFormat> vpWordFormatsOf(const vpLampMap &map, const vpRollingShutter &shutter)
{
  const double rowTime = shutter.rowTime > 0 ? shutter.rowTimeSigma / shutter.rowTime : 0;
  std::vector<vpWordFormat> formats;
  for (const vpLamp &lamp : map.lamps) {
    const vpModulation &sent = lamp.modulation;
    if (sent.kind != vpModulation::Kind::word) {
      continue;
    }
    const size_t chips = sent.chips().size();
    const auto same =
        std::find_if(formats.begin(), formats.end(), [&sent, chips](const vpWordFormat &format) {
          return format.chips == chips && format.chipRate == sent.chipRate;
        });
    const double tolerance = std::hypot(rowTime, 1e-6 * lamp.oscillatorPpm);
    if (same == formats.end()) {
      formats.push_back({chips, sent.chipRate, tolerance});
    } else {
      same->tolerance = std::max(same->tolerance, tolerance);
    }
  }
  return formats;
}

END_VISP_NAMESPACE
