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
  slip of the left and the right wheel over a step (share of their ways), errors of speed (m/s) and turn rate
  (rad/s) within a frame, position of a lamp (m). All residuals are in standard deviations, times a \e weight
  that is shared by all of a kind and changes between solutions.
*/

#include <ceres/rotation.h>
#include <visp3/vlp_calibration/vpLampRun.h>
#include <visp3/vlp_calibration/vpRigParameters.h>
#include <visp3/vlp_core/vpPoseText.h>

#include "vpOdometryPath.h"
#include "vpPixelRay.h"

BEGIN_VISP_NAMESPACE

//! m, what the left and the right wheel roll over a step. \param separation m, of the wheels; 0: unknown.
inline Eigen::Vector2d vpRolled(const vpPlanarStep &step, double separation)
{
  const double half = 0.5 * separation * step.turn;
  return {step.along - half, step.along + half};
}

//! m straight on and rad that a step goes beside the odometry's where wheels slip. \param separation m, of
//! the wheels; 0: their slip tells nothing of the turn.
template <typename T>
Eigen::Matrix<T, 2, 1> vpBySlip(const vpPlanarStep &step, double separation, const T *slip)
{
  const Eigen::Vector2d ways = vpRolled(step, separation);
  const T left = slip[0] * T(ways(0)), right = slip[1] * T(ways(1));
  return {T(-0.5) * (left + right), separation > 0 ? (left - right) / T(separation) : T(0.0)};
}

//! The step that the base truly made where its odometry says \e step: x, y (m) and turn (rad).
//! \param more What it went on straight (m) and turned (rad) beside.
template <typename T>
Eigen::Matrix<T, 3, 1> vpTrueStep(const vpPlanarStep &step, const T *odometry,
                                  const Eigen::Matrix<T, 2, 1> &more)
{
  // Of all of it only the first order, step by step small: the drift is along the chord of the way.
  const T turned =
      odometry[2] * T(step.turn) + odometry[3] * T(step.along) + odometry[4] * T(step.dt) + more(1); // rad
  const T half = T(0.5) * turned, length = T(1.0) + odometry[0],
          drift = odometry[1] * T(step.turn) + more(0); // m
  const double c = std::cos(0.5 * step.turn), s = std::sin(0.5 * step.turn);
  return {length * (T(step.x) - half * T(step.y)) + drift * T(c),
          length * (half * T(step.x) + T(step.y)) + drift * T(s), T(step.turn) + turned};
}

//! A lamp's image point against its prediction.
struct vpImageResidual {
  const vpVlpRig *rig;
  Eigen::Vector2d point;     // px
  vpPlanarStep since;        // from the view's pose to the image's own time
  double separation;         // m, of the wheels
  Eigen::Matrix2d whitening; // 1/px
  Eigen::Matrix3d cRb;       // of the rig as given
  Eigen::Vector3d btc;       // m, likewise
  const double *weight;

  vpImageResidual(const vpVlpRig &rigGiven, const Eigen::Vector2d &seen, const Eigen::Matrix2d &covariance,
                  const vpPlanarStep &motion, double separationOfWheels, const double &weightOfAll)
      : rig(&rigGiven), point(seen), since(motion), separation(separationOfWheels), weight(&weightOfAll)
  {
    const Eigen::LLT<Eigen::Matrix2d> root(covariance.inverse().eval());
    whitening = root.matrixU();
    cRb = vpQuaternionOf(rig->bMc).conjugate().toRotationMatrix();
    btc = Eigen::Vector3d(rig->bMc[0][3], rig->bMc[1][3], rig->bMc[2][3]);
  }

