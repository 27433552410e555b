/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpTransposed_h
#define vpTransposed_h

#include <cmath>
#include <utility>

#include <visp3/vlp_core/vpLampObservation.h>

BEGIN_VISP_NAMESPACE

//! An outline of samples and lines of a transposed picture as one of u and v, and the way back.
inline vpLampOutline vpTransposed(vpLampOutline outline)
{
  std::swap(outline.centre.x(), outline.centre.y());
  outline.angle = std::remainder(M_PI / 2 - outline.angle, M_PI);
  for (Eigen::Vector2d &corner : outline.corners) {
    std::swap(corner.x(), corner.y());
  }
  std::swap(outline.centreCovariance(0, 0), outline.centreCovariance(1, 1));
  return outline;
}

END_VISP_NAMESPACE

#endif
