/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vlp-evaluate: poses against the truth, as numbers, figures and a report.

#include "common/vpProgram.h"
#include "vpEvaluate.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main(int argc, char **argv)
{
  return vpRunProgram("vlp-evaluate", [&] {
    vpEvaluateOptions options;
    return options.parse(argc, argv) ? vpEvaluate(options) : vpExitCode::done;
  });
}
