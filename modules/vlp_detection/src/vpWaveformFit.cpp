/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpWaveformFit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "vpStripeLimits.h"

BEGIN_VISP_NAMESPACE

namespace
{

//! A wave that is 1 in the first \e duty of each period, at \e x periods: its integral from 0, itself, and
//! how the integral grows with the duty.
struct Pulse {
  double integral, level, byDuty;
  Pulse(double x, double duty)
  {
    const double whole = std::floor(x), begun = x - whole;
    const bool lit = begun < duty;
    integral = whole * duty + (lit ? begun : duty);
    level = lit ? 1 : 0;
    byDuty = whole + (lit ? 0 : 1);
  }
};

//! A pulse averaged over \e width periods about \e x, and its derivatives.
struct Averaged {
  double value, byX, byWidth, byDuty;
  Averaged(double x, double width, double duty)
  {
    const double w = std::max(width, 1e-6);
    const Pulse to(x + 0.5 * w, duty), from(x - 0.5 * w, duty);
    value = (to.integral - from.integral) / w;
    byX = (to.level - from.level) / w;
    byWidth = (0.5 * (to.level + from.level) - value) / w;
    byDuty = (to.byDuty - from.byDuty) / w;
  }
};

} // namespace

vpWaveformFit::vpWaveformFit(const vpStripeProfile &profile, const Settings &settings,
                             const std::vector<double> &envelope)
    : m_profile(&profile), m_settings(settings),
      m_linear(2 + std::clamp(settings.envelopeOrder, 0, mostLinear - 2)), m_given(envelope)
{
  const auto [first, last] = std::minmax_element(profile.time.begin(), profile.time.end());
  const size_t n = profile.light.size();
  m_middle = 0.5 * (*first + *last);
  m_half = std::max(0.5 * (*last - *first), 1e-12);
  m_line = 2 * m_half / std::max<double>(1, static_cast<double>(n) - 1);
  for (size_t i = 0; i < n; ++i) {
    // A dark line has some light of its neighbours, by blur and compression.
    static const double spill = 0.01; // share of theirs, standard deviation
    const double missed = std::hypot(m_settings.modelError * profile.light[i], spill * m_given[i]);
    m_weight.push_back(1 / (profile.sigma[i] * profile.sigma[i] + missed * missed));
  }
  m_wave.resize(n);
  m_derivative.resize(n);
  // A dark lamp is about as dark as its surroundings, which the profile has no more.
  static const double glow = 0.05; // share of the lit lamp's light, standard deviation
  const double dark = std::max(1.0, glow * *std::max_element(m_given.begin(), m_given.end()));
  m_darkness = 1 / (dark * dark);
}

double vpWaveformFit::waveform(const Vector &x, double t, Vector &derivative) const
{
  const double turns = x(frequency) * t + x(phase);
  const double width = x(exposure) * x(frequency);
  const double own = m_settings.twoPulse ? 0.5 : 1; // share of the duty that is one pulse's
  const Averaged one(turns, width, own * x(duty));
  double value = one.value, byX = one.byX, byWidth = one.byWidth, byDuty = own * one.byDuty, byDifference = 0;
  if (m_settings.twoPulse) {
    const Averaged two(turns - x(phaseDifference), width, own * x(duty));
    value += two.value;
    byX += two.byX;
    byWidth += two.byWidth;
    byDuty += own * two.byDuty;
    byDifference = -two.byX;
  }
  derivative << byX * t + byWidth * x(exposure), byX, byDuty, byWidth * x(frequency), byDifference;
  return value;
}

/*!
  Prior of a parameter at \e x: chi-square, its curvature and its mean. The exposure's is Cauchy's: nearly
  always it is as stated, and where it is not, it may be anything.
*/
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
    const Prior normal = bell(m_profile->exposure, m_settings.exposureTolerance * m_profile->exposure);
    return {std::log1p(normal.chiSquare), normal.weight / (1 + normal.chiSquare), normal.mean};
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
  x(duty) = std::clamp(x(duty), 0.02, 0.98);
  if (m_freeExposure) {
    x(exposure) = std::clamp(x(exposure), 0.1 * m_profile->exposure, 5 * m_profile->exposure);
  }
  if (m_settings.twoPulse) {
    x(phaseDifference) = std::clamp(x(phaseDifference), 0.5 * x(duty), 0.5);
  }
}

