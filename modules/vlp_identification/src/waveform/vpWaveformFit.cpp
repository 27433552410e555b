/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpWaveformFit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "vpColumnProducts.h"
#include "vpStripeLimits.h"

BEGIN_VISP_NAMESPACE

vpWaveformFit::vpWaveformFit(const vpStripeProfile &profile, const Settings &settings,
                             const std::vector<double> &envelope)
    : m_profile(&profile), m_settings(settings),
      m_bends(1 + std::clamp(settings.envelopeOrder, 0, mostLinear - 2))
{
  const auto [first, last] = std::minmax_element(profile.time.begin(), profile.time.end());
  const auto n = static_cast<Eigen::Index>(profile.light.size());
  const double middle = 0.5 * (*first + *last);
  m_half = std::max(0.5 * (*last - *first), 1e-12);
  m_line = 2 * m_half / std::max<double>(1, static_cast<double>(n) - 1);
  m_time = Eigen::Map<const Eigen::ArrayXd>(profile.time.data(), n) - middle;
  m_light = Eigen::Map<const Eigen::ArrayXd>(profile.light.data(), n);
  m_given = Eigen::Map<const Eigen::ArrayXd>(envelope.data(), n);
  static const double shortest = 10, longest = 5, sigmas = 5; // times the stated exposure
  m_logEdgeSigma = profile.logEdgeSigma();
  m_logExposureSigma = std::hypot(m_settings.exposureTolerance, m_logEdgeSigma);
  const double farthest = std::exp(sigmas * m_logEdgeSigma);
  m_leastExposure = profile.exposure / std::max(shortest, farthest);
  m_mostExposure = profile.exposure * std::max(longest, farthest);
  // A dark line has some light of its neighbours, by blur and compression.
  static const double spill = 0.01; // share of theirs, standard deviation
  m_weight = (Eigen::Map<const Eigen::ArrayXd>(profile.sigma.data(), n).square() +
              (m_settings.modelError * m_light).square() + (spill * m_given).square())
                 .inverse();
  // A dark lamp is about as dark as its surroundings, which the profile has no more.
  static const double glow = 0.05; // share of the lit lamp's light, standard deviation
  const double dark = std::max(1.0, glow * m_given.maxCoeff());
  m_darkness = 1 / (dark * dark);
  prepareSums();
}

//! What of the normal equations of offset and envelope does not depend on the wave.
void vpWaveformFit::prepareSums()
{
  const Eigen::Index bends = m_bends;
  m_powers.resize(m_time.size(), bends);
  m_ofWave.resize(m_time.size(), 2 * bends);
  m_ofSquare.resize(m_time.size(), 2 * bends - 1);
  const Eigen::ArrayXd y = m_time / m_half;
  m_powers.col(0) = m_given;
  m_ofSquare.col(0) = m_weight * m_given.square();
  for (Eigen::Index k = 1; k < bends; ++k) {
    m_powers.col(k) = m_powers.col(k - 1).array() * y;
  }
  for (Eigen::Index p = 1; p < m_ofSquare.cols(); ++p) {
    m_ofSquare.col(p) = m_ofSquare.col(p - 1).array() * y;
  }
  for (Eigen::Index k = 0; k < bends; ++k) {
    m_ofWave.col(k) = m_weight * m_powers.col(k).array();
    m_ofWave.col(bends + k) = m_ofWave.col(k).array() * m_light;
  }
  m_weights = m_weight.sum();
  m_lights = (m_weight * m_light).sum();
  m_squares = (m_weight * m_light.square()).sum();
}

//! The lamp's light at each time, averaged over the exposure, and its derivatives; both pulses', the
//! second's.
void vpWaveformFit::evaluateWave(const Vector &x, const Eigen::ArrayXd &time, vpPulseWave &wave,
                                 vpPulseWave &second) const
{
  const double width = x(exposure) * x(frequency);
  if (!m_settings.twoPulse) {
    wave.evaluate(time, x(frequency), x(phase), width, x(duty));
    return;
  }
  static const double own = 0.5; // share of the duty that is one pulse's
  wave.evaluate(time, x(frequency), x(phase), width, own * x(duty));
  second.evaluate(time, x(frequency), x(phase) - x(phaseDifference), width, own * x(duty));
  wave.value += second.value;
  wave.byTurn += second.byTurn;
  wave.byWidth += second.byWidth;
  wave.byDuty = own * (wave.byDuty + second.byDuty);
}

