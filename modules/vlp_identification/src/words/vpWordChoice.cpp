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

namespace
{
const double drift = 0.25; // chips, at the profile's ends between neighbours of a grid of durations
} // namespace

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

vpWordFit::Word vpWordFit::plain(size_t chips, double chip) const
{
  Word word;
  word.chips.assign(chips, 0);
  word.chip = chip;
  word.exposure = m_exposure;
  word.light[0] = m_dark;
  word.light[1] = 1;
  return word;
}

//! Chi-square of words on a grid of phases, with exposure and gain as stated, with more of both, and with an
//! exposure of about a chip: what is stated may be far off, what blurs the edges yet lets chips be seen is
//! not.
void vpWordFit::grid(const Word &about, std::vector<Word> &found) const
{
  static const int phases = 8;
  static const double blurred = 1.8, saturated = 1.15, aboutOneChip = 1.2;
  const Light light = lightOf(about);
  for (int k = 0; k < 3 * phases; ++k) {
    Word word = about;
    word.phase = static_cast<double>(k / 3) / phases;
    word.exposure = k % 3 == 0   ? about.exposure
                    : k % 3 == 1 ? blurred * about.exposure
                                 : aboutOneChip * about.chip;
    word.gain = k % 3 == 0 ? 1 : saturated;
    word.chiSquare = least(word, light, nullptr);
    found.push_back(std::move(word));
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
    if (least(word, lightOf(word), &word.chips) > 1e299) {
      continue;
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

std::vector<vpWordFit::Word> vpWordFit::words(size_t chips, double chip, double tolerance, size_t count) const
{
  const double step = drift * chip / m_half;
  const int steps = std::max(1, static_cast<int>(std::ceil(tolerance / step)));
  std::vector<Word> found;
  for (int k = -steps; k <= steps; ++k) {
    grid(plain(chips, chip * (1 + tolerance * k / steps)), found);
  }
  return refined(found, count);
}

std::vector<vpWordFit::Word> vpWordFit::durations(double shortest, double longest, size_t count) const
{
  // Of each duration the best, and of these those that are better than their neighbours.
  std::vector<Word> found;
  for (double chip = shortest; chip <= longest; chip *= 1 + drift * chip / m_half) {
    std::vector<Word> phases;
    // A ring longer than the profile does not close.
    grid(plain(static_cast<size_t>(std::ceil(span() / chip)) + vpChipTrellis::widestWindow, chip), phases);
    found.push_back(
        std::move(*std::min_element(phases.begin(), phases.end(),
                                    [](const Word &a, const Word &b) { return a.chiSquare < b.chiSquare; })));
  }
  std::vector<Word> minima;
  for (size_t k = 0; k < found.size(); ++k) {
    if ((k == 0 || cost(found[k]) <= cost(found[k - 1])) &&
        (k + 1 == found.size() || cost(found[k]) < cost(found[k + 1]))) {
      minima.push_back(found[k]);
    }
  }
  return refined(minima, count);
}

std::vector<vpWordFit::Word> vpWordFit::repeating(const Word &start, size_t fewest, size_t most,
                                                  size_t count) const
{
  // Repetition tells the duration better than the start does.
  static const std::array<double, 5> atTheEnds{-0.4, -0.2, 0, 0.2, 0.4}; // chips
  static const std::array<double, 3> atTheMiddle{-0.15, 0, 0.15};
  const Light light = lightOf(start);
  std::vector<Word> found;
  for (size_t chips = fewest; chips <= most; ++chips) {
    for (double later : atTheMiddle) {
      for (double more : atTheEnds) {
        Word word = moved(start, {later, more, 0, 0});
        word.chips.assign(chips, 0);
        word.chiSquare = least(word, light, nullptr);
        found.push_back(std::move(word));
      }
    }
  }
  return refined(found, count);
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
  if (width > vpChipTrellis::widestWindow || !fill(trellis, word, lightOf(word), width)) {
    return 0;
  }
  std::vector<std::string> counted{canonical(word.chips)};
  double odds = 0;
  auto count = [&](const Word &other) {
    std::string chips = canonical(other.chips);
    if (std::find(counted.begin(), counted.end(), chips) == counted.end()) {
      odds += std::exp(-0.5 * (other.chiSquare - word.chiSquare) / inflation);
      counted.push_back(std::move(chips));
    }
  };
  const double least = trellis.least();
  for (size_t k = 0; k < word.chips.size(); ++k) {
    static const double unlikely = 40; // times its chi-square: whatever follows, it does not count
    Word other = word;
    const double more = trellis.leastWithout(k, word.chips[k] != 0, &other.chips) - least;
    if (more < unlikely * inflation) {
      descend(other); // phase, light and the rest follow other chips
      count(other);
    }
  }
  std::for_each(others.begin(), others.end(), count);
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
