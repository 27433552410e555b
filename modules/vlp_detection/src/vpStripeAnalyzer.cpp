/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_detection/vpStripeAnalyzer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "vpOutlineModel.h"
#include "vpWaveformFit.h"

BEGIN_VISP_NAMESPACE

namespace
{

//! Stretch of line \e v inside the outline, shrunk towards its middle by \e share.
bool chordOf(const vpLampOutline &outline, double v, double share, double &first, double &last)
{
  if (outline.shape == vpLampOutline::Shape::ellipse) {
    if (!vpEllipseModel(outline.centre, outline.a, outline.b, outline.angle).stretch(v, 0, first, last)) {
      return false;
    }
  } else {
    first = 1e9;
    last = -1e9;
    for (size_t i = 0; i < 4; ++i) {
      const Eigen::Vector2d &p = outline.corners[i];
      const Eigen::Vector2d &q = outline.corners[(i + 1) % 4];
      if ((p.y() - v) * (q.y() - v) <= 0 && p.y() != q.y()) {
        const double u = p.x() + (q.x() - p.x()) * (v - p.y()) / (q.y() - p.y());
        first = std::min(first, u);
        last = std::max(last, u);
      }
    }
    if (first > last) {
      return false;
    }
  }
  const double cut = 0.5 * (1 - share) * (last - first);
  first += cut;
  last -= cut;
  return true;
}

//! Bright stripes and how their height goes along the lamp.
struct Peaks {
  std::vector<size_t> line;
  double deepest = 0; // depth of the deepest valley between peaks, as a share of the lower peak beside it
};

/*!
  Alternating highs and lows, each standing out from the one before by four standard deviations and by three
  tenths of itself: works alike for stripes of a few grey levels and of two hundred.
*/
Peaks findPeaks(const vpStripeProfile &profile)
{
  static const double share = 0.3;
  static const double sigmas = 4;
  Peaks peaks;
  const std::vector<double> &p = profile.light;
  size_t high = 0, low = 0;
  bool rising = true;
  for (size_t i = 1; i < p.size(); ++i) {
    const double least = sigmas * profile.sigma[i];
    if (rising) {
      if (p[i] > p[high]) {
        high = i;
      } else if (p[high] - p[i] > std::max(least, share * p[high])) {
        peaks.line.push_back(high);
        low = i;
        rising = false;
      }
    } else {
      if (p[i] < p[low]) {
        low = i;
      } else if (p[i] - p[low] > std::max(least, share * p[i])) {
        high = i;
        rising = true;
      }
    }
  }
  if (rising && (peaks.line.empty() || p[high] > 0.3 * p[peaks.line.back()])) {
    peaks.line.push_back(high);
  }
  return peaks;
}

double scaledLine(const vpStripeProfile &profile, size_t i)
{
  const auto [first, last] = std::minmax_element(profile.time.begin(), profile.time.end());
  return (2 * profile.time[i] - *first - *last) / std::max(*last - *first, 1e-12);
}

//! Polynomial of the given order through the logarithms of the peaks' heights.
Eigen::VectorXd envelopeThroughPeaks(const vpStripeProfile &profile, const Peaks &peaks, int order)
{
  const auto n = static_cast<Eigen::Index>(peaks.line.size());
  Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(order + 1);
  if (n == 0) {
    coefficients(0) = std::log(std::max(1.0, *std::max_element(profile.light.begin(), profile.light.end())));
    return coefficients;
  }
  const int fitted = static_cast<int>(std::min<Eigen::Index>(order, n - 1));
  Eigen::MatrixXd A(n + fitted, fitted + 1);
  Eigen::VectorXd b(n + fitted);
  A.setZero();
  b.setZero();
  for (Eigen::Index i = 0; i < n; ++i) {
    const double y = scaledLine(profile, peaks.line[i]);
    for (int k = 0; k <= fitted; ++k) {
      A(i, k) = std::pow(y, k);
    }
    b(i) = std::log(std::max(profile.light[peaks.line[i]], 0.5));
  }
  for (int k = 1; k <= fitted; ++k) {
    A(n + k - 1, k) = 0.1; // as flat as the peaks allow
  }
  coefficients.head(fitted + 1) = A.colPivHouseholderQr().solve(b);
  return coefficients;
}

struct Candidate {
  double frequency;
  double phase; // periods, of the sinusoid's maximum, at the middle of the profile
  double gain;  // in chi-square over a lamp without stripes
};

/*!
  Least-squares periodogram of the profile with its envelope divided out: at each frequency a sinusoid beside
  a level and a slope. Local maxima, the best first.
*/
std::vector<Candidate> periodogram(const vpStripeProfile &profile, const Eigen::VectorXd &envelope,
                                   double modelError)
{
  const auto n = static_cast<Eigen::Index>(profile.light.size());
  const auto [first, last] = std::minmax_element(profile.time.begin(), profile.time.end());
  const double middle = 0.5 * (*first + *last);
  const double span = (*last - *first) * n / std::max<double>(n - 1, 1);
  Eigen::VectorXd q(n), w(n), y(n), t(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    t(i) = profile.time[i] - middle;
    y(i) = 2 * t(i) / span;
    double log = 0;
    for (Eigen::Index k = envelope.size() - 1; k >= 0; --k) {
      log = log * y(i) + envelope(k);
    }
    const double scale = std::exp(log);
    q(i) = profile.light[i] / scale;
    w(i) = 1 / std::hypot(profile.sigma[i] / scale, modelError * std::min(1.0, q(i)));
  }
  Eigen::MatrixXd A(n, 4);
  A.col(0) = w;
  A.col(1) = w.cwiseProduct(y);
  const Eigen::VectorXd b = w.cwiseProduct(q);
  const Eigen::Matrix<double, Eigen::Dynamic, 2> plain = A.leftCols<2>();
  const Eigen::Vector2d plainFit = (plain.transpose() * plain).ldlt().solve(plain.transpose() * b);
  const double without = (b - plain * plainFit).squaredNorm();

  const double lowest = 0.7 / span;
  const double highest = 0.5 * n / span;
  const double step = 0.1 / span;
  std::vector<Candidate> all;
  for (double f = lowest; f <= highest + 0.5 * step; f += step) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const double angle = 2 * M_PI * f * t(i);
      A(i, 2) = w(i) * std::cos(angle);
      A(i, 3) = w(i) * std::sin(angle);
    }
    const Eigen::Matrix4d normal = A.transpose() * A + 1e-9 * Eigen::Matrix4d::Identity();
    const Eigen::Vector4d right = A.transpose() * b;
    const Eigen::Vector4d x = normal.ldlt().solve(right);
    const double gain = without - (b.squaredNorm() - x.dot(right));
    all.push_back({f, std::atan2(x(3), x(2)) / (2 * M_PI), gain});
  }
  std::vector<Candidate> maxima;
  for (size_t i = 0; i < all.size(); ++i) {
    if ((i == 0 || all[i].gain >= all[i - 1].gain) &&
        (i + 1 == all.size() || all[i].gain > all[i + 1].gain)) {
      maxima.push_back(all[i]);
    }
  }
  std::sort(maxima.begin(), maxima.end(),
            [](const Candidate &a, const Candidate &b) { return a.gain > b.gain; });
  return maxima;
}

