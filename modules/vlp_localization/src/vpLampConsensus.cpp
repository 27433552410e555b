/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampConsensus.h"

#include <algorithm>
#include <cmath>
#include <sstream>

BEGIN_VISP_NAMESPACE

namespace
{

//! Probability that a chi-square of \e degrees of freedom exceeds \e x: Q(degrees / 2, x / 2) by its recurrence.
double chiSquareTail(double x, int degrees)
{
  if (degrees <= 0) {
    return 1;
  }
  const double h = 0.5 * x;
  const bool odd = degrees % 2 == 1;
  double tail = odd ? std::erfc(std::sqrt(h)) : std::exp(-h);
  double term = odd ? 2 * std::sqrt(h / M_PI) * std::exp(-h) : h * std::exp(-h);
  for (int k = odd ? 3 : 4; k <= degrees; k += 2) {
    tail += term;
    term *= h / (0.5 * k);
  }
  return tail;
}

std::string joined(const std::vector<std::string> &ids)
{
  std::string text;
  for (const std::string &id : ids) {
    text += (text.empty() ? "" : ", ") + id;
  }
  return text;
}

vpVlpFix refusal(const std::string &reason)
{
  vpVlpFix fix;
  fix.refusal = reason;
  return fix;
}

} // namespace

vpLampConsensus::vpLampConsensus(const vpLampMap &map, const vpVlpRig &rig,
                                 const std::vector<vpLampObservation> &observations, double mapTolerance,
                                 double outlierLikelihood)
    : m_map(map), m_rig(rig), m_observations(observations), m_tolerance(mapTolerance),
      m_likelihood(outlierLikelihood)
{
}

std::vector<size_t> vpLampConsensus::usable(std::vector<vpLampObservation> &observations)
{
  static const double placed = 0.1; // share of the diameter, standard deviation of the middle
  std::vector<size_t> which;
  for (size_t i = 0; i < observations.size(); ++i) {
    vpLampObservation &lamp = observations[i];
    if (lamp.id.empty()) {
      continue;
    }
    const auto twins = std::count_if(observations.begin(), observations.end(),
                                     [&](const vpLampObservation &other) { return other.id == lamp.id; });
    const double sigma = std::sqrt(lamp.covariance.trace());
    if (twins > 1) {
      lamp.remark = "seen " + std::to_string(twins) + " times: one of them is a reflection";
    } else if (lamp.outline.shape == vpLampOutline::Shape::region || !(sigma < placed * lamp.outline.diameter())) {
      lamp.remark = lamp.cut ? "cut by the picture's border: its middle is uncertain" : "its middle is uncertain";
    } else {
      which.push_back(i);
    }
  }
  return which;
}

std::vector<vpLampSight> vpLampConsensus::sights(const std::vector<size_t> &which, double leastPositionSigma) const
{
  std::vector<vpLampSight> lamps;
  for (size_t i : which) {
    const vpLamp &lamp = *m_map.find(m_observations[i].id);
    lamps.push_back(vpLampSight::from(lamp, m_observations[i], m_rig.camera));
    lamps.back().positionSigma = std::max(lamps.back().positionSigma, leastPositionSigma);
  }
  return lamps;
}

bool vpLampConsensus::agree(const vpVlpFix &fix) const
{
  return fix.valid && chiSquareTail(fix.chiSquare, fix.degreesOfFreedom) > m_likelihood && sizesFit(fix);
}

//! Whether lamps whose size the map states look about that large from where the fix puts the camera.
bool vpLampConsensus::sizesFit(const vpVlpFix &fix) const
{
  static const double tolerance = 0.3; // of the size: the map may mean the housing, the picture shows the light
  const vpHomogeneousMatrix cMw = fix.wMc.inverse();
  for (const vpLampObservation &seen : m_observations) {
    const vpLamp *lamp = m_map.find(seen.id);
    if (lamp == nullptr || !std::isfinite(lamp->size) || seen.cut ||
        std::find(fix.lamps.begin(), fix.lamps.end(), seen.id) == fix.lamps.end()) {
      continue;
    }
    const Eigen::Vector3d &p = lamp->position;
    const double depth = cMw[2][0] * p.x() + cMw[2][1] * p.y() + cMw[2][2] * p.z() + cMw[2][3];
    const double expected = m_rig.camera.get_px() * lamp->size / depth;
    static const double coarse = 3; // px
    if (std::abs(seen.outline.diameter() - expected) > tolerance * expected + coarse) {
      return false;
    }
  }
  return true;
}

vpVlpFix vpLampConsensus::solve(const std::vector<size_t> &usable, const Solve &solver) const
{
  static const size_t fewest = 2;
  if (usable.size() < fewest) {
    return refusal(usable.empty() ? "no lamp of the map seen"
                                  : "one lamp of the map seen, two are needed for a position");
  }
  std::vector<size_t> members = usable;
  vpVlpFix tolerant = solver(sights(members, m_tolerance));
  while (tolerant.valid && !agree(tolerant) && members.size() > 3) {
    // Without the one lamp that the others do best without.
    std::vector<size_t> best;
    vpVlpFix bestFix;
    for (size_t left = 0; left < members.size(); ++left) {
      std::vector<size_t> others = members;
      others.erase(others.begin() + static_cast<long>(left));
      const vpVlpFix fix = solver(sights(others, m_tolerance));
      if (fix.valid && (!bestFix.valid || fix.chiSquare < bestFix.chiSquare)) {
        best = others;
        bestFix = fix;
      }
    }
    if (!bestFix.valid) {
      break;
    }
    members = best;
    tolerant = bestFix;
  }
  if (!tolerant.valid) {
    return tolerant;
  }
  if (!agree(tolerant)) {
    return refusal("lamps " + joined(tolerant.lamps) + " do not agree on one place");
  }
  vpVlpFix fix = solver(sights(members, 0));
  if (!fix.valid) {
    return fix;
  }
  if (fix.degreesOfFreedom > 0) {
    fix.covariance *= std::max(1.0, fix.chiSquare / fix.degreesOfFreedom);
  }
  return fix;
}

void vpLampConsensus::explain(const vpVlpFix &fix, const std::vector<size_t> &usable,
                              std::vector<vpLampObservation> &observations)
{
  for (size_t i : usable) {
    vpLampObservation &lamp = observations[i];
    const bool member = std::find(fix.lamps.begin(), fix.lamps.end(), lamp.id) != fix.lamps.end();
    lamp.accepted = fix.valid && member;
    if (!lamp.accepted) {
      lamp.remark = fix.valid ? "not needed, or not where the other lamps expect it" : fix.refusal;
    }
  }
}

END_VISP_NAMESPACE
