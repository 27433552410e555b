/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPlanText_h
#define vpPlanText_h

#include <array>
#include <cstdio>
#include <string>

#include <visp3/vlp_core/vpModulation.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

//! A number to three digits.
inline std::string vpFigureText(double value)
{
  std::array<char, 32> buffer;
  const bool whole = value >= 100 && value < 1e6;
  std::snprintf(buffer.data(), buffer.size(), whole ? "%.0f" : "%.3g", value);
  return buffer.data();
}

//! How a lamp blinks, in a few words.
inline std::string vpSignalText(const vpModulation &modulation)
{
  if (modulation.kind == vpModulation::Kind::word) {
    return modulation.bits + " at " + vpNumberText(modulation.chipRate) + " Hz";
  }
  std::string text = vpNumberText(modulation.frequency) + " Hz";
  text += modulation.duty ? ", " + vpNumberText(*modulation.duty) : "";
  return modulation.kind == vpModulation::Kind::twoPulse
             ? text + ", " + vpNumberText(modulation.phaseDifference)
             : text;
}

END_VISP_NAMESPACE

#endif
