/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEmitterView_h
#define vpEmitterView_h

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/vlp_core/vpPixelEdge.h>

#include "vpEmissionMean.h"
#include "vpEmitter.h"
#include "vpSensorGrid.h"

BEGIN_VISP_NAMESPACE

//! An emitter seen from one pose of the camera.
class vpEmitterView
{
public:
  vpEmitterView(const vpEmitter &emitter, const vpHomogeneousMatrix &wMc);

  //! Coordinates in the emitter's plane (m) of what the ray sees of it. \return False where it sees nothing
  //! of that plane.
  bool at(const Eigen::Vector2d &ray, Eigen::Vector2d &inPlane) const
  {
    const Eigen::Vector3d r(ray.x(), ray.y(), 1);
    const double depth = m_height / m_normal.dot(r); // along the camera's z
    inPlane = m_foot + depth * Eigen::Vector2d(m_x.dot(r), m_y.dot(r));
    return depth > 0 && depth < farthest;
  }

  //! Whether the emitter shows the camera its bright side.
  bool visible() const { return m_visible; }

  //! cos of the angle between the ray and the emitter's normal.
  double cosine(const Eigen::Vector2d &ray) const
  {
    return std::abs(m_normal.dot(Eigen::Vector3d(ray.x(), ray.y(), 1))) / std::sqrt(ray.squaredNorm() + 1);
  }

  //! m, from the camera to a point of the emitter's plane.
  double distance(const Eigen::Vector2d &inPlane) const
  {
    return std::hypot((inPlane - m_foot).norm(), m_height);
  }

  //! Point of the emitter's plane, in the camera frame.
  Eigen::Vector3d inCamera(const Eigen::Vector2d &inPlane) const
  {
    return m_centre + inPlane.x() * m_x + inPlane.y() * m_y;
  }

private:
  static constexpr double farthest = 1e4; // m

  Eigen::Vector3d m_centre, m_x, m_y, m_normal; // in the camera frame
  Eigen::Vector2d m_foot;                       // the camera's place in the emitter's coordinates, m
  double m_height = 0;                          // m, of the emitter's plane along its normal
  bool m_visible = true;
};

/*!
  Share of a pixel's square that the blurred shape covers, times its own brightness there (1 in its middle).
  \e middle is the pixel's ray, \e inPlane what it sees.
*/
class vpEmitterShare
{
public:
  vpEmitterShare(const vpSensorGrid &grid, double blur)
      : m_grid(grid), m_blur(std::max(blur, sharpest)), m_mean(m_blur)
  {
  }

  //! px, from the edge, beyond which a pixel is covered wholly or not at all.
  double band() const { return 5 * m_blur + 1.5; }

  //! px^2, of blur and square in any direction.
  double variance() const { return m_blur * m_blur + 1.0 / 12; }

  double at(const vpEmitter &emitter, const vpEmitterView &view, const Eigen::Vector2d &pixel,
            const Eigen::Vector2d &inPlane) const;

  //! Mean brightness of the emission pattern, of what the pixel sees inside the outline.
  double emission(const vpEmitter &emitter, const vpEmitterView &view, const Eigen::Vector2d &pixel,
                  const Eigen::Vector2d &inPlane) const;

  //! m of the emitter's plane that a step of one pixel there is at most.
  double longestStep(const vpEmitterView &view, const Eigen::Vector2d &pixel) const;

private:
  static constexpr double sharpest = 0.02; // px of blur; nothing shows any less
  static constexpr double exact = 2;       // px of blur up to which the pixel's square is integrated as it is

  //! Plane coordinates seen half a pixel to either side, in u and v.
  struct Neighbours {
    Eigen::Vector2d right, left, down, up;

    //! Of the plane coordinates by u and v, m per pixel.
    Eigen::Matrix2d gradient() const { return (Eigen::Matrix2d() << right - left, down - up).finished(); }
  };
  Neighbours around(const vpEmitterView &view, const Eigen::Vector2d &pixel) const;
  vpPixelEdge acrossBend(double d, const Eigen::Vector2d &normal, double bend, double spread) const;
  double smallDisc(const vpEmitter &emitter, const Eigen::Vector2d &inPlane,
                   const Eigen::Matrix2d &gradient) const;
  double disc(const vpEmitter &emitter, const Eigen::Vector2d &inPlane, const Neighbours &near) const;
  double rectangle(const vpEmitter &emitter, const Eigen::Vector2d &inPlane, const Neighbours &near) const;

  const vpSensorGrid &m_grid;
  double m_blur;
  vpEmissionMean m_mean;
};

END_VISP_NAMESPACE

#endif
