/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vlp-simulate: a scenario to a run folder with ground truth.

#include "common/vpProgram.h"
#include "vpSimulate.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main(int argc, char **argv)
{
  return vpRunProgram("vlp-simulate", [&] {
    vpSimulateOptions options;
    return options.parse(argc, argv) ? vpSimulate(options) : vpExitCode::done;
  });
}
