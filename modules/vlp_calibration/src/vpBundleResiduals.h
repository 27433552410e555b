/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpBundleResiduals_h
#define vpBundleResiduals_h

/*!
  \file vpBundleResiduals.h
  The residuals of vpLampBundle, for Ceres' automatic derivatives. Parameter blocks: the step of the rig (as
  vpRigParameter), the odometry's errors (as vpOdometryError), position (m) and heading (rad) of the base,
  position of a lamp (m). All residuals are in standard deviations, times a \e weight that is shared by all of
  a kind and changes between solutions.
*/

#include <ceres/rotation.h>
#include <visp3/vlp_calibration/vpLampRun.h>
#include <visp3/vlp_calibration/vpRigParameters.h>
#include <visp3/vlp_core/vpPoseText.h>

#include "vpOdometryPath.h"
#include "vpPixelRay.h"

BEGIN_VISP_NAMESPACE

//! The step that the base truly made where its odometry says \e step: x, y (m) and turn (rad).
template <typename T>
Eigen::Matrix<T, 3, 1> vpTrueStep(const vpPlanarStep &step, const T *odometry)
{
  // Of all of it only the first order, step by step small: the drift is along the chord of the way.
  const T more = odometry[2] * T(step.turn) + odometry[3] * T(step.along) + odometry[4] * T(step.dt); // rad
  const T half = T(0.5) * more, length = T(1.0) + odometry[0], drift = odometry[1] * T(step.turn);
  const double c = std::cos(0.5 * step.turn), s = std::sin(0.5 * step.turn);
  return {length * (T(step.x) - half * T(step.y)) + drift * T(c),
          length * (half * T(step.x) + T(step.y)) + drift * T(s), T(step.turn) + more};
}

//! A lamp's image point against its prediction.
struct vpImageResidual {
  const vpVlpRig *rig;
  vpLampImage image;
  vpPlanarStep since;        // from the view's pose to the image's own time
  Eigen::Matrix2d whitening; // 1/px
  Eigen::Matrix3d cRb;       // of the rig as given
  Eigen::Vector3d btc;       // m, likewise
  const double *weight;

  vpImageResidual(const vpVlpRig &rigGiven, const vpLampImage &seen, const vpPlanarStep &motion,
                  const double &weightOfAll)
      : rig(&rigGiven), image(seen), since(motion), weight(&weightOfAll)
  {
    const Eigen::LLT<Eigen::Matrix2d> root(image.covariance.inverse().eval());
    whitening = root.matrixU();
    cRb = vpQuaternionOf(rig->bMc).conjugate().toRotationMatrix();
    btc = Eigen::Vector3d(rig->bMc[0][3], rig->bMc[1][3], rig->bMc[2][3]);
  }

  //! Measured minus predicted, px of the picture's middle.
  template <typename T>
  Eigen::Matrix<T, 2, 1> pixels(const T *step, const T *odometry, const T *position, const T *heading,
                                const T *lamp) const
  {
    using std::cos;
    using std::sin;
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Eigen::Matrix<T, 3, 1> moved = vpTrueStep(since, odometry);
    const T c0 = cos(heading[0]), s0 = sin(heading[0]);
    const T x = lamp[0] - position[0] - (c0 * moved(0) - s0 * moved(1)),
            y = lamp[1] - position[1] - (s0 * moved(0) + c0 * moved(1));
    const T yaw = heading[0] + moved(2), c = cos(yaw), s = sin(yaw);
    Vector b(c * x + s * y - T(btc(0)) - step[0], -s * x + c * y - T(btc(1)) - step[1],
             lamp[2] - T(btc(2)) - step[2]);
    const T back[3] = {-step[3], -step[4], -step[5]};
    Vector upright;
    ceres::AngleAxisRotatePoint(back, b.data(), upright.data());
    const Vector inCamera = cRb.cast<T>() * upright;
    const Eigen::Matrix<T, 2, 1> ray = vpPixelRay(rig->camera, image.point, step[6], step[7], step[8]);
    // In pixels of the camera that is looked for: in those of the one given, a longer lens would make errors
    // smaller.
    const T longer = T(1.0) + step[8];
    return {T(rig->camera.get_px()) * longer * (ray(0) - inCamera(0) / inCamera(2)),
            T(rig->camera.get_py()) * longer * (ray(1) - inCamera(1) / inCamera(2))};
  }

