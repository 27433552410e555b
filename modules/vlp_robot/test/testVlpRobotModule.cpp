/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// As ViSP has its modules' tests: a packet comes out of the bytes that it went into.

#include <cstdlib>

#include <visp3/vlp_robot/vpDynamixelPacket.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main()
{
  vpDynamixelPacket sent;
  sent.id = 200;
  sent.parameters = {1, 2, 3};
  vpDynamixelParser parser;
  const std::vector<std::uint8_t> bytes = sent.encoded();
  parser.push(bytes.data(), bytes.size());
  const auto received = parser.next();
  return received && received->id == sent.id && received->parameters == sent.parameters ? EXIT_SUCCESS
                                                                                        : EXIT_FAILURE;
}