double vpWaveformFit::cost(const Vector &x, bool derivatives)
{
  // Normal equations of offset and envelope; the envelope's bends are unlikely to be sharp.
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, mostLinear, mostLinear>;
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, mostLinear, 1>;
  const size_t n = m_wave.size();
  Small A = Small::Zero(m_linear, m_linear);
  Column b = Column::Zero(m_linear);
  double squares = 0;
  Vector derivative;
  std::array<double, mostLinear> row{};
  row[0] = 1;
  for (size_t i = 0; i < n; ++i) {
    const double t = m_profile->time[i] - m_middle, w = m_weight[i], light = m_profile->light[i];
    m_wave[i] = waveform(x, t, derivative);
    if (derivatives) {
      m_derivative[i] = derivative;
    }
    row[1] = m_given[i] * m_wave[i];
    for (int k = 2; k < m_linear; ++k) {
      row[k] = row[k - 1] * t / m_half;
    }
    for (int k = 0; k < m_linear; ++k) {
      for (int l = 0; l <= k; ++l) {
        A(k, l) += w * row[k] * row[l];
      }
      b(k) += w * row[k] * light;
    }
    squares += w * light * light;
  }
  A.diagonal().array() += 1e-9 * (A(0, 0) + 1e-12);
  A(0, 0) += m_darkness;
  for (int k = 2; k < m_linear; ++k) {
    A(k, k) += 0.06; // bends of four times the envelope are one standard deviation
  }
  A.triangularView<Eigen::StrictlyUpper>() = A.transpose();
  Column c = A.ldlt().solve(b);
  // No light is less than none: were it, a lamp's dark pulse blurred by a long exposure would do for a bright
  // one.
  const double least = -1 - 0.02 * std::abs(c(1)) * m_given[m_given.size() / 2];
  if (c(0) < least) {
    const Column fixed = b - least * A.col(0);
    c.tail(m_linear - 1) =
        A.bottomRightCorner(m_linear - 1, m_linear - 1).ldlt().solve(fixed.tail(m_linear - 1));
    c(0) = least;
  }
  for (int k = 0; k < m_linear; ++k) {
    m_coefficient[static_cast<size_t>(k)] = c(k);
  }
  if (!(c(1) > 0)) {
    return 1e300; // a lamp that shines where it should be dark
  }
  m_chiSquare = std::max(0.0, squares - 2 * c.dot(b) + c.dot(A * c));
  double sum = m_chiSquare;
  for (int p = 0; p < parameters; ++p) {
    sum += prior(p, x).chiSquare;
  }
  return sum;
}

//! Of the nonlinear parameters, the linear ones eliminated; at the place of the latest cost(), with
//! derivatives.
void vpWaveformFit::normalEquations(Matrix &H, Vector &g) const
{
  constexpr int all = parameters + mostLinear;
  using Full = Eigen::Matrix<double, all, all>;
  Full N = Full::Zero();
  Eigen::Matrix<double, all, 1> r = Eigen::Matrix<double, all, 1>::Zero(), J;
  for (size_t i = 0; i < m_wave.size(); ++i) {
    const double y = (m_profile->time[i] - m_middle) / m_half;
    double envelope = 0, power = m_given[i];
    J.setZero();
    J(parameters) = 1;
    for (int k = 1; k < m_linear; ++k) {
      envelope += m_coefficient[static_cast<size_t>(k)] * power;
      J(parameters + k) = m_wave[i] * power;
      power *= y;
    }
    J.head<parameters>() = envelope * m_derivative[i];
    const double residual = m_profile->light[i] - m_coefficient[0] - envelope * m_wave[i];
    N.noalias() += m_weight[i] * J * J.transpose();
    r += m_weight[i] * residual * J;
  }
  N(parameters, parameters) += m_darkness;
  N.diagonal().tail<mostLinear>().array() += 1e-9 * N(parameters, parameters) + 1e-12;
  const Eigen::Matrix<double, mostLinear, mostLinear> L = N.bottomRightCorner<mostLinear, mostLinear>();
  const Eigen::Matrix<double, mostLinear, parameters> C = N.bottomLeftCorner<mostLinear, parameters>();
  H = N.topLeftCorner<parameters, parameters>() - C.transpose() * L.ldlt().solve(C);
  g = r.head<parameters>(); // the linear ones are at their best: their gradient is 0
}

