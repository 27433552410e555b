/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpLampMap.h>

#include "fuzz/vpFuzzTarget.h"

VLP_FUZZ_TARGET(lamps)
{
  const std::string file = vpFuzzFile("lamps.yaml", data, size);
  vpFuzzReadsBack(file, ".yaml", [](const std::string &name) { return vpLampMap::load(name); });
  vpFuzzReads([&] { vpLampMap::load(file).identifiers(); });
}
