/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_simulation/vpScenario.h>

#include "fuzz/vpFuzzTarget.h"

// Rig and lamps that it may name: those of data/.
VLP_FUZZ_TARGET(scenario)
{
  const std::string file = vpFuzzFile("scenario.yaml", data, size);
  vpFuzzReads([&] { vpScenario::load(file); });
}
