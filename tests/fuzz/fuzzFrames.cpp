/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_sensor/vpPictureSequence.h>

#include "fuzz/vpFuzzTarget.h"

VLP_FUZZ_TARGET(frames)
{
  const std::string file = vpFuzzFile("frames.csv", data, size);
  vpFuzzReads([&] {
    const vpPictureSequence frames = vpPictureSequence::fromRun(file.substr(0, file.rfind('/')));
    vpFuzzExpect(frames.size() > 0, "a frame");
    vpFuzzExpect(frames.remark().find('\n') == std::string::npos, "a remark of one line");
  });
}
