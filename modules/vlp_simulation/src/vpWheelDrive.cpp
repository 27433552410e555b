/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpWheelDrive.h"

#include <cmath>

BEGIN_VISP_NAMESPACE

double vpWheelDrive::roll(double goal, double duration)
{
  const double missing = goal - m_reference;
  const double rampTime = std::abs(missing) / m_acceleration; // 0 where it is infinite
  const double slope = std::copysign(m_acceleration, missing);
  if (rampTime >= duration) {
    return ramp(slope, duration);
  }
  const double angle = rampTime > 0 ? ramp(slope, rampTime) : 0;
  m_reference = goal;
  return angle + ramp(0, duration - rampTime);
}

double vpWheelDrive::ramp(double slope, double duration)
{
  const double followed = (m_reference + slope * duration / 2) * duration; // the reference's own angle
  if (m_lag == 0) {
    m_reference += slope * duration;
    m_speed = m_reference;
    return followed;
  }
  const double offset = m_speed - m_reference + slope * m_lag;
  const double decayed = -std::expm1(-duration / m_lag);
  m_speed = m_reference + slope * (duration - m_lag) + offset * (1 - decayed);
  m_reference += slope * duration;
  if (std::abs(m_speed - m_reference) < 1e-15) {
    m_speed = m_reference; // a standing robot stands, and no denormal numbers slow its simulation down
  }
  return followed - slope * m_lag * duration + offset * m_lag * decayed;
}

END_VISP_NAMESPACE
