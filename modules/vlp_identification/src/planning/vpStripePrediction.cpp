/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_identification/vpStripePrediction.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <Eigen/Core>
#include <Eigen/LU>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "waveform/vpStripeLimits.h"

BEGIN_VISP_NAMESPACE

namespace
{
void demand(bool good, const std::string &what, double came)
{
  if (!good) {
    throw vpException(vpException::badValue,
                      what + ": " + vpNumberText(came) + ", expected a finite number above 0");
  }
}

bool isPositive(double x)
{
  return std::isfinite(x) && x > 0;
}

double sinc(double x)
{
  return x == 0 ? 1 : std::sin(M_PI * x) / (M_PI * x);
}

//! A wave that is 1 in the first \e duty of each period, averaged over \e width periods about \e x, and its
//! derivatives.
struct AveragedPulse {
  double value, byX, byWidth, byDuty;

  AveragedPulse(double x, double width, double duty)
  {
    double integral[2], level[2], byDutyAt[2];
    for (int end = 0; end < 2; ++end) {
      const double at = x + (end - 0.5) * width, whole = std::floor(at), begun = at - whole;
      integral[end] = whole * duty + std::min(begun, duty);
      level[end] = begun < duty ? 1 : 0;
      byDutyAt[end] = whole + (begun < duty ? 0 : 1);
    }
    value = (integral[1] - integral[0]) / width;
    byX = (level[1] - level[0]) / width;
    byWidth = (0.5 * (level[0] + level[1]) - value) / width;
    byDuty = (byDutyAt[1] - byDutyAt[0]) / width;
  }
};

constexpr int phases = 16; // of the lamp against the lines, tried one after the other

//! By how much an edge of a pulse may be earlier (negative) or later, s, and the lines look the same.
struct Interval {
  double low, high;
};

//! Where in a period the light goes on or off, in periods.
std::vector<double> edgesOf(const vpModulation &modulation)
{
  const double duty = modulation.duty.value_or(0.5);
  if (modulation.kind == vpModulation::Kind::twoPulse) {
    return {0, 0.5 * duty, modulation.phaseDifference, modulation.phaseDifference + 0.5 * duty};
  }
  return {0, duty};
}

/*!
  Of each edge that the lines see, one a period: as far as the gap between two exposures where it lies in one,
  \e seen to both sides where an exposure shows it. \param middle Of each line's exposure, n of them, s.
*/
std::vector<Interval> intervalsOf(double phase, double period, const double *middle, size_t n,
                                  double exposure, double seen)
{
  std::vector<Interval> intervals;
  size_t line = 0;
  for (double edge = middle[0] - 0.5 * exposure + (phase - std::floor(phase)) * period;
       edge < middle[n - 1] + 0.5 * exposure; edge += period) {
    while (line + 1 < n && middle[line] + 0.5 * exposure < edge) {
      ++line; // the first exposure that has not ended yet
    }
    const double start = middle[line] - 0.5 * exposure;
    const bool hidden = edge < start;
    intervals.push_back({-seen - (hidden ? edge - (middle[line - 1] + 0.5 * exposure) : 0),
                         seen + (hidden ? start - edge : 0)});
  }
  return intervals;
}

//! What the edges of a lamp allow.
struct Room {
  double shorter = -std::numeric_limits<double>::infinity(); // change of the period, s
  double longer = std::numeric_limits<double>::infinity();
  double shifts = 0; // sum of the squares of what all edges of one kind may be shifted by, s^2

