/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpWordCode.h"

#include <algorithm>
#include <bitset>

BEGIN_VISP_NAMESPACE

vpWordCode::vpWordCode(const std::string &chips) : m_length(static_cast<unsigned int>(chips.size()))
{
  for (const char chip : chips) {
    m_chips = m_chips << 1 | (chip == '1' ? 1u : 0u);
  }
}

std::uint64_t vpWordCode::turned(unsigned int turn) const
{
  if (turn == 0) {
    return m_chips;
  }
  const std::uint64_t all = ~std::uint64_t(0) >> (mostChips - m_length);
  return (m_chips << turn | m_chips >> (m_length - turn)) & all;
}

unsigned int vpWordCode::occurrences(const vpWordCode &chips) const
{
  unsigned int count = 0;
  for (unsigned int turn = 0; turn < m_length; ++turn) {
    count += turned(turn) >> (m_length - chips.m_length) == chips.m_chips;
  }
  return count;
}

unsigned int vpWordCode::distance(const vpWordCode &other) const
{
  unsigned int least = m_length;
  for (unsigned int turn = 0; turn < m_length && least > 0; ++turn) {
    least = std::min(least, differing(m_chips, other.turned(turn)));
  }
  return least;
}

unsigned int vpWordCode::differing(std::uint64_t a, std::uint64_t b)
{
  return static_cast<unsigned int>(std::bitset<mostChips>(a ^ b).count());
}

END_VISP_NAMESPACE