//! The light alone, of each line, into m_value.
void vpWaveformFit::evaluateValue(const Vector &x)
{
  const double width = x(exposure) * x(frequency), own = x(duty) / pulses();
  m_value.setZero(m_time.size());
  vpPulseWave::addValue(m_time, x(frequency), x(phase), width, own, m_value);
  if (m_settings.twoPulse) {
    vpPulseWave::addValue(m_time, x(frequency), x(phase) - x(phaseDifference), width, own, m_value);
  }
}

//! Prior of a parameter at \e x: chi-square, its curvature and its mean.
vpWaveformFit::Prior vpWaveformFit::prior(int parameter, const Vector &x) const
{
  auto bell = [&](double mean, double sigma) {
    const double z = (x(parameter) - mean) / sigma;
    return Prior{z * z, 1 / (sigma * sigma), mean};
  };
  if (!isFree(parameter)) {
    return {};
  }
  switch (parameter) {
  case exposure: {
    // Student's t, its degrees of freedom those of the sum of a normal claim and of a lamp's own Cauchy
    // distribution (Welch 1947): a claim that is far more exact than it is true is forgiven.
    static const double asNormal = 1e6; // degrees of freedom
    const double share = m_logEdgeSigma / m_settings.exposureTolerance,
                 freedom = std::min(std::pow(1 + share * share, 2), asNormal),
                 log = std::log(x(exposure) / m_profile->exposure), perLog = m_logExposureSigma * x(exposure),
                 square = std::pow(log / m_logExposureSigma, 2);
    return {(freedom + 1) * std::log1p(square / freedom),
            (freedom + 1) / (freedom + square) / (perLog * perLog), x(exposure) * (1 - log)};
  }
  case duty:
    return bell(0.5, 0.3); // the spread of a uniform one
  case phaseDifference:
    return bell(0.25, 0.15);
  default:
    return {};
  }
}

void vpWaveformFit::keepPossible(Vector &x) const
{
  // A start is good to less than half a cycle over the profile: farther off lies another one's minimum.
  const double reach = 0.4 / m_half;
  x(frequency) =
      std::max(std::clamp(x(frequency), m_startFrequency - reach, m_startFrequency + reach), 0.1 / m_half);
  x(duty) = std::clamp(x(duty), vpStripeLimits::leastDuty, 1 - vpStripeLimits::leastDuty);
  x(exposure) = std::clamp(x(exposure), m_leastExposure, m_mostExposure);
  if (m_settings.twoPulse) {
    x(phaseDifference) = std::clamp(x(phaseDifference), 0.5 * x(duty), 0.5);
  }
}

