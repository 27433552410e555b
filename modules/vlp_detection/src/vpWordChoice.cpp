/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Of vpWordFit: the grid over durations of a chip, and how sure the chips are.

#include "vpWordFit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

BEGIN_VISP_NAMESPACE

std::string vpWordFit::canonical(const std::vector<char> &chips)
{
  std::string word, greatest;
  for (char chip : chips) {
    word += chip != 0 ? '1' : '0';
  }
  for (size_t k = 0; k < word.size(); ++k) {
    greatest = std::max(greatest, word);
    std::rotate(word.begin(), word.begin() + 1, word.end());
  }
  return greatest;
}

double vpWordFit::cost(const Word &word) const
{
  static const double bits = 0.5;
  const auto n = static_cast<double>(m_weight.size());
  return n * std::log1p(word.chiSquare / n) + 2 * M_LN2 * bits * static_cast<double>(word.chips.size());
}

//! Words on a grid of phases at one duration of a chip, with exposure and saturation as stated and otherwise.
void vpWordFit::grid(size_t chips, double chip, std::vector<Word> &found) const
{
  static const int phases = 8;
  static const double saturated = 1.35, blurred = 2;
  for (int k = 0; k < 4 * phases; ++k) {
    Word word;
    word.chips.assign(chips, 0);
    word.chip = chip;
    word.phase = static_cast<double>(k / 4) / phases;
    word.gain = k % 2 == 0 ? 1 : saturated;
    word.exposure = m_profile->exposure * (k % 4 < 2 ? 1 : blurred);
    word.light[0] = m_dark;
    word.light[1] = 1;
    word.chiSquare = decode(word);
    if (word.chiSquare < 1e299) {
      found.push_back(std::move(word));
    }
  }
}

//! The best of a grid brought to their minima: those of equal chips count once.
std::vector<vpWordFit::Word> vpWordFit::refined(std::vector<Word> &grid, size_t count) const
{
  auto better = [this](const Word &a, const Word &b) { return cost(a) < cost(b); };
  std::sort(grid.begin(), grid.end(), better);
  std::vector<Word> words;
  std::vector<std::string> tried, kept;
  for (Word &word : grid) {
    if (words.size() == count || tried.size() == 2 * count) {
      break;
    }
    std::string start = canonical(word.chips);
    if (std::find(tried.begin(), tried.end(), start) != tried.end()) {
      continue;
    }
    tried.push_back(std::move(start));
    refine(word);
    std::string chips = canonical(word.chips);
    if (word.chiSquare < 1e299 && std::find(kept.begin(), kept.end(), chips) == kept.end()) {
      kept.push_back(std::move(chips));
      words.push_back(std::move(word));
    }
  }
  std::sort(words.begin(), words.end(), better);
  return words;
}

std::vector<vpWordFit::Word> vpWordFit::words(const Range &range, size_t count) const
{
  static const double drift = 0.25; // chips, at the profile's ends between neighbours of the grid
  const double step = drift * range.chip / m_half;
  const int steps = std::max(1, static_cast<int>(std::ceil(range.tolerance / step)));
  std::vector<Word> grid;
  for (size_t chips = range.fewest; chips <= range.most; ++chips) {
    for (int k = -steps; k <= steps; ++k) {
      this->grid(chips, range.chip * (1 + range.tolerance * k / steps), grid);
    }
  }
  return refined(grid, count);
}

std::vector<vpWordFit::Word> vpWordFit::durations(double shortest, double longest, size_t count) const
{
  static const double drift = 0.25; // chips
  std::vector<Word> grid;
  for (double chip = shortest; chip <= longest; chip *= 1 + drift * chip / m_half) {
    // A ring longer than the profile does not close.
    const size_t chips = static_cast<size_t>(std::ceil(span() / chip)) + vpChipTrellis::widestWindow;
    this->grid(chips, chip, grid);
  }
  return refined(grid, count);
}

double vpWordFit::inflation(const Word &word) const
{
  const double freedom = static_cast<double>(m_weight.size()) - m_linear - nonlinear;
  return std::max(1.0, word.chiSquare / std::max(1.0, freedom));
}

double vpWordFit::confidence(const Word &word, const std::vector<Word> &others, double inflation) const
{
  const int width = window(word);
  vpChipTrellis trellis(word.chips.size(), width);
  if (width > vpChipTrellis::widestWindow || !fill(trellis, word, width)) {
    return 0;
  }
  const double least = trellis.least();
  double odds = 0;
  for (size_t k = 0; k < word.chips.size(); ++k) {
    // Phase and light would follow other chips a little.
    static const double following = 0.7;
    const double more = trellis.leastWithout(k, word.chips[k] != 0) - least;
    odds += std::exp(-0.5 * following * more / inflation);
  }
  const std::string chips = canonical(word.chips);
  for (const Word &other : others) {
    if (canonical(other.chips) != chips) {
      odds += std::exp(-0.5 * (other.chiSquare - word.chiSquare) / inflation);
    }
  }
  return 1 / (1 + odds);
}

double vpWordFit::durationSigma(const Word &word, double inflation) const
{
  // Wide enough that an edge between two exposures is felt by one of them.
  static const double step = 0.1; // chips
  Eigen::VectorXd residuals;
  Jacobian J;
  if (!jacobian(word, step, residuals, J)) {
    return 1;
  }
  Curvature H = J.transpose() * J;
  H.diagonal().array() += 1e-6;
  return std::sqrt(inflation * H.inverse()(1, 1)) * word.chip / m_half;
}

END_VISP_NAMESPACE
