/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// How vpVlpFilter mixes what comes of several hypotheses, and matches the noise of lamps' points.

#include <visp3/vlp_localization/vpVlpFilter.h>

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

BEGIN_VISP_NAMESPACE

/*!
  What lamps' points scatter by, as a share of what they say: by the innovations of a calm robot, whose pose
  rests on such points and is as good as they were (covariance matching, Mehra 1972).
*/
void vpVlpFilter::weighNoise(const Innovation &seen, const Eigen::Matrix2d &stated)
{
  static const double calm = 0.03, noisy = 0.3; // share of the accelerations; of an innovation's variance
  static const double priorPoints = 10;         // that the stated variance weighs as much as
  static const double slowest = 0.02, outlying = 9, least = 0.25, most = 9;
  if (m_manoeuvreShare > calm || m_noise * stated.trace() < noisy * seen.covariance.trace()) {
    return;
  }
  const double excess = 0.5 * std::min(seen.distance(0), outlying) - 1;
  const double gain = std::max(slowest, 1 / (priorPoints + ++m_weighed));
  m_noise = std::clamp(m_noise * std::exp(gain * excess), least, most);
}

void vpVlpFilter::mix(const std::vector<const vpVlpFilter *> &parts, const std::vector<double> &weights)
{
  static thread_local Vector mean, apart; // kept, so that it takes no memory
  static thread_local Matrix spread;
  mean.setZero(m_x.size());
  spread.setZero(m_x.size(), m_x.size());
  for (size_t k = 0; k < parts.size(); ++k) {
    apart = parts[k]->m_x - m_x;
    for (const Index first : {x, mark0}) {
      apart(first + yaw) = std::remainder(apart(first + yaw), 2 * M_PI);
    }
    mean += weights[k] * apart;
    spread += weights[k] * parts[k]->m_P;
    for (Eigen::Index column = 0; column < spread.cols(); ++column) {
      spread.col(column) += weights[k] * apart(column) * apart;
    }
  }
  m_P = spread;
  for (Eigen::Index column = 0; column < m_P.cols(); ++column) {
    m_P.col(column) -= mean(column) * mean;
  }
  m_x += mean;
}

END_VISP_NAMESPACE
