/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vpStripeProfile::agreedByColumns(): the modulation that all columns of a lamp share, whatever its emission
// pattern.

#include <visp3/vlp_identification/vpStripeAnalyzer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include <visp3/vlp_core/vpBrighter.h>

BEGIN_VISP_NAMESPACE

namespace
{
//! Moves the values, of which there are some, about.
double medianOf(std::vector<double> &values)
{
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

//! A strip of columns, line by line: its light, grey levels, NaN where it shows none of the lamp or the grey
//! scale ends; and what the other lines say of its emission there.
struct Strip {
  std::vector<double> light, emission, variance;
  double variancePerLine = 0; // grey levels^2, by which the emission changes from line to line
};

//! Mean and variance, grey levels, of a strip's emission.
struct Estimate {
  double mean = 0, variance = 0;
};

/*!
  The shared modulation m and the strips' emissions S by turns: light = S m + noise, S a random walk along the
  lines (Rauch, Tung and Striebel 1965). Each line's m comes from what all other lines say of S there, so that
  it is no cause of itself; the walk's variance is that at which the innovations are as large as they should
  be (Mehra 1970).
*/
class SharedModulation
{
public:
  SharedModulation(std::vector<Strip> strips, double noise);
  void iterate();
  size_t lines() const { return m_modulation.size(); }
  double modulation(size_t line) const { return m_modulation[line]; }
  double sigma(size_t line) const { return m_sigma[line]; } // infinite where no strip tells

private:
  void start();
  void smooth(Strip &strip) const;
  double filter(const Strip &strip, bool backwards, std::vector<Estimate> &before) const;
  void shareTrend();
  void share();

  std::vector<Strip> m_strips;
  std::vector<double> m_modulation, m_sigma;
  double m_noise; // grey levels^2, of a strip's light
  double m_brightest = 0;
};

SharedModulation::SharedModulation(std::vector<Strip> strips, double noise)
    : m_strips(std::move(strips)), m_noise(noise * noise)
{
  static const double soon = 0.1; // share of the brightest light, by which a strip may change in a line
  const size_t lines = m_strips.empty() ? 0 : m_strips.front().light.size();
  m_modulation.assign(lines, 1);
  m_sigma.assign(lines, std::numeric_limits<double>::infinity());
  for (Strip &strip : m_strips) {
    double most = 0;
    for (double light : strip.light) {
      most = std::fmax(most, light);
    }
    m_brightest = std::max(m_brightest, most);
    strip.variancePerLine = (soon * most) * (soon * most) + 1e-6;
    strip.emission.resize(lines);
    strip.variance.resize(lines);
  }
  start();
}

//! To begin with, each line's light over the most that its strips have near it.
void SharedModulation::start()
{
  static const size_t periods = 4;   // that a lamp shows, or more
  static const double dimmest = 0.1; // share of the brightest strip
  const size_t n = lines(), reach = std::max<size_t>(2, n / (2 * periods));
  for (size_t i = 0; i < n; ++i) {
    std::vector<double> shares;
    for (const Strip &strip : m_strips) {
      double most = 0;
      for (size_t k = i - std::min(i, reach); k < std::min(n, i + reach + 1); ++k) {
        most = std::fmax(most, strip.light[k]);
      }
      if (!std::isnan(strip.light[i]) && most > dimmest * m_brightest) {
        shares.push_back(strip.light[i] / most);
      }
    }
    m_modulation[i] = shares.empty() ? 0.5 : std::clamp(medianOf(shares), 0.0, 1.0);
  }
}

//! What the lines before each one say of the strip's emission there. \return Mean square of the innovations
//! over their variance.
double SharedModulation::filter(const Strip &strip, bool backwards, std::vector<Estimate> &before) const
{
  const size_t n = lines();
  before.resize(n);
  Estimate now{0, m_brightest * m_brightest};
  double sum = 0;
  int count = 0;
  for (size_t k = 0; k < n; ++k) {
    const size_t i = backwards ? n - 1 - k : k;
    before[i] = now;
    const double m = m_modulation[i], light = strip.light[i];
    if (!std::isnan(light)) {
      const double innovation = light - m * now.mean, variance = m * m * now.variance + m_noise,
                   gain = m * now.variance / variance;
      now.mean += gain * innovation;
      now.variance *= 1 - gain * m;
      sum += innovation * innovation / variance;
      ++count;
    }
    now.variance += strip.variancePerLine;
  }
  return count > 0 ? sum / count : 1;
}

void SharedModulation::smooth(Strip &strip) const
{
  std::vector<Estimate> before, after;
  static const double step = 4;
  const double chiSquare = filter(strip, false, before);
  strip.variancePerLine *= std::clamp(chiSquare, 1 / step, step);
  filter(strip, false, before);
  filter(strip, true, after);
  for (size_t i = 0; i < before.size(); ++i) {
    const double first = 1 / before[i].variance, second = 1 / after[i].variance;
    strip.variance[i] = 1 / (first + second);
    strip.emission[i] = std::max(0.0, strip.variance[i] * (first * before[i].mean + second * after[i].mean));
  }
}

//! Each line's modulation: strips where the emission jumps are outliers, Student's t of few degrees of
//! freedom.
void SharedModulation::share()
{
  static const double freedom = 2;
  std::vector<double> known;
  for (size_t i = 0; i < lines(); ++i) {
    double square = 0;
    for (int step = 0; step < 4; ++step) {
      double product = 0;
      square = 0;
      for (const Strip &strip : m_strips) {
        const double light = strip.light[i], emission = strip.emission[i];
        if (!std::isnan(light)) {
          const double m = m_modulation[i], variance = m_noise + m * m * strip.variance[i],
                       left = light - m * emission,
                       weight = (freedom + 1) / (freedom + left * left / variance) / variance;
          product += weight * emission * light;
          square += weight * emission * emission;
        }
      }
      m_modulation[i] = square > 0 ? std::max(0.0, product / square) : 0;
    }
    m_sigma[i] = 1 / std::sqrt(square);
    if (square > 1) {
      known.push_back(m_modulation[i]);
    }
  }
  if (known.empty()) {
    return;
  }
  static const double lit = 0.9; // share of the lines that are darker than a lit one
  const auto bright = known.begin() + static_cast<long>(lit * static_cast<double>(known.size() - 1));
  std::nth_element(known.begin(), bright, known.end());
  const double scale = std::max(*bright, 1e-6);
  for (size_t i = 0; i < lines(); ++i) {
    m_modulation[i] /= scale;
    m_sigma[i] /= scale;
  }
}

//! What half of the strips say of the emission's change from one line to the next is the modulation's, or the
//! envelope's, of which nothing else tells it.
void SharedModulation::shareTrend()
{
  static const double dimmest = 0.02, lit = 0.3; // shares of the brightest light, of a lit line's
  double gain = 1;
  std::vector<double> gains(lines(), 1), ratios;
  for (size_t i = 1; i < lines(); ++i) {
    ratios.clear();
    const bool told = m_modulation[i] > lit && m_modulation[i - 1] > lit; // in the dark nothing is
    for (const Strip &strip : m_strips) {
      if (told && strip.emission[i - 1] > dimmest * m_brightest &&
          strip.emission[i] > dimmest * m_brightest && !std::isnan(strip.light[i]) &&
          !std::isnan(strip.light[i - 1])) {
        ratios.push_back(strip.emission[i] / strip.emission[i - 1]);
      }
    }
    gain *= ratios.empty() ? 1 : medianOf(ratios);
    gains[i] = gain;
  }
  for (size_t i = 0; i < lines(); ++i) {
    m_modulation[i] *= gains[i];
    for (Strip &strip : m_strips) {
      strip.emission[i] /= gains[i];
      strip.variance[i] /= gains[i] * gains[i];
    }
  }
}

void SharedModulation::iterate()
{
  for (Strip &strip : m_strips) {
    smooth(strip);
  }
  shareTrend();
  share();
}

//! Standard deviation of a region's pixels, grey levels: what neighbours differ by, whatever pattern they
//! show.
double noiseOf(const cv::Mat_<unsigned char> &lines, const cv::Rect &box)
{
  static const double least = 0.3,
                      perMedian = 0.954; // 8 bits round; median of two Gaussian pixels' difference
  static const int enough = 10000;       // pairs, for a hundredth of it
  const int step = 1 + box.area() / enough;
  std::array<int, 256> pairs{}; // of each difference
  int all = 0;
  for (int line = box.y; line < box.br().y; line += step, all += box.width - 1) {
    const unsigned char *row = lines[line] + box.x;
    for (int x = 0; x + 1 < box.width; ++x) {
      ++pairs[static_cast<size_t>(std::abs(row[x + 1] - row[x]))];
    }
  }
  int median = 0;
  for (int fewer = pairs[0]; 2 * fewer <= all && median < 255;) {
    fewer += pairs[static_cast<size_t>(++median)];
  }
  return std::max(least, median / perMedian);
}

/*!
  Means of the lines of a region, strip by strip, above its darkest twentieth; of those inside the lamp, where
  its outline is known.
*/
std::vector<Strip> stripsOf(const cv::Mat_<unsigned char> &lines, const cv::Rect &box,
                            const vpLampOutline &outline, int width)
{
  static const unsigned char nearlyWhite = 250;
  static const size_t few = 20;
  std::vector<Strip> strips(static_cast<size_t>(box.width / width));
  std::vector<double> all;
  for (int line = box.y; line < box.br().y; ++line) {
    double from = box.x, to = box.br().x;
    if (outline.shape != vpLampOutline::Shape::region && !outline.stretch(line, from, to)) {
      from = to = box.x;
    }
    int first = box.x;
    for (Strip &strip : strips) {
      const unsigned char *row = lines[line] + first;
      const double mean = static_cast<double>(vpBrighter::sum(row, width)) / width;
      all.push_back(mean);
      const bool shows =
          first > from && first + width - 1 < to && vpBrighter::brightest(row, width) < nearlyWhite;
      strip.light.push_back(shows ? mean : std::nan(""));
      first += width;
    }
  }
  if (all.empty()) {
    return {};
  }
  const auto darkest = all.begin() + static_cast<long>(all.size() / few);
  std::nth_element(all.begin(), darkest, all.end());
  for (Strip &strip : strips) {
    for (double &light : strip.light) {
      light -= *darkest;
    }
  }
  return strips;
}
} // namespace

vpStripeProfile vpStripeProfile::agreedByColumns(const cv::Mat_<unsigned char> &lines,
                                                 const vpLineTiming &timing, const vpOutlineFit &fit,
                                                 const vpLedRoi &roi)
{
  static const int mostStrips = 32, narrowest = 2; // samples
  static const int rounds = 6;
  static const double lit = 100, least = 0.5; // grey levels, of a lit line; of its standard deviation
  static const double unknown = 0.3;          // standard deviation of a line that tells nothing
  vpStripeProfile profile;
  profile.exposure = std::hypot(timing.exposure(), timing.averaging());
  profile.logExposureSigma = timing.logExposureSigma();
  const int width = std::max(narrowest, roi.box.width / mostStrips);
  SharedModulation shared(stripsOf(lines, roi.box, fit.outline, width),
                          noiseOf(lines, roi.box) / std::sqrt(width));
  for (int round = 0; round < rounds; ++round) {
    shared.iterate();
  }
  for (size_t i = 0; i < shared.lines(); ++i) {
    if (shared.sigma(i) < unknown) {
      profile.time.push_back(
          timing.middle(static_cast<unsigned int>(roi.box.y) + static_cast<unsigned int>(i)));
      profile.light.push_back(lit * shared.modulation(i));
      profile.sigma.push_back(std::max(least, lit * shared.sigma(i)));
    }
  }
  return profile;
}

END_VISP_NAMESPACE
