/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpDispersion_h
#define vpDispersion_h

#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  How far points in the plane (m) lie apart, by two measures.

  The paper's dispersion circle (section 3.2.1) has the farthest distance of two points as its diameter. It
  need not hold all points. The smallest circle that does is between 1 and 2 / sqrt(3) times as large (Jung's
  theorem). One point, or none: all is 0.
*/
struct VISP_EXPORT vpDispersion {
  Eigen::Vector2d first = Eigen::Vector2d::Zero(), second = Eigen::Vector2d::Zero(); // the farthest pair
  Eigen::Vector2d centre = Eigen::Vector2d::Zero(); // of the smallest circle that holds all
  double circleRadius = 0;                          // of that circle

  double diameter() const { return (second - first).norm(); }
  double radius() const { return 0.5 * diameter(); } // the paper's dispersion radius

  /*!
    Both measures by way of the convex hull, in O(n log n): rotating calipers (Shamos 1978) and the randomised
    incremental circle (Welzl 1991), in double precision throughout.
    \throw vpException (badValue) where a coordinate is not finite.
  */
  static vpDispersion of(const std::vector<Eigen::Vector2d> &points);
};

END_VISP_NAMESPACE

#endif
