/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_detection/vpBlinkingLight.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <visp3/vlp_core/vpBrighter.h>

#include "outlines/vpRimFit.h"
#include "vpChordShape.h"

BEGIN_VISP_NAMESPACE

namespace
{
const int thick = 3; // lines of a band

//! A few lit lines together: what they have more than the dark lines beside them, sample by sample.
struct Band {
  int first, last;                // lines
  std::vector<float> light, dark; // dark: what the dark lines have
};

//! Samples of a band that are brighter than some level.
struct Run {
  size_t band;
  int first, last;
};

cv::Rect grown(const cv::Rect &box, int by)
{
  return {box.x - by, box.y - by, box.width + 2 * by, box.height + 2 * by};
}

//! Sum of each sample over some lines.
void addLine(const cv::Mat_<unsigned char> &lines, int line, const cv::Rect &window, std::vector<float> &sum)
{
  const unsigned char *row = lines[line] + window.x;
  for (size_t x = 0; x < sum.size(); ++x) {
    sum[x] += row[x];
  }
}

//! Means over a few samples to both sides.
std::vector<float> smoothed(const std::vector<float> &values, int side)
{
  std::vector<float> sums(values.size() + 1, 0), means(values.size());
  std::partial_sum(values.begin(), values.end(), sums.begin() + 1);
  const int n = static_cast<int>(values.size());
  for (int x = 0; x < n; ++x) {
    const int from = std::max(0, x - side), to = std::min(n, x + side + 1);
    means[static_cast<size_t>(x)] =
        (sums[static_cast<size_t>(to)] - sums[static_cast<size_t>(from)]) / static_cast<float>(to - from);
  }
  return means;
}

//! Standard deviation of values, by differences of any two of them.
double deviationOf(std::vector<float> &differences)
{
  static const double perMedian = 0.954, least = 0.1; // of two Gaussian values' difference; grey levels
  if (differences.empty()) {
    return least;
  }
  const auto middle = differences.begin() + static_cast<long>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return std::max(least, *middle / perMedian);
}

//! Lit and dark lines of a window, and what the former have more.
class Demodulation
{
public:
  Demodulation(const cv::Mat_<unsigned char> &lines, const std::vector<float> &lit, const cv::Rect &window);
  void drop(const std::vector<cv::Rect> &others);
  std::vector<Run> runsAbove(double level) const;
  const std::vector<Band> &bands() const { return m_bands; }
  double noise() const; // grey levels, standard deviation of a band's light
  double pixelNoise() const;
  double background() const { return m_background; } // grey value beside the lamp
  double brightest() const;

private:
  void addBands(int first, int last, const std::vector<int> &dark);
  void dropOthers();

