/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpWaveformFit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

BEGIN_VISP_NAMESPACE

namespace
{

//! Integral from 0 to x of a wave that is 1 in the first \e duty of each period.
double integral(double x, double duty)
{
  const double whole = std::floor(x);
  return whole * duty + std::min(x - whole, duty);
}

} // namespace

vpWaveformFit::vpWaveformFit(const vpStripeProfile &profile, const Settings &settings)
    : m_profile(&profile), m_settings(settings)
{
  const auto [first, last] = std::minmax_element(profile.time.begin(), profile.time.end());
  m_middle = 0.5 * (*first + *last);
  m_half = std::max(0.5 * (*last - *first), 1e-12);
  m_weight.resize(static_cast<Eigen::Index>(profile.light.size()));
  for (size_t i = 0; i < profile.light.size(); ++i) {
    m_weight(i) = 1 / std::hypot(profile.sigma[i], m_settings.modelError * profile.light[i]);
  }
}

double vpWaveformFit::waveform(double x, double width, double duty)
{
  const double half = 0.5 * std::max(width, 1e-6);
  return (integral(x + half, duty) - integral(x - half, duty)) / (2 * half);
}

double vpWaveformFit::model(const Eigen::VectorXd &x, size_t line) const
{
  const double t = m_profile->time[line] - m_middle;
  const double turns = x(frequency) * t + x(phase);
  const double width = x(exposure) * x(frequency);
  double wave;
  if (m_settings.twoPulse) {
    wave = waveform(turns, width, 0.5 * x(duty)) + waveform(turns - x(phaseDifference), width, 0.5 * x(duty));
  } else {
    wave = waveform(turns, width, x(duty));
  }
  const double y = t / m_half;
  double log = 0;
  for (Eigen::Index k = x.size() - 1; k >= waveformParameters; --k) {
    log = log * y + x(k);
  }
  return x(offset) + std::exp(std::min(log, 20.0)) * wave;
}

bool vpWaveformFit::isFree(int parameter) const
{
  return parameter != phaseDifference || m_settings.twoPulse;
}

//! Weight of a parameter's prior and its mean.
double vpWaveformFit::prior(int parameter, double &mean) const
{
  auto weight = [](double sigma) { return 1 / (sigma * sigma); };
  switch (parameter) {
  case exposure:
    mean = m_profile->exposure;
    return weight(m_settings.exposureTolerance * m_profile->exposure);
  case duty:
    mean = 0.5;
    return weight(0.3); // the spread of a uniform one
  case phaseDifference:
    mean = 0.25;
    return weight(0.15);
  case frequency:
  case phase:
  case offset:
    mean = 0;
    return 0;
  default: // of the envelope the level is free, its bends are unlikely to be sharp
    mean = 0;
    return parameter == waveformParameters ? 0 : weight(5);
  }
}

void vpWaveformFit::keepPossible(Eigen::VectorXd &x) const
{
  // A start is good to less than half a cycle over the profile: farther off lies another one's minimum.
  const double reach = 0.4 / m_half;
  x(frequency) =
      std::max(std::clamp(x(frequency), m_startFrequency - reach, m_startFrequency + reach), 0.1 / m_half);
  x(duty) = std::clamp(x(duty), 0.02, 0.98);
  x(exposure) = std::clamp(x(exposure), 0.1 * m_profile->exposure, 5 * m_profile->exposure);
  // No light is less than none: were it, a lamp's dark pulse blurred by a long exposure would do for a bright
  // one.
  const double error = 0.02 * std::exp(std::min(x(waveformParameters), 20.0));
  x(offset) = std::max(x(offset), -error - 1);
  if (m_settings.twoPulse) {
    x(phaseDifference) = std::clamp(x(phaseDifference), 0.5 * x(duty), 0.5);
  }
}

