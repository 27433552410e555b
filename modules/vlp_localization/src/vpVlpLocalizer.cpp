/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include <algorithm>
#include <cmath>

#include "vpLampConsensus.h"
#include "vpLampNames.h"

BEGIN_VISP_NAMESPACE

vpVlpLocalizer::vpVlpLocalizer(const vpVlpRig &rig, const vpLampMap &map)
    : detector(rig, map), matcher(rig, map), m_rig(rig), m_map(map)
{
  for (size_t i = 0; i < map.lamps.size(); ++i) {
    m_lampOf.emplace(map.lamps[i].id, i);
  }
}

vpVlpLocation vpVlpLocalizer::process(const vpVlpFrame &frame)
{
  vpVlpLocation location;
  location.timestamp = frame.timestamp;

  // Sections 2.1.1 and 2.1.2: LED-ROI, outline, stripe features and LED-ID of every lamp-like region.
  detector.detect(frame.I);
  location.observations = detector.observations();

  // Lamps whose place in the picture can be relied on, and whose id can, once places have told apart what
  // stripes do not: lamps that share an identifier, a lamp and its reflection.
  std::vector<size_t> usable = vpLampConsensus::usable(location.observations);
  std::string doubt;
  if (!namedApart(location.observations, usable)) {
    const vpLampMatch match = matchByPlace(location.observations, usable, frame.timestamp);
    nameByPlace(match, m_map, location.observations, usable);
    doubt = match.refusal;
  }

  // Section 2.1.3: the pose from the rays to these lamps, two of them or all that agree with each other.
  const vpLampConsensus consensus(lampsOf(location.observations), m_rig, location.observations, mapTolerance,
                                  outlierLikelihood);
  location.fix = consensus.solve(usable, [this](const std::vector<vpLampSight> &lamps) {
    return solver == Solver::two ? twoLamps.solveBestPair(lamps, m_rig) : manyLamps.solve(lamps, m_rig);
  });
  if (usable.size() < 2 && !doubt.empty()) {
    location.fix.refusal = doubt;
  }

  // Who counted, and why the others did not.
  vpLampConsensus::explain(location.fix, usable, location.observations);
  if (location.fix.valid && !location.fix.ambiguous) {
    m_lastPose = {location.fix.wMb, frame.timestamp};
  }
  return location;
}

std::vector<const vpLamp *> vpVlpLocalizer::lampsOf(const std::vector<vpLampObservation> &observations) const
{
  std::vector<const vpLamp *> lamps;
  for (const vpLampObservation &observation : observations) {
    const auto found = m_lampOf.find(observation.id);
    lamps.push_back(found == m_lampOf.end() ? nullptr : &m_map.lamps[found->second]);
  }
  return lamps;
}

vpLampMatch vpVlpLocalizer::matchByPlace(const std::vector<vpLampObservation> &observations,
                                         const std::vector<size_t> &usable, double time) const
{
  if (manyLamps.attitude == vpManyLampSolver::Attitude::free && solver == Solver::all) {
    vpLampMatch match;
    match.refusal = "lamps that blink alike are told apart by the attitude of the mount only, and it is free";
    return match;
  }
  std::optional<vpPoseHint> hint;
  if (m_lastPose) {
    const double since = std::abs(time - m_lastPose->time);
    hint = vpPoseHint{m_lastPose->wMb, hintReach + maxSpeed * since, hintTurn + maxTurnRate * since};
  }
  return matcher.match(observations, usable, hint);
}

END_VISP_NAMESPACE
