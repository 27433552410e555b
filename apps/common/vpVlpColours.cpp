/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpVlpColours.h"

BEGIN_VISP_NAMESPACE

cv::Scalar vpVlpColours::ofLamp(const vpLampObservation &lamp)
{
  return lamp.accepted ? green : (lamp.id.empty() ? orange : yellow);
}

cv::Scalar vpVlpColours::ofState(const std::string &state)
{
  if (state == "fix") {
    return {255, 200, 90};
  }
  if (state == "tracking") {
    return green;
  }
  if (state == "coasting") {
    return {40, 130, 255};
  }
  if (state == "relocated") {
    return violet;
  }
  return state == "ambiguous" ? yellow : grey;
}

std::string vpStateOf(const vpVlpLocation &location)
{
  if (!location.fix.valid) {
    return "none";
  }
  if (location.fix.ambiguous) {
    return "ambiguous";
  }
  if (location.relocated) {
    return "relocated";
  }
  if (!location.tracked) {
    return "fix";
  }
  return location.state == vpVlpFilter::State::tracking ? "tracking" : "coasting";
}

END_VISP_NAMESPACE
