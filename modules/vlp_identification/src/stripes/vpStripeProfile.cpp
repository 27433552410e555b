/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_identification/vpStripeAnalyzer.h>

#include <algorithm>
#include <cmath>

#include <visp3/vlp_core/vpBrighter.h>

#include "vpBlackEnd.h"

BEGIN_VISP_NAMESPACE

namespace
{

//! The part of line \e v inside an outline, shrunk towards its middle by \e share; false: none.
bool stretch(const vpLampOutline &outline, double v, double share, double &first, double &last)
{
  if (!outline.stretch(v, first, last)) {
    return false;
  }
  const double cut = 0.5 * (1 - share) * (last - first);
  first += cut;
  last -= cut;
  return true;
}

//! Samples of one line that lie inside the lamp.
struct Chord {
  int line, first, last;
};

//! The light of one line of the lamp, and that of its left and right half, grey levels.
struct LineLight {
  double whole, left, right;
  int samples, half;

  LineLight(const unsigned char *row, const Chord &chord, double background)
      : samples(chord.last - chord.first + 1), half(samples / 2)
  {
    const int ofLeft = vpBrighter::sum(row + chord.first, half),
              ofRight = vpBrighter::sum(row + chord.last - half + 1, half),
              between = 2 * half < samples ? row[chord.first + half] : 0;
    left = static_cast<double>(ofLeft) / half - background;
    right = static_cast<double>(ofRight) / half - background;
    whole = static_cast<double>(ofLeft + ofRight + between) / samples - background;
  }
};

/*!
  Correlation over the lines of what their left and right halves show, pixel noise taken off: 1 where light
  that varies from line to line does so on the whole of each line, as a shutter's stripes do.
*/
class Agreement
{
public:
  void add(const LineLight &line, double noise)
  {
    static const int fewest = 8; // samples of a line
    if (line.samples < fewest) {
      return;
    }
    const double left = line.left, right = line.right, weight = line.samples;
    m_weight += weight;
    m_left += weight * left;
    m_right += weight * right;
    m_leftLeft += weight * left * left;
    m_rightRight += weight * right * right;
    m_leftRight += weight * left * right;
    m_noise += weight * noise * noise / line.half;
  }

  double value() const
  {
    if (!(m_weight > 0)) {
      return 1;
    }
    const double left = m_left / m_weight, right = m_right / m_weight, noise = m_noise / m_weight;
    const double leftVariance = m_leftLeft / m_weight - left * left - noise,
                 rightVariance = m_rightRight / m_weight - right * right - noise;
    const double common = m_leftRight / m_weight - left * right;
    return common / std::sqrt(std::max(leftVariance * rightVariance, 1e-12));
  }

private:
  double m_weight = 0, m_left = 0, m_right = 0, m_leftLeft = 0, m_rightRight = 0, m_leftRight = 0,
         m_noise = 0;
};

/*!
  A lamp adds light: its surroundings are no brighter than its darkest lines, which a glow beside its edge may
  make them seem. \return By how much they were, grey levels up to 0.
*/
double subtractDarkest(std::vector<double> &light)
{
  static const size_t few = 20; // a part of the lines
  if (light.empty()) {
    return 0;
  }
  std::vector<double> sorted = light;
  const auto darkest = sorted.begin() + static_cast<long>(sorted.size() / few);
  std::nth_element(sorted.begin(), darkest, sorted.end());
  const double below = std::min(0.0, *darkest);
  for (double &line : light) {
    line -= below;
  }
  return below;
}

/*!
  Takes light and noise of the lines, which \e chords are, to what they were before the grey scale's dark end
  clipped them. \param noise Of a pixel, grey levels, about. \return The same of the surroundings, grey
  levels.
*/
double unclip(const cv::Mat_<unsigned char> &lines, const std::vector<Chord> &chords, double background,
              double noise, vpStripeProfile &profile)
{
  static const double rounding = 1, above = 2; // grey levels; deviations, from where means are as they seem
  if (noise < rounding || chords.empty() ||
      background + *std::min_element(profile.light.begin(), profile.light.end()) > above * noise) {
    return background;
  }
  std::vector<vpBlackEnd::Line> shown;
  for (size_t i = 0; i < chords.size(); ++i) {
    const int samples = chords[i].last - chords[i].first + 1,
              bright = vpBrighter::count(lines[chords[i].line] + chords[i].first, samples, 0);
    shown.push_back({profile.light[i] + background, samples, samples - bright});
  }
  const vpBlackEnd end(shown, noise);
  background = end.before(background).mean;
  for (size_t i = 0; i < shown.size(); ++i) {
    const vpBlackEnd::Light light = end.before(shown[i].mean);
    profile.light[i] = light.mean - background;
    profile.sigma[i] = std::max(profile.sigma[i], light.sigma / std::sqrt(shown[i].samples));
  }
  return background;
}

} // namespace

