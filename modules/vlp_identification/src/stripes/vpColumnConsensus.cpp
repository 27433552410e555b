/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vpStripeProfile::agreedByColumns(): the modulation that all columns of a lamp share, whatever its emission
// pattern.

#include <visp3/vlp_identification/vpStripeAnalyzer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Core>
#include <opencv2/imgproc.hpp>
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

//! Strips of columns: of each one its light, grey levels, on each line.
struct Strips {
  Eigen::ArrayXXd light; // strip, line; 0 where it is not seen
  Eigen::ArrayXXd seen;  // 1; 0 where the strip shows none of the lamp or the grey scale ends
};

//! Of the strips' emission on each line, grey levels.
struct Estimate {
  Eigen::ArrayXXd mean, variance; // strip, line
};

/*!
  The shared modulation m and the strips' emissions S by turns: light = S m + noise, S a random walk along the
  lines (Rauch, Tung and Striebel 1965). Each line's m comes from what all other lines say of S there, so that
  it is no cause of itself; the walk's variance is that at which the innovations are as large as they should
  be (Mehra 1970). All strips are worked on side by side.
*/
class SharedModulation
{
public:
  SharedModulation(Strips strips, double noise);
  void iterate();
  size_t lines() const { return m_modulation.size(); }
  double modulation(size_t line) const { return m_modulation[line]; }
  double sigma(size_t line) const { return m_sigma[line]; } // infinite where no strip tells

private:
  void start();
  void smooth();
  Eigen::ArrayXd filter(bool backwards, Estimate &before) const;
  void shareTrend();
  void share();

  Strips m_strips;
  Estimate m_emission, m_before, m_after; // by all lines, by those before and by those after each one
  Eigen::ArrayXd m_walk; // grey levels^2, by which a strip's emission changes from line to line
  std::vector<double> m_modulation, m_sigma;
  double m_noise; // grey levels^2, of a strip's light
  double m_brightest = 0;
};

SharedModulation::SharedModulation(Strips strips, double noise)
    : m_strips(std::move(strips)), m_noise(noise * noise)
{
  static const double soon = 0.1; // share of the brightest light, by which a strip may change in a line
  const Eigen::Index count = m_strips.light.rows(), lines = m_strips.light.cols();
  if (m_strips.light.size() == 0) {
    return;
  }
  m_modulation.assign(static_cast<size_t>(lines), 1);
  m_sigma.assign(static_cast<size_t>(lines), std::numeric_limits<double>::infinity());
  for (Estimate *each : {&m_emission, &m_before, &m_after}) {
    each->mean.setZero(count, lines);
    each->variance.setZero(count, lines);
  }
  const Eigen::ArrayXd most = m_strips.light.rowwise().maxCoeff().max(0);
  m_brightest = most.maxCoeff();
  m_walk = (soon * most).square() + 1e-6;
  start();
}

//! To begin with, each line's light over the most that its strips have near it.
void SharedModulation::start()
{
  static const int periods = 4;      // that a lamp shows, or more
  static const double dimmest = 0.1; // share of the brightest strip
  const auto n = static_cast<int>(m_strips.light.cols()), count = static_cast<int>(m_strips.light.rows());
  const int reach = std::max(2, n / (2 * periods));
  const cv::Mat_<double> light(n, count, m_strips.light.data());
  cv::Mat_<double> most;
  cv::dilate(light, most, cv::Mat::ones(2 * reach + 1, 1, CV_8U));
  std::vector<double> shares;
  for (int i = 0; i < n; ++i) {
    shares.clear();
    for (int strip = 0; strip < count; ++strip) {
      if (m_strips.seen(strip, i) > 0 && most(i, strip) > dimmest * m_brightest) {
        shares.push_back(light(i, strip) / most(i, strip));
      }
    }
    const auto line = static_cast<size_t>(i);
    m_modulation[line] = shares.empty() ? 0.5 : std::clamp(medianOf(shares), 0.0, 1.0);
    m_sigma[line] = std::sqrt(m_noise / static_cast<double>(shares.size())) / m_brightest;
  }
}

//! What the lines before each one say of the emission there. \return Of each strip, mean square of the
//! innovations over their variance.
Eigen::ArrayXd SharedModulation::filter(bool backwards, Estimate &before) const
{
  const Eigen::Index n = m_strips.light.cols(), count = m_strips.light.rows();
  Eigen::ArrayXd mean = Eigen::ArrayXd::Zero(count),
                 variance = Eigen::ArrayXd::Constant(count, m_brightest * m_brightest), sum = mean,
                 innovation(count), precision(count);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index i = backwards ? n - 1 - k : k;
    before.mean.col(i) = mean;
    before.variance.col(i) = variance;
    const double m = m_modulation[static_cast<size_t>(i)];
    innovation = m_strips.light.col(i) - m * mean;
    precision = m_strips.seen.col(i) / (m * m * variance + m_noise);
    sum += innovation.square() * precision;
    mean += m * variance * precision * innovation;
    variance += m_walk - (m * variance).square() * precision;
  }
  const Eigen::ArrayXd seen = m_strips.seen.rowwise().sum();
  return (seen > 0).select(sum / seen.max(1), 1);
}

