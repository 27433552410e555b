/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_detection/vpBlinkingLight.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <visp3/vlp_core/vpBrighter.h>

#include "outlines/vpRimFit.h"
#include "vpChordShape.h"
#include "vpDemodulation.h"

BEGIN_VISP_NAMESPACE

namespace
{
//! Lines, the most that are dark from one band to the next.
int longestGap(const std::vector<vpLitBand> &bands)
{
  int gap = 0;
  for (size_t k = 1; k < bands.size(); ++k) {
    gap = std::max(gap, bands[k].first - bands[k - 1].last);
  }
  return gap;
}

//! The runs that hang together with a seed: no more than \e reach from each other, px, and a dark gap.
//! \param runs Band by band, from left to right.
std::vector<vpLitRun> connected(const std::vector<vpLitRun> &runs, const std::vector<vpLitBand> &bands,
                                const cv::Rect &seed, int reach)
{
  const int lines = reach + longestGap(bands);
  std::vector<vpLitRun> found;
  std::vector<std::vector<vpLitRun>> open(bands.size()); // the rest
  for (const vpLitRun &run : runs) {
    const cv::Rect box(run.first, bands[run.band].first, run.last - run.first + 1,
                       bands[run.band].last - bands[run.band].first + 1);
    ((box & seed).area() > 0 ? found : open[run.band]).push_back(run);
  }
  // Takes those of a band that are near a run. False: the band is too far off, and so is the next one.
  const auto take = [&](const vpLitRun &run, size_t band) {
    if (bands[band].first - bands[run.band].last > lines ||
        bands[run.band].first - bands[band].last > lines) {
      return false;
    }
    std::vector<vpLitRun> &there = open[band];
    const auto first = std::lower_bound(there.begin(), there.end(), run.first - reach,
                                        [](const vpLitRun &other, int x) { return other.last < x; }),
               end = std::lower_bound(first, there.end(), run.last + reach + 1,
                                      [](const vpLitRun &other, int x) { return other.first < x; });
    found.insert(found.end(), first, end);
    there.erase(first, end);
    return true;
  };
  for (size_t k = 0; k < found.size(); ++k) {
    const vpLitRun run = found[k]; // a copy: they move as more are found
    for (size_t band = run.band; band < bands.size() && take(run, band); ++band) {
    }
    for (size_t band = run.band; band > 0 && take(run, band - 1); --band) {
    }
  }
  return found;
}

//! First and last sample of the runs in each band; none: last before first.
std::vector<vpLitRun> outermost(const std::vector<vpLitRun> &runs, size_t bands)
{
  std::vector<vpLitRun> outer;
  for (size_t k = 0; k < bands; ++k) {
    outer.push_back({k, std::numeric_limits<int>::max(), -1});
  }
  for (const vpLitRun &run : runs) {
    outer[run.band].first = std::min(outer[run.band].first, run.first);
    outer[run.band].last = std::max(outer[run.band].last, run.last);
  }
  return outer;
}

/*!
  Where a band's light passes half of what it is a little farther in, to a part of a sample: at one level
  for all, bright ends would lie farther out than dim ones. \param from Its first sample above the level.
  \param step 1: the band goes on to the right; -1: to the left.
*/
float crossingOf(const std::vector<float> &light, int from, int to, int step, double level)
{
  static const int farther = 8; // samples: past the blur of a lens and the means over a few
  auto at = [&light](int x) { return light[static_cast<size_t>(x)]; };
  float plateau = 0;
  for (int k = 0; k <= farther && step * (to - from) >= k; ++k) {
    plateau = std::max(plateau, at(from + step * k));
  }
  const double half = std::max(level, 0.5 * plateau);
  int x = from;
  while (x != to && at(x) <= half) {
    x += step;
  }
  const double above = at(x) - half, below = half - at(x - step);
  return static_cast<float>(x - step * std::clamp(above / std::max(above + below, 1e-3), 0.0, 1.0));
}

vpRimFit::Ends endsOf(const std::vector<vpLitRun> &outer, const std::vector<vpLitBand> &bands, double level,
                      const cv::Point &origin)
{
  vpRimFit::Ends ends;
  for (const vpLitRun &run : outer) {
    const std::vector<float> &light = bands[run.band].light;
    if (run.first > 0 && run.last >= run.first && run.last + 1 < static_cast<int>(light.size())) {
      const auto line = static_cast<float>(0.5 * (bands[run.band].first + bands[run.band].last)),
                 left = static_cast<float>(origin.x);
      ends.emplace_back(left + crossingOf(light, run.first, run.last, 1, level), line);
      ends.emplace_back(left + crossingOf(light, run.last, run.first, -1, level), line);
    }
  }
  return ends;
}

//! Middle of the light of some runs, px.
Eigen::Vector2d middleOf(const std::vector<vpLitRun> &runs, const std::vector<vpLitBand> &bands, int left)
{
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 0;
  for (const vpLitRun &run : runs) {
    const vpLitBand &band = bands[run.band];
    for (int x = run.first; x <= run.last; ++x) {
      const double light = band.light[static_cast<size_t>(x)] * (band.last - band.first + 1);
      sum += light * Eigen::Vector2d(left + x, 0.5 * (band.first + band.last));
      weight += light;
    }
  }
  return sum / std::max(weight, 1e-9);
}

vpLedRoi regionOf(const std::vector<vpLitRun> &outer, const std::vector<vpLitBand> &bands, int left,
                  double level)
{
  vpLedRoi roi;
  roi.level = level;
  for (const vpLitRun &run : outer) {
    if (run.last < run.first) {
      continue;
    }
    for (int line = bands[run.band].first; line <= bands[run.band].last; ++line) {
      roi.chords.push_back({line, left + run.first, left + run.last});
      roi.box |= cv::Rect(left + run.first, line, run.last - run.first + 1, 1);
    }
  }
  return roi;
}

//! Whether it touches the window's sides.
bool reaches(const vpLedRoi &roi, const cv::Rect &window)
{
  return roi.box.x <= window.x || roi.box.y <= window.y || roi.box.br().x >= window.br().x ||
         roi.box.br().y >= window.br().y;
}

} // namespace

