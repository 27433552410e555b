/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>

#include <visp3/vlp_servo/vpPath.h>

#include "fuzz/vpFuzzTarget.h"

VLP_FUZZ_TARGET(path)
{
  const std::string file = vpFuzzFile("path.yaml", data, size);
  vpFuzzReadsBack(file, ".yaml", [](const std::string &name) { return vpPath::load(name); });
  vpFuzzReads([&] {
    const vpPath path = vpPath::load(file);
    vpFuzzExpect(path.length() > 0 && std::isfinite(path.length()), "a length above 0");
    for (const double share : {0.0, 0.3, 1.0}) {
      const vpPathPoint point = path.at(share * path.length());
      vpFuzzExpect(point.place.allFinite() && std::isfinite(point.heading + point.curvature), "a place");
    }
  });
}
