/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSurprise_h
#define vpSurprise_h

#include <algorithm>
#include <cmath>

#include <visp3/vlp_localization/vpVlpFix.h>

BEGIN_VISP_NAMESPACE

//! How far the lamps of a frame are from what may be chance.
namespace vpSurprise
{
//! Of a chi-square, in its standard deviations.
inline double beyondMean(double chiSquare, double degrees)
{
  return (chiSquare - degrees) / std::sqrt(2 * std::max(1.0, degrees));
}

//! Whether a fix's residuals are no chance.
inline bool of(const vpVlpFix &fix)
{
  static const double most = 3; // standard deviations
  return beyondMean(fix.chiSquare, fix.degreesOfFreedom) > most;
}

//! Makes a fix whose residuals are no chance as uncertain as they are large: by Birge's ratio.
inline void doubt(vpVlpFix &fix)
{
  if (of(fix)) {
    fix.covariance *= fix.chiSquare / fix.degreesOfFreedom;
  }
}
} // namespace vpSurprise

END_VISP_NAMESPACE

#endif
