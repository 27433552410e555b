/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpFaultyLine_h
#define vpFaultyLine_h

#include <cstdint>
#include <random>
#include <vector>

/*!
  What a bad line does to the bytes on it: alters them, loses them, and holds messages up. Bytes stay in
  order.
*/
class vpFaultyLine
{
public:
  struct Faults {
    double corrupted = 0; // share of bytes replaced by another value
    double lost = 0;      // share of bytes
    double delayed = 0;   // share of messages
    double delay = 0.06;  // s that those are held up
    std::uint64_t seed = 1;
  };

  vpFaultyLine() = default;
  explicit vpFaultyLine(const Faults &faults) : m_faults(faults), m_random(faults.seed) {}

  std::vector<std::uint8_t> pass(const std::vector<std::uint8_t> &bytes)
  {
    std::vector<std::uint8_t> out;
    for (const std::uint8_t byte : bytes) {
      if (happens(m_faults.lost)) {
        continue;
      }
      out.push_back(happens(m_faults.corrupted) ? static_cast<std::uint8_t>(byte ^ (1 + m_random() % 255))
                                                : byte);
    }
    return out;
  }

  //! s that the next message is held up.
  double holdUp() { return happens(m_faults.delayed) ? m_faults.delay : 0; }

private:
  bool happens(double share) { return share > 0 && static_cast<double>(m_random() >> 11) * 0x1p-53 < share; }

  Faults m_faults;
  std::mt19937_64 m_random;
};

#endif