double vpWaveformFit::cost(const Eigen::VectorXd &x, Eigen::VectorXd &weighted) const
{
  for (Eigen::Index i = 0; i < weighted.size(); ++i) {
    weighted(i) = m_weight(i) * (m_profile->light[i] - model(x, i));
  }
  double sum = weighted.squaredNorm();
  for (int p = 0; p < x.size(); ++p) {
    double mean;
    const double weight = prior(p, mean);
    sum += weight * (x(p) - mean) * (x(p) - mean);
  }
  return sum;
}

/*!
  Levenberg-Marquardt from m_x, with derivatives over \e reach seconds. \return the normal equations' matrix
  there.
*/
Eigen::MatrixXd vpWaveformFit::descend(double reach, Eigen::VectorXd &residual)
{
  const int n = static_cast<int>(m_weight.size());
  const int count = static_cast<int>(m_x.size());
  Eigen::VectorXd step(count);
  step.setConstant(1e-4);
  step(phase) = step(duty) = step(phaseDifference) = reach * m_x(frequency);
  step(frequency) = step(phase) / m_half;
  step(exposure) = std::min(reach, 0.3 * m_x(exposure));
  step(offset) = 1e-2;

  Eigen::VectorXd shifted(n), trial(n);
  double best = cost(m_x, residual);
  Eigen::MatrixXd J(n, count);
  Eigen::MatrixXd H;
  double damping = 1e-3;
  for (int iteration = 0; iteration < 40; ++iteration) {
    Eigen::VectorXd g = Eigen::VectorXd::Zero(count);
    for (int p = 0; p < count; ++p) {
      if (!isFree(p)) {
        J.col(p).setZero();
        continue;
      }
      Eigen::VectorXd x = m_x;
      x(p) += step(p);
      cost(x, shifted);
      x(p) -= 2 * step(p);
      cost(x, trial);
      J.col(p) = (trial - shifted) / (2 * step(p)); // d model / d p, weighted
    }
    H = J.transpose() * J;
    g += J.transpose() * residual;
    for (int p = 0; p < count; ++p) {
      double mean;
      const double weight = isFree(p) ? prior(p, mean) : 1;
      H(p, p) += weight;
      if (isFree(p) && weight > 0) {
        g(p) -= weight * (m_x(p) - mean);
      }
    }
    bool better = false;
    double gain = 0;
    for (int attempt = 0; attempt < 8 && !better; ++attempt) {
      Eigen::MatrixXd damped = H;
      damped.diagonal() *= 1 + damping;
      damped.diagonal().array() += 1e-12;
      const Eigen::VectorXd move = damped.ldlt().solve(g);
      Eigen::VectorXd x = m_x + move;
      keepPossible(x);
      const double c = move.allFinite() ? cost(x, trial) : best;
      if (c < best) {
        gain = best - c;
        best = c;
        m_x = x;
        residual = trial;
        better = true;
        damping = std::max(damping * 0.2, 1e-7);
      } else {
        damping *= 5;
      }
    }
    if (!better || gain < 1e-6 * best) {
      break;
    }
  }
  return H;
}

