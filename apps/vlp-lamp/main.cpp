/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vlp-lamp: tells lamps how to blink.

#include "common/vpProgram.h"
#include "vpTellLamps.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main(int argc, char **argv)
{
  return vpRunProgram("vlp-lamp", [&] {
    vpLampOptions options;
    return options.parse(argc, argv) ? vpTellLamps(options) : vpExitCode::done;
  });
}
