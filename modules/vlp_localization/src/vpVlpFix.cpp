/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_localization/vpVlpFix.h>

#include <limits>

#include <visp3/core/vpPixelMeterConversion.h>

BEGIN_VISP_NAMESPACE

namespace
{
Eigen::Vector2d rayThrough(const vpCameraParameters &camera, const Eigen::Vector2d &pixel)
{
  // A projection model that this ViSP does not convert leaves it as it is, and the solvers refuse it.
  Eigen::Vector2d ray = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  vpPixelMeterConversion::convertPoint(camera, pixel.x(), pixel.y(), ray.x(), ray.y());
  return ray;
}
} // namespace

vpLampSight vpLampSight::from(const vpLamp &lamp, const vpLampObservation &observation,
                              const vpCameraParameters &camera)
{
  vpLampSight sight;
  sight.id = lamp.id;
  sight.position = lamp.position;
  sight.positionSigma = lamp.positionSigma;
  sight.ray = rayThrough(camera, observation.point);

  const double step = 0.1; // px: far below any curvature of a lens, far above rounding
  Eigen::Matrix2d byPixel; // every projection model of ViSP alike: by central differences
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d shift = step * Eigen::Vector2d::Unit(axis);
    byPixel.col(axis) =
        (rayThrough(camera, observation.point + shift) - rayThrough(camera, observation.point - shift)) /
        (2 * step);
  }
  sight.covariance = byPixel * observation.covariance * byPixel.transpose();
  return sight;
}

END_VISP_NAMESPACE
