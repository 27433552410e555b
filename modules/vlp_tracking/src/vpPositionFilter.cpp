/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPositionFilter.h"

#include <cmath>

BEGIN_VISP_NAMESPACE

void vpPositionFilter::init(const vpImagePoint &position, double positionSigma, double velocitySigma)
{
  m_filter.init(4, 2, 1);
  m_filter.dt = 1;
  m_filter.F.eye(4);
  m_filter.F[0][2] = m_filter.F[1][3] = 1;
  m_filter.H.resize(2, 4);
  m_filter.H[0][0] = m_filter.H[1][1] = 1;
  m_filter.R.eye(2);
  m_filter.Q.resize(4, 4);
  m_filter.Xest.resize(4);
  m_filter.Xest[0] = position.get_u();
  m_filter.Xest[1] = position.get_v();
  m_filter.Pest.resize(4, 4);
  m_filter.Pest[0][0] = m_filter.Pest[1][1] = positionSigma * positionSigma;
  m_filter.Pest[2][2] = m_filter.Pest[3][3] = velocitySigma * velocitySigma;
}

vpImagePoint vpPositionFilter::predict(double accelerationSigma)
{
  const double q = accelerationSigma * accelerationSigma; // constant during a frame
  for (int axis = 0; axis < 2; ++axis) {
    m_filter.Q[axis][axis] = q / 4;
    m_filter.Q[axis][axis + 2] = m_filter.Q[axis + 2][axis] = q / 2;
    m_filter.Q[axis + 2][axis + 2] = q;
  }
  m_filter.prediction();
  return predicted();
}

void vpPositionFilter::correct(const vpImagePoint &measured, double sigma)
{
  m_filter.R[0][0] = m_filter.R[1][1] = sigma * sigma;
  vpColVector z(2);
  z[0] = measured.get_u();
  z[1] = measured.get_v();
  m_filter.filtering(z);
}

void vpPositionFilter::coast()
{
  // vpKalmanFilter predicts from its last estimate, however many predictions came since.
  m_filter.Xest = m_filter.Xpre;
  m_filter.Pest = m_filter.Ppre;
}

void vpPositionFilter::rest(const vpImagePoint &position)
{
  m_filter.Xest[0] = position.get_u();
  m_filter.Xest[1] = position.get_v();
  m_filter.Xest[2] = m_filter.Xest[3] = 0;
}

vpImagePoint vpPositionFilter::predicted() const
{
  return vpImagePoint(m_filter.Xpre[1], m_filter.Xpre[0]);
}

double vpPositionFilter::predictedSigma() const
{
  return std::sqrt((m_filter.Ppre[0][0] + m_filter.Ppre[1][1]) / 2);
}

vpImagePoint vpPositionFilter::position() const
{
  return vpImagePoint(m_filter.Xest[1], m_filter.Xest[0]);
}

vpImagePoint vpPositionFilter::velocity() const
{
  return vpImagePoint(m_filter.Xest[3], m_filter.Xest[2]);
}

double vpPositionFilter::positionSigma() const
{
  return std::sqrt((m_filter.Pest[0][0] + m_filter.Pest[1][1]) / 2);
}

END_VISP_NAMESPACE
