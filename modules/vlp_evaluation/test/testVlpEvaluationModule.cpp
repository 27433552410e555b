/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// As ViSP has its modules' tests: mean and largest of errors.

#include <cmath>
#include <cstdlib>

#include <visp3/vlp_evaluation/vpErrorStatistics.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main()
{
  const vpErrorStatistics errors = vpErrorStatistics::of({1, 2, 6});
  return std::abs(errors.mean - 3) < 1e-12 && errors.largest == 6 ? EXIT_SUCCESS : EXIT_FAILURE;
}
