/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// As ViSP has its modules' tests: a lamp of duty one half is lit half of a period.

#include <cmath>
#include <cstdlib>

#include <visp3/vlp_simulation/vpLampLight.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main()
{
  vpModulation modulation;
  modulation.kind = vpModulation::Kind::pwm;
  modulation.frequency = 1000;
  modulation.duty = 0.5;
  return std::abs(vpLampLight(modulation).over(0, 1e-3).share - 0.5) < 1e-9 ? EXIT_SUCCESS : EXIT_FAILURE;
}
