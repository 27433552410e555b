/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpExpectedAppearance.h"

#include <algorithm>
#include <cmath>

BEGIN_VISP_NAMESPACE

namespace
{
double across(const vpTargetCandidate &candidate)
{
  return candidate.moments.sigmaU / candidate.window.getWidth();
}

double down(const vpTargetCandidate &candidate)
{
  return candidate.moments.sigmaV / candidate.window.getHeight();
}

double extentOf(const vpTargetCandidate &candidate)
{
  return std::sqrt(across(candidate) * down(candidate));
}

double crowdOf(const vpTargetCandidate &candidate)
{
  return candidate.mass > 0 ? candidate.moments.mass / candidate.mass : 0;
}
} // namespace

void vpExpectedAppearance::RunningMean::add(double value, double rate)
{
  spread += rate * (std::abs(value - mean) - spread);
  mean += rate * (value - mean);
}

void vpExpectedAppearance::begin(const vpTargetCandidate &given)
{
  static const double spread = 0.01, least = 1e-3;
  m_coefficient = {1, spread};
  m_crowd = {std::max(crowdOf(given), least), spread};
  m_extent = {std::max(extentOf(given), least), spread / 3};
  m_firstAcross = across(given);
  m_firstDown = down(given);
}

double vpExpectedAppearance::plausibility(const vpTargetCandidate &candidate) const
{
  static const double whole = 0.98; // less of it visible: the picture ends, not the target
  const double likeness = (candidate.coefficient + m_coefficient.margin()) / m_coefficient.mean;
  const double extended = (extentOf(candidate) + m_extent.margin()) / m_extent.mean;
  const double crowded = (crowdOf(candidate) - m_crowd.margin()) / m_crowd.mean;
  return std::min(1.0, likeness) * (candidate.visible > whole ? std::min(1.0, extended) : 1.0) /
         std::max(1.0, crowded);
}

bool vpExpectedAppearance::asExpected(const vpTargetCandidate &candidate) const
{
  static const double enough = 0.98;
  return plausibility(candidate) >= enough;
}

double vpExpectedAppearance::growthAcross(const vpTargetCandidate &candidate) const
{
  return m_firstAcross > 0 && across(candidate) > 0 ? across(candidate) / m_firstAcross : 1;
}

double vpExpectedAppearance::growthDown(const vpTargetCandidate &candidate) const
{
  return m_firstDown > 0 && down(candidate) > 0 ? down(candidate) / m_firstDown : 1;
}

bool vpExpectedAppearance::changedAlike(const vpTargetCandidate &candidate) const
{
  static const double apart = 0.5; // as a share of their mean
  const double u = std::log(growthAcross(candidate)), v = std::log(growthDown(candidate));
  return u * v > 0 && std::abs(u - v) < apart * std::abs(u + v) / 2;
}

void vpExpectedAppearance::learn(const vpTargetCandidate &seen)
{
  static const double expected = 0.1, unexpected = 0.02; // a frame
  const double rate = asExpected(seen) ? expected : unexpected;
  m_coefficient.add(seen.coefficient, rate);
  m_crowd.add(crowdOf(seen), rate);
  m_extent.add(extentOf(seen), rate);
}

END_VISP_NAMESPACE