/*!
  The best of several starts. Edges of pulses fall between lines, so that minima lie side by side and the
  curvature of one does not know the others: what explains the profile nearly as well widens the doubt.
*/
class BestFit
{
public:
  void add(vpWaveformFit &&fit) { m_fits.push_back(std::move(fit)); }

  std::optional<vpWaveformFit> result()
  {
    if (m_fits.empty()) {
      return std::nullopt;
    }
    vpWaveformFit best = *std::min_element(m_fits.begin(), m_fits.end(),
                                           [](const auto &a, const auto &b) { return a.cost() < b.cost(); });
    using P = vpWaveformFit;
    for (const P::Parameter parameter : {P::frequency, P::duty, P::phaseDifference}) {
      double spread = 0;
      for (const vpWaveformFit &other : m_fits) {
        const double likelihood = std::exp(0.5 * (best.cost() - other.cost())); // beside that of the best
        const double apart = other.value(parameter) - best.value(parameter);
        spread = std::max(spread, likelihood * apart * apart);
      }
      best.widen(parameter, spread);
    }
    return best;
  }

private:
  std::vector<vpWaveformFit> m_fits;
};

std::optional<vpWaveformFit> fitPwm(const vpStripeProfile &profile, const std::vector<Candidate> &candidates,
                                    const vpWaveformFit::Settings &settings, const Eigen::VectorXd &envelope)
{
  BestFit fits;
  for (const Candidate &candidate : candidates) {
    std::vector<double> exposures{profile.exposure};
    static const double longExposure =
        0.3; // periods: it may be misstated, and from there no way leads to sharp stripes
    if (profile.exposure * candidate.frequency > longExposure) {
      exposures.push_back(0.1 / candidate.frequency);
    }
    for (double exposure : exposures) {
      for (double duty : {0.25, 0.5, 0.75}) {
        vpWaveformFit fit(profile, settings);
        // The first harmonic peaks in the middle of the pulse.
        if (fit.run(candidate.frequency, 0.5 * duty - candidate.phase, duty, 0, envelope, exposure) &&
            fit.preferStatedExposure()) {
          fits.add(std::move(fit));
        }
      }
    }
  }
  return fits.result();
}

