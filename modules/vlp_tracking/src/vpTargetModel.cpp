/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpTargetModel.h"

#include <algorithm>
#include <cmath>

BEGIN_VISP_NAMESPACE

namespace
{
int colourBin(int red, int green, int blue)
{
  static const int dark = 40;      // of 255: below, hue is but noise
  static const double faint = 0.2; // saturation below which it is too
  const int highest = std::max({red, green, blue});
  const int spread = highest - std::min({red, green, blue});
  const double saturation = highest > 0 ? double(spread) / highest : 0;
  if (highest < dark || saturation < faint) {
    return vpColourBins::hues * vpColourBins::saturations + highest * vpColourBins::intensities / 256;
  }
  double sextant = 0; // hue in 60 degrees
  if (highest == red) {
    sextant = double(green - blue) / spread + (green < blue ? 6 : 0);
  } else if (highest == green) {
    sextant = double(blue - red) / spread + 2;
  } else {
    sextant = double(red - green) / spread + 4;
  }
  const int hue = static_cast<int>(sextant / 6 * vpColourBins::hues) % vpColourBins::hues;
  const int level = static_cast<int>((saturation - faint) / (1 - faint) * vpColourBins::saturations);
  return hue * vpColourBins::saturations + std::min(level, vpColourBins::saturations - 1);
}

//! Spreads the bins first, first + step, ... over their neighbours by 1/4 1/2 1/4. Ends keep what would fall
//! off, or where they meet (\e circular) go on at the other end.
void spread(vpBinShares &shares, int first, int step, int count, bool circular)
{
  auto at = [&](int i) -> double & { return shares[first + step * i]; };
  const double front = circular ? at(count - 1) : at(0);
  const double back = circular ? at(0) : at(count - 1);
  double before = front;
  for (int i = 0; i < count; ++i) {
    const double here = at(i);
    at(i) = 0.25 * before + 0.5 * here + 0.25 * (i + 1 < count ? at(i + 1) : back);
    before = here;
  }
}

void approach(vpBinShares &shares, const vpBinShares &goal, double rate)
{
  for (size_t bin = 0; bin < shares.size(); ++bin) {
    shares[bin] += rate * (goal[bin] - shares[bin]);
  }
}
} // namespace

const vpColourBins::Table &vpColourBins::table()
{
  static const Table bins = [] {
    Table table{};
    for (size_t k = 0; k < table.size(); ++k) {
      auto middle = [k](int shift) { return static_cast<int>((k >> shift & 31) * 8 + 4); };
      table[k] = static_cast<unsigned char>(colourBin(middle(10), middle(5), middle(0)));
    }
    return table;
  }();
  return bins;
}

vpBinShares vpTargetModel::smoothed(const vpBinShares &shares) const
{
  vpBinShares result{};
  if (!m_colour) {
    for (int from = 0; from < vpGreyBins::count; ++from) {
      for (int to = 0; shares[from] > 0 && to < vpGreyBins::count; ++to) {
        result[to] += shares[from] * m_blur[from][to];
      }
    }
    return result;
  }
  using Bins = vpColourBins;
  result = shares;
  for (int level = 0; level < Bins::saturations; ++level) {
    spread(result, level, Bins::saturations, Bins::hues, true);
  }
  for (int hue = 0; hue < Bins::hues; ++hue) {
    spread(result, hue * Bins::saturations, 1, Bins::saturations, false);
  }
  spread(result, Bins::hues * Bins::saturations, 1, Bins::intensities, false);
  return result;
}

void vpTargetModel::setSmoothing(double greyLevels)
{
  const double sigma = greyLevels / vpGreyBins::width;
  for (int from = 0; from < vpGreyBins::count; ++from) {
    double sum = 0;
    for (int to = 0; to < vpGreyBins::count; ++to) {
      m_blur[from][to] = std::exp(-0.5 * (to - from) * (to - from) / (sigma * sigma));
      sum += m_blur[from][to];
    }
    for (double &share : m_blur[from]) {
      share /= sum;
    }
  }
}

//! Mean difference of what tells the target from its surroundings and their mean.
double vpTargetModel::contrast() const
{
  double surroundings = 0, sum = 0, weight = 0;
  for (int bin = 0; bin < vpGreyBins::count; ++bin) {
    surroundings += m_surroundings[bin] * bin;
  }
  for (int bin = 0; bin < vpGreyBins::count; ++bin) {
    sum += m_weights[bin] * m_target[bin] * std::abs(bin - surroundings);
    weight += m_weights[bin] * m_target[bin];
  }
  return weight > 0 ? vpGreyBins::width * sum / weight : 0;
}

void vpTargetModel::learn(bool colour, const vpBinShares &target, const vpBinShares &surroundings)
{
  static const double least = 10; // grey levels
  static const double ofContrast = 0.15;
  m_colour = colour;
  setSmoothing(least);
  m_target = smoothed(target);
  m_surroundings = smoothed(surroundings);
  weigh();
  if (!colour) {
    setSmoothing(std::max(least, ofContrast * contrast()));
    m_target = smoothed(target);
    m_surroundings = smoothed(surroundings);
    weigh();
  }
}

void vpTargetModel::refresh(const vpBinShares &target, const vpBinShares &surroundings, double rate)
{
  approach(m_target, smoothed(target), rate);
  approach(m_surroundings, smoothed(surroundings), rate);
  weigh();
}

void vpTargetModel::weigh()
{
  static const int whole = 255;
  static const double telling = 0.02; // of the target, that its surroundings lack
  double told = 0;
  for (size_t bin = 0; bin < m_target.size(); ++bin) {
    const double q = m_target[bin], o = m_surroundings[bin];
    const double weight = q > o ? (q - o) * (q - o) / ((q + o) * (q + o)) : 0;
    m_weights[bin] = static_cast<int>(std::lround(whole * weight));
    told += weight * q;
  }
  if (told < telling) { // it looks as its surroundings do: all that is left is the plain histogram
    const double highest = *std::max_element(m_target.begin(), m_target.end());
    for (size_t bin = 0; bin < m_target.size(); ++bin) {
      m_weights[bin] = static_cast<int>(std::lround(whole * m_target[bin] / highest));
    }
  }
}

double vpTargetModel::mass(const vpBinShares &shares) const
{
  double sum = 0;
  for (size_t bin = 0; bin < shares.size(); ++bin) {
    sum += m_weights[bin] * shares[bin];
  }
  return sum / 255;
}

double vpTargetModel::bhattacharyya(const vpBinShares &candidate) const
{
  const vpBinShares seen = smoothed(candidate);
  const double whole = mass(m_target);
  const double scale = std::sqrt(whole * std::max(whole, mass(seen)));
  double sum = 0;
  for (size_t bin = 0; bin < seen.size(); ++bin) {
    sum += m_weights[bin] * std::sqrt(seen[bin] * m_target[bin]);
  }
  return scale > 0 ? std::min(1.0, sum / 255 / scale) : 0;
}

END_VISP_NAMESPACE
