/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_identification/vpStripeAnalyzer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include <Eigen/LU>
#include <visp3/vlp_core/vpSimdClones.h>

#include "vpEmitterFalloff.h"
#include <visp3/vlp_core/vpBrighter.h>
#include <visp3/vlp_core/vpLanes.h>

#pragma GCC diagnostic ignored "-Wpsabi" // vectors are passed within this file only

BEGIN_VISP_NAMESPACE

namespace
{

using vpLanes::all;
using vpLanes::Floats;

using Falloff = vpEmitterFalloff;
constexpr int white = Falloff::white;

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

//! Sums over some samples of a line, for least squares of its brightness at the lamp's middle.
struct Brightness {
  float light = 0, squares = 0;
  int samples = 0;
  double value() const { return static_cast<double>(light) / squares; }
  Brightness operator+(const Brightness &other) const
  {
    return {light + other.light, squares + other.squares, samples + other.samples};
  }
};

//! Of \e count samples from \e first on: of all, and of those that are not white.
struct BothSums {
  Brightness all, notWhite;
  BothSums operator+(const BothSums &other) const { return {all + other.all, notWhite + other.notWhite}; }
};

VP_SIMD_CLONES void sumsOf(const unsigned char *row, int first, int count, float background,
                           const Falloff::SquaredRadius &radius, const Falloff::Log &falloff, BothSums &sums)
{
  static const Floats ramp = {0, 1, 2, 3, 4, 5, 6, 7};
  static constexpr float far = 12; // the exponential is that of what is below 0
  const float scale = std::exp(far);
  Floats grey, light{}, squares{}, lightNotWhite{}, squaresNotWhite{}, notWhite{};
  for (int i = 0; i < count; i += vpLanes::count) {
    if (count - i >= vpLanes::count) {
      grey = vpLanes::grey(row + first + i);
    } else {
      std::array<unsigned char, vpLanes::count> rest{};
      std::memcpy(rest.data(), row + first + i, static_cast<size_t>(count - i));
      grey = vpLanes::grey(rest.data());
    }
    const Floats from = ramp + static_cast<float>(first + i) - radius.nearest;
    const Floats r2 = vpLanes::least(radius.scale * from * from + radius.least, all(1.25f));
    const Floats member = vpLanes::select(ramp < static_cast<float>(count - i), all(1), all(0));
    const Floats share =
        member * scale * vpLanes::exponential(r2 * (falloff.linear + falloff.square * r2) - far);
    const Floats seen = share * (grey - background);
    const vpLanes::Integers below = grey < static_cast<float>(white);
    light += seen;
    squares += share * share;
    lightNotWhite += vpLanes::select(below, seen, all(0));
    squaresNotWhite += vpLanes::select(below, share * share, all(0));
    notWhite += vpLanes::select(below, member, all(0));
  }
  sums.all = {vpLanes::sum(light), vpLanes::sum(squares), count};
  sums.notWhite = {vpLanes::sum(lightNotWhite), vpLanes::sum(squaresNotWhite),
                   static_cast<int>(vpLanes::sum(notWhite))};
}

//! The same of an even emitter, whole numbers all of them.
BothSums sumsOfEven(const unsigned char *row, int first, int count, float background)
{
  const vpBrighter::Sums sums = vpBrighter::sums(row + first, count, white - 1);
  auto brightness = [background](int grey, int samples) {
    const auto all = static_cast<float>(samples);
    return Brightness{static_cast<float>(grey) - background * all, all, samples};
  };
  return {brightness(sums.all, count), brightness(sums.all - sums.brighter, count - sums.samplesBrighter)};
}

//! The samples of one line of the lamp: of its left and right half, and of what may be between them.
class LineSamples
{
public:
  LineSamples(const unsigned char *row, const Falloff::Chord &chord, const Falloff &falloff,
              double background)
  {
    const int count = chord.last - chord.first + 1, half = count / 2;
    const Falloff::SquaredRadius radius = falloff.along(chord.line);
    auto sums = [&](int first, int samples) {
      if (falloff.even()) {
        return sumsOfEven(row, first, samples, static_cast<float>(background));
      }
      BothSums sums;
      sumsOf(row, first, samples, static_cast<float>(background), radius, falloff.log(), sums);
      return sums;
    };
    const BothSums left = sums(chord.first, half), right = sums(chord.last - half + 1, half);
    m_left = left.all;
    m_right = right.all;
    m_whole = left + right;
    if (2 * half < count) {
      m_whole = m_whole + sums(chord.first + half, 1);
    }
  }
  int count() const { return m_whole.all.samples; }
  const Brightness &left() const { return m_left; }
  const Brightness &right() const { return m_right; }

