/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_robot/vpOdometry.h>

#include "fuzz/vpFuzzTarget.h"

VLP_FUZZ_TARGET(odometry)
{
  const std::string file = vpFuzzFile("odometry.csv", data, size);
  vpFuzzReads([&] {
    const std::vector<vpOdometry> samples = vpReadOdometry(file);
    vpWriteOdometry(file, samples);
    vpFuzzExpect(vpReadOdometry(file).size() == samples.size(), "as many samples again");
  });
}
