/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPositionFilter_h
#define vpPositionFilter_h

#include <Eigen/Core>
#include <visp3/core/vpImagePoint.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  Where the target is: a Kalman filter of constant velocity, x = (u, v, du, dv), whose measurement noise is
  given anew with each measurement. The unit of time is one frame, velocities are in px/frame. Its two axes
  are alike and independent, so that they share one covariance. (ViSP's vpKalmanFilter takes memory in every
  step.)
*/
class vpPositionFilter
{
public:
  void init(const vpImagePoint &position, double positionSigma, double velocitySigma);

  //! From the last estimate, also where it was called before. \e accelerationSigma, px/frame^2: change of
  //! velocity from frame to frame.
  vpImagePoint predict(double accelerationSigma);

  //! After predict(), where the target was seen; \e sigma in px.
  void correct(const vpImagePoint &measured, double sigma);

  //! After predict(), where it was not: the prediction becomes the estimate, with its larger covariance.
  void coast();

  //! Moves the estimate, and lets it rest there.
  void rest(const vpImagePoint &position);

  vpImagePoint predicted() const;
  double predictedSigma() const; // px, of either axis

  vpImagePoint position() const;
  vpImagePoint velocity() const; // px/frame
  double positionSigma() const;  // px, of either axis

private:
  Eigen::Matrix2d m_estimated = Eigen::Matrix2d::Zero(),
                  m_predicted = Eigen::Matrix2d::Zero(); // columns u and v: px, px/frame
  Eigen::Matrix2d m_estimatedP = Eigen::Matrix2d::Zero(),
                  m_predictedP = Eigen::Matrix2d::Zero(); // of either column
};

END_VISP_NAMESPACE

#endif
