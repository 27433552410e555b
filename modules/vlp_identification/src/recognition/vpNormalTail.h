/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpNormalTail_h
#define vpNormalTail_h

#include <cmath>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! Q(x): probability that a standard normal variable exceeds \e x.
inline double vpNormalTail(double x)
{
  return 0.5 * std::erfc(x / std::sqrt(2.0));
}

//! The x of which vpNormalTail() is \e probability, 0 < probability <= 0.5.
inline double vpNormalTailAt(double probability)
{
  double low = 0, high = 38; // beyond it Q is no normal number
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (vpNormalTail(middle) > probability ? low : high) = middle;
  }
  return high;
}

END_VISP_NAMESPACE

#endif