std::optional<vpWaveformFit> fitTwoPulse(const vpStripeProfile &profile,
                                         const std::vector<Candidate> &candidates,
                                         vpWaveformFit::Settings settings, const Eigen::VectorXd &envelope)
{
  settings.twoPulse = true;
  BestFit fits;
  const double span = profile.time.back() - profile.time.front();
  for (const Candidate &candidate : candidates) {
    for (int multiple = 1; multiple <= 2; ++multiple) { // the second harmonic may be the stronger
      const double f = candidate.frequency / multiple;
      if (f * std::abs(span) < 0.9) {
        continue;
      }
      for (double k : {0.15, 0.25, 0.35, 0.45}) {
        for (double start : {0.0, 0.25, 0.5, 0.75}) {
          vpWaveformFit fit(profile, settings);
          if (fit.run(f, start, 0.3, k, envelope)) {
            fits.add(std::move(fit));
          }
        }
      }
    }
  }
  return fits.result();
}

void take(vpStripeFeatures &features, const vpWaveformFit &fit, bool twoPulse)
{
  using P = vpWaveformFit;
  features.signal = twoPulse ? vpStripeFeatures::Signal::twoPulse : vpStripeFeatures::Signal::pwm;
  features.frequency = fit.value(P::frequency);
  features.frequencySigma = fit.sigma(P::frequency);
  features.duty = fit.value(P::duty);
  features.dutySigma = fit.sigma(P::duty);
  features.misfit = fit.misfit();
  if (twoPulse) {
    features.phaseDifference = fit.value(P::phaseDifference);
    features.phaseDifferenceSigma = fit.sigma(P::phaseDifference);
  }
}

} // namespace

vpStripeProfile vpStripeProfile::along(const cv::Mat_<unsigned char> &lines, const vpLineTiming &timing,
                                       const vpOutlineFit &fit, const vpLedRoi &roi)
{
  const vpLampOutline &outline = fit.outline;
  const bool soft = outline.shape == vpLampOutline::Shape::region || fit.blur > 0.1 * outline.diameter() / 2;
  const double share = soft ? 0.35 : 0.8;
  const double margin = soft ? 0 : 2 * fit.blur;
  const Eigen::Vector4d box = outline.box();
  vpStripeProfile profile;
  profile.exposure = std::hypot(timing.exposure(), timing.averaging());
  const bool sidesHidden = outline.shape != vpLampOutline::Shape::ellipse; // those along the lines
  const double top = sidesHidden ? std::max<double>(roi.box.y, box(1)) : std::max(0.0, box(1));
  const double bottom =
      sidesHidden ? std::min<double>(roi.box.br().y - 1, box(3)) : std::min(lines.rows - 1.0, box(3));
  const int from = static_cast<int>(std::ceil(top + margin));
  const int to = static_cast<int>(std::floor(bottom - margin));
  const double noise = std::max(fit.noise, 0.3);
  for (int line = from; line <= to; ++line) {
    double first, last;
    if (!chordOf(outline, line, share, first, last)) {
      continue;
    }
    const int left = std::max(0, static_cast<int>(std::ceil(first)));
    const int right = std::min(lines.cols - 1, static_cast<int>(std::floor(last)));
    if (right - left < 2) {
      continue;
    }
    double sum = 0;
    for (int x = left; x <= right; ++x) {
      sum += lines(line, x);
    }
    const int count = right - left + 1;
    profile.time.push_back(timing.middle(static_cast<unsigned int>(line)));
    profile.light.push_back(sum / count - fit.background);
    profile.sigma.push_back(noise / std::sqrt(count));
  }
  return profile;
}

