/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPositionFilter_h
#define vpPositionFilter_h

#include <visp3/core/vpImagePoint.h>
#include <visp3/core/vpKalmanFilter.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  Where the target is: a Kalman filter of constant velocity, x = (u, v, du, dv), whose measurement noise is
  given anew with each measurement. The unit of time is one frame, velocities are in px/frame.
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
  double predictedSigma() const; // px, root mean square of both axes

  vpImagePoint position() const;
  vpImagePoint velocity() const; // px/frame
  double positionSigma() const;  // px, root mean square of both axes

private:
  vpKalmanFilter m_filter;
};

END_VISP_NAMESPACE

#endif
