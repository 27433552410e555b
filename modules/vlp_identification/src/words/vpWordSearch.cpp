/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpWordSearch.h"

#include <algorithm>
#include <cmath>
#include <numeric>

BEGIN_VISP_NAMESPACE

namespace
{
const size_t fewestChips = 6; // of a word of unknown format: fewer hold no header and no identifier
const size_t mostChips = 64;

using Word = vpWordFit::Word;

size_t longestRun(const std::vector<char> &chips)
{
  size_t run = 1, longest = 1;
  for (size_t k = 1; k < chips.size(); ++k) {
    run = chips[k] == chips[k - 1] ? run + 1 : 1;
    longest = std::max(longest, run);
  }
  return longest;
}

//! The greatest number of chips that a profile shows so often that their repetition is no chance.
size_t mostRepeating(const Word &word, double span)
{
  // Chips of a Manchester code are half as many bits: it takes more of them to agree.
  static const double repetitions = 1.3;
  const double seenTwice = longestRun(word.chips) > 2 ? 16 : 21; // chips
  const double seen = span / word.chip;
  const double most = std::min({seen - seenTwice, seen / repetitions, static_cast<double>(mostChips)});
  return static_cast<size_t>(std::max(0.0, most));
}

//! Lengths of the runs of equal chips round a word, from the first that begins in it; \e first where that is.
std::vector<size_t> runsOf(const std::vector<char> &chips, size_t &first)
{
  const size_t n = chips.size();
  std::vector<size_t> runs;
  first = 0;
  while (first < n && chips[first] == chips[(first + n - 1) % n]) {
    ++first;
  }
  for (size_t k = first; k < first + n; ++k) {
    if (k == first || chips[k % n] != chips[(k + n - 1) % n]) {
      runs.push_back(0);
    }
    ++runs.back();
  }
  return runs;
}

//! The word with as long chips as its runs allow: two equal halves are one chip.
Word coarsest(const Word &word)
{
  size_t first, divisor = 0;
  for (size_t run : runsOf(word.chips, first)) {
    divisor = std::gcd(divisor, run);
  }
  Word coarse = word;
  if (divisor > 1 && divisor < word.chips.size()) {
    const size_t n = word.chips.size();
    coarse.chips.clear();
    for (size_t k = 0; k < n; k += divisor) {
      coarse.chips.push_back(word.chips[(first + k) % n]);
    }
    coarse.chip *= static_cast<double>(divisor);
    coarse.phase = (word.phase - static_cast<double>(first)) / static_cast<double>(divisor);
  }
  return coarse;
}

//! The light that a word makes, whoever counts its chips: canonical, of the shortest repetition.
std::string signalOf(const Word &word)
{
  const std::string chips = vpWordFit::canonical(coarsest(word).chips);
  const size_t period = (chips + chips).find(chips, 1);
  return chips.substr(0, period);
}

//! Probability of a word beside others.
double amongOthers(const vpWordFit &fit, const Word &word, const std::vector<Word> &others)
{
  std::vector<std::string> counted{signalOf(word)};
  double odds = 0;
  for (const Word &other : others) {
    std::string signal = signalOf(other);
    if (std::find(counted.begin(), counted.end(), signal) == counted.end()) {
      counted.push_back(std::move(signal));
      odds += std::exp(-0.5 * (fit.cost(other) - fit.cost(word)));
    }
  }
  return 1 / (1 + odds);
}

//! Words of chips as long as those of \e starts, the best first.
std::vector<Word> repeating(const vpWordFit &fit, const std::vector<Word> &starts)
{
  static const size_t lengths = 4; // to fit, of each start
  std::vector<Word> words;
  std::vector<double> tried;
  double least = 1e300;
  for (const Word &start : starts) {
    // Others that differ by less than half a chip over the profile, or fit worse whatever they save.
    const double same = 0.25 * start.chip / fit.span() * start.chip;
    if (start.chiSquare > 1e299 || std::any_of(tried.begin(), tried.end(), [&](double chip) {
          return std::abs(chip - start.chip) < same;
        })) {
      continue;
    }
    tried.push_back(start.chip);
    Word shorter = start;
    shorter.chips.resize(fewestChips);
    if (fit.cost(shorter) > least) {
      continue;
    }
    for (Word &word : fit.repeating(start, fewestChips, mostRepeating(start, fit.span()), lengths)) {
      least = std::min(least, fit.cost(word));
      words.push_back(std::move(word));
    }
  }
  std::sort(words.begin(), words.end(),
            [&fit](const Word &a, const Word &b) { return fit.cost(a) < fit.cost(b); });
  return words;
}

} // namespace