  //! Measured minus predicted, px of the picture's middle.
  template <typename T>
  Eigen::Matrix<T, 2, 1> pixels(const T *step, const T *odometry, const T *slip, const T *rates,
                                const T *position, const T *heading, const T *lamp) const
  {
    using std::cos;
    using std::sin;
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Eigen::Matrix<T, 3, 1> moved = vpTrueStep<T>(
        since, odometry,
        vpBySlip(since, separation, slip) + T(since.dt) * Eigen::Map<const Eigen::Matrix<T, 2, 1>>(rates));
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
    const Eigen::Matrix<T, 2, 1> ray = vpPixelRay(rig->camera, point, step[6], step[7], step[8]);
    // In pixels of the camera that is looked for: in those of the one given, a longer lens would make errors
    // smaller.
    const T longer = T(1.0) + step[8];
    return {T(rig->camera.get_px()) * longer * (ray(0) - inCamera(0) / inCamera(2)),
            T(rig->camera.get_py()) * longer * (ray(1) - inCamera(1) / inCamera(2))};
  }

  template <typename T>
  bool operator()(const T *step, const T *odometry, const T *slip, const T *rates, const T *position,
                  const T *heading, const T *lamp, T *residual) const
  {
    Eigen::Map<Eigen::Matrix<T, 2, 1>> r(residual);
    r = T(*weight) * (whitening.cast<T>() * pixels(step, odometry, slip, rates, position, heading, lamp));
    return true;
  }
};

//! Errors of speed and turn rate within a frame.
struct vpRatesResidual {
  Eigen::Vector2d sigma; // m/s, rad/s
  const double *weight;

  template <typename T>
  bool operator()(const T *rates, T *residual) const
  {
    residual[0] = T(*weight / sigma(0)) * rates[0];
    residual[1] = T(*weight / sigma(1)) * rates[1];
    return true;
  }
};

//! The step from one view's pose to the next against the odometry's: along the base, sideways, turn.
struct vpStepResidual {
  vpPlanarStep step;
  double separation;     // m, of the wheels
  Eigen::Vector3d sigma; // m, m, rad
  const Eigen::Vector3d *weight;

  template <typename T>
  bool operator()(const T *odometry, const T *slip, const T *position0, const T *heading0, const T *position1,
                  const T *heading1, T *residual) const
  {
    using std::cos;
    using std::sin;
    const Eigen::Matrix<T, 3, 1> expected = vpTrueStep<T>(step, odometry, vpBySlip(step, separation, slip));
    // In the frame that has turned half way: there the way of a base that rolls is straight ahead.
    const T half = T(0.5) * (heading0[0] + heading1[0]);
    const T c = cos(half), s = sin(half), ch = cos(T(0.5) * expected(2)), sh = sin(T(0.5) * expected(2));
    const T x = position1[0] - position0[0], y = position1[1] - position0[1];
    residual[0] = T((*weight)(0) / sigma(0)) * (c * x + s * y - (ch * expected(0) + sh * expected(1)));
    residual[1] = T((*weight)(1) / sigma(1)) * (-s * x + c * y - (-sh * expected(0) + ch * expected(1)));
    residual[2] = T((*weight)(2) / sigma(2)) * (heading1[0] - heading0[0] - expected(2));
    return true;
  }
};

//! Slip over the first step of a run, and from step to step: what is kept of it falls off exponentially with
//! the way of each wheel (a Gauss-Markov process).
struct vpSlipResidual {
  Eigen::Vector2d kept, sigma; // share; of what is new
  const double *weight;

  template <typename T>
  bool operator()(const T *before, const T *slip, T *residual) const
  {
    for (int i = 0; i < 2; ++i) {
      residual[i] = T(*weight / sigma(i)) * (slip[i] - T(kept(i)) * before[i]);
    }
    return true;
  }

  template <typename T>
  bool operator()(const T *slip, T *residual) const
  {
    const T none[2] = {T(0.0), T(0.0)};
    return (*this)(none, slip, residual);
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

//! What one difference of the wheels' radii does to a turn and to a straight line, as of vpOdometryError,
//! where the wheels are as far apart as speed and turn show.
struct vpWheelsResidual {
  double separation; // m, as the odometry takes it

  template <typename T>
  bool operator()(const T *odometry, T *residual) const
  {
    static const double exact = 1e-6;                                // m/rad
    const T apart = (T(1.0) + odometry[0]) / (T(1.0) + odometry[2]); // times the separation
    residual[0] = (odometry[1] - T(0.25 * separation * separation) * apart * odometry[3]) / T(exact);
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