vpStripeFeatures vpStripeAnalyzer::analyze(const vpStripeProfile &profile) const
{
  vpStripeFeatures features;
  static const size_t fewestLines = 6;
  if (profile.light.size() < fewestLines) {
    return features;
  }
  const Peaks peaks = findPeaks(profile);
  features.stripes = static_cast<unsigned int>(peaks.line.size());
  std::vector<double> sorted = profile.light;
  std::sort(sorted.begin(), sorted.end());
  const double low = std::max(0.0, sorted[sorted.size() / 20]);
  const double high = sorted[sorted.size() - 1 - sorted.size() / 20];
  features.modulation = high > 0 ? std::clamp((high - low) / (high + low), 0.0, 1.0) : 0;

  double dimmest = high, brightest = 0;
  for (size_t line : peaks.line) {
    dimmest = std::min(dimmest, profile.light[line]);
    brightest = std::max(brightest, profile.light[line]);
  }
  static const double evenEmitter = 1.6;
  vpWaveformFit::Settings settings;
  settings.modelError = modelError;
  settings.exposureTolerance = exposureTolerance;
  settings.envelopeOrder =
      std::clamp(static_cast<int>(peaks.line.size()) - 1, 0, brightest > evenEmitter * dimmest ? 4 : 2);
  const Eigen::VectorXd envelope = envelopeThroughPeaks(profile, peaks, settings.envelopeOrder);
  std::vector<Candidate> candidates = periodogram(profile, envelope, modelError);
  if (candidates.empty() || candidates.front().gain < minSignificance ||
      features.modulation < minModulation) {
    return features;
  }
  candidates.resize(std::min<size_t>(candidates.size(), 3));

  const std::optional<vpWaveformFit> pwm = fitPwm(profile, candidates, settings, envelope);
  if (pwm) {
    take(features, *pwm, false);
  }
  static const double wellExplained = 0.05;
  if (searchTwoPulses && (!pwm || pwm->misfit() > wellExplained)) {
    const std::optional<vpWaveformFit> two = fitTwoPulse(profile, candidates, settings, envelope);
    if (two && two->misfit() < maxMisfit && (!pwm || two->misfit() < 0.5 * pwm->misfit())) {
      take(features, *two, true);
    }
  }
  // Less than a period shows how long a pulse or a gap is, not how often it comes; and no fit of so few lines
  // is put to the test.
  static const double leastPeriods = 1.2;
  static const size_t leastLines = 8;
  const double span = std::abs(profile.time.back() - profile.time.front());
  if (span * features.frequency < leastPeriods || profile.time.size() < leastLines) {
    features.frequencySigma = std::max(features.frequencySigma, features.frequency);
  }
  if (!(features.misfit < maxMisfit)) {
    features.signal = vpStripeFeatures::Signal::coded;
    const double none = std::numeric_limits<double>::quiet_NaN(); // what was fitted is not what it sends
    features.frequency = features.frequencySigma = features.duty = features.dutySigma = none;
    features.phaseDifference = features.phaseDifferenceSigma = none;
  }
  return features;
}

END_VISP_NAMESPACE
