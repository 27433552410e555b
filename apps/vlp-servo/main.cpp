/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vlp-servo: drives a robot along a path on the poses of the lamps.

#include "common/vpProgram.h"
#include "vpVlpServo.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main(int argc, char **argv)
{
  return vpRunProgram("vlp-servo", [&] {
    vpVlpServoOptions options;
    return options.parse(argc, argv) ? vpVlpServo(options) : vpExitCode::done;
  });
}