  //! By edges of one kind. \param enough Of longer - shorter, s: it need not be known better.
  void narrow(const std::vector<Interval> &edges, double enough, double period)
  {
    Interval all{-period, period};
    for (const Interval &edge : edges) {
      all = {std::max(all.low, edge.low), std::min(all.high, edge.high)};
    }
    shifts += std::pow(std::max(0.0, all.high - all.low), 2);
    const size_t count = edges.size(), third = (count + 2) / 3; // pairs far apart bind the most
    for (size_t k = 0; k < third && longer - shorter > enough; ++k) {
      for (size_t l = std::max(k + 1, count - third); l < count; ++l) {
        const double periods = static_cast<double>(l - k);
        longer = std::min(longer, (edges[l].high - edges[k].low) / periods);
        shorter = std::max(shorter, (edges[l].low - edges[k].high) / periods);
      }
    }
  }
};

enum Parameter { ofFrequency, ofPhase, ofDuty, ofExposure, ofDifference, ofOffset, ofAmplitude, parameters };
using Vector = Eigen::Matrix<double, parameters, 1>;
using Matrix = Eigen::Matrix<double, parameters, parameters>;

/*!
  Light of a lamp at time \e t (s), lit 1 and dark 0, and its derivatives: by a frequency in 1/scale, \e scale
  (s) being the lamp's length in time, so that all parameters are of order one.
*/
double lightAt(const vpModulation &sent, double t, double start, double averaging, double scale,
               Vector &derivative)
{
  const bool two = sent.kind == vpModulation::Kind::twoPulse;
  const double f = sent.frequency, x = f * t + start, own = two ? 0.5 : 1;
  const double d = sent.duty.value_or(0.5);
  const AveragedPulse one(x, f * averaging, own * d);
  double value = one.value, byX = one.byX, byDuty = own * one.byDuty, byWidth = one.byWidth, byK = 0;
  if (two) {
    const AveragedPulse other(x - sent.phaseDifference, f * averaging, own * d);
    value += other.value;
    byX += other.byX;
    byDuty += own * other.byDuty;
    byWidth += other.byWidth;
    byK = -other.byX;
  }
  derivative << (byX * t + byWidth * averaging) / scale, byX, byDuty, byWidth * f * averaging, byK, 1, value;
  return value;
}
} // namespace

vpStripePrediction::vpStripePrediction(const vpVlpRig &rig)
{
  const vpLineTiming timing = rig.lineTiming();
  demand(isPositive(rig.shutter.rowTime), "shutter: row_time_s", rig.shutter.rowTime);
  demand(timing.lines() > 0, "picture: lines", timing.lines());
  m_pixels = rig.shutter.alongColumns() ? rig.camera.get_px() : rig.camera.get_py();
  demand(isPositive(m_pixels), "camera: focal length in pixels", m_pixels);
  for (unsigned int k = 0; k < timing.lines(); ++k) {
    m_middle.push_back(timing.middle(k));
  }
  std::sort(m_middle.begin(), m_middle.end()); // a reversed readout
  m_lineTime = std::abs(timing.meanLineTime());
  m_exposure = std::hypot(timing.exposure(), timing.averaging());
  m_logExposureSigma = timing.logExposureSigma();
  m_relativeRowTime = rig.shutter.rowTimeSigma / rig.shutter.rowTime;
}

double vpStripePrediction::lines(double size, double height) const
{
  demand(isPositive(size), "size of the lamp (m)", size);
  demand(isPositive(height), "height of the lamp above the camera (m)", height);
  return std::min(pictureLines(), size / height * m_pixels);
}

double vpStripePrediction::height(double size, double lines) const
{
  demand(isPositive(size), "size of the lamp (m)", size);
  demand(isPositive(lines), "lines of the lamp", lines);
  return size * m_pixels / lines;
}

double vpStripePrediction::contrast(double frequency) const
{
  return std::abs(sinc(frequency * m_exposure));
}

double vpStripePrediction::frequencyOfContrast(double share) const
{
  if (m_exposure == 0) {
    return std::numeric_limits<double>::infinity();
  }
  double low = 0, high = 1; // periods: sinc falls from 1 to 0
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (sinc(middle) > share ? low : high) = middle;
  }
  return low / m_exposure;
}

