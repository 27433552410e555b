/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpWindowSums.h"

BEGIN_VISP_NAMESPACE

void vpKernelAxis::set(double centre, double length, double targetLength, unsigned int pixels)
{
  static const int whole = 255;
  const double half = length / 2;
  const int begin = static_cast<int>(std::ceil(centre - half)),
            end = static_cast<int>(std::floor(centre + half)) + 1;
  step = stepOf(length);
  middle = centre;
  weights.clear();
  double all = 0, chords = 0;
  sum = targetMean = first = 0;
  for (int i = begin; i < end; i += step) {
    const double x = i - centre;
    const int weight = static_cast<int>(whole * (1 - x * x / (half * half)));
    all += weight;
    if (i >= 0 && i < static_cast<int>(pixels)) {
      first = weights.empty() ? i : first;
      weights.push_back(weight);
      sum += weight;
      const double chord = std::sqrt(std::max(0.0, 1 - 4 * x * x / (targetLength * targetLength)));
      chords += weight * chord;
      targetMean += weight * chord * x;
    }
  }
  targetMean = chords > 0 ? targetMean / chords : 0;
  visible = all > 0 ? sum / all : 0;
}

vpBinShares vpWindowSums::shares(const Lanes &lanes)
{
  vpBinShares sums{};
  double all = 0;
  for (size_t bin = 0; bin < sums.size(); ++bin) {
    sums[bin] = static_cast<double>(lanes[0][bin] + lanes[1][bin] + lanes[2][bin] + lanes[3][bin]);
    all += sums[bin];
  }
  for (double &share : sums) {
    share = all > 0 ? share / all : 0;
  }
  return sums;
}

vpWindowMoments vpWindowSums::summedUp(const std::vector<std::uint64_t> &rows) const
{
  struct Sums {
    double zeroth = 0, first = 0, second = 0;
    void add(double weight, double x)
    {
      zeroth += weight;
      first += weight * x;
      second += weight * x * x;
    }
    double mean() const { return first / zeroth; }
    double sigma() const { return std::sqrt(std::max(0.0, second / zeroth - mean() * mean())); }
  };
  Sums u, v;
  for (size_t x = 0; x < m_columns.size(); ++x) {
    u.add(1.0 * m_columns[x] * m_across.weights[x],
          m_across.first + static_cast<int>(x) * m_across.step - m_across.middle);
  }
  for (size_t y = 0; y < rows.size(); ++y) {
    v.add(1.0 * rows[y] * m_down.weights[y],
          m_down.first + static_cast<int>(y) * m_down.step - m_down.middle);
  }
  vpWindowMoments moments;
  if (u.zeroth > 0 && v.zeroth > 0) {
    moments.mass = u.zeroth / (255 * m_across.sum * m_down.sum);
    moments.meanU = u.mean() - m_across.targetMean;
    moments.meanV = v.mean() - m_down.targetMean;
    moments.sigmaU = u.sigma();
    moments.sigmaV = v.sigma();
  }
  return moments;
}

END_VISP_NAMESPACE
