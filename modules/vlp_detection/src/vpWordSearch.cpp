/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpWordSearch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

BEGIN_VISP_NAMESPACE

namespace
{
const size_t fewestChips = 6;        // of a word of unknown format: fewer hold no header and no identifier
const size_t mostChips = 64;

using Word = vpWordFit::Word;

//! The greatest number of chips that a profile shows so often that their repetition is no chance.
size_t mostRepeating(const Word &word, double span)
{
  // Chips of a Manchester code are half as many bits: it takes more of them to agree.
  size_t run = 1, longestRun = 1;
  for (size_t k = 1; k < word.chips.size(); ++k) {
    run = word.chips[k] == word.chips[k - 1] ? run + 1 : 1;
    longestRun = std::max(longestRun, run);
  }
  static const double repetitions = 1.3;
  const double seenTwice = longestRun > 2 ? 16 : 20; // chips
  const double seen = span / word.chip;
  const double most = std::min({seen - seenTwice, seen / repetitions, static_cast<double>(mostChips)});
  return static_cast<size_t>(std::max(0.0, most));
}

//! Probability of a word beside others.
double amongOthers(const vpWordFit &fit, const Word &word, const std::vector<Word> &others)
{
  std::vector<std::string> counted{vpWordFit::canonical(word.chips)};
  double odds = 0;
  for (const Word &other : others) {
    std::string chips = vpWordFit::canonical(other.chips);
    if (std::find(counted.begin(), counted.end(), chips) == counted.end()) {
      counted.push_back(std::move(chips));
      odds += std::exp(-0.5 * (fit.cost(other) - fit.cost(word)));
    }
  }
  return 1 / (1 + odds);
}
} // namespace

bool vpWordSearch::singlePulse(const std::vector<char> &chips)
{
  // All rises and all falls have equal distances.
  std::vector<size_t> lit, dark;
  const size_t n = chips.size();
  for (size_t k = 0; k < n; ++k) {
    if (chips[k] == 0 || chips[(k + n - 1) % n] != 0) {
      continue; // no rise
    }
    size_t end = 1;
    while (chips[(k + end) % n] != 0) {
      ++end;
    }
    lit.push_back(end);
    while (chips[(k + end) % n] == 0) {
      ++end;
    }
    dark.push_back(end - lit.back());
  }
  auto equal = [](const std::vector<size_t> &runs) {
    return std::all_of(runs.begin(), runs.end(), [&runs](size_t run) { return run == runs.front(); });
  };
  return equal(lit) && equal(dark);
}

std::optional<vpWordSearch::Found> vpWordSearch::known(const std::vector<vpWordFormat> &formats,
                                                       double misfit) const
{
  static const double leastTolerance = 0.012;
  static const size_t tried = 4;
  const vpWordFit fit(*m_profile, m_settings, m_envelope);
  std::optional<Found> best;
  for (const vpWordFormat &format : formats) {
    const double chip = 1 / format.chipRate;
    const double tolerance = std::max(leastTolerance, 3 * format.tolerance);
    if (fit.span() < static_cast<double>(format.chips) * chip * (1 - tolerance)) {
      continue;
    }
    const std::vector<Word> words = fit.words(format.chips, chip, tolerance, tried);
    if (words.empty() || (best && fit.cost(best->word) < fit.cost(words.front()))) {
      continue;
    }
    const Word &word = words.front();
    if (getenv("WD")) printf("known misfit %.3f chi2 %.1f infl %.2f conf %.4f exp %g gain %.2f bend %.2f chip %g next %.1f\n", word.misfit, word.chiSquare, fit.inflation(word), fit.confidence(word, words, fit.inflation(word)), word.exposure, word.gain, word.light[6]/word.light[1], word.chip, words.size()>1?words[1].chiSquare-word.chiSquare:-1);
    if (word.misfit < misfit && fit.span() >= static_cast<double>(format.chips) * word.chip) {
      const double inflation = fit.inflation(word);
      best = Found{word, fit.confidence(word, words, inflation), fit.durationSigma(word, inflation), inflation};
    }
  }
  return best;
}

//! Of the stretches between crossings of half the envelope, s, roughly.
double vpWordSearch::shortestRun() const
{
  auto share = [this](size_t i) { return m_profile->light[i] / m_envelope[i]; };
  double shortest = std::abs(m_profile->time.back() - m_profile->time.front()), begin = 0;
  bool begun = false;
  for (size_t i = 1; i < m_envelope.size(); ++i) {
    const double before = share(i - 1), now = share(i);
    if ((now > 0.5) == (before > 0.5)) {
      continue;
    }
    const double way = (0.5 - before) / (now - before);
    const double at = m_profile->time[i - 1] + way * (m_profile->time[i] - m_profile->time[i - 1]);
    if (begun) {
      shortest = std::min(shortest, std::abs(at - begin));
    }
    begin = at;
    begun = true;
  }
  return shortest;
}

//! The lines of the middle \e span seconds.
vpStripeProfile vpWordSearch::middle(double span, std::vector<double> &envelope) const
{
  vpStripeProfile part;
  part.exposure = m_profile->exposure;
  envelope.clear();
  const double at = 0.5 * (m_profile->time.front() + m_profile->time.back());
  for (size_t i = 0; i < m_envelope.size(); ++i) {
    if (std::abs(m_profile->time[i] - at) <= 0.5 * span) {
      part.time.push_back(m_profile->time[i]);
      part.light.push_back(m_profile->light[i]);
      part.sigma.push_back(m_profile->sigma[i]);
      envelope.push_back(m_envelope[i]);
    }
  }
  return part;
}

std::optional<vpWordSearch::Found> vpWordSearch::blind(double misfit) const
{
  static const size_t durations = 6, lengths = 6; // to fit
  const double run = shortestRun();
  const double line = std::abs(m_profile->time.back() - m_profile->time.front()) /
                      static_cast<double>(m_profile->time.size() - 1);
  const double shortest = std::max(1.1 * line, 0.45 * run);
  const double longest = 1.3 * run + 2 * line;
  std::vector<double> envelope;
  const vpStripeProfile part = middle(2.5 * mostChips * shortest, envelope);
  const vpWordFit fit(part, m_settings, envelope);
  const std::vector<Word> once = fit.durations(shortest, longest, durations);
  std::vector<Word> words;
  for (const Word &start : once) {
    if (start.misfit < misfit) {
      for (Word &word : fit.repeating(start, fewestChips, mostRepeating(start, fit.span()), lengths)) {
        words.push_back(std::move(word));
      }
    }
  }
  const auto best = std::min_element(
      words.begin(), words.end(), [&fit](const Word &a, const Word &b) { return fit.cost(a) < fit.cost(b); });
  if (best == words.end() || best->misfit > misfit) {
    return std::nullopt;
  }
  Found found;
  found.word = *best;
  words.insert(words.end(), once.begin(), once.end()); // it may be that nothing repeats
  const double inflation = fit.inflation(found.word);
  found.confidence =
      std::min(amongOthers(fit, found.word, words), fit.confidence(found.word, {}, inflation));
  found.inflation = inflation;
  found.durationSigma = fit.durationSigma(found.word, inflation);
  if (getenv("WD")) printf("blind n %zu chip %g exp %g gain %.2f misfit %.3f infl %.1f cost %.1f conf %g %g %s\n", found.word.chips.size(), found.word.chip, found.word.exposure, found.word.gain, found.word.misfit, inflation, fit.cost(found.word),amongOthers(fit, found.word, words), fit.confidence(found.word, {}, inflation), vpWordFit::canonical(found.word.chips).c_str());
  return found;
}

END_VISP_NAMESPACE
