/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_simulation/vpSimulatedScene.h>

#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

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