void SharedModulation::smooth()
{
  static const double step = 4;
  m_walk *= filter(false, m_before).max(1 / step).min(step);
  filter(false, m_before);
  filter(true, m_after);
  m_emission.variance = m_before.variance * m_after.variance / (m_before.variance + m_after.variance);
  m_emission.mean =
      (m_emission.variance * (m_before.mean / m_before.variance + m_after.mean / m_after.variance)).max(0);
}

//! Each line's modulation: strips where the emission jumps are outliers, Student's t of few degrees of
//! freedom.
void SharedModulation::share()
{
  static const double freedom = 2;
  std::vector<double> known;
  Eigen::ArrayXd weight(m_strips.light.rows());
  for (size_t i = 0; i < lines(); ++i) {
    const auto line = static_cast<Eigen::Index>(i);
    const auto light = m_strips.light.col(line), emission = m_emission.mean.col(line);
    double square = 0;
    for (int step = 0; step < 4; ++step) {
      const double m = m_modulation[i];
      weight =
          (freedom + 1) * m_strips.seen.col(line) * emission /
          (freedom * (m_noise + m * m * m_emission.variance.col(line)) + (light - m * emission).square());
      square = (weight * emission).sum();
      m_modulation[i] = square > 0 ? std::max(0.0, (weight * light).sum() / square) : 0;
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
  const Eigen::ArrayXXd &emission = m_emission.mean, &seen = m_strips.seen;
  double gain = 1;
  std::vector<double> gains(lines(), 1), ratios;
  for (size_t i = 1; i < lines(); ++i) {
    ratios.clear();
    const auto line = static_cast<Eigen::Index>(i);
    const bool told = m_modulation[i] > lit && m_modulation[i - 1] > lit; // in the dark nothing is
    for (Eigen::Index strip = 0; told && strip < emission.rows(); ++strip) {
      if (emission(strip, line - 1) > dimmest * m_brightest &&
          emission(strip, line) > dimmest * m_brightest && seen(strip, line) * seen(strip, line - 1) > 0) {
        ratios.push_back(emission(strip, line) / emission(strip, line - 1));
      }
    }
    gain *= ratios.empty() ? 1 : medianOf(ratios);
    gains[i] = gain;
  }
  for (size_t i = 0; i < lines(); ++i) {
    const auto line = static_cast<Eigen::Index>(i);
    m_modulation[i] *= gains[i];
    m_emission.mean.col(line) /= gains[i];
    m_emission.variance.col(line) /= gains[i] * gains[i];
  }
}

void SharedModulation::iterate()
{
  if (m_modulation.empty()) {
    return;
  }
  smooth();
  shareTrend();
  share();
}

/*!
  Means of the lines of a region, strip by strip, above its darkest twentieth; of those inside the lamp, where
  its outline is known.
*/
Strips stripsOf(const cv::Mat_<unsigned char> &lines, const cv::Rect &box, const vpLampOutline &outline,
                int width)
{
  static const size_t few = 20;
  Strips strips{Eigen::ArrayXXd(box.width / width, box.height),
                Eigen::ArrayXXd(box.width / width, box.height)};
  const vpOutlineLines across(outline);
  for (int i = 0; i < box.height; ++i) {
    const int line = box.y + i;
    double from = box.x, to = box.br().x;
    if (outline.shape != vpLampOutline::Shape::region && !across.stretch(line, from, to)) {
      from = to = box.x;
    }
    for (int k = 0, first = box.x; k < strips.light.rows(); ++k, first += width) {
      const unsigned char *row = lines[line] + first;
      strips.light(k, i) = static_cast<double>(vpBrighter::sum(row, width)) / width;
      strips.seen(k, i) = first > from && first + width - 1 < to &&
                                  vpBrighter::brightest(row, width) < vpBrighter::nearlyWhite
                              ? 1
                              : 0;
    }
  }
  if (strips.light.size() > 0) {
    std::vector<double> all(strips.light.data(), strips.light.data() + strips.light.size());
    const auto darkest = all.begin() + static_cast<long>(all.size() / few);
    std::nth_element(all.begin(), darkest, all.end());
    strips.light = (strips.light - *darkest) * strips.seen;
  }
  return strips;
}
} // namespace

vpStripeProfile vpStripeProfile::agreedByColumns(const cv::Mat_<unsigned char> &lines,
                                                 const vpLineTiming &timing, const vpOutlineFit &fit,
                                                 const vpLedRoi &roi)
{
  static const int mostStrips = 32, narrowest = 2; // samples
  static const double lit = 100, least = 0.5;      // grey levels, of a lit line; of its standard deviation
  static const int rounds = 6;                     // of turns
  static const double unknown = 0.3;               // standard deviation of a line that tells nothing
  vpStripeProfile profile;
  profile.exposure = std::hypot(timing.exposure(), timing.averaging());
  profile.logExposureSigma = timing.logExposureSigma();
  const int width = std::max(narrowest, roi.box.width / mostStrips);
  SharedModulation shared(stripsOf(lines, roi.box, fit.outline, width),
                          vpOutlineFitter::noiseOf(lines, roi.box) / std::sqrt(width));
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
