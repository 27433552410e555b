/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpStripeCheck.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "vpColumnProducts.h"

BEGIN_VISP_NAMESPACE

bool vpStripeCheck::compare(const vpStripeProfile &profile, const vpStripeFeatures &known)
{
  static const Eigen::Index fewest = 12; // lines
  static const double modelError = 0.03; // share of the light, as vpStripeAnalyzer's
  const auto n = static_cast<Eigen::Index>(profile.light.size());
  if (n < fewest || !(known.frequency > 0) || !(known.duty > 0 && known.duty < 1)) {
    return false;
  }
  const double middle = 0.5 * (profile.time.front() + profile.time.back());
  m_half = 0.5 * std::abs(profile.time.back() - profile.time.front());
  m_time = Eigen::Map<const Eigen::ArrayXd>(profile.time.data(), n) - middle;
  m_light = Eigen::Map<const Eigen::ArrayXd>(profile.light.data(), n);
  const auto noise = Eigen::Map<const Eigen::ArrayXd>(profile.sigma.data(), n);
  m_weight = (noise.square() + (modelError * m_light).square() + 1).inverse();
  m_columns.resize(n, all);

  // The first harmonic peaks in the middle of the pulse.
  const double mean = m_light.mean(), turn = 2 * M_PI * known.frequency;
  double cosines = 0, sines = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    cosines += (m_light(i) - mean) * std::cos(turn * m_time(i));
    sines += (m_light(i) - mean) * std::sin(turn * m_time(i));
  }
  double frequency = known.frequency, phase = 0.5 * known.duty + std::atan2(-sines, cosines) / (2 * M_PI);
  const double exposure = std::isfinite(known.exposure) ? known.exposure : profile.exposure;
  static const int steps = 3;
  for (int step = 0; step < steps; ++step) {
    solve(frequency, phase, exposure * frequency, known.duty, all);
    static const double farthest = 0.1; // periods
    if (!m_solution.allFinite()) {
      return false;
    }
    phase += std::clamp(m_solution(linear), -farthest, farthest);
    frequency += std::clamp(m_solution(linear + 1), -farthest / m_half, farthest / m_half);
  }
  const Matrix normal = m_normal;
  solve(frequency, phase, exposure * frequency, known.duty, linear);
  amplitude = m_solution(1);
  const Eigen::ArrayXd residual =
      m_light - (m_columns.leftCols<linear>() * m_solution.head<linear>()).array();
  const double power = (m_light - mean).square().sum(),
               inflation = (m_weight * residual.square()).sum() / static_cast<double>(n - all);
  misfit = std::max(0.0, (residual.square() - noise.square()).sum()) / std::max(power, 1e-9);
  change = frequency - known.frequency;
  const Vector ofChange = normal.ldlt().solve(Vector(Vector::Unit(linear + 1)));
  changeSigma = std::sqrt(std::max(0.0, ofChange(linear + 1)) * std::max(1.0, inflation));
  return std::isfinite(misfit) && std::isfinite(changeSigma);
}

//! The linear unknowns, and steps of phase and frequency where these are asked for too.
void vpStripeCheck::solve(double frequency, double phase, double width, double duty, int unknowns)
{
  m_wave.evaluate(m_time, frequency, phase, width, duty);
  m_columns.col(0).setOnes();
  m_columns.col(1) = m_wave.value;
  m_columns.col(2) = m_wave.value * m_time / m_half;
  m_columns.col(3) = m_columns.col(2).array() * m_time / m_half;
  for (int columns : {linear, unknowns}) {
    if (columns == all) {
      m_envelope = m_solution(1) + m_time / m_half * (m_solution(2) + m_time / m_half * m_solution(3));
      m_columns.col(linear) = m_envelope * m_wave.byTurn;
      m_columns.col(linear + 1) = m_columns.col(linear).array() * m_time;
    }
    m_normal.setIdentity();
    m_solution.setZero();
    for (int k = 0; k < columns; ++k) {
      m_weighted = m_columns.col(k).array() * m_weight;
      vpColumnProducts(m_columns.data(), m_columns.rows(), k + 1, m_weighted.data(), &m_normal(0, k));
      vpColumnProducts(m_light.data(), m_columns.rows(), 1, m_weighted.data(), &m_solution(k));
    }
    m_normal.triangularView<Eigen::StrictlyLower>() = m_normal.transpose();
    m_normal.diagonal().head(columns) *= 1 + 1e-9;
    m_solution = m_normal.ldlt().solve(m_solution).eval();
    if (columns == unknowns) {
      break;
    }
  }
}

END_VISP_NAMESPACE
