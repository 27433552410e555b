/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpFuzzBytes_h
#define vpFuzzBytes_h

#include <cstddef>
#include <cstdint>
#include <vector>

//! The input as a row of decisions. Once it is used up, each is 0.
class vpFuzzBytes
{
public:
  vpFuzzBytes(const std::uint8_t *data, size_t size) : m_data(data), m_left(size) {}

  bool empty() const { return m_left == 0; }
  std::uint8_t byte()
  {
    if (m_left == 0) {
      return 0;
    }
    --m_left;
    return *m_data++;
  }
  //! From -1 to 1.
  double share()
  {
    const int high = byte();
    return (256 * high + byte()) / 32767.5 - 1;
  }
  //! As many as there are, at most.
  std::vector<std::uint8_t> bytes(size_t most)
  {
    std::vector<std::uint8_t> taken;
    while (taken.size() < most && !empty()) {
      taken.push_back(byte());
    }
    return taken;
  }

private:
  const std::uint8_t *m_data;
  size_t m_left;
};

#endif
