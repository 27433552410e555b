/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "fuzz/vpFuzzTarget.h"
#include "vpLampPlaces.h"

// Places of lamps that vlp-plan is given: a table, or, where the input begins as YAML, a map.
VLP_FUZZ_TARGET(places)
{
  const bool yaml = size > 5 && std::string(reinterpret_cast<const char *>(data), 5) == "lamps";
  const std::string file = vpFuzzFile(yaml ? "places.yaml" : "places.csv", data, size);
  vpFuzzReads([&] { vpLampPlaces::load(file, 0.15); });
}
