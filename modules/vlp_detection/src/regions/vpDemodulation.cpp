/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpDemodulation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <visp3/vlp_core/vpBrighter.h>

BEGIN_VISP_NAMESPACE

namespace
{
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
} // namespace

vpDemodulation::vpDemodulation(const cv::Mat_<unsigned char> &lines, const std::vector<float> &lit,
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
      addBands(line, last - 1, dark, lit);
      line = last;
    }
  }
  dropOthers();
}

double vpDemodulation::background(const cv::Rect &lamp) const
{
  std::vector<float> beside;
  for (const vpLitBand &band : m_bands) {
    const auto width = static_cast<long>(band.dark.size()),
               from = std::clamp<long>(lamp.x - m_window.x, 0, width),
               to = std::clamp<long>(lamp.br().x - m_window.x, from, width);
    beside.insert(beside.end(), band.dark.begin(), band.dark.begin() + from);
    beside.insert(beside.end(), band.dark.begin() + to, band.dark.end());
  }
  if (beside.empty()) {
    return lamp.empty() ? 0 : background();
  }
  const auto middle = beside.begin() + static_cast<long>(beside.size() / 2);
  std::nth_element(beside.begin(), middle, beside.end());
  return *middle;
}

//! What shines on dark lines by more than the lamp does is no light of this lamp; where the grey scale ends
//! on lit lines it is not known.
void vpDemodulation::dropOthers()
{
  static const float share = 0.4f, least = 3; // of the light; grey levels
  const auto dark = static_cast<float>(background());
  for (vpLitBand &band : m_bands) {
    for (size_t x = 0; x < band.light.size(); ++x) {
      const float light = band.light[x];
      if (band.dark[x] - dark > least + (share + band.own) * light &&
          band.dark[x] + light < vpBrighter::nearlyWhite) {
        band.light[x] = 0;
      }
    }
  }
}

void vpDemodulation::drop(const std::vector<cv::Rect> &others)
{
  for (vpLitBand &band : m_bands) {
    for (const cv::Rect &box : others) {
      const cv::Rect other = vpGrown(box, 4 + std::max(box.width, box.height) / 16); // its halo, too
      const int from = std::max(other.x - m_window.x, 0),
                to = std::min(other.br().x - m_window.x, m_window.width);
      if (band.last >= other.y && band.first < other.br().y && from < to) {
        std::fill(band.light.begin() + from, band.light.begin() + to, 0.f);
      }
    }
  }
}

//! Of a stripe, a few lines each, against the dark lines nearest to the stripe.
void vpDemodulation::addBands(int first, int last, const std::vector<int> &dark,
                              const std::vector<float> &lit)
{
  static const int side = 2;    // samples
  static const long enough = 4; // dark lines to each side
  const auto after = std::upper_bound(dark.begin(), dark.end(), last);
  const auto from = after - std::min<long>(enough, after - dark.begin()),
             to = after + std::min<long>(enough, dark.end() - after);
  std::vector<float> reference(static_cast<size_t>(m_window.width), 0);
  float least = 0; // share of the lamp's light, on dark lines
  const auto references = static_cast<float>(to - from);
  for (auto line = from; line != to; ++line) {
    addLine(m_lines, *line, m_window, reference);
    least += lit[static_cast<size_t>(*line)] / references;
  }
  const int count = std::max(1, (last - first + 1) / thick);
  for (int k = 0; k < count; ++k) {
    vpLitBand band;
    band.first = first + (last - first + 1) * k / count;
    band.last = first + (last - first + 1) * (k + 1) / count - 1;
    std::vector<float> sum(reference.size(), 0);
    float most = 0;
    const auto of = static_cast<float>(band.last - band.first + 1);
    for (int line = band.first; line <= band.last; ++line) {
      addLine(m_lines, line, m_window, sum);
      most += lit[static_cast<size_t>(line)] / of;
    }
    band.own = least / (most - least);
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
double vpDemodulation::noise() const
{
  static const size_t apart = 5;
  std::vector<float> differences;
  for (const vpLitBand &band : m_bands) {
    for (size_t x = apart; x < band.light.size(); ++x) {
      differences.push_back(std::abs(band.light[x] - band.light[x - apart]));
    }
  }
  return deviationOf(differences);
}

double vpDemodulation::brightest() const
{
  float most = 0;
  for (const vpLitBand &band : m_bands) {
    most = std::max(most, *std::max_element(band.light.begin(), band.light.end()));
  }
  return most;
}

std::vector<vpLitRun> vpDemodulation::runsAbove(double level) const
{
  static const int shortest = 3; // samples
  std::vector<vpLitRun> runs;
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

END_VISP_NAMESPACE
