/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampGeometry_h
#define vpLampGeometry_h

/*!
  \file vpLampGeometry.h
  What the solvers share: the ray that a pose predicts for a lamp, its derivatives, the covariances of lamps
  and mount, and the closed form of two lamps. Private to the module.
*/

#include <complex>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_localization/vpVlpFix.h>

BEGIN_VISP_NAMESPACE

using vpMatrix6d = Eigen::Matrix<double, 6, 6>;
using vpMatrix26d = Eigen::Matrix<double, 2, 6>;

//! Pose of the robot base in the map.
struct vpBasePose {
  Eigen::Matrix3d wRb = Eigen::Matrix3d::Identity();
  Eigen::Vector3d wtb = Eigen::Vector3d::Zero(); // m

  //! The base's up direction, z of w, in b.
  Eigen::Vector3d bUp() const { return wRb.row(2).transpose(); }
  //! Angle between z of b and z of w, rad.
  double tilt() const;
  //! Moved by \e step: translation (m) and rotations about the fixed axes of w (rad).
  vpBasePose moved(const Eigen::Matrix<double, 6, 1> &step) const;
  //! The step that moved() takes to \e pose.
  Eigen::Matrix<double, 6, 1> stepTo(const vpBasePose &pose) const;
  vpHomogeneousMatrix wMb() const;
  static vpBasePose of(const vpHomogeneousMatrix &wMb);
};

//! The mount of a rig, and what its lens may be off by, in Eigen's terms.
struct vpMountFrame {
  explicit vpMountFrame(const vpVlpRig &rig);

  Eigen::Matrix3d bRc;
  Eigen::Vector3d btc;              // m
  Eigen::Vector3d translationSigma; // m
  Eigen::Vector3d rotationSigma;    // rad
  double principalPointSigma;       // normalised units; 0 where the rig states none
  double focalLengthSigma;          // share, likewise

  bool tiltStated() const { return rotationSigma.x() > 0 || rotationSigma.y() > 0; }
  bool lensStated() const { return principalPointSigma > 0 || focalLengthSigma > 0; }
};

/*!
  The measurement equation: ray = projection of bRc^T (wRb^T (P - wtb) - btc). Its derivative is taken by
  the translation of the base and by small rotations of it about the fixed axes of w, with the camera rigid
  on it; that by the lamp's position P is minus the one by the translation.
*/
struct vpPredictedRay {
  bool inFront = false; // of the camera; else the rest is not set
  Eigen::Vector2d ray = Eigen::Vector2d::Zero();
  vpMatrix26d derivative = vpMatrix26d::Zero();
};

vpPredictedRay predictRay(const Eigen::Vector3d &lamp, const vpBasePose &pose, const vpMountFrame &mount);

//! Covariance of measured minus predicted ray: the image point's and the lamp position's, by the derivative
//! above.
Eigen::Matrix2d rayCovariance(const vpLampSight &lamp, const vpPredictedRay &predicted);

//! Covariance of the camera's tilt on a level base about x and y of w, rad^2: the rig's roll and pitch sigma
//! turned by the yaw.
Eigen::Matrix2d tiltCovariance(const vpBasePose &pose, const vpMountFrame &mount);

//! Derivative of rays by that tilt, about the camera's own centre. \param byBase By the base, 2n x 6, columns
//! as of vpPredictedRay. \return 2n x 2.
Eigen::MatrixXd byCameraTilt(const Eigen::Matrix<double, Eigen::Dynamic, 6> &byBase, const vpBasePose &pose,
                             const vpMountFrame &mount);

//! Covariance of rays by the errors of principal point and focal length, which all share. \param rays 2n.
//! \return 2n x 2n.
Eigen::MatrixXd lensCovariance(const Eigen::VectorXd &rays, const vpMountFrame &mount);

/*!
  What the mount's translation and yaw add to the covariance of wMb = wMc bMc^-1: an error e of its yaw
  turns the base by -e about its z and moves it by e z x btc, one of its translation moves it by as much the
  other way.
*/
vpMatrix6d mountCovariance(const vpBasePose &pose, const vpMountFrame &mount);

/*!
  Covariance of wMb, without mountCovariance(), where roll and pitch were taken as level and x, y, z, yaw
  estimated.

  Implicit differentiation at the solution p = (x, y, z, yaw). With an error n of the rays, the lens's
  included, dP of the lamps' positions and a true tilt d (about x and y of w) of the camera that is taken as
  upright, the rays are h(p, P, d), and to first order

    true p - p = K (-n - (dh/dP) dP - (dh/dtilt) d),

  K being the inverse of J = dh/dp for two lamps and (J^T S^-1 J)^-1 J^T S^-1 for more. So cov(p) = K S K^T
  with

    S = cov(n) + dh/dP cov(P) dh/dP^T + dh/dtilt cov(d) dh/dtilt^T,

  cov(d), the covariance of roll and pitch, is the rig's, and cov(p, d) = -K (dh/dtilt) cov(d). Left out:
  what is of second order in the sigmas. In P and n this is small while the relative sigma of the height is;
  in the tilt it is height times tilt squared.

  \param K 4 x 2n. \param S 2n x 2n. \param byTilt dh/dtilt, 2n x 2. \param tilt cov(d), rad^2.
*/
vpMatrix6d levelCovariance(const Eigen::MatrixXd &K, const Eigen::MatrixXd &S, const Eigen::MatrixXd &byTilt,
                           const Eigen::Matrix2d &tilt);

//! A ray turned level and scaled to unit height, x + iy, in a frame that has the base's heading.
struct vpUprightRay {
  vpUprightRay(const Eigen::Vector2d &ray, const vpMountFrame &mount);

  bool aboveHorizon; // else the rest is not set
  std::complex<double> value;
  Eigen::Matrix2d byRay; // derivative
};

//! Two lamps seen from a level base.
struct vpLampPair {
  std::complex<double> step;    // from the first lamp to the second in the map, m
  double rise;                  // m, height of the second lamp above the first
  std::complex<double> rays[2]; // upright

  /*!
    Heights H of the first lamp above the camera, m, with both lamps above it: the roots of
    |step|^2 = |H (q2 - q1) + rise q2|^2. None, one or two. The rays must differ.
    \param disagree Set where the equation has no real root: no height fits both map and picture.
  */
  std::vector<double> heights(bool &disagree) const;

  //! Heading of the base that sees the first lamp at height \e H above the camera, rad.
  double heading(double H) const { return std::arg(step / (H * (rays[1] - rays[0]) + rise * rays[1])); }
};

//! Why the lamps cannot be used together, in one line: a value that is none, an id given twice. Empty where
//! they can.
std::string sightProblem(const std::vector<vpLampSight> &lamps);

//! An angle (rad) in words.
std::string degrees(double angle);

//! Why so few lamps give no position.
std::string tooFewLamps(size_t seen);

//! A fix that is none.
vpVlpFix refusedFix(const std::string &refusal);

//! Sets pose, lamps and residuals of a valid fix. False where a lamp is not in front of the camera.
bool describeFix(vpVlpFix &fix, const std::vector<vpLampSight> &lamps, const vpBasePose &pose,
                 const vpVlpRig &rig);

END_VISP_NAMESPACE

#endif
