/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// As ViSP has its modules' tests: no lamps are no position, with a reason.

#include <cstdlib>

#include <visp3/vlp_localization/vpTwoLampSolver.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main()
{
  const vpVlpFix fix = vpTwoLampSolver().solveBestPair({}, vpVlpRig());
  return !fix.valid && !fix.refusal.empty() ? EXIT_SUCCESS : EXIT_FAILURE;
}