double vpStripeProfile::depth() const
{
  if (light.empty()) {
    return 0;
  }
  std::vector<double> sorted = light;
  std::sort(sorted.begin(), sorted.end());
  const double low = std::max(0.0, sorted[sorted.size() / 20]);
  const double high = sorted[sorted.size() - 1 - sorted.size() / 20];
  return high > 0 ? std::clamp((high - low) / (high + low), 0.0, 1.0) : 0;
}

vpStripeProfile vpStripeProfile::along(const cv::Mat_<unsigned char> &lines, const vpLineTiming &timing,
                                       const vpOutlineFit &fit, const vpLedRoi &roi)
{
  const vpLampOutline &outline = fit.outline;
  const bool ellipse = outline.shape == vpLampOutline::Shape::ellipse; // else its sides along the lines hide
  const bool soft = outline.shape == vpLampOutline::Shape::region || fit.blur > 0.1 * outline.diameter() / 2;
  static const double halfALine = 0.5; // px, that a line is wide beside its middle
  const double margin = soft ? 0 : 2 * fit.blur + halfALine;
  const Eigen::Vector4d box = outline.box();
  const double top = ellipse ? std::max(0.0, box(1)) : std::max<double>(roi.box.y, box(1));
  const double bottom =
      ellipse ? std::min(lines.rows - 1.0, box(3)) : std::min<double>(roi.box.br().y - 1, box(3));
  auto chordsOf = [&](double share) {
    std::vector<Chord> chords;
    for (int line = static_cast<int>(std::ceil(top + margin)); line <= bottom - margin; ++line) {
      double first, last;
      if (!stretch(outline, line, share, first, last)) {
        continue;
      }
      const int left = std::max(0, static_cast<int>(std::ceil(first)));
      const int right = std::min(lines.cols - 1, static_cast<int>(std::floor(last)));
      if (right - left >= 2) {
        chords.push_back({line, left, right});
      }
    }
    return chords;
  };
  static const double nearlyAll = 0.8, middle = 0.35; // of a chord
  vpStripeProfile profile;
  profile.exposure = std::hypot(timing.exposure(), timing.averaging());
  profile.logExposureSigma = timing.logExposureSigma();
  Agreement agreement;
  const double noise = std::max(fit.noise, 0.3);
  const std::vector<Chord> chords = chordsOf(soft ? middle : nearlyAll);
  for (const Chord &chord : chords) {
    const LineLight line(lines[chord.line], chord, fit.background);
    profile.time.push_back(timing.middle(static_cast<unsigned int>(chord.line)));
    profile.light.push_back(line.whole);
    profile.sigma.push_back(noise / std::sqrt(line.samples));
    agreement.add(line, noise);
  }
  const double background = unclip(lines, chords, fit.background, noise, profile);
  static const double nearlyWhite = 250; // grey value of a line that may have had more light than it shows
  profile.white = nearlyWhite - background - subtractDarkest(profile.light);
  profile.agreement = agreement.value();
  return profile;
}

END_VISP_NAMESPACE