double vpWaveformFit::cost(const Vector &x)
{
  // Normal equations of offset and envelope.
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, mostLinear, mostLinear>;
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, mostLinear, 1>;
  evaluateValue(x);
  m_square = m_value.square();
  const Eigen::Index bends = m_bends, linear = 1 + bends, lines = m_time.size();
  std::array<double, 2 * mostLinear> ofWave, ofSquare;
  vpColumnProducts(m_ofWave.data(), lines, m_ofWave.cols(), m_value.data(), ofWave.data());
  vpColumnProducts(m_ofSquare.data(), lines, m_ofSquare.cols(), m_square.data(), ofSquare.data());
  Small A(linear, linear);
  Column b(linear);
  A(0, 0) = m_weights;
  b(0) = m_lights;
  for (Eigen::Index k = 0; k < bends; ++k) {
    A(k + 1, 0) = ofWave[static_cast<size_t>(k)];
    b(k + 1) = ofWave[static_cast<size_t>(bends + k)];
  }
  for (Eigen::Index p = 0; p < m_ofSquare.cols(); ++p) {
    for (Eigen::Index k = std::max<Eigen::Index>(0, p - bends + 1); 2 * k <= p; ++k) {
      A(p - k + 1, k + 1) = ofSquare[static_cast<size_t>(p)];
    }
  }
  A.diagonal().array() += 1e-9 * (A(0, 0) + 1e-12);
  A(0, 0) += m_darkness;
  A.triangularView<Eigen::StrictlyUpper>() = A.transpose();
  Column c = A.ldlt().solve(b);
  const double least = leastOffset(c(1));
  if (c(0) < least) {
    const Column fixed = b - least * A.col(0);
    c.tail(bends) = A.bottomRightCorner(bends, bends).ldlt().solve(fixed.tail(bends));
    c(0) = least;
  }
  for (Eigen::Index k = 0; k < linear; ++k) {
    m_coefficient[static_cast<size_t>(k)] = c(k);
  }
  if (!(c(1) > 0)) {
    return 1e300; // a lamp that shines where it should be dark
  }
  m_chiSquare = std::max(0.0, m_squares - 2 * c.dot(b) + c.dot(A * c));
  double sum = m_chiSquare;
  for (int p = 0; p < parameters; ++p) {
    sum += prior(p, x).chiSquare;
  }
  return sum;
}

void vpWaveformFit::settle()
{
  m_cost = cost(m_x);
  evaluateWave(m_x, m_time, m_wave, m_second);
}

//! Of the nonlinear parameters at m_x, the linear ones, of the latest cost(), eliminated.
void vpWaveformFit::normalEquations(Matrix &H, Vector &g)
{
  // Columns: the nonlinear parameters, the offset, the envelope's coefficients.
  constexpr int most = parameters + mostLinear;
  const Eigen::Index bends = m_bends, linear = 1 + bends, all = parameters + linear;
  m_jacobian.resize(m_time.size(), all);
  const Eigen::ArrayXd light = envelope();
  evaluateWave(m_x, m_time, m_wave, m_second);
  m_residual = m_light - m_coefficient[0] - light * m_wave.value;
  m_jacobian.col(phase) = light * m_wave.byTurn;
  m_jacobian.col(exposure) = light * m_wave.byWidth;
  m_jacobian.col(frequency) =
      m_jacobian.col(phase).array() * m_time + m_x(exposure) * m_jacobian.col(exposure).array();
  m_jacobian.col(exposure) *= m_x(frequency);
  m_jacobian.col(duty) = light * m_wave.byDuty;
  if (m_settings.twoPulse) {
    m_jacobian.col(phaseDifference) = -light * m_second.byTurn;
  } else {
    m_jacobian.col(phaseDifference).setZero();
  }
  m_jacobian.col(parameters).setOnes();
  for (Eigen::Index k = 0; k < bends; ++k) {
    m_jacobian.col(parameters + 1 + k) = m_powers.col(k).array() * m_wave.value;
  }
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most, most> N(all, all);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most, 1> r(all);
  for (Eigen::Index k = 0; k < all; ++k) {
    m_column = m_weight * m_jacobian.col(k).array();
    vpColumnProducts(m_residual.data(), m_time.size(), 1, m_column.data(), &r(k));
    vpColumnProducts(m_jacobian.data(), m_time.size(), k + 1, m_column.data(), &N(0, k));
    for (Eigen::Index l = 0; l < k; ++l) {
      N(k, l) = N(l, k);
    }
  }
  N(parameters, parameters) += m_darkness;
  N.diagonal().tail(linear).array() += 1e-9 * N(parameters, parameters) + 1e-12;
  const auto C = N.bottomLeftCorner(linear, parameters);
  H = N.topLeftCorner<parameters, parameters>() -
      C.transpose() * N.bottomRightCorner(linear, linear).ldlt().solve(C);
  g = r.head<parameters>(); // the linear ones are at their best: their gradient is 0
}

