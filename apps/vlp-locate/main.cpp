/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vlp-locate: frames to poses.

#include "common/vpProgram.h"
#include "vpLocate.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main(int argc, char **argv)
{
  return vpRunProgram("vlp-locate", [&] {
    vpLocateOptions options;
    return options.parse(argc, argv) ? vpLocate(options) : vpExitCode::done;
  });
}
