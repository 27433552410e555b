/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_simulation/vpSimulatedScene.h>

#include <cmath>

#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

vpSimulatedLamp vpSimulatedLamp::image(const Eigen::Vector3d &shift, double share, double extraBlur,
                                       bool mirrored) const
{
  vpSimulatedLamp seen = *this;
  seen.lamp.position += shift;
  seen.level *= share;
  seen.blur = std::hypot(blur, extraBlur);
  seen.glows = false;
  if (mirrored) {
    const double away = shift.head<2>().norm(); // m, the mirror's normal
    if (!(away > 0)) {
      throw vpException(vpException::badValue, "image of lamp " + lamp.id +
                                                   ": mirrored and straight above or below it, expected a "
                                                   "shift in x or y");
    }
    // The mirror turns the x axis, and y with it to the wrong side of x: there the pattern is flipped.
    const double mirror = std::atan2(shift.y(), shift.x());
    seen.lamp.yaw = 2 * mirror + M_PI - lamp.yaw;
    seen.emission = emission.mirrored();
  }
  return seen;
}

Eigen::Vector2d vpSimulatedPerson::at(double time) const
{
  if (path.empty()) {
    throw vpException(vpException::badValue, "person: no path, expected one step or more");
  }
  if (time <= path.front().time) {
    return path.front().position;
  }
  for (size_t k = 1; k < path.size(); ++k) {
    const Step &from = path[k - 1], &to = path[k];
    if (time <= to.time) {
      const double way = to.time > from.time ? (time - from.time) / (to.time - from.time) : 1;
      return from.position + way * (to.position - from.position);
    }
  }
  return path.back().position;
}

END_VISP_NAMESPACE
