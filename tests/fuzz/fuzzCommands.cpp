/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_servo/vpServoLog.h>

#include "fuzz/vpFuzzTarget.h"

// The log of a drive: its commands are the input.
VLP_FUZZ_TARGET(commands)
{
  const std::string path = "{type: polyline, points_m: [[0, 0], [1, 0]]}";
  vpFuzzFile("path.yaml", path.data(), path.size());
  vpFuzzFile("poses.tum", "", 0);
  const std::string file = vpFuzzFile("commands.csv", data, size);
  vpFuzzReads([&] { vpServoLog::load(file.substr(0, file.rfind('/'))).estimatedErrors(); });
}
