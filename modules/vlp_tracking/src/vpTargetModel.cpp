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

vpBinShares smoothed(vpBinShares shares, bool colour)
{
  static const int rounds = 3; // each adds a variance of half a bin: 10 grey levels together
  if (!colour) {
    for (int k = 0; k < rounds; ++k) {
      spread(shares, 0, 1, vpGreyBins::count, false);
    }
    return shares;
  }
  using Bins = vpColourBins; // coarse bins: one round
  for (int level = 0; level < Bins::saturations; ++level) {
    spread(shares, level, Bins::saturations, Bins::hues, true);
  }
  for (int hue = 0; hue < Bins::hues; ++hue) {
    spread(shares, hue * Bins::saturations, 1, Bins::saturations, false);
  }
  spread(shares, Bins::hues * Bins::saturations, 1, Bins::intensities, false);
  return shares;
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

void vpTargetModel::learn(bool colour, const vpBinShares &target, const vpBinShares &surroundings)
{
  m_colour = colour;
  m_target = smoothed(target, colour);
  m_surroundings = smoothed(surroundings, colour);
  weigh();
}

void vpTargetModel::refresh(const vpBinShares &target, const vpBinShares &surroundings, double rate)
{
  approach(m_target, smoothed(target, m_colour), rate);
  approach(m_surroundings, smoothed(surroundings, m_colour), rate);
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
  const vpBinShares seen = smoothed(candidate, m_colour);
  const double whole = mass(m_target);
  const double scale = std::sqrt(whole * std::max(whole, mass(seen)));
  double sum = 0;
  for (size_t bin = 0; bin < seen.size(); ++bin) {
    sum += m_weights[bin] * std::sqrt(seen[bin] * m_target[bin]);
  }
  return scale > 0 ? std::min(1.0, sum / 255 / scale) : 0;
}

END_VISP_NAMESPACE
