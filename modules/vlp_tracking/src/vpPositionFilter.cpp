/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPositionFilter.h"

#include <cmath>

BEGIN_VISP_NAMESPACE

void vpPositionFilter::init(const vpImagePoint &position, double positionSigma, double velocitySigma)
{
  rest(position);
  m_estimatedP = Eigen::Vector2d(positionSigma, velocitySigma).cwiseAbs2().asDiagonal();
}

vpImagePoint vpPositionFilter::predict(double accelerationSigma)
{
  const double q = accelerationSigma * accelerationSigma; // constant during a frame
  const Eigen::Matrix2d F = (Eigen::Matrix2d() << 1, 1, 0, 1).finished(),
                        Q = (Eigen::Matrix2d() << q / 4, q / 2, q / 2, q).finished();
  m_predicted = F * m_estimated;
  m_predictedP = F * m_estimatedP * F.transpose() + Q;
  return predicted();
}

void vpPositionFilter::correct(const vpImagePoint &measured, double sigma)
{
  const Eigen::Vector2d gain = m_predictedP.col(0) / (m_predictedP(0, 0) + sigma * sigma);
  const Eigen::RowVector2d innovation =
      Eigen::RowVector2d(measured.get_u(), measured.get_v()) - m_predicted.row(0);
  m_estimated = m_predicted + gain * innovation;
  m_estimatedP = m_predictedP - gain * m_predictedP.row(0);
}

void vpPositionFilter::coast()
{
  m_estimated = m_predicted;
  m_estimatedP = m_predictedP;
}

void vpPositionFilter::rest(const vpImagePoint &position)
{
  m_estimated.row(0) << position.get_u(), position.get_v();
  m_estimated.row(1).setZero();
}

vpImagePoint vpPositionFilter::predicted() const
{
  return vpImagePoint(m_predicted(0, 1), m_predicted(0, 0));
}

double vpPositionFilter::predictedSigma() const
{
  return std::sqrt(m_predictedP(0, 0));
}

vpImagePoint vpPositionFilter::position() const
{
  return vpImagePoint(m_estimated(0, 1), m_estimated(0, 0));
}

vpImagePoint vpPositionFilter::velocity() const
{
  return vpImagePoint(m_estimated(1, 1), m_estimated(1, 0));
}

double vpPositionFilter::positionSigma() const
{
  return std::sqrt(m_estimatedP(0, 0));
}

END_VISP_NAMESPACE
