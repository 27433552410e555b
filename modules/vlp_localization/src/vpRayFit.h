/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpRayFit_h
#define vpRayFit_h

#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "vpLampGeometry.h"

BEGIN_VISP_NAMESPACE

/*!
  \file vpRayFit.h
  The least squares of vpManyLampSolver. Private to the module.

  Residuals are the rays measured minus predicted, stacked as r, with the covariance S of all that the
  estimate does not answer for; r^T S^-1 r is minimised.
  - Level (attitude of the mount): x, y, z, yaw are estimated. S holds the image points, the lamps'
    positions, the rig's roll and pitch sigma, which tilts all rays together and so ties them to each other,
    and its lens's.
  - Free: all six are estimated. S holds image points, lamps' positions and lens. Where the rig states a roll
  or pitch sigma, that angle's sine (a horizontal component of the base's up direction) is one more residual:
    base and camera lean as one.
  - Free, tilt held: the same sum, minimised over x, y, z, yaw with the tilt of the start: a point of its
    profile.
  To first order level and free weigh the rig's sigma alike, and their minima follow the same chi-square
  distribution.
*/
class vpRayFit
{
public:
  enum class Kind { level, free, freeTiltHeld };

  struct Minimum {
    vpBasePose pose;
    double cost = 0; // r^T S^-1 r
    bool converged = false;
  };

  vpRayFit(const std::vector<vpLampSight> &lamps, const vpMountFrame &mount, Kind kind);

  //! Levenberg-Marquardt from \e start. S is taken there, and where it varies with the pose at each minimum
  //! found again.
  Minimum minimise(const vpBasePose &start, int rounds = 3) const;

  //! Covariance of wMb at a minimum, without mountCovariance(). False where the lamps do not determine the
  //! pose.
  bool covariance(const vpBasePose &pose, vpMatrix6d &covariance) const;

  //! Residuals less parameters.
  int degreesOfFreedom() const;

private:
  using Rows6 = Eigen::Matrix<double, Eigen::Dynamic, 6>;
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Eigen::Dynamic, 6>; // by parameter
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
  using Parameters = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
  using Cholesky = Eigen::LLT<Eigen::MatrixXd>;
  struct Linear {
    bool inFront = true;        // all lamps; else the rest is not complete
    Eigen::VectorXd residual;   // r
    Rows6 byBase;               // derivative of the prediction, columns as of vpPredictedRay
    Eigen::MatrixXd covariance; // S, where asked for
  };

  int rows() const;
  Linear linearise(const vpBasePose &pose, bool withCovariance) const;
  void addTiltPrior(Linear &linear, const vpBasePose &pose) const;
  bool descend(Minimum &minimum, const Cholesky &S) const;

  const std::vector<vpLampSight> &m_lamps;
  const vpMountFrame &m_mount;
  const bool m_level;                  // level: roll and pitch belong to S
  const std::vector<int> m_parameters; // columns of vpPredictedRay
  bool m_fixedCovariance = true;       // S is the same at all poses
};

END_VISP_NAMESPACE

#endif
