/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPixelRay_h
#define vpPixelRay_h

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <visp3/core/vpCameraParameters.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

/*!
  \file vpPixelRay.h
  vpPixelMeterConversion for numbers that carry derivatives (ceres::Jet): ViSP's own takes doubles only.
*/

BEGIN_VISP_NAMESPACE

//! Angle off the axis of a Kannala-Brandt camera, by Newton's method, from where its image lies.
template <typename T>
T vpKannalaBrandtAngle(const T &distorted, const std::vector<double> &k)
{
  static const int steps = 10; // it converges in four
  T angle = distorted;
  for (int i = 0; i < steps; ++i) {
    const T s = angle * angle;
    T value(0), slope(0);
    for (size_t n = std::min<size_t>(k.size(), 4); n-- > 0;) { // of ViSP's five coefficients four count
      value = s * (value + T(k[n]));
      slope = s * (slope + T((2.0 * static_cast<double>(n) + 3.0) * k[n]));
    }
    angle = angle - (angle * (T(1.0) + value) - distorted) / (T(1.0) + slope);
  }
  return angle;
}

/*!
  Ray (normalised coordinates, without distortion) of the pixel (u, v) of \e camera with its principal point
  moved by du, dv (px) and its focal length longer by the share df.
*/
template <typename T>
Eigen::Matrix<T, 2, 1> vpPixelRay(const vpCameraParameters &camera, const Eigen::Vector2d &pixel, const T &du,
                                  const T &dv, const T &df)
{
  using std::sqrt;
  using std::tan;
  Eigen::Matrix<T, 2, 1> ray((T(pixel.x() - camera.get_u0()) - du) / (T(camera.get_px()) * (T(1.0) + df)),
                             (T(pixel.y() - camera.get_v0()) - dv) / (T(camera.get_py()) * (T(1.0) + df)));
  const T squared = ray.squaredNorm();
  if (camera.get_projModel() == vpCameraParameters::perspectiveProjWithDistortion) {
    ray *= T(1.0) + T(camera.get_kdu()) * squared;
  } else if (camera.get_projModel() == vpCameraParameters::ProjWithKannalaBrandtDistortion &&
             squared > T(1e-16)) {
    const T distorted = sqrt(squared);
    ray *= tan(vpKannalaBrandtAngle(distorted, camera.getKannalaBrandtDistortionCoefficients())) / distorted;
  }
  return ray;
}

END_VISP_NAMESPACE

#endif
