/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpRoundStep.h>

#include <cmath>
#include <initializer_list>

BEGIN_VISP_NAMESPACE

double vpRoundStep(double value)
{
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= value) {
      return factor * power;
    }
  }
  return 10 * power;
}

END_VISP_NAMESPACE
