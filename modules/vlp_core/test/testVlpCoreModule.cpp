/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// As ViSP has its modules' tests: two lamps that blink alike share an identifier.

#include <cstdlib>

#include <visp3/vlp_core/vpLampMap.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main()
{
  vpLamp lamp;
  lamp.modulation.kind = vpModulation::Kind::pwm;
  lamp.modulation.frequency = 2000;
  vpLampMap map;
  map.lamps.assign(3, lamp);
  map.lamps[1].modulation.frequency = 3000;
  const std::vector<vpIdentifier> identifiers = map.identifiers();
  return identifiers.size() == 2 && identifiers[0].lamps.size() == 2 ? EXIT_SUCCESS : EXIT_FAILURE;
}
