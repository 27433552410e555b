/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpPixelEdge.h>

#include <algorithm>
#include <cmath>

#include "vpNormalTable.h"

BEGIN_VISP_NAMESPACE

vpPixelEdge vpPixelEdge::at(double d, const Eigen::Vector2d &normal, double blur, double exactUpTo)
{
  static const double boxes = 1.0 / 12; // px^2, variance of both, whatever the normal
  const double spread = std::sqrt(blur * blur + boxes);
  if (blur > exactUpTo || std::abs(d) > 1 + 4 * spread) {
    const double z = -d / spread;
    const vpNormalTable::Value edge = vpNormalTable::at(z);
    return {edge.below, edge.density / spread, -z * edge.density * blur / (spread * spread)};
  }
  static const double narrowest = 0.02; // px; a narrower box would cancel digits and change nothing
  const double p = std::max(0.5 * std::abs(normal.x()), narrowest);
  const double q = std::max(0.5 * std::abs(normal.y()), narrowest);
  const double shift[4] = {p + q, p - q, q - p, -p - q};
  static const double sign[4] = {1, -1, -1, 1};
  vpPixelEdge edge{0, 0, 0};
  for (int i = 0; i < 4; ++i) {
    const double z = (shift[i] - d) / blur;
    const vpNormalTable::Value corner = vpNormalTable::at(z);
    const double once = z * corner.below + corner.density;
    edge.share += sign[i] * 0.5 * (z * once + corner.below);
    edge.byShift += sign[i] * once;
    edge.byBlur += sign[i] * corner.below;
  }
  const double area = 4 * p * q;
  edge.share *= blur * blur / area;
  edge.byShift *= blur / area;
  edge.byBlur *= blur / area; // heat equation: d/d blur = blur d^2/d shift^2
  return edge;
}

END_VISP_NAMESPACE
