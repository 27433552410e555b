/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// How vpVlpFilter matches its noises to the innovations that it sees.

#include <visp3/vlp_localization/vpVlpFilter.h>

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

BEGIN_VISP_NAMESPACE

bool vpVlpFilter::settle(double chiSquare, int degreesOfFreedom)
{
  static const double chance = 2, beyond = 6; // standard deviations of a chi-square
  const double excess = (chiSquare - degreesOfFreedom) / std::sqrt(2.0 * std::max(1, degreesOfFreedom));
  static const double rousing = 3;
  static const double believed = 0.3; // degrees of freedom, that what was thought before weighs as much as
  const double matched = std::sqrt((believed + m_moved) / (believed + m_movable));
  m_moved = m_movable = 0;
  // One lamp does not show whether the robot turns about it.
  static const double alone = 0.03, aloneCalming = 0.5;
  const bool many = degreesOfFreedom > 2;
  const double calming = many ? matched : std::min(matched, aloneCalming);
  m_unrest = std::clamp(m_unrest * (excess > chance ? rousing : calming), many ? calmest : alone, 1.0);
  return excess < beyond;
}

/*!
  What lamps' points scatter by, as a share of what they say: by the innovations of a calm robot, whose pose
  rests on such points and is as good as they were (covariance matching, Mehra 1972).
*/
void vpVlpFilter::weighNoise(const Innovation &seen, const Eigen::Matrix2d &stated)
{
  static const double calm = 0.03, noisy = 0.3; // share of the accelerations; of an innovation's variance
  static const double believed = 10; // points, that what the first of them scatter by weighs as much as
  static const double slowest = 0.02, outlying = 9, least = 0.25, most = 9;
  if (m_unrest > calm || m_noise * stated.trace() < noisy * seen.covariance.trace()) {
    return;
  }
  const double excess = 0.5 * std::min(seen.distance(0), outlying) - 1;
  const double gain = std::max(slowest, 1 / (believed + ++m_weighed));
  m_noise = std::clamp(m_noise * std::exp(gain * excess), least, most);
}

//! What motion may explain of an innovation, and how large that part is.
void vpVlpFilter::weighMotion(const Innovation &seen, const Eigen::Matrix2d &stated)
{
  static const double outlying = 4; // times what was to be expected
  const Eigen::Matrix2d inverse = seen.covariance.inverse(),
                        share = Eigen::Matrix2d::Identity() - inverse * m_noise * stated;
  m_movable += share.trace();
  m_moved += std::min((share * inverse * seen.ray).dot(seen.ray), outlying * share.trace());
}

END_VISP_NAMESPACE
