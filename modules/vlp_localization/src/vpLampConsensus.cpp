/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampConsensus.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <Eigen/LU>
#include <unsupported/Eigen/SpecialFunctions>
#include <visp3/vlp_core/vpNumberText.h>

#include "vpLampFrame.h"
#include "vpLampPicture.h"

BEGIN_VISP_NAMESPACE

namespace
{
//! Probability that a chi-square of \e degrees of freedom exceeds \e x.
double chiSquareTail(double x, int degrees)
{
  return degrees > 0 ? Eigen::numext::igammac(0.5 * degrees, 0.5 * x) : 1;
}

bool has(const vpVlpFix &fix, const std::string &id)
{
  return std::find(fix.lamps.begin(), fix.lamps.end(), id) != fix.lamps.end();
}
} // namespace

vpLampConsensus::vpLampConsensus(std::vector<const vpLamp *> lamps, const vpVlpRig &rig,
                                 const std::vector<vpLampObservation> &observations, double mapTolerance,
                                 double outlierLikelihood)
    : m_lamps(std::move(lamps)), m_rig(rig), m_observations(observations), m_tolerance(mapTolerance),
      m_likelihood(outlierLikelihood)
{
  for (size_t i = 0; i < m_lamps.size(); ++i) {
    m_sights.push_back(m_lamps[i] == nullptr ? vpLampSight()
                                             : vpLampSight::from(*m_lamps[i], observations[i], rig.camera));
  }
}

void vpLampConsensus::usable(std::vector<vpLampObservation> &observations, std::vector<size_t> &which)
{
  // Two standard deviations of the middle lie within the lamp; how much such a lamp tells its covariance
  // says.
  static const double placed = 0.25; // share of the diameter
  which.clear();
  for (size_t i = 0; i < observations.size(); ++i) {
    vpLampObservation &lamp = observations[i];
    if (lamp.id.empty() && lamp.candidates.empty()) {
      continue;
    }
    const double sigma = std::sqrt(lamp.covariance.trace());
    if (lamp.outline.shape == vpLampOutline::Shape::region || !(sigma < placed * lamp.outline.diameter())) {
      lamp.remark =
          lamp.cut ? "cut by the picture's border: its middle is uncertain" : "its middle is uncertain";
    } else {
      which.push_back(i);
    }
  }
}

vpVlpFix vpLampConsensus::solve(const std::vector<size_t> &usable, const Solve &solver) const
{
  std::vector<size_t> known;
  std::copy_if(usable.begin(), usable.end(), std::back_inserter(known),
               [this](size_t i) { return m_lamps[i] != nullptr; });
  if (known.size() < poseLamps) {
    return refusedFix(tooFewLamps(known.size()));
  }
  Group group = solved(known, solver);
  // One of three could be any of them, and some few of many always agree by chance.
  const size_t fewestLeft = known.size() - known.size() / 4;
  while (group.fix.valid && !(chiSquareTail(misfit(group), group.fix.degreesOfFreedom) > m_likelihood)) {
    if (group.which.size() <= fewestLeft) {
      std::string ids;
      for (const std::string &id : group.fix.lamps) {
        ids += (ids.empty() ? "" : ", ") + id;
      }
      return refusedFix("lamps " + ids + " do not agree on one place");
    }
    const std::vector<Group> others = allButOne(group, solver);
    group = *std::min_element(others.begin(), others.end(),
                              [this](const Group &a, const Group &b) { return misfit(a) < misfit(b); });
  }
  vpVlpFix fix = withoutWrongSizes(withoutMisplaced(group, solver), solver).fix;
  if (fix.valid && fix.degreesOfFreedom > 0) {
    fix.covariance *= std::max(1.0, fix.chiSquare / fix.degreesOfFreedom);
  }
  return fix;
}

vpLampConsensus::Group vpLampConsensus::solved(const std::vector<size_t> &which, const Solve &solver) const
{
  std::vector<vpLampSight> sights;
  for (size_t i : which) {
    sights.push_back(m_sights[i]);
  }
  return {which, solver(sights)};
}

std::vector<vpLampConsensus::Group> vpLampConsensus::allButOne(const Group &all, const Solve &solver) const
{
  std::vector<Group> groups;
  for (size_t left = 0; left < all.which.size(); ++left) {
    std::vector<size_t> others = all.which;
    others.erase(others.begin() + static_cast<long>(left));
    groups.push_back(solved(others, solver));
  }
  return groups;
}

