/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCameraModel_h
#define vpCameraModel_h

#include <cmath>

#include <Eigen/Core>
#include <visp3/vlp_calibration/vpCameraCalibration.h>

BEGIN_VISP_NAMESPACE

//! Number of parameters of each model: px, py, u0, v0 and the distortion's.
constexpr int vpParametersOf(vpCameraCalibration::Model model)
{
  switch (model) {
  case vpCameraCalibration::Model::perspective:
    return 4;
  case vpCameraCalibration::Model::visp:
    return 5;
  case vpCameraCalibration::Model::kannalaBrandt:
    return 8;
  case vpCameraCalibration::Model::opencv:
    return 9;
  }
  return 0;
}

//! Pixel of the ray (x, y, 1), for numbers that carry derivatives, too.
template <vpCameraCalibration::Model model, typename T>
Eigen::Matrix<T, 2, 1> vpPixelOf(const T *p, const T &x, const T &y)
{
  using Model = vpCameraCalibration::Model;
  using std::atan;
  using std::sqrt;
  const T squared = x * x + y * y;
  T dx = x, dy = y;
  if constexpr (model == Model::visp) {
    dx = x * (T(1.0) + p[4] * squared);
    dy = y * (T(1.0) + p[4] * squared);
  } else if constexpr (model == Model::kannalaBrandt) {
    if (squared > T(1e-16)) {
      const T r = sqrt(squared), angle = atan(r), s = angle * angle;
      const T share = angle * (T(1.0) + s * (p[4] + s * (p[5] + s * (p[6] + s * p[7])))) / r;
      dx = x * share;
      dy = y * share;
    }
  } else if constexpr (model == Model::opencv) {
    const T radial = T(1.0) + squared * (p[4] + squared * (p[5] + squared * p[8]));
    dx = x * radial + T(2.0) * p[6] * x * y + p[7] * (squared + T(2.0) * x * x);
    dy = y * radial + p[6] * (squared + T(2.0) * y * y) + T(2.0) * p[7] * x * y;
  }
  return {p[2] + p[0] * dx, p[3] + p[1] * dy};
}

END_VISP_NAMESPACE

#endif