void vpWaveformFit::begin(double f, double startPhase, double startDuty, double k, double startExposure)
{
  m_startFrequency = f;
  m_x << f, startPhase, startDuty, startExposure > 0 ? startExposure : m_profile->exposure, k;
  keepPossible(m_x);
}

void vpWaveformFit::approach()
{
  descend(5);
}

bool vpWaveformFit::arrive()
{
  descend(60);
  for (int round = 0; round < 2 && m_bends > 1 && bendEnvelope(); ++round) {
    descend(20);
  }
  return m_x.allFinite() && m_cost < 1e299;
}

//! Takes what the polynomial found into the given envelope: where a lamp is ten times dimmer at its rim,
//! polynomials alone do not do.
bool vpWaveformFit::bendEnvelope()
{
  static const double least = 0.02, most = 5;
  const Eigen::ArrayXd bent = envelope() / m_coefficient[1], factor = bent / m_given;
  if (!(factor > 1 / most && factor < most).all() || ((factor - 1).abs() < least).all()) {
    return false;
  }
  m_given = bent;
  prepareSums();
  return true;
}

/*!
  The least light of a dark lamp, grey levels: were it less than none, a lamp's dark pulse blurred by a long
  exposure would do for a bright one. \param share Of the envelope, that the lit lamp has.
*/
double vpWaveformFit::leastOffset(double share) const
{
  return -1 - 0.02 * std::abs(share) * m_given(m_given.size() / 2);
}

Eigen::ArrayXd vpWaveformFit::envelope() const
{
  return (m_powers * Eigen::Map<const Eigen::VectorXd>(m_coefficient.data() + 1, m_bends)).array();
}

//! Grey levels, at each line. After settle().
Eigen::ArrayXd vpWaveformFit::residuals() const
{
  return m_light - m_coefficient[0] - envelope() * m_wave.value;
}

//! Levenberg and Marquardt's method from m_x.
void vpWaveformFit::descend(int iterations)
{
  m_cost = cost(m_x);
  double damping = 1e-3;
  Vector step = Vector::Ones(); // what a parameter may well be off by
  step(phase) = step(duty) = step(phaseDifference) = m_line * m_x(frequency);
  step(frequency) = step(phase) / m_half;
  step(exposure) = 0.3 * m_profile->exposure;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    Vector g;
    normalEquations(m_curvature, g);
    for (int p = 0; p < parameters; ++p) {
      const Prior known = prior(p, m_x);
      m_curvature(p, p) += isFree(p) ? known.weight : 1e12;
      g(p) = isFree(p) ? g(p) - known.weight * (m_x(p) - known.mean) : 0;
    }
    bool better = false;
    double gain = 0;
    for (int attempt = 0; attempt < 6 && !better; ++attempt) {
      // An edge between two exposures is felt by no line: the damping holds it where it is.
      Matrix damped = m_curvature;
      damped.diagonal() += damping * (m_curvature.diagonal() + step.cwiseAbs2().cwiseInverse());
      Vector x = m_x + damped.ldlt().solve(g);
      keepPossible(x);
      const double c = x.allFinite() ? cost(x) : m_cost;
      if (c < m_cost) {
        gain = m_cost - c;
        m_cost = c;
        m_x = x;
        better = true;
        damping = std::max(damping * 0.2, 1e-7);
      } else {
        damping = std::max(10 * damping, 1e-3);
      }
    }
    if (!better || gain < 1e-4 + 1e-7 * m_cost) {
      break;
    }
  }
  settle();
}

int vpWaveformFit::degreesOfFreedom() const
{
  const int free = (m_settings.twoPulse ? parameters : parameters - 1) + 1 + m_bends;
  return std::max(1, static_cast<int>(m_time.size()) - free);
}

double vpWaveformFit::misfit() const
{
  const auto noise = Eigen::Map<const Eigen::ArrayXd>(m_profile->sigma.data(), m_time.size());
  const double left = (residuals().square() - noise.square()).sum(),
               power = (m_light - m_light.mean()).square().sum();
  return std::max(0.0, left) / std::max(power, 1e-9);
}

END_VISP_NAMESPACE
