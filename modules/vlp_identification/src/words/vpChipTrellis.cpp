/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpChipTrellis.h"

#include <algorithm>
#include <array>

BEGIN_VISP_NAMESPACE

vpChipTrellis::vpChipTrellis(size_t chips, int window)
    : m_chips(chips), m_window(window), m_costs(chips << window, 0.0)
{
}

double vpChipTrellis::least(std::vector<char> *chips) const
{
  return least(chips, none, 0);
}

double vpChipTrellis::leastWithout(size_t k, bool value, std::vector<char> *chips) const
{
  return least(chips, k, value ? 1 : 0);
}

double vpChipTrellis::least(std::vector<char> *chips, size_t barred, size_t barredValue) const
{
  static const double never = 1e300;
  const size_t states = size_t{1} << (m_window - 1); // the window's chips but the last
  using States = std::array<double, size_t{1} << (widestWindow - 1)>;
  std::vector<char> leaves(chips != nullptr ? m_chips * states : 0);
  double best = never;
  for (size_t start = 0; start < states; ++start) {
    States cost, next;
    cost.fill(never);
    cost[start] = 0;
    for (size_t k = 0; k < m_chips; ++k) {
      const double *own = &m_costs[k << m_window];
      for (size_t to = 0; to < states; ++to) {
        // Chip k is the one that leaves the window.
        const size_t dark = to << 1, lit = dark | 1;
        double without = cost[dark & (states - 1)] + own[dark];
        double with = cost[lit & (states - 1)] + own[lit];
        if (k == barred) {
          (barredValue == 1 ? with : without) = never;
        }
        next[to] = std::min(with, without);
        if (chips != nullptr) {
          leaves[k * states + to] = with < without ? 1 : 0;
        }
      }
      std::swap(cost, next);
    }
    if (cost[start] < best) {
      best = cost[start];
      if (chips != nullptr) {
        chips->resize(m_chips);
        size_t state = start;
        for (size_t k = m_chips; k-- > 0;) {
          const char chip = leaves[k * states + state];
          (*chips)[k] = chip;
          state = ((state << 1) | static_cast<size_t>(chip)) & (states - 1);
        }
      }
    }
  }
  return best;
}

END_VISP_NAMESPACE