  template <typename T>
  bool operator()(const T *step, const T *odometry, const T *position, const T *heading, const T *lamp,
                  T *residual) const
  {
    Eigen::Map<Eigen::Matrix<T, 2, 1>> r(residual);
    r = T(*weight) * (whitening.cast<T>() * pixels(step, odometry, position, heading, lamp));
    return true;
  }
};

//! The step from one view's pose to the next against the odometry's: along the base, sideways, turn.
struct vpStepResidual {
  vpPlanarStep step;
  Eigen::Vector3d sigma; // m, m, rad
  const Eigen::Vector3d *weight;

  template <typename T>
  bool operator()(const T *odometry, const T *position0, const T *heading0, const T *position1,
                  const T *heading1, T *residual) const
  {
    using std::cos;
    using std::sin;
    const Eigen::Matrix<T, 3, 1> expected = vpTrueStep(step, odometry);
    // In the frame that has turned half way: there the way of a base that rolls is straight ahead.
    const T half = heading0[0] + T(0.5) * expected(2);
    const T c = cos(half), s = sin(half), ch = cos(T(0.5) * expected(2)), sh = sin(T(0.5) * expected(2));
    const T x = position1[0] - position0[0], y = position1[1] - position0[1];
    residual[0] = T((*weight)(0) / sigma(0)) * (c * x + s * y - (ch * expected(0) + sh * expected(1)));
    residual[1] = T((*weight)(1) / sigma(1)) * (-s * x + c * y - (-sh * expected(0) + ch * expected(1)));
    residual[2] = T((*weight)(2) / sigma(2)) * (heading1[0] - heading0[0] - expected(2));
    return true;
  }
};

//! Without odometry: a base that rolls goes where it heads half way through its turn.
struct vpRollingResidual {
  double sigma; // m
  const Eigen::Vector3d *weight;

  template <typename T>
  bool operator()(const T *position0, const T *heading0, const T *position1, const T *heading1,
                  T *residual) const
  {
    using std::cos;
    using std::sin;
    const T half = T(0.5) * (heading0[0] + heading1[0]);
    residual[0] = T((*weight)(1) / sigma) *
                  (-sin(half) * (position1[0] - position0[0]) + cos(half) * (position1[1] - position0[1]));
    return true;
  }
};

//! A pose that is known.
struct vpPlaceResidual {
  vpPlanarPose place;
  double placeSigma, headingSigma; // m, rad

  template <typename T>
  bool operator()(const T *position, const T *heading, T *residual) const
  {
    residual[0] = (position[0] - T(place(0))) / T(placeSigma);
    residual[1] = (position[1] - T(place(1))) / T(placeSigma);
    residual[2] = (heading[0] - T(place(2))) / T(headingSigma);
    return true;
  }
};

//! Values about which a block lies: a prior. A sigma of 0 or infinity: none on that one.
template <int N>
struct vpPriorResidual {
  Eigen::Matrix<double, N, 1> mean, sigma;

  template <typename T>
  bool operator()(const T *block, T *residual) const
  {
    for (int i = 0; i < N; ++i) {
      const bool none = !(sigma(i) > 0) || std::isinf(sigma(i));
      residual[i] = none ? T(0.0) : (block[i] - T(mean(i))) / T(sigma(i));
    }
    return true;
  }
};

//! What one difference of the wheels' radii does to a turn and to a straight line, as of vpOdometryError.
struct vpWheelsResidual {
  double separation; // m

  template <typename T>
  bool operator()(const T *odometry, T *residual) const
  {
    static const double exact = 1e-6; // m/rad
    residual[0] = (odometry[1] - T(0.25 * separation * separation) * odometry[3]) / T(exact);
    return true;
  }
};

//! A distance between two lamps, and the direction that the map has from one to the other.
struct vpDistanceResidual {
  double metres, sigma;
  Eigen::Vector2d direction; // in x and y, of unit length

  template <typename T>
  bool operator()(const T *from, const T *to, T *residual) const
  {
    using std::sqrt;
    static const double straight = 1e-6; // m: which way the map lies is a choice
    const T x = to[0] - from[0], y = to[1] - from[1], z = to[2] - from[2];
    residual[0] = (sqrt(x * x + y * y + z * z) - T(metres)) / T(sigma);
    residual[1] = (T(direction.x()) * y - T(direction.y()) * x) / T(straight);
    return true;
  }
};

END_VISP_NAMESPACE

#endif
