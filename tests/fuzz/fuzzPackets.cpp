/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_robot/vpDynamixelPacket.h>

#include "fuzz/vpFuzzTarget.h"

// Bytes of a bad line, in pieces as long as the first byte says.
VLP_FUZZ_TARGET(packets)
{
  if (size == 0) {
    return;
  }
  const size_t piece = 1 + data[0];
  vpDynamixelParser parser;
  size_t pushed = 0;
  for (size_t i = 1; i < size; i += piece) {
    const size_t now = std::min(piece, size - i);
    parser.push(data + i, now);
    pushed += now;
    while (const std::optional<vpDynamixelPacket> packet = parser.next()) {
      const std::vector<std::uint8_t> bytes = packet->encoded();
      vpDynamixelParser other;
      other.push(bytes.data(), bytes.size());
      const std::optional<vpDynamixelPacket> again = other.next();
      vpFuzzExpect(again && again->id == packet->id && again->instruction == packet->instruction &&
                       again->error == packet->error && again->parameters == packet->parameters,
                   "a packet that is read as it was encoded");
    }
    vpFuzzExpect(parser.pending() + parser.skippedBytes() <= pushed, "no byte more than came");
    vpFuzzExpect(parser.pending() <= 7 + vpDynamixelPacket::largestLength, "memory of one packet");
  }
}
