/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpCameraXml.h>

#include "fuzz/vpFuzzTarget.h"

VLP_FUZZ_TARGET(cameraXml)
{
  const std::string file = vpFuzzFile("camera.xml", data, size);
  vpFuzzReadsBack(file, ".xml", [](const std::string &name) { return vpCameraXml::load(name, "UB300"); });
}
