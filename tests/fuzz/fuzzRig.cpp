/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpVlpRig.h>

#include "fuzz/vpFuzzTarget.h"

// Beside the rig are the cameras that rigs of data/ name: UB300, in two files.
VLP_FUZZ_TARGET(rig)
{
  static const std::string camera =
      "<root><camera><name>UB300</name><image_width>800</image_width><image_height>600</image_height><model>"
      "<type>perspectiveProjWithoutDistortion</type><px>416</px><py>416</py><u0>399.5</u0><v0>299.5</v0>"
      "</model></camera></root>";
  for (const char *const name : {"ub300-800x600.xml", "ub300-2048x1536.xml"}) {
    vpFuzzFile(name, camera.data(), camera.size());
  }
  const std::string file = vpFuzzFile("rig.yaml", data, size);
  vpFuzzReads([&] {
    const vpVlpRig rig = vpVlpRig::load(file);
    const vpLineTiming timing = rig.lineTiming();
    vpFuzzExpect(timing.lines() == (rig.shutter.alongColumns() ? rig.width : rig.height),
                 "a time for each line");
  });
}
