/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpChipTrellis_h
#define vpChipTrellis_h

#include <cstddef>
#include <vector>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  The likeliest chips of a word that repeats. A line's exposure touches a few neighbouring chips (the window),
  so that its cost depends on these alone, and the sum over all lines is one of terms that go round a ring:
  its minimum over all 2^n words is exact by dynamic programming (Viterbi 1967; on a ring, for each state that
  it may start and end with).
*/
class vpChipTrellis
{
public:
  static constexpr int widestWindow = 5;

  //! \param chips Of one repetition, at least \e window. \param window Chips that a line touches at most.
  vpChipTrellis(size_t chips, int window);

  //! Costs of lines whose first chip is \e first, by the pattern of the window's chips: bit j is chip first +
  //! j. To be added to.
  double *costs(size_t first) { return &m_costs[first << m_window]; }

  //! Least cost of all words. \param chips Where given, the word that has it, 1 lit.
  double least(std::vector<char> *chips = nullptr) const;

  //! Least cost of all words whose chip \e k is not \e value.
  double leastWithout(size_t k, bool value, std::vector<char> *chips = nullptr) const;

private:
  static constexpr size_t none = static_cast<size_t>(-1);
  double least(std::vector<char> *chips, size_t barred, size_t barredValue) const;

  size_t m_chips;
  int m_window;
  std::vector<double> m_costs;
};

END_VISP_NAMESPACE

#endif
