/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What libFuzzer calls, in a program with one target.

#include "fuzz/vpFuzzTarget.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, size_t size)
{
  vpFuzzTarget::all().front().function(data, size);
  return 0;
}
