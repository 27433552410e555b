/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpFaultyLine_h
#define vpFaultyLine_h

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include <visp3/vlp_robot/vpDynamixelPacket.h>

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

  //! A message as it arrives.
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
    if (out != bytes) {
      ++m_spoilt;
      m_unseen += seemsWhole(bytes, out);
    }
    return out;
  }

  //! Messages that did not arrive as they were sent.
  std::uint64_t spoilt() const { return m_spoilt; }

  //! s that the next message is held up.
  double holdUp() { return happens(m_faults.delayed) ? m_faults.delay : 0; }

  //! Of those, the ones that hold a packet with a right CRC that nobody sent: it takes 1 in 65536 for one.
  std::uint64_t unseen() const { return m_unseen; }

private:
  static std::vector<vpDynamixelPacket> packetsOf(const std::vector<std::uint8_t> &bytes)
  {
    vpDynamixelParser parser;
    parser.push(bytes.data(), bytes.size());
    std::vector<vpDynamixelPacket> packets;
    while (const std::optional<vpDynamixelPacket> packet = parser.next()) {
      packets.push_back(*packet);
    }
    return packets;
  }

  static bool seemsWhole(const std::vector<std::uint8_t> &sent, const std::vector<std::uint8_t> &came)
  {
    const std::vector<vpDynamixelPacket> before = packetsOf(sent);
    for (const vpDynamixelPacket &packet : packetsOf(came)) {
      const auto same = [&](const vpDynamixelPacket &other) {
        return other.instruction == packet.instruction && other.parameters == packet.parameters;
      };
      if (std::none_of(before.begin(), before.end(), same)) {
        return true;
      }
    }
    return false;
  }

  bool happens(double share) { return share > 0 && static_cast<double>(m_random() >> 11) * 0x1p-53 < share; }

  Faults m_faults;
  std::mt19937_64 m_random;
  std::uint64_t m_spoilt = 0, m_unseen = 0;
};

#endif
