/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpFrequencyRows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

BEGIN_VISP_NAMESPACE

namespace
{
//! The longest of the chains that end at one of the first so many candidates (a tree of Fenwick's).
class LongestBefore
{
public:
  explicit LongestBefore(size_t candidates) : m_tree(candidates + 1, {0, 0}) {}

  void add(size_t candidate, size_t length)
  {
    for (size_t i = candidate + 1; i < m_tree.size(); i += i & (~i + 1)) {
      m_tree[i] = std::max(m_tree[i], {length, candidate});
    }
  }

  //! Its length and where it ends; length 0: there is none.
  std::pair<size_t, size_t> among(size_t first) const
  {
    std::pair<size_t, size_t> best{0, 0};
    for (size_t i = first; i > 0; i -= i & (~i + 1)) {
      best = std::max(best, m_tree[i]);
    }
    return best;
  }

private:
  std::vector<std::pair<size_t, size_t>> m_tree;
};
} // namespace

vpFrequencyRows::vpFrequencyRows(const vpLedIdPlanner &planner, double lines)
    : m_lowest(planner.lowest(lines)), m_highest(planner.highest())
{
  for (const double duty : planner.duties) {
    m_rows.push_back(rowOf(planner, duty, lines));
  }
}

vpFrequencyRows::Row vpFrequencyRows::rowOf(const vpLedIdPlanner &planner, double duty, double lines) const
{
  Row row{duty, {}};
  const double highest = std::min(m_highest, std::min(duty, 1 - duty) / planner.prediction.exposure());
  const double step = planner.frequencyStep;
  static const double rounding = 1e-9, cell = 5; // Hz, within which the shape's sigma changes little
  vpStripeUncertainty below = planner.prediction.shapeSigma(vpPwmLamp(m_lowest, duty), lines), above = below;
  double end = m_lowest; // of the cell, at which above is
  for (double n = std::ceil(m_lowest / step - rounding); n * step <= highest * (1 + rounding); ++n) {
    while (end < n * step) {
      end = std::max(end + cell, n * step);
      below = above;
      above = planner.prediction.shapeSigma(vpPwmLamp(end, duty), lines);
    }
    const double frequency = planner.made(n * step);
    if (frequency > highest * (1 + rounding) ||
        (!row.candidates.empty() && !(frequency > row.candidates.back().frequency))) {
      continue;
    }
    const vpStripeUncertainty sigma = planner.prediction.together(vpPwmLamp(frequency, duty), lines, 0,
                                                                  below.duty > above.duty ? below : above);
    row.candidates.push_back({frequency, sigma.frequency, sigma.duty});
  }
  return row;
}

double vpFrequencyRows::sigmaOf(const Candidate &candidate) const
{
  return std::hypot(candidate.frequencySigma, 1e-6 * m_oscillatorPpm * candidate.frequency);
}

double vpFrequencyRows::widest() const
{
  double least = std::numeric_limits<double>::infinity();
  for (const Row &row : m_rows) {
    for (const Candidate &candidate : row.candidates) {
      least = std::min(least, sigmaOf(candidate));
    }
  }
  return std::max(0.0, m_highest - m_lowest) / least + 1;
}

//! From a row's duty to the nearest other one of the set.
double vpFrequencyRows::roomAcross(unsigned int set, size_t row) const
{
  double room = std::numeric_limits<double>::infinity();
  for (size_t other = 0; other < m_rows.size(); ++other) {
    if (other != row && (set >> other & 1) == 1) {
      room = std::min(room, std::abs(m_rows[other].duty - m_rows[row].duty));
    }
  }
  return room;
}

/*!
  The longest chain of candidates in which each is far enough from the one before, as the less certain of both
  demands: for each candidate in turn the longest chain that ends there, which goes on from a candidate that
  is below its reach and whose own reach is below it.
*/
std::vector<double> vpFrequencyRows::longestChain(const std::vector<Candidate> &candidates,
                                                  double distance) const
{
  const size_t n = candidates.size();
  std::vector<double> reach(n);
  std::vector<size_t> byReachedUntil(n);
  for (size_t i = 0; i < n; ++i) {
    reach[i] = distance * sigmaOf(candidates[i]);
    byReachedUntil[i] = i;
  }
  const auto until = [&](size_t i) { return candidates[i].frequency + reach[i]; };
  std::stable_sort(byReachedUntil.begin(), byReachedUntil.end(),
                   [&](size_t a, size_t b) { return until(a) < until(b); });
  LongestBefore longest(n);
  std::vector<size_t> length(n, 1), before(n, n);
  size_t open = 0, last = n; // how many may be gone on from; the end of the longest chain of all
  for (size_t i = 0; i < n; ++i) {
    const double f = candidates[i].frequency;
    for (; open < n && byReachedUntil[open] < i && until(byReachedUntil[open]) <= f; ++open) {
      longest.add(byReachedUntil[open], length[byReachedUntil[open]]);
    }
    const auto below = std::upper_bound(candidates.begin(), candidates.end(), f - reach[i],
                                        [](double value, const Candidate &c) { return value < c.frequency; });
    const auto [best, from] = longest.among(static_cast<size_t>(below - candidates.begin()));
    if (best > 0) {
      length[i] = best + 1;
      before[i] = from;
    }
    last = last == n || length[i] > length[last] ? i : last;
  }
  std::vector<double> chain;
  for (size_t i = last; i < n; i = before[i]) {
    chain.push_back(candidates[i].frequency);
  }
  return {chain.rbegin(), chain.rend()};
}

std::vector<vpModulation> vpFrequencyRows::filled(unsigned int set, double alongFrequency,
                                                  double acrossDuty) const
{
  std::vector<vpModulation> lamps;
  for (size_t i = 0; i < m_rows.size(); ++i) {
    if ((set >> i & 1) == 0) {
      continue;
    }
    const double room = roomAcross(set, i);
    std::vector<Candidate> certain;
    for (const Candidate &candidate : m_rows[i].candidates) {
      if (candidate.dutySigma * acrossDuty <= room) {
        certain.push_back(candidate);
      }
    }
    for (const double frequency : longestChain(certain, alongFrequency)) {
      lamps.push_back(vpPwmLamp(frequency, m_rows[i].duty));
    }
  }
  return lamps;
}

END_VISP_NAMESPACE
