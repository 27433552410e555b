/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_robot/vpMobileBase.h>

#include <cmath>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

double vpBaseLimits::share(const vpBaseVelocity &velocity) const
{
  return std::abs(velocity.v) / v + std::abs(velocity.w) / w;
}

vpBaseVelocity vpBaseLimits::saturated(const vpBaseVelocity &velocity) const
{
  const double taken = share(velocity);
  if (!std::isfinite(taken)) {
    throw vpException(vpException::badValue, "velocity: v " + vpNumberText(velocity.v) + " m/s, w " +
                                                 vpNumberText(velocity.w) +
                                                 " rad/s, expected finite numbers");
  }
  return taken > 1 ? vpBaseVelocity{velocity.v / taken, velocity.w / taken} : velocity;
}

END_VISP_NAMESPACE
