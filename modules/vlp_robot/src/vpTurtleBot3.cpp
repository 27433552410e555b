/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_robot/vpTurtleBot3.h>

#include <algorithm>
#include <cmath>
#include <limits>

BEGIN_VISP_NAMESPACE

namespace
{
//! The nearest whole number; ties towards zero, else half a count carried over would move a base told to
//! stand.
double nearest(double counts)
{
  return std::copysign(std::ceil(std::abs(counts) - 0.5), counts);
}
} // namespace

vpTurtleBot3::vpTurtleBot3(Model model)
    : wheelRadius(0.033), wheelSeparation(model == Model::burger ? 0.160 : 0.287),
      wheelSpeedLimit(model == Model::burger ? 265 * velocityUnit : 0.26 / 0.033)
{
}

vpWheels vpTurtleBot3::wheelSpeeds(const vpBaseVelocity &velocity) const
{
  const double turn = velocity.w * wheelSeparation / 2;
  return {(velocity.v - turn) / wheelRadius, (velocity.v + turn) / wheelRadius};
}

vpBaseVelocity vpTurtleBot3::velocity(const vpWheels &speeds) const
{
  return {wheelRadius * (speeds.right + speeds.left) / 2,
          wheelRadius * (speeds.right - speeds.left) / wheelSeparation};
}

vpBaseLimits vpTurtleBot3::limits() const
{
  const double rim = wheelRadius * wheelSpeedLimit;
  return {rim, rim / (wheelSeparation / 2)};
}

vpBaseVelocity vpVelocityRounding::next(const vpBaseVelocity &velocity)
{
  constexpr double counts = vpTurtleBot3::commandCounts;
  const vpBaseVelocity asked = m_limits.saturated(velocity);
  const vpBaseVelocity wanted{asked.v * counts + m_carry.v, asked.w * counts + m_carry.w};

  // Of the nearest steps and those towards zero, the closest pair within the limits. That of both towards
  // zero always is: it asks of the wheels no more than `asked` does.
  vpBaseVelocity best;
  double least = std::numeric_limits<double>::infinity();
  for (const double v : {nearest(wanted.v), std::trunc(asked.v * counts)}) {
    for (const double w : {nearest(wanted.w), std::trunc(asked.w * counts)}) {
      const double cost = m_limits.share({v - wanted.v, w - wanted.w});
      if (m_limits.share({v / counts, w / counts}) <= 1 + 1e-9 && cost < least) {
        best = {v, w};
        least = cost;
      }
    }
  }
  if (m_dither) {
    m_carry.v = std::clamp(wanted.v - best.v, -0.5, 0.5);
    m_carry.w = std::clamp(wanted.w - best.w, -0.5, 0.5);
  }
  return {best.v / counts, best.w / counts};
}

END_VISP_NAMESPACE
