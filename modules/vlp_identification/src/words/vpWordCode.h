/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpWordCode_h
#define vpWordCode_h

#include <cstdint>
#include <string>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! The chips of a word as the bits of a number, the first chip the highest: quick to turn and to compare.
class vpWordCode
{
public:
  static constexpr unsigned int mostChips = 64;

  //! \param chips '0' and '1', at most mostChips of them.
  explicit vpWordCode(const std::string &chips);

  //! The same chips beginning \e turn chips later, 0 <= turn < length().
  std::uint64_t turned(unsigned int turn) const;
  unsigned int length() const { return m_length; }

  //! Number of rotations at which the word begins with \e chips, no more than it has itself.
  unsigned int occurrences(const vpWordCode &chips) const;

  //! Least number of chips in which \e other, of the same length, differs over all rotations.
  unsigned int distance(const vpWordCode &other) const;

  static unsigned int differing(std::uint64_t a, std::uint64_t b);

private:
  std::uint64_t m_chips = 0;
  unsigned int m_length = 0;
};

END_VISP_NAMESPACE

#endif
