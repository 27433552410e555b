/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vlp-plan: identifiers for lamps, and which lamps of a map may be confused.

#include "common/vpProgram.h"
#include "vpPlan.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main(int argc, char **argv)
{
  return vpRunProgram("vlp-plan", [&] {
    vpPlanOptions options;
    return options.parse(argc, argv) ? vpPlan(options) : vpExitCode::done;
  });
}
