/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEmitter_h
#define vpEmitter_h

#include <cmath>

#include <Eigen/Core>
#include <visp3/vlp_simulation/vpSimulatedScene.h>

BEGIN_VISP_NAMESPACE

//! A flat shape that shines: a lamp or a window.
struct vpEmitter {
  Eigen::Vector3d centre;
  Eigen::Vector3d x, y;        // unit vectors in its plane
  double halfX = 0, halfY = 0; // m; of a disc its radius
  bool disc = true;
  bool lamp = true;    // shines downwards only; scatters in the lens
  bool glows = true;   // on the ceiling, as a lamp does
  double level = 0;    // grey value
  double blur = 0;     // px, on top of the lens's
  double rim = 0;      // share
  double exponent = 0; // m - 1 of a light that falls with cos^m off its axis
  const vpLampLight *light = nullptr;
  const vpEmission *emission = nullptr; // none: even

  explicit vpEmitter(const vpSimulatedLamp &lamp);
  explicit vpEmitter(const vpSimulatedWindow &window);

  //! Of a point of its plane (m), with the outline at 1.
  Eigen::Vector2d place(const Eigen::Vector2d &inPlane) const
  {
    return {inPlane.x() / halfX, inPlane.y() / halfY};
  }

  //! Whether a place is inside the outline.
  bool covers(const Eigen::Vector2d &place) const
  {
    return disc ? place.squaredNorm() <= 1 : place.cwiseAbs().maxCoeff() <= 1;
  }

  double reach() const { return disc ? halfX : std::hypot(halfX, halfY); }
};

END_VISP_NAMESPACE

#endif
