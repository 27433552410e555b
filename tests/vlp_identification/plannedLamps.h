/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef plannedLamps_h
#define plannedLamps_h

#include <string>
#include <vector>

#include <visp3/vlp_identification/vpLedIdPlanner.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

//! Lamps of one size on a ceiling, and rigs that see them.
namespace plannedLamps
{
constexpr double crystal = 50, rc = 10000; // ppm
constexpr double diameter = 0.175;         // m
constexpr double height = 1.5;             // m

inline vpVlpRig rigOf(const std::string &name)
{
  return vpVlpRig::load(VLP_DATA_DIR "/rigs/ub300-" + name + ".yaml");
}
constexpr const char *fullSize = "2048x1536", *resized = "800x600"; // the latter by nearest neighbour

inline vpModulation pwm(double frequency, double duty)
{
  vpModulation modulation;
  modulation.kind = vpModulation::Kind::pwm;
  modulation.frequency = frequency;
  modulation.duty = duty;
  return modulation;
}

inline vpLampMap mapOf(const std::vector<vpModulation> &signals, double ppm)
{
  vpLampMap map;
  for (const vpModulation &signal : signals) {
    vpLamp lamp;
    lamp.id = std::to_string(map.lamps.size());
    lamp.position = {static_cast<double>(map.lamps.size()), 0, 1.69};
    lamp.size = diameter;
    lamp.modulation = signal;
    lamp.oscillatorPpm = ppm;
    map.lamps.push_back(lamp);
  }
  return map;
}
} // namespace plannedLamps

#endif