double vpStripePrediction::sinusoidBound(double lines, double amplitude) const
{
  if (!(lines > 1) || !(amplitude > 0)) {
    return std::numeric_limits<double>::infinity();
  }
  const double eta = 0.5 * amplitude * amplitude * std::pow(10, snrDb / 10);
  return std::sqrt(12 / (eta * lines * (lines * lines - 1))) / (2 * M_PI * m_lineTime);
}

double vpStripePrediction::lineNoise(double duty) const
{
  return std::hypot(std::pow(10, -snrDb / 20), 2 * modelError * std::sqrt(duty));
}

double vpStripePrediction::frequencySigma(const vpModulation &modulation, double lines) const
{
  // Two pulses half a period apart have little at f and much at 2 f, which tells f twice as well.
  const int harmonics = modulation.kind == vpModulation::Kind::twoPulse ? 2 : 1;
  double amplitude = 0;
  for (int k = 1; k <= harmonics; ++k) {
    amplitude =
        std::max(amplitude, k * 4 * std::abs(modulation.harmonic(k)) * contrast(k * modulation.frequency));
  }
  const double byModel = lineNoise(modulation.duty.value_or(0.5)) / std::pow(10, -snrDb / 20);
  return margin * byModel * sinusoidBound(lines, amplitude);
}

//! The delivered lines that lamp number \e trial, anywhere in the picture, covers: the first one, and how
//! many.
std::pair<size_t, size_t> vpStripePrediction::linesUnder(double lines, int trial) const
{
  static const size_t stride = 7; // steps of a nearest-neighbour resize repeat after 25 lines or so
  const size_t n = std::min(m_middle.size(), static_cast<size_t>(std::max(2.0, std::floor(lines))));
  return {m_middle.size() == n ? 0 : stride * static_cast<size_t>(trial) % (m_middle.size() - n + 1), n};
}

vpStripeUncertainty vpStripePrediction::hiddenEdgesAt(const vpModulation &modulation, double lines, int trial,
                                                      double negligible) const
{
  // Short enough that the stripes hardly tell: it leaves gaps of its own.
  const double exposure = m_exposure * (1 - 0.5 * exposureTolerance);
  if (exposure >= m_lineTime) {
    return {};
  }
  const double seen = vpStripeLimits::untrue * std::max(0.0, m_lineTime - m_exposure);
  const double f = modulation.frequency;
  const auto [first, n] = linesUnder(lines, trial);
  Room room;
  for (const double edge : edgesOf(modulation)) {
    room.narrow(intervalsOf(edge + (trial + 0.5) / phases, 1 / f, &m_middle[first], n, exposure, seen),
                negligible / (f * f), 1 / f);
  }
  const double shift = f * std::sqrt(room.shifts / 12);
  return {f * f * (room.longer - room.shorter), shift, shift};
}

vpStripeUncertainty vpStripePrediction::hiddenEdges(const vpModulation &modulation, double lines) const
{
  static const double negligible = 0.1; // share of the other errors
  const double least = negligible * frequencySigma(modulation, lines);
  vpStripeUncertainty worst;
  for (int trial = 0; trial < phases; ++trial) {
    const vpStripeUncertainty here =
        hiddenEdgesAt(modulation, lines, trial, std::max(least, worst.frequency));
    worst.frequency = std::max(worst.frequency, here.frequency);
    worst.duty = std::max(worst.duty, here.duty);
  }
  worst.phaseDifference = worst.duty;
  return worst;
}

//! Standard deviation of the duty where the stripes would be the same with pulse and exposure exchanged.
double vpStripePrediction::takenForExposure(const vpModulation &modulation) const
{
  const double duty = modulation.duty.value_or(0.5),
               pulses = modulation.kind == vpModulation::Kind::twoPulse ? 2 : 1;
  const double other = pulses * modulation.frequency * m_exposure; // duty
  static const double whole = 0.98;
  if (other > whole) {
    return 0;
  }
  const double less = vpStripeLimits::unlikely(duty / other, m_logExposureSigma, other) -
                      vpStripeLimits::unlikely(1, m_logExposureSigma, duty);
  return less < 0 ? std::abs(other - duty) : vpStripeLimits::spread(other - duty, less);
}