bool vpWordSearch::singlePulse(const std::vector<char> &chips)
{
  size_t first;
  const std::vector<size_t> runs = runsOf(chips, first);
  for (size_t k = 2; k < runs.size(); ++k) {
    if (runs[k] != runs[k - 2]) {
      return false;
    }
  }
  return true;
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
    if (word.misfit < misfit && fit.span() >= static_cast<double>(format.chips) * word.chip) {
      const double inflation = fit.inflation(word);
      best =
          Found{word, fit.confidence(word, words, inflation), fit.durationSigma(word, inflation), inflation};
    }
  }
  return best;
}

//! Of the stretches between crossings of half the envelope, s: one in eight is shorter, by noise or at the
//! rim.
double vpWordSearch::shortRun() const
{
  static const double half = 0.5, sigmas = 4;
  std::vector<double> runs;
  double begin = 0;
  bool begun = false, lit = m_profile->light[0] > half * m_envelope[0];
  for (size_t i = 1; i < m_envelope.size(); ++i) {
    const double rise = m_profile->light[i] - half * m_envelope[i];
    const double margin = std::min(sigmas * m_profile->sigma[i], 0.3 * m_envelope[i]);
    if (lit ? rise > -margin : rise < margin) {
      continue;
    }
    lit = !lit;
    if (begun) {
      runs.push_back(std::abs(m_profile->time[i] - begin));
    }
    begin = m_profile->time[i];
    begun = true;
  }
  if (runs.empty()) {
    return std::abs(m_profile->time.back() - m_profile->time.front());
  }
  const auto place = runs.begin() + static_cast<long>(runs.size() / 8);
  std::nth_element(runs.begin(), place, runs.end());
  return *place;
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
  static const size_t durations = 8; // to fit
  const double run = shortRun();
  const double line = std::abs(m_profile->time.back() - m_profile->time.front()) /
                      static_cast<double>(m_profile->time.size() - 1);
  const double shortest = std::max(1.1 * line, 0.45 * run);
  const double longest = 1.3 * run + 2 * line;
  std::vector<double> envelope;
  const vpStripeProfile part = middle(2.5 * mostChips * shortest, envelope);
  const vpWordFit fit(part, m_settings, envelope);
  std::vector<Word> once = fit.durations(shortest, longest, durations);
  once.erase(
      std::remove_if(once.begin(), once.end(), [misfit](const Word &start) { return start.misfit > misfit; }),
      once.end());
  std::vector<Word> words = repeating(fit, once);
  if (words.empty() || words.front().misfit > misfit) {
    return std::nullopt;
  }
  Found found;
  found.word = coarsest(words.front());
  Word twice = found.word; // its last run may go on at its beginning
  twice.chips.insert(twice.chips.end(), found.word.chips.begin(), found.word.chips.end());
  const size_t chips = found.word.chips.size();
  if (chips < fewestChips || chips > mostRepeating(twice, fit.span())) {
    return std::nullopt;
  }
  fit.refine(found.word);
  words.insert(words.end(), once.begin(), once.end()); // it may be that nothing repeats
  found.inflation = fit.inflation(found.word);
  found.confidence =
      std::min(amongOthers(fit, found.word, words), fit.confidence(found.word, {}, found.inflation));
  // Chips that do not repeat may agree by chance, at any of several lengths.
  const double bits = longestRun(twice.chips) > 2 ? 1 : 0.5; // a chip; of Manchester's code a half
  const double seenTwice = fit.span() / found.word.chip - static_cast<double>(chips);
  found.confidence *= 1 - std::min(1.0, 3 * std::exp2(-bits * seenTwice));
  found.durationSigma = fit.durationSigma(found.word, found.inflation);
  return found;
}

END_VISP_NAMESPACE
