/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_detection/vpStripePrediction.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>
#include <Eigen/LU>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

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

/*!
  Standard deviation of the pulses' length by edges that hide, periods: of one edge, in a gap of length g for
  the share g / T of all edges, where it may lie anywhere: g sqrt(g / T) / sqrt(12); of 2 f T N edges, half of
  them rising.
*/
double vpStripePrediction::hiddenEdges(double frequency, double lines) const
{
  const double gap = std::max(0.0, m_lineTime - m_exposure);
  const double stripes = std::max(1.0, frequency * m_lineTime * lines);
  return gap * std::sqrt(gap / m_lineTime / 12) * frequency * std::sqrt(2 / stripes);
}

void vpStripePrediction::shapeSigma(const vpModulation &modulation, double lines, double &dutySigma,
                                    double &phaseSigma) const
{
  static const int phases = 16; // averaged over
  const size_t n = std::min(m_middle.size(), static_cast<size_t>(std::max(1.0, std::floor(lines))));
  const size_t first = (m_middle.size() - n) / 2;
  const double middle = 0.5 * (m_middle[first] + m_middle[first + n - 1]);
  const double scale = m_lineTime * static_cast<double>(n);
  const double averaging = std::max(m_exposure, 1e-3 / modulation.frequency);
  const double white = 0.5 * std::pow(10, -snrDb / 20); // of light, lit 1

  Matrix information = Matrix::Zero();
  Vector derivative;
  for (int j = 0; j < phases; ++j) {
    for (size_t i = first; i < first + n; ++i) {
      const double light =
          lightAt(modulation, m_middle[i] - middle, (j + 0.5) / phases, averaging, scale, derivative);
      const double variance = white * white + modelError * modelError * light * light;
      information += derivative * derivative.transpose() / (phases * variance);
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
  const double hidden = hiddenEdges(modulation.frequency, lines);
  dutySigma = margin * std::hypot(std::sqrt(covariance(ofDuty, ofDuty)), hidden);
  phaseSigma = margin * std::hypot(std::sqrt(covariance(ofDifference, ofDifference)), hidden);
}

double vpStripePrediction::frequencyDoubt(const vpModulation &modulation, double lines,
                                          double oscillatorPpm) const
{
  const double f = modulation.frequency;
  return std::hypot(frequencySigma(modulation, lines), m_relativeRowTime * f, 1e-6 * oscillatorPpm * f);
}

vpStripeDoubt vpStripePrediction::doubt(const vpModulation &modulation, double lines,
                                        double oscillatorPpm) const
{
  vpStripeDoubt doubt;
  doubt.frequency = frequencyDoubt(modulation, lines, oscillatorPpm);
  shapeSigma(modulation, lines, doubt.duty, doubt.phaseDifference);
  doubt.duty = std::hypot(doubt.duty, dutyError);
  doubt.phaseDifference = std::hypot(doubt.phaseDifference, phaseError);
  return doubt;
}

END_VISP_NAMESPACE