vpStripeUncertainty vpStripePrediction::shapeSigma(const vpModulation &modulation, double lines) const
{
  const size_t n = std::min(m_middle.size(), static_cast<size_t>(std::max(2.0, std::floor(lines))));
  const double middle = 0.5 * (m_middle[0] + m_middle[n - 1]);
  const double scale = m_lineTime * static_cast<double>(n);
  const double averaging = std::max(m_exposure, 1e-3 / modulation.frequency);
  const double white = 0.5 * std::pow(10, -snrDb / 20); // of light, lit 1

  Matrix information = Matrix::Zero();
  Vector derivative;
  for (int j = 0; j < phases; j += 2) {
    for (size_t i = 0; i < n; ++i) {
      const double light =
          lightAt(modulation, m_middle[i] - middle, (j + 1.) / phases, averaging, scale, derivative);
      const double variance = white * white + modelError * modelError * light * light;
      information += derivative * derivative.transpose() / (0.5 * phases * variance);
    }
  }
  // What is known beforehand, as vpStripeAnalyzer has it: of the duty no more than that it is one.
  static const double anyDuty = 0.3, anyDifference = 0.15, loose = 10;
  Vector known = Vector::Constant(loose);
  known(ofDuty) = anyDuty;
  known(ofExposure) = exposureTolerance; // its derivative is by the exposure's logarithm
  known(ofDifference) = anyDifference;
  information.diagonal() += known.cwiseProduct(known).cwiseInverse();
  const Matrix covariance = information.inverse();
  vpStripeUncertainty sigma;
  sigma.duty = margin * std::sqrt(covariance(ofDuty, ofDuty));
  sigma.phaseDifference = margin * std::sqrt(covariance(ofDifference, ofDifference));
  sigma.duty = std::hypot(sigma.duty, takenForExposure(modulation));
  return sigma;
}

vpStripeUncertainty vpStripePrediction::uncertainty(const vpModulation &modulation, double lines,
                                                    double oscillatorPpm) const
{
  return together(modulation, lines, oscillatorPpm, shapeSigma(modulation, lines));
}

std::vector<vpStripeUncertainty> vpStripePrediction::scatter(const vpModulation &modulation, double lines,
                                                             double oscillatorPpm) const
{
  const vpStripeUncertainty shape = shapeSigma(modulation, lines);
  std::vector<vpStripeUncertainty> all;
  for (int trial = 0; trial < phases; ++trial) {
    vpStripeUncertainty hidden = hiddenEdgesAt(modulation, lines, trial, 0);
    hidden.frequency /= std::sqrt(12.); // of a uniform distribution
    all.push_back(sum(modulation, lines, oscillatorPpm, shape, hidden));
  }
  return all;
}

vpStripeUncertainty vpStripePrediction::together(const vpModulation &modulation, double lines,
                                                 double oscillatorPpm, const vpStripeUncertainty &shape) const
{
  return sum(modulation, lines, oscillatorPpm, shape, hiddenEdges(modulation, lines));
}

vpStripeUncertainty vpStripePrediction::sum(const vpModulation &modulation, double lines,
                                            double oscillatorPpm, const vpStripeUncertainty &shape,
                                            const vpStripeUncertainty &hidden) const
{
  const double f = modulation.frequency;
  vpStripeUncertainty all;
  all.frequency = std::hypot(std::hypot(frequencySigma(modulation, lines), hidden.frequency),
                             m_relativeRowTime * f, 1e-6 * oscillatorPpm * f);
  all.duty = std::hypot(shape.duty, hidden.duty, dutyError);
  all.phaseDifference = std::hypot(shape.phaseDifference, hidden.phaseDifference, phaseError);
  return all;
}

END_VISP_NAMESPACE