double vpBlinkingLight::share(const cv::Mat_<unsigned char> &lines, const std::vector<float> &lit,
                              const cv::Rect &box)
{
  static const long few = 20; // of as many lines one is as dark as the darkest, noise aside
  std::vector<double> light;
  for (int line = box.y; line < box.br().y; ++line) {
    light.push_back(vpBrighter::sum(lines[line] + box.x, box.width));
  }
  std::vector<double> sorted = light;
  const auto low = sorted.begin() + static_cast<long>(sorted.size()) / few;
  std::nth_element(sorted.begin(), low, sorted.end());
  const double dark = *low;
  double all = 0, kept = 0, shines = 0, squares = 0;
  for (size_t i = 0; i < light.size(); ++i) {
    const double now = lit[static_cast<size_t>(box.y) + i];
    all += light[i] - dark;
    kept += (light[i] - dark) * now;
    shines += now;
    squares += now * now;
  }
  const double chance = shines / static_cast<double>(light.size()), most = squares / std::max(shines, 1e-9);
  return (kept / std::max(all, 1e-9) - chance) / std::max(most - chance, 1e-9);
}

std::optional<vpBlinkingLight::Extent> vpBlinkingLight::about(const cv::Mat_<unsigned char> &lines,
                                                              const std::vector<float> &lit,
                                                              const vpLedRoi &seed,
                                                              const std::vector<cv::Rect> &others)
{
  static const double sigmas = 4, least = 1, most = 0.5; // of the noise; grey levels; of the brightest light
  static const int rounds = 3;
  const cv::Rect picture(0, 0, lines.cols, lines.rows);
  const int size = std::max(seed.box.width, seed.box.height), reach = std::max(3, size / 4);
  cv::Rect box = seed.box;
  for (int round = 0; round < rounds; ++round) {
    const cv::Rect window = vpGrown(box, size) & picture;
    vpDemodulation light(lines, lit, window);
    light.drop(others);
    if (light.bands().empty()) {
      return std::nullopt;
    }
    std::vector<vpRimFit::Ends> levels;
    std::vector<vpLedRoi> regions;
    std::vector<Eigen::Vector2d> middles;
    for (double level = std::max(least, sigmas * light.noise()); level < most * light.brightest();
         level *= vpRimFit::levelRatio) {
      const std::vector<vpLitRun> runs =
          connected(light.runsAbove(level), light.bands(), seed.box - cv::Point(window.x, 0), reach);
      const std::vector<vpLitRun> outer = outermost(runs, light.bands().size());
      vpLedRoi region = regionOf(outer, light.bands(), window.x, seed.level);
      if (2 * (region.box & seed.box).area() < seed.box.area()) {
        break; // one bright stripe has as sharp a rim as a lamp
      }
      middles.push_back(middleOf(runs, light.bands(), window.x));
      levels.push_back(endsOf(outer, light.bands(), level, window.tl()));
      regions.push_back(std::move(region));
    }
    if (regions.empty() || regions.front().chords.empty()) {
      return std::nullopt;
    }
    if (reaches(regions.front(), window) && window != picture && round + 1 < rounds) {
      box |= regions.front().box;
      continue;
    }
    size_t chosen = 0;
    const std::optional<vpOutlineFit> fit = vpRimFit::mostStable(levels, chosen);
    vpChordShape::markCuts(regions[chosen], picture.size());
    if (!fit || regions[chosen].cutAcross || regions[chosen].cutAlong) {
      return std::nullopt; // what is seen of a lamp that the border cuts says nothing of its middle
    }
    Extent extent{regions[chosen], *fit};
    if (extent.fit.outline.shape == vpLampOutline::Shape::quadrilateral) {
      vpRimFit::addHiddenSides(extent.fit.outline,
                               vpChordShape::longestGap(extent.roi) + vpDemodulation::thick);
    }
    vpRimFit::allowForGlow(extent.fit, middles[chosen]);
    extent.fit.background = light.background(extent.roi.box);
    extent.fit.noise = vpOutlineFitter::noiseOf(lines, extent.roi.box);
    return extent;
  }
  return std::nullopt;
}

END_VISP_NAMESPACE
