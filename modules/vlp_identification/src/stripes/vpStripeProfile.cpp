/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_identification/vpStripeAnalyzer.h>

#include <algorithm>
#include <cmath>

#include <visp3/vlp_core/vpBrighter.h>

#include "recognition/vpNormalTail.h"
#include "vpBlackEnd.h"
#include "vpWhiteEnd.h"

BEGIN_VISP_NAMESPACE

namespace
{

//! From where to where a line lies inside the lamp, samples.
struct Chord {
  int line;
  double from, to;

  int first() const { return static_cast<int>(std::ceil(from)); }
  int last() const { return static_cast<int>(std::floor(to)); }
  int samples() const { return last() - first() + 1; }
};

//! The light of one line of the lamp, and that of its left and right half, grey levels.
struct LineLight {
  double whole, left, right;
  int samples, half;

  LineLight(const unsigned char *row, const Chord &chord, double background)
      : samples(chord.samples()), half(samples / 2)
  {
    const int ofLeft = vpBrighter::sum(row + chord.first(), half),
              ofRight = vpBrighter::sum(row + chord.last() - half + 1, half),
              between = 2 * half < samples ? row[chord.first() + half] : 0;
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

//! The samples inside the lamp, line by line: well inside where it has no sharp edge, or none that is known.
//! \param blur px, of its edge.
std::vector<Chord> chordsOf(const cv::Mat_<unsigned char> &lines, const vpOutlineFit &fit,
                            const vpLedRoi &roi, double blur)
{
  static const double middle = 0.35, most = 0.7; // of a chord: of a soft lamp; of a region
  std::vector<Chord> chords;
  auto add = [&](int line, double first, double last, double share) {
    const double half = 0.5 * share * (last - first), centre = 0.5 * (first + last);
    const Chord chord{line, std::max(0.0, centre - half), std::min(lines.cols - 1.0, centre + half)};
    if (chord.samples() > 2) {
      chords.push_back(chord);
    }
  };
  const vpLampOutline &outline = fit.outline;
  if (outline.shape == vpLampOutline::Shape::region) {
    for (const vpLedChord &chord : roi.hull()) {
      if (chord.line >= roi.box.y && chord.line < roi.box.br().y) {
        add(chord.line, chord.first, chord.last, most);
      }
    }
    return chords;
  }
  const bool ellipse = outline.shape == vpLampOutline::Shape::ellipse; // else its sides along the lines hide
  const bool soft = fit.blur > 0.1 * outline.diameter() / 2;
  static const double beside = 1; // px: half a line, and half of the pixel that a sharp edge divides
  const double margin = soft ? 0 : 2 * blur + beside;
  const Eigen::Vector4d box = outline.box();
  const double top = ellipse ? std::max(0.0, box(1)) : std::max(roi.box.y + margin, box(1));
  const double bottom =
      ellipse ? std::min(lines.rows - 1.0, box(3)) : std::min(roi.box.br().y - 1 - margin, box(3));
  const double centre = 0.5 * (box(1) + box(3)), inside = 1 - 2 * margin / (box(3) - box(1));
  const vpOutlineLines across(outline);
  for (int line = static_cast<int>(std::ceil(top)); inside > 0 && line <= bottom; ++line) {
    double first, last;
    if (across.stretch(centre + (line - centre) / inside, first, last)) {
      add(line, first, last, soft ? middle : inside);
    }
  }
  return chords;
}

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

//! What each line shows, of a profile that \e chords are, before the surroundings' light is taken off.
std::vector<vpBlackEnd::Line> shownBy(const cv::Mat_<unsigned char> &lines, const std::vector<Chord> &chords,
                                      double background, const vpStripeProfile &profile)
{
  std::vector<vpBlackEnd::Line> shown;
  for (size_t i = 0; i < chords.size(); ++i) {
    const int samples = chords[i].samples(),
              bright = vpBrighter::count(lines[chords[i].line] + chords[i].first(), samples, 0);
    shown.push_back({profile.light[i] + background, samples, samples - bright});
  }
  return shown;
}

//! Whether the grey scale's dark end clips lines. \param noise Of a pixel, grey levels, about.
bool touchesBlack(const vpStripeProfile &profile, double background, double noise)
{
  static const double rounding = 1, above = 2; // grey levels; deviations, from where means are as they seem
  return noise >= rounding && !profile.light.empty() &&
         background + *std::min_element(profile.light.begin(), profile.light.end()) <= above * noise;
}

/*!
  Takes light and noise of the lines, which \e chords are, to what they were before the grey scale's dark end
  clipped them. \param noise Of a pixel, grey levels, about. \return The same of the surroundings, grey
  levels.
*/
double unclip(const cv::Mat_<unsigned char> &lines, const std::vector<Chord> &chords, double background,
              double noise, vpStripeProfile &profile)
{
  if (!touchesBlack(profile, background, noise)) {
    return background;
  }
  const std::vector<vpBlackEnd::Line> shown = shownBy(lines, chords, background, profile);
  const vpBlackEnd end(shown, noise);
  background = end.before(background).mean;
  for (size_t i = 0; i < shown.size(); ++i) {
    const vpBlackEnd::Light light = end.before(shown[i].mean);
    profile.light[i] = light.mean - background;
    profile.sigma[i] = std::max(profile.sigma[i], light.sigma / std::sqrt(shown[i].samples));
  }
  return background;
}

/*!
  Whether the grey scale's bright end clips more samples than noise would lift that high. \param noise Of a
  pixel, grey levels, about: what its dark end clips tells it better.
*/
bool reachesWhite(const cv::Mat_<unsigned char> &lines, const std::vector<Chord> &chords, double background,
                  double noise, const vpStripeProfile &profile)
{
  static const double factor = 2, sigmas = 4; // of what noise lifts, known about; of chance
  std::vector<int> white;
  for (const Chord &chord : chords) {
    white.push_back(
        vpBrighter::count(lines[chord.line] + chord.first(), chord.samples(), vpBrighter::nearlyWhite - 1));
  }
  if (std::all_of(white.begin(), white.end(), [](int count) { return count == 0; })) {
    return false;
  }
  if (touchesBlack(profile, background, noise)) {
    noise = vpBlackEnd(shownBy(lines, chords, background, profile), noise).noise();
  }
  double all = 0, byNoise = 0; // samples
  for (size_t i = 0; i < chords.size(); ++i) {
    const double above = (vpBrighter::nearlyWhite - background - profile.light[i]) / noise;
    all += white[i];
    byNoise += above > 1 ? chords[i].samples() * vpNormalTail(above) : 0;
  }
  return all > factor * byNoise + sigmas * std::sqrt(byNoise);
}

//! Means of the lines' samples.
vpStripeProfile meansOf(const cv::Mat_<unsigned char> &lines, const vpLineTiming &timing,
                        const std::vector<Chord> &chords, double background, double noise)
{
  vpStripeProfile profile;
  profile.exposure = std::hypot(timing.exposure(), timing.averaging());
  profile.logExposureSigma = timing.logExposureSigma();
  Agreement agreement;
  for (const Chord &chord : chords) {
    const LineLight line(lines[chord.line], chord, background);
    profile.time.push_back(timing.middle(static_cast<unsigned int>(chord.line)));
    profile.light.push_back(line.whole);
    profile.sigma.push_back(noise / std::sqrt(line.samples));
    agreement.add(line, noise);
  }
  profile.agreement = agreement.value();
  return profile;
}

/*!
  Takes the light of lines, which \e chords are, for what the grey scale's bright end spares of it, where it
  spares some of each line. Elsewhere their means have to do: as an edge of a stripe brightens, its mean rises
  ever less, which nothing but its ends tells.
*/
void takeSpared(const cv::Mat_<unsigned char> &lines, const std::vector<Chord> &chords, double background,
                double noise, vpStripeProfile &profile)
{
  static const double unstraight = 0.05; // of white, half way up
  vpWhiteEnd end(background, noise);
  for (const Chord &chord : chords) {
    end.add(lines[chord.line], chord.from, chord.to);
  }
  const std::vector<vpWhiteEnd::Light> spared = end.light();
  const double white = vpBrighter::nearlyWhite - background;
  const bool all = std::all_of(spared.begin(), spared.end(),
                               [white](const vpWhiteEnd::Light &light) { return light.mean < white; });
  for (size_t i = 0; i < spared.size(); ++i) {
    const double share = std::clamp(profile.light[i] / white, 0.0, 1.0);
    profile.light[i] = all ? spared[i].mean : profile.light[i];
    profile.sigma[i] =
        all ? spared[i].sigma : std::hypot(profile.sigma[i], 4 * unstraight * share * (1 - share) * white);
  }
}

} // namespace

bool vpStripeProfile::isClipped() const
{
  return !light.empty() && *std::max_element(light.begin(), light.end()) >= white;
}

double vpStripeProfile::logEdgeSigma() const
{
  static const double shortened = 0.5; // by what of an edge is white, of a lamp of one to four times that
  return isClipped() ? std::hypot(logExposureSigma, shortened) : logExposureSigma;
}

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
  const double noise = std::max(fit.noise, 0.3);
  std::vector<Chord> chords = chordsOf(lines, fit, roi, fit.blur);
  vpStripeProfile profile = meansOf(lines, timing, chords, fit.background, noise);
  if (reachesWhite(lines, chords, fit.background, noise, profile)) {
    chords = chordsOf(lines, fit, roi, fit.clippedBlur()); // what counts lies beside the edge
    profile = meansOf(lines, timing, chords, fit.background, noise);
    takeSpared(lines, chords, fit.background, noise, profile);
  }
  const double background = unclip(lines, chords, fit.background, noise, profile);
  profile.white = vpBrighter::nearlyWhite - background - subtractDarkest(profile.light);
  return profile;
}

END_VISP_NAMESPACE
