/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include <algorithm>

#include "vpLampConsensus.h"

BEGIN_VISP_NAMESPACE

vpVlpLocalizer::vpVlpLocalizer(const vpVlpRig &rig, const vpLampMap &map)
    : detector(rig, map), m_rig(rig), m_map(map)
{
}

vpVlpLocation vpVlpLocalizer::process(const vpVlpFrame &frame)
{
  vpVlpLocation location;
  location.timestamp = frame.timestamp;

  // Sections 2.1.1 and 2.1.2: LED-ROI, outline, stripe features and LED-ID of every lamp-like region.
  detector.detect(frame.I);
  location.observations = detector.observations();

  // Lamps whose id and place in the picture can be relied on.
  const std::vector<size_t> usable = vpLampConsensus::usable(location.observations);

  // Section 2.1.3: the pose from the rays to these lamps, two of them or all that agree with each other.
  const vpLampConsensus consensus(m_map, m_rig, location.observations, mapTolerance, outlierLikelihood);
  location.fix = consensus.solve(usable, [this](const std::vector<vpLampSight> &lamps) {
    return solver == Solver::two ? twoLamps.solveBestPair(lamps, m_rig) : manyLamps.solve(lamps, m_rig);
  });

  // Who counted, and why the others did not.
  vpLampConsensus::explain(location.fix, usable, location.observations);
  return location;
}

END_VISP_NAMESPACE
