/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPwmLamps_h
#define vpPwmLamps_h

#include <string>
#include <vector>

#include <visp3/vlp_core/vpLampMap.h>

BEGIN_VISP_NAMESPACE

//! Lamps of one pulse a period, Hz, of a duty that is not stated: L1500 is that of 1500 Hz.
inline vpLampMap vpPwmLamps(const std::vector<double> &frequencies)
{
  vpLampMap map;
  for (const double frequency : frequencies) {
    vpLamp lamp;
    lamp.id = "L" + std::to_string(static_cast<int>(frequency));
    lamp.modulation.kind = vpModulation::Kind::pwm;
    lamp.modulation.frequency = frequency;
    map.lamps.push_back(lamp);
  }
  return map;
}

END_VISP_NAMESPACE

#endif