/*!
  Chi-square of a fix's residuals under the covariances of rays and the map's tolerance; infinite where there
  is no fix. The fix minimises another sum, so this is no less than the least there is.
*/
double vpLampConsensus::misfit(const Group &group) const
{
  if (!group.fix.valid) {
    return std::numeric_limits<double>::infinity();
  }
  const vpHomogeneousMatrix cMw = group.fix.wMc.inverse();
  double sum = 0;
  for (size_t k = 0; k < group.fix.lamps.size(); ++k) {
    const vpLampSight &sight = m_sights[*std::find_if(group.which.begin(), group.which.end(), [&](size_t i) {
      return m_sights[i].id == group.fix.lamps[k];
    })];
    const Eigen::Vector3d &place = sight.position;
    const double depth = cMw[2][0] * place.x() + cMw[2][1] * place.y() + cMw[2][2] * place.z() + cMw[2][3];
    const double sigma = std::max(sight.positionSigma, m_tolerance) / depth;
    const Eigen::Matrix2d covariance = sight.covariance + sigma * sigma * Eigen::Matrix2d::Identity();
    sum += group.fix.residuals[k].dot(covariance.inverse() * group.fix.residuals[k]);
  }
  return sum;
}

/*!
  Without the one lamp that is elsewhere than the map says, where that is as good as certain: under what map
  and pictures say of themselves, all lamps contradict each other, without that lamp they do not, and without
  any other they still do.
*/
vpLampConsensus::Group vpLampConsensus::withoutMisplaced(const Group &all, const Solve &solver) const
{
  static const double contradiction = 1e-6, agreement = 0.01; // probabilities
  static const int enough = 4; // degrees of freedom: of three lamps left, two bear the third out
  const auto likelihood = [](const Group &group) {
    return group.fix.valid ? chiSquareTail(group.fix.chiSquare, group.fix.degreesOfFreedom) : 0;
  };
  if (!all.fix.valid || all.fix.degreesOfFreedom < enough || likelihood(all) > contradiction) {
    return all;
  }
  std::vector<Group> groups = allButOne(all, solver);
  const auto end = std::remove_if(groups.begin(), groups.end(),
                                  [&](const Group &group) { return likelihood(group) <= contradiction; });
  const bool one = end - groups.begin() == 1 && likelihood(groups.front()) > agreement;
  return one ? groups.front() : all;
}

/*!
  Without lamps that look larger or smaller than the map's size makes them: what was taken for such a lamp may
  be something else, or its outline be spoilt. Where these are half of all lamps or more, the place may be
  what is wrong.
*/
vpLampConsensus::Group vpLampConsensus::withoutWrongSizes(const Group &all, const Solve &solver) const
{
  static const double tolerance =
      0.3;                        // of the size: the map may mean the housing, the picture shows the light
  static const double coarse = 3; // px
  Group group = all;
  while (group.fix.valid) {
    const vpBasePose wMb = vpBasePose::of(group.fix.wMb);
    std::string remark; // of the first one
    std::vector<size_t> right;
    for (size_t i : group.which) {
      const vpLampObservation &seen = m_observations[i];
      const double expected = vpLampPicture(*m_lamps[i], wMb, m_rig).diameter(),
                   found = seen.outline.diameter();
      if (!std::isfinite(m_lamps[i]->size) || seen.cut || !has(group.fix, seen.id) ||
          std::abs(found - expected) <= tolerance * expected + coarse) {
        right.push_back(i);
      } else if (remark.empty()) {
        remark = "lamp " + seen.id + " looks " + vpNumberText(std::round(found)) + " px large, expected " +
                 vpNumberText(std::round(expected)) + " px by its size in the map";
      }
    }
    if (right.size() == group.which.size()) {
      break;
    }
    group = 2 * right.size() > all.which.size() ? solved(right, solver) : Group{right, refusedFix(remark)};
  }
  return group;
}

void vpLampConsensus::explain(const vpVlpFix &fix, const std::vector<size_t> &usable,
                              std::vector<vpLampObservation> &observations)
{
  for (size_t i : usable) {
    vpLampObservation &lamp = observations[i];
    lamp.accepted = fix.valid && has(fix, lamp.id);
    if (!lamp.accepted) {
      lamp.remark = !fix.valid              ? fix.refusal
                    : fix.lamps.size() == 2 ? "not of the pair with the best geometry"
                                            : elsewhere;
    }
  }
}

END_VISP_NAMESPACE
