/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpStripeCheck.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "waveform/vpColumnProducts.h"

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
  m_lines = n;
  const auto needed = static_cast<size_t>(parts * n);
  if (m_memory.size() < needed) {
    m_memory.resize(2 * needed); // the next lamp has a line more
  }
  Array times = part(time), lights = part(light), weights = part(weight), residual = part(weighted);
  times = Eigen::Map<const Eigen::ArrayXd>(profile.time.data(), n) - middle;
  lights = Eigen::Map<const Eigen::ArrayXd>(profile.light.data(), n);
  const auto noise = Eigen::Map<const Eigen::ArrayXd>(profile.sigma.data(), n);
  weights = (noise.square() + (modelError * lights).square() + 1).inverse();

  // The first harmonic peaks in the middle of the pulse.
  const double mean = lights.mean(), turn = 2 * M_PI * known.frequency;
  std::complex<double> harmonic = 0, direction = std::polar(1.0, turn * times(0)), step = 1;
  double apart = 0; // s, that the step is of: lines are mostly as far apart as those before
  for (Eigen::Index i = 0; i < n; ++i) {
    harmonic += (lights(i) - mean) * direction;
    const double next = i + 1 < n ? times(i + 1) - times(i) : apart;
    static const double same = 1e-6; // of it
    if (std::abs(next - apart) > same * std::abs(next)) {
      apart = next;
      step = std::polar(1.0, turn * apart);
    }
    direction *= step;
  }
  double frequency = known.frequency, phase = 0.5 * known.duty + std::arg(std::conj(harmonic)) / (2 * M_PI);
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
    static const double still = 0.002; // periods: the step after it would be a hundredth of that
    if (std::abs(m_solution(linear)) + std::abs(m_solution(linear + 1)) * m_half < still) {
      break;
    }
  }
  const Matrix normal = m_normal;
  solve(frequency, phase, exposure * frequency, known.duty, linear);
  amplitude = m_solution(1);
  residual = lights;
  for (int k = 0; k < linear; ++k) {
    residual -= m_solution(k) * part(columns + k);
  }
  const double power = (lights - mean).square().sum(),
               inflation = (weights * residual.square()).sum() / static_cast<double>(n - all);
  misfit = std::max(0.0, (residual.square() - noise.square()).sum()) / std::max(power, 1e-9);
  change = frequency - known.frequency;
  const Vector ofChange = normal.ldlt().solve(Vector(Vector::Unit(linear + 1)));
  changeSigma = std::sqrt(std::max(0.0, ofChange(linear + 1)) * std::max(1.0, inflation));
  return std::isfinite(misfit) && std::isfinite(changeSigma);
}

//! The linear unknowns, and steps of phase and frequency where these are asked for too.
void vpStripeCheck::solve(double frequency, double phase, double width, double duty, int unknowns)
{
  vpPulseWave::evaluate(part(time).data(), m_lines, frequency, phase, width, duty, part(value).data(),
                        part(byTurn).data(), part(byWidth).data(), part(byDuty).data());
  const Array times = part(time), weights = part(weight);
  const double perHalf = 1 / m_half;
  part(columns).setOnes();
  part(columns + 1) = part(value);
  part(columns + 2) = part(value) * times * perHalf;
  part(columns + 3) = part(columns + 2) * times * perHalf;
  m_normal.setIdentity();
  Vector right = Vector::Zero();
  for (int known = 0, count = linear; known < unknowns; known = count, count = unknowns) {
    if (known > 0) {
      part(envelope) = m_solution(1) + times * perHalf * (m_solution(2) + times * perHalf * m_solution(3));
      part(columns + linear) = part(envelope) * part(byTurn);
      part(columns + linear + 1) = part(columns + linear) * times;
    }
    for (int k = known; k < count; ++k) {
      part(weighted) = part(columns + k) * weights;
      vpColumnProducts(part(columns).data(), m_lines, k + 1, part(weighted).data(), &m_normal(0, k));
      vpColumnProducts(part(light).data(), m_lines, 1, part(weighted).data(), &right(k));
      m_normal(k, k) *= 1 + 1e-9;
    }
    m_normal.triangularView<Eigen::StrictlyLower>() = m_normal.transpose();
    m_solution = m_normal.ldlt().solve(right);
  }
}

END_VISP_NAMESPACE