bool vpWaveformFit::run(double f, double startPhase, double startDuty, double k,
                        const Eigen::VectorXd &startEnvelope, double startExposure)
{
  const int n = static_cast<int>(m_weight.size());
  m_x = Eigen::VectorXd::Zero(waveformParameters + m_settings.envelopeOrder + 1);
  m_startFrequency = f;
  m_x(frequency) = f;
  m_x(phase) = startPhase;
  m_x(duty) = startDuty;
  m_x(exposure) = startExposure > 0 ? startExposure : m_profile->exposure;
  m_x(phaseDifference) = k;
  const Eigen::Index bends = std::min<Eigen::Index>(startEnvelope.size(), m_settings.envelopeOrder + 1);
  m_x.segment(waveformParameters, bends) = startEnvelope.head(bends);
  keepPossible(m_x);

  // An edge of the pulse is felt by the line that it falls into and by no other: derivatives over a third of
  // a line see across the kinks that this makes, those over a fraction of it then settle.
  const double line = 2 * m_half / std::max(1, n - 1);
  Eigen::VectorXd residual(n);
  Eigen::MatrixXd H;
  for (double share : {0.33, 0.02}) {
    H = descend(share * line, residual);
  }
  const double chiSquare = residual.squaredNorm();
  m_cost = cost(m_x, residual);
  // What the model leaves out is alike on neighbouring lines: they say less together than each says alone.
  const double alike = residual.head(n - 1).dot(residual.tail(n - 1)) / std::max(chiSquare, 1e-12);
  const double together = std::clamp((1 + alike) / std::max(1 - alike, 0.1), 1.0, 10.0);
  // A variance told from few residuals may be any.
  const double untold = 1 + 6.0 / (degreesOfFreedom() * degreesOfFreedom());
  const Eigen::MatrixXd covariance = untold * H.inverse();
  m_sigma = (covariance.diagonal().cwiseMax(0) * std::max(1.0, together * chiSquare / degreesOfFreedom()))
                .cwiseSqrt();
  // Minima lie a fraction of a line apart (above), and the curvature of one of them does not know the others.
  const double placed =
      0.07 * line * std::min(1.0, line / m_x(exposure)); // s, standard deviation of the pulses
  m_sigma(frequency) = std::hypot(m_sigma(frequency), placed * m_x(frequency) / (2 * m_half));
  m_sigma(duty) = std::hypot(m_sigma(duty), placed * m_x(frequency));
  m_sigma(phaseDifference) = std::hypot(m_sigma(phaseDifference), placed * m_x(frequency));
  return m_x.allFinite() && m_sigma.allFinite();
}

bool vpWaveformFit::preferStatedExposure(int attempts)
{
  if (m_settings.twoPulse) {
    return true;
  }
  const double pulse = m_x(duty) / m_x(frequency); // s
  static const double wholePeriod = 0.98;
  double exposed = m_x(exposure) * m_x(frequency); // periods
  auto unlikely = [this](double time, double share) {
    static const double misstated = 0.5; // of the exposure's logarithm, standard deviation
    static const double usual = 0.2;     // of the duty
    return std::hypot(std::log(time / m_profile->exposure) / misstated, (share - 0.5) / usual);
  };
  if (unlikely(m_x(exposure), m_x(duty)) <= unlikely(pulse, std::min(exposed, wholePeriod)) ||
      attempts == 0) {
    return true;
  }
  if (exposed > wholePeriod) {
    exposed = 0.5; // no pulse, only a start for one
  }
  Eigen::VectorXd envelope = m_x.tail(m_x.size() - waveformParameters);
  envelope(0) += std::log(std::min(1.0, m_x(duty) / exposed)) - std::log(std::min(1.0, exposed / m_x(duty)));
  // The pulse's middle stays. The fit from there may find its way back.
  return run(m_x(frequency), m_x(phase) + 0.5 * (exposed - m_x(duty)), exposed, 0, envelope, pulse);
}

int vpWaveformFit::degreesOfFreedom() const
{
  const int free = static_cast<int>(m_x.size()) - (m_settings.twoPulse ? 0 : 1);
  return std::max(1, static_cast<int>(m_weight.size()) - free);
}

double vpWaveformFit::misfit() const
{
  const auto n = static_cast<double>(m_profile->light.size());
  double mean = 0;
  for (double light : m_profile->light) {
    mean += light / n;
  }
  double power = 0, left = 0;
  for (size_t i = 0; i < m_profile->light.size(); ++i) {
    const double residual = m_profile->light[i] - model(m_x, i);
    const double noise = m_profile->sigma[i];
    left += residual * residual - noise * noise;
    power += (m_profile->light[i] - mean) * (m_profile->light[i] - mean);
  }
  return std::max(0.0, left) / std::max(power, 1e-9);
}

END_VISP_NAMESPACE