bool vpWaveformFit::run(double f, double startPhase, double startDuty, double k, double startExposure,
                        bool near)
{
  const double exposed = startExposure > 0 ? startExposure : m_profile->exposure;
  static const double slow = 0.3; // periods
  m_startFrequency = f;
  m_x << f, startPhase, startDuty, exposed, k;
  // A sharp edge is felt only by the line that it falls into, and would be led on line by line; a slow one
  // from afar.
  if (!near && exposed * f < 0.5 * slow) {
    m_x(exposure) = slow / f;
    m_freeExposure = false;
    keepPossible(m_x);
    descend(15);
    m_freeExposure = true;
    m_x(exposure) = exposed;
  }
  keepPossible(m_x);
  descend(60);
  for (int round = 0; round < 2 && m_linear > 2 && bendEnvelope(); ++round) {
    descend(20);
  }
  return m_x.allFinite() && m_cost < 1e299;
}

//! Takes what the polynomial found into the given envelope: where a lamp is ten times dimmer at its rim,
//! polynomials alone do not do.
bool vpWaveformFit::bendEnvelope()
{
  static const double most = 5;
  std::vector<double> bent = m_given;
  for (size_t i = 0; i < bent.size(); ++i) {
    const double factor = envelope(i) / (m_given[i] * m_coefficient[1]);
    if (!(factor > 1 / most && factor < most)) {
      return false;
    }
    bent[i] *= factor;
  }
  m_given = bent;
  return true;
}

//! At line \e i, as it was fitted, grey levels.
double vpWaveformFit::envelope(size_t i) const
{
  const double y = (m_profile->time[i] - m_middle) / m_half;
  double sum = 0;
  for (int k = m_linear - 1; k >= 1; --k) {
    sum = sum * y + m_coefficient[static_cast<size_t>(k)];
  }
  return sum * m_given[i];
}

//! Levenberg and Marquardt's method from m_x.
void vpWaveformFit::descend(int iterations)
{
  m_cost = cost(m_x, true);
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
      const double c = x.allFinite() ? cost(x, true) : m_cost;
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
  m_cost = cost(m_x, true);
}

//! Chi-square of a pulse and an exposure, and not each the other.
double vpWaveformFit::unlikely(const Vector &x) const
{
  return vpStripeLimits::unlikely(x(exposure) / m_profile->exposure, x(duty));
}

//! What pulse and exposure would be were each taken for the other.
std::optional<vpWaveformFit::Vector> vpWaveformFit::exchanged() const
{
  const double pulse = m_x(duty) / pulses(), exposed = m_x(exposure) * m_x(frequency); // periods
  static const double wholePeriod = 0.98;
  if (exposed * pulses() > wholePeriod) {
    return std::nullopt;
  }
  Vector other = m_x;
  other(phase) += 0.5 * (exposed - pulse); // the pulse's middle stays
  other(duty) = exposed * pulses();
  other(exposure) = pulse / m_x(frequency);
  return other;
}

bool vpWaveformFit::preferStatedExposure()
{
  const std::optional<Vector> other = exchanged();
  if (!other || unlikely(m_x) <= unlikely(*other)) {
    return true;
  }
  // The fit from there may find its way back.
  return run((*other)(frequency), (*other)(phase), (*other)(duty), (*other)(phaseDifference),
             (*other)(exposure), true);
}

int vpWaveformFit::degreesOfFreedom() const
{
  const int free = (m_settings.twoPulse ? parameters : parameters - 1) + m_linear;
  return std::max(1, static_cast<int>(m_wave.size()) - free);
}

double vpWaveformFit::misfit() const
{
  const auto n = static_cast<double>(m_wave.size());
  double mean = 0;
  for (double light : m_profile->light) {
    mean += light / n;
  }
  double power = 0, left = 0;
  for (size_t i = 0; i < m_wave.size(); ++i) {
    const double residual = m_profile->light[i] - m_coefficient[0] - envelope(i) * m_wave[i];
    const double noise = m_profile->sigma[i];
    left += residual * residual - noise * noise;
    power += (m_profile->light[i] - mean) * (m_profile->light[i] - mean);
  }
  return std::max(0.0, left) / std::max(power, 1e-9);
}

END_VISP_NAMESPACE