  const cv::Mat_<unsigned char> &m_lines;
  cv::Rect m_window;
  std::vector<Band> m_bands;
  float m_background = 0;
};

Demodulation::Demodulation(const cv::Mat_<unsigned char> &lines, const std::vector<float> &lit,
                           const cv::Rect &window)
    : m_lines(lines), m_window(window)
{
  static const float bright = 0.75f, dim = 0.25f; // of the swing of the window's lines
  const auto begin = lit.begin() + window.y, end = begin + window.height;
  const auto [least, most] = std::minmax_element(begin, end);
  const float above = *least + bright * (*most - *least), below = *least + dim * (*most - *least);
  std::vector<int> dark;
  for (int line = window.y; line < window.br().y; ++line) {
    if (lit[static_cast<size_t>(line)] < below) {
      dark.push_back(line);
    }
  }
  for (int line = window.y; line < window.br().y && !dark.empty(); ++line) {
    int last = line;
    while (last < window.br().y && lit[static_cast<size_t>(last)] >= above) {
      ++last;
    }
    if (last > line) {
      addBands(line, last - 1, dark);
      line = last;
    }
  }
  dropOthers();
}

//! What shines on dark lines as well is no light of this lamp.
void Demodulation::dropOthers()
{
  static const float share = 0.4f, least = 3; // of the light; grey levels
  std::vector<float> all;
  for (const Band &band : m_bands) {
    all.insert(all.end(), band.dark.begin(), band.dark.end());
  }
  if (all.empty()) {
    return;
  }
  const auto middle = all.begin() + static_cast<long>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  m_background = *middle;
  for (Band &band : m_bands) {
    for (size_t x = 0; x < band.light.size(); ++x) {
      if (band.dark[x] - m_background > least + share * band.light[x]) {
        band.light[x] = 0;
      }
    }
  }
}

void Demodulation::drop(const std::vector<cv::Rect> &others)
{
  for (Band &band : m_bands) {
    for (const cv::Rect &box : others) {
      const cv::Rect other = grown(box, 4 + std::max(box.width, box.height) / 16); // its halo, too
      const int from = std::max(other.x - m_window.x, 0),
                to = std::min(other.br().x - m_window.x, m_window.width);
      if (band.last >= other.y && band.first < other.br().y && from < to) {
        std::fill(band.light.begin() + from, band.light.begin() + to, 0.f);
      }
    }
  }
}

//! Of a stripe, a few lines each, against the dark lines nearest to the stripe.
void Demodulation::addBands(int first, int last, const std::vector<int> &dark)
{
  static const int side = 2;    // samples
  static const long enough = 4; // dark lines to each side
  const auto after = std::upper_bound(dark.begin(), dark.end(), last);
  const auto from = after - std::min<long>(enough, after - dark.begin()),
             to = after + std::min<long>(enough, dark.end() - after);
  std::vector<float> reference(static_cast<size_t>(m_window.width), 0);
  for (auto line = from; line != to; ++line) {
    addLine(m_lines, *line, m_window, reference);
  }
  const auto references = static_cast<float>(to - from);
  const int count = std::max(1, (last - first + 1) / thick);
  for (int k = 0; k < count; ++k) {
    Band band;
    band.first = first + (last - first + 1) * k / count;
    band.last = first + (last - first + 1) * (k + 1) / count - 1;
    std::vector<float> sum(reference.size(), 0);
    for (int line = band.first; line <= band.last; ++line) {
      addLine(m_lines, line, m_window, sum);
    }
    const auto of = static_cast<float>(band.last - band.first + 1);
    for (size_t x = 0; x < sum.size(); ++x) {
      sum[x] = sum[x] / of - reference[x] / references;
    }
    band.light = smoothed(sum, side);
    band.dark = smoothed(reference, side);
    for (float &grey : band.dark) {
      grey /= references;
    }
    m_bands.push_back(band);
  }
}

//! Of differences beyond the smoothing.
double Demodulation::noise() const
{
  static const size_t apart = 5;
  std::vector<float> differences;
  for (const Band &band : m_bands) {
    for (size_t x = apart; x < band.light.size(); ++x) {
      differences.push_back(std::abs(band.light[x] - band.light[x - apart]));
    }
  }
  return deviationOf(differences);
}

double Demodulation::pixelNoise() const
{
  std::vector<float> differences;
  for (const Band &band : m_bands) {
    const unsigned char *row = m_lines[band.first] + m_window.x;
    for (int x = 0; x + 1 < m_window.width; ++x) {
      differences.push_back(static_cast<float>(std::abs(row[x + 1] - row[x])));
    }
  }
  return deviationOf(differences);
}

double Demodulation::brightest() const
{
  float most = 0;
  for (const Band &band : m_bands) {
    most = std::max(most, *std::max_element(band.light.begin(), band.light.end()));
  }
  return most;
}

std::vector<Run> Demodulation::runsAbove(double level) const
{
  static const int shortest = 3; // samples
  std::vector<Run> runs;
  for (size_t k = 0; k < m_bands.size(); ++k) {
    const std::vector<float> &light = m_bands[k].light;
    const int n = static_cast<int>(light.size());
    for (int x = 0; x < n; ++x) {
      int last = x;
      while (last < n && light[static_cast<size_t>(last)] > level) {
        ++last;
      }
      if (last - x >= shortest) {
        runs.push_back({k, x, last - 1});
      }
      x = std::max(x, last);
    }
  }
  return runs;
}

//! Lines, the most that are dark from one band to the next.
int longestGap(const std::vector<Band> &bands)
{
  int gap = 0;
  for (size_t k = 1; k < bands.size(); ++k) {
    gap = std::max(gap, bands[k].first - bands[k - 1].last);
  }
  return gap;
}

//! The runs that hang together with a seed: no more than \e reach from each other, px, and a dark gap.
std::vector<Run> connected(const std::vector<Run> &runs, const std::vector<Band> &bands, const cv::Rect &seed,
                           int reach)
{
  const int lines = reach + longestGap(bands);
  auto near = [&](const Run &a, const Run &b) {
    return bands[b.band].first - bands[a.band].last <= lines &&
           bands[a.band].first - bands[b.band].last <= lines && b.first - a.last <= reach &&
           a.first - b.last <= reach;
  };
  std::vector<Run> found;
  std::vector<char> taken(runs.size(), 0);
  for (size_t i = 0; i < runs.size(); ++i) {
    const Run &run = runs[i];
    const cv::Rect box(run.first, bands[run.band].first, run.last - run.first + 1,
                       bands[run.band].last - bands[run.band].first + 1);
    if ((box & seed).area() > 0) {
      taken[i] = 1;
      found.push_back(run);
    }
  }
  for (size_t k = 0; k < found.size(); ++k) {
    for (size_t i = 0; i < runs.size(); ++i) {
      if (taken[i] == 0 && near(found[k], runs[i])) {
        taken[i] = 1;
        found.push_back(runs[i]);
      }
    }
  }
  return found;
}

//! First and last sample of the runs in each band; none: last before first.
std::vector<Run> outermost(const std::vector<Run> &runs, size_t bands)
{
  std::vector<Run> outer;
  for (size_t k = 0; k < bands; ++k) {
    outer.push_back({k, std::numeric_limits<int>::max(), -1});
  }
  for (const Run &run : runs) {
    outer[run.band].first = std::min(outer[run.band].first, run.first);
    outer[run.band].last = std::max(outer[run.band].last, run.last);
  }
  return outer;
}

/*!
  Where a band's light passes half of what it is a little farther in, to a part of a sample: at one level for
  all, bright ends would lie farther out than dim ones.
  \param from Its first sample above the level. \param step 1: the band goes on to the right; -1: to the left.
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

vpRimFit::Ends endsOf(const std::vector<Run> &outer, const std::vector<Band> &bands, double level,
                      const cv::Point &origin)
{
  vpRimFit::Ends ends;
  for (const Run &run : outer) {
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
Eigen::Vector2d middleOf(const std::vector<Run> &runs, const std::vector<Band> &bands, int left)
{
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 0;
  for (const Run &run : runs) {
    const Band &band = bands[run.band];
    for (int x = run.first; x <= run.last; ++x) {
      const double light = band.light[static_cast<size_t>(x)] * (band.last - band.first + 1);
      sum += light * Eigen::Vector2d(left + x, 0.5 * (band.first + band.last));
      weight += light;
    }
  }
  return sum / std::max(weight, 1e-9);
}

vpLedRoi regionOf(const std::vector<Run> &outer, const std::vector<Band> &bands, int left, double level)
{
  vpLedRoi roi;
  roi.level = level;
  for (const Run &run : outer) {
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

//! What touches the window's sides.
bool isCut(const vpLedRoi &roi, const cv::Rect &window)
{
  return roi.box.x <= window.x || roi.box.y <= window.y || roi.box.br().x >= window.br().x ||
         roi.box.br().y >= window.br().y;
}

} // namespace

double vpBlinkingLight::share(const cv::Mat_<unsigned char> &lines, const std::vector<float> &lit,
                              const cv::Rect &box)
{
  std::vector<double> light;
  for (int line = box.y; line < box.br().y; ++line) {
    light.push_back(vpBrighter::sum(lines[line] + box.x, box.width));
  }
  const double dark = *std::min_element(light.begin(), light.end());
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
    const cv::Rect window = grown(box, size) & picture;
    Demodulation light(lines, lit, window);
    light.drop(others);
    if (light.bands().empty()) {
      return std::nullopt;
    }
    std::vector<vpRimFit::Ends> levels;
    std::vector<vpLedRoi> regions;
    std::vector<Eigen::Vector2d> middles;
    for (double level = std::max(least, sigmas * light.noise()); level < most * light.brightest();
         level *= vpRimFit::levelRatio) {
      const std::vector<Run> runs =
          connected(light.runsAbove(level), light.bands(), seed.box - cv::Point(window.x, 0), reach);
      const std::vector<Run> outer = outermost(runs, light.bands().size());
      middles.push_back(middleOf(runs, light.bands(), window.x));
      levels.push_back(endsOf(outer, light.bands(), level, window.tl()));
      regions.push_back(regionOf(outer, light.bands(), window.x, seed.level));
    }
    if (regions.empty() || regions.front().chords.empty()) {
      return std::nullopt;
    }
    if (isCut(regions.front(), window) && window != picture && round + 1 < rounds) {
      box |= regions.front().box;
      continue;
    }
    size_t chosen = 0;
    const std::optional<vpOutlineFit> fit = vpRimFit::mostStable(levels, regions.front().box, chosen);
    if (!fit) {
      return std::nullopt;
    }
    Extent extent{regions[chosen], *fit, regions.front()};
    if (extent.fit.outline.shape == vpLampOutline::Shape::quadrilateral) {
      vpRimFit::addHiddenSides(extent.fit.outline, vpChordShape::longestGap(extent.roi) + thick);
    }
    vpRimFit::allowForGlow(extent.fit, middles[chosen]);
    extent.fit.background = light.background();
    extent.fit.noise = light.pixelNoise();
    extent.roi.cutAcross = extent.roi.box.x <= 0 || extent.roi.box.br().x >= lines.cols;
    extent.roi.cutAlong = extent.roi.box.y <= 0 || extent.roi.box.br().y >= lines.rows;
    return extent;
  }
  return std::nullopt;
}

END_VISP_NAMESPACE
