/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_calibration/vpCameraCalibration.h>

#include "fuzz/vpFuzzTarget.h"

VLP_FUZZ_TARGET(cameraInfo)
{
  const std::string file = vpFuzzFile("camera_info.yaml", data, size);
  vpFuzzReads([&] { vpCameraFromInfo(file); });
}