  //! Of those that are not white; of all where these are too few.
  const Brightness &whole() const
  {
    static const int enough = 4; // samples
    return m_whole.notWhite.samples < enough ? m_whole.all : m_whole.notWhite;
  }

private:
  Brightness m_left, m_right;
  BothSums m_whole;
};

/*!
  Correlation over the lines of what their left and right halves show, pixel noise taken off: 1 where light
  that varies from line to line does so on the whole of each line, as a shutter's stripes do.
*/
class Agreement
{
public:
  void add(const LineSamples &line, double noise)
  {
    static const int fewest = 8; // samples of a line
    if (line.count() < fewest) {
      return;
    }
    const double left = line.left().value(), right = line.right().value(), weight = line.count();
    m_weight += weight;
    m_left += weight * left;
    m_right += weight * right;
    m_leftLeft += weight * left * left;
    m_rightRight += weight * right * right;
    m_leftRight += weight * left * right;
    m_noise += weight * noise * noise / line.left().samples;
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

//! Whether most of some line is white.
bool hasWhiteLines(const cv::Mat_<unsigned char> &lines, const std::vector<Falloff::Chord> &chords)
{
  return std::any_of(chords.begin(), chords.end(), [&lines](const Falloff::Chord &chord) {
    const int samples = chord.last - chord.first + 1;
    return 2 * vpBrighter::count(lines[chord.line] + chord.first, samples, white - 1) > samples - 1;
  });
}

} // namespace

vpStripeProfile vpStripeProfile::along(const cv::Mat_<unsigned char> &lines, const vpLineTiming &timing,
                                       const vpOutlineFit &fit, const vpLedRoi &roi)
{
  const vpLampOutline &outline = fit.outline;
  const bool ellipse = outline.shape == vpLampOutline::Shape::ellipse; // else its sides along the lines hide
  const bool soft = outline.shape == vpLampOutline::Shape::region || fit.blur > 0.1 * outline.diameter() / 2;
  const double margin = soft ? 0 : 2 * fit.blur;
  const Eigen::Vector4d box = outline.box();
  const double top = ellipse ? std::max(0.0, box(1)) : std::max<double>(roi.box.y, box(1));
  const double bottom =
      ellipse ? std::min(lines.rows - 1.0, box(3)) : std::min<double>(roi.box.br().y - 1, box(3));
  auto chordsOf = [&](double share) {
    std::vector<Falloff::Chord> chords;
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
  std::vector<Falloff::Chord> chords = chordsOf(soft ? middle : nearlyAll);
  if (ellipse && !soft && hasWhiteLines(lines, chords)) {
    chords = chordsOf(std::max(nearlyAll, 1 - (margin + 1) / outline.b)); // the rim may be dimmer than white
  }
  const Falloff falloff = ellipse && !soft ? Falloff(lines, chords, fit) : Falloff();
  vpStripeProfile profile;
  profile.exposure = std::hypot(timing.exposure(), timing.averaging());
  Agreement agreement;
  for (const Falloff::Chord &chord : chords) {
    const LineSamples line(lines[chord.line], chord, falloff, fit.background);
    const Brightness brightness = line.whole();
    profile.time.push_back(timing.middle(static_cast<unsigned int>(chord.line)));
    profile.light.push_back(brightness.value());
    profile.sigma.push_back(std::max(fit.noise, 0.3) / std::sqrt(brightness.squares));
    agreement.add(line, fit.noise);
  }
  profile.agreement = agreement.value();
  return profile;
}

END_VISP_NAMESPACE
