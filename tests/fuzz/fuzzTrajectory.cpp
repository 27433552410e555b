/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpTrajectory.h>

#include "fuzz/vpFuzzTarget.h"

VLP_FUZZ_TARGET(trajectory)
{
  const std::string file = vpFuzzFile("poses.tum", data, size);
  // Between quaternion and matrix the last bit is rounded.
  vpFuzzReadsBack(
      file, ".tum", [](const std::string &name) { return vpTrajectory::load(name); }, false);
}
