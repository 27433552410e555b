/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpMotionModes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

BEGIN_VISP_NAMESPACE

namespace
{
//! One of several kinds, the first of which is left at the rate \e change and come back to at \e settling,
//! 1/s.
template <size_t Kinds>
void wander(std::array<double, Kinds> &probability, double dt, double change, double settling)
{
  const double leave = 1 - std::exp(-change * dt), settle = 1 - std::exp(-settling * dt);
  std::array<double, Kinds> after{};
  for (size_t from = 0; from < Kinds; ++from) {
    const double back = from == 0 ? 0 : settle, away = (1 - back) * leave;
    after[0] += probability[from] * back;
    after[from] += probability[from] * (1 - back) * (1 - leave);
    for (size_t to = 0; to < Kinds; ++to) {
      after[to] += to == from ? 0 : probability[from] * away / (Kinds - 1);
    }
  }
  probability = after;
}
} // namespace

vpMotionModes::vpMotionModes(const vpVlpHypotheses &hypotheses)
    : m_hypotheses(hypotheses), m_right(hypotheses.right)
{
  m_without.fill(1. / alone);
  m_by.fill(1. / (count - alone));
  predict(0, false);
}

void vpMotionModes::apply(size_t mode, vpVlpFilter &filter) const
{
  const vpVlpHypotheses &of = m_hypotheses;
  const std::array<double, count> shares = {of.steady, of.gentle, of.lively, 1, of.steady, of.onWheels};
  using Odometry = vpVlpFilter::Odometry;
  filter.odometry = mode < alone    ? Odometry::ignored
                    : mode == alone ? Odometry::measured
                                    : Odometry::followed;
  filter.manoeuvreShare = shares[mode];
}

void vpMotionModes::predict(double dt, bool odometry)
{
  const vpVlpHypotheses &of = m_hypotheses;
  wander(m_without, dt, of.change, of.settling);
  wander(m_by, dt, of.change, of.settling);
  const double slipped = m_right * (1 - std::exp(-of.slip * dt)),
               gripped = (1 - m_right) * (1 - std::exp(-of.grip * dt));
  m_right += gripped - slipped;
  m_changed = {slipped / std::max(1 - m_right, 1e-300), gripped / std::max(m_right, 1e-300)};
  m_odometry = odometry;
  const double by = odometry ? m_right : 0;
  for (size_t k = 0; k < count; ++k) {
    m_probability[k] = k < alone ? (1 - by) * m_without[k] : by * m_by[k - alone];
  }
}

size_t vpMotionModes::likeliest() const
{
  const auto first = m_probability.begin();
  return static_cast<size_t>(std::max_element(first, first + static_cast<long>(possible())) - first);
}

void vpMotionModes::heedOdometry(const std::array<double, count> &logDensity)
{
  const double most = *std::max_element(logDensity.begin() + alone, logDensity.end());
  if (!std::isfinite(most)) {
    return; // no motion explains them
  }
  const auto by = m_probability.begin() + alone;
  const double before = std::accumulate(by, m_probability.end(), 0.);
  for (size_t k = alone; k < count; ++k) {
    m_probability[k] *= std::exp(logDensity[k] - most);
  }
  const double after = std::accumulate(by, m_probability.end(), 0.);
  std::for_each(by, m_probability.end(), [&](double &one) { one *= after > 0 ? before / after : 1; });
}

double vpMotionModes::correct(const std::array<double, count> &logLikelihood)
{
  const double most = *std::max_element(logLikelihood.begin(), logLikelihood.begin() + possible());
  double sum = 0;
  const std::array<double, count> prior = m_probability;
  for (size_t k = 0; k < possible(); ++k) {
    m_probability[k] *= std::exp(logLikelihood[k] - most);
    sum += m_probability[k];
  }
  const auto share = [this, sum](auto &kinds, size_t first) {
    const auto from = m_probability.begin() + static_cast<long>(first);
    const double all = std::accumulate(from, from + static_cast<long>(kinds.size()), 0.);
    for (size_t k = 0; k < kinds.size() && all > 0; ++k) {
      kinds[k] = m_probability[first + k] / all;
    }
    return all / sum;
  };
  share(m_without, 0);
  if (m_odometry) {
    m_right = share(m_by, alone);
  }
  for (size_t k = 0; k < count; ++k) {
    m_probability[k] /= sum;
    m_information += m_probability[k] > 0 ? m_probability[k] * std::log(m_probability[k] / prior[k]) : 0;
  }
  return most + std::log(sum);
}

END_VISP_NAMESPACE
