/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_sensor/vpReadGreyPicture.h>

#include "fuzz/vpFuzzTarget.h"

VLP_FUZZ_TARGET(picture)
{
  const std::string file = vpFuzzFile("picture", data, size);
  vpFuzzReads([&] {
    vpImage<unsigned char> I;
    vpReadGreyPicture(file, I);
    vpFuzzExpect(I.getSize() > 0, "pixels");
  });
}
