/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpStripeLimits_h
#define vpStripeLimits_h

#include <algorithm>
#include <cmath>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  What stripes cannot tell, however little noise there is: for the fit that has to say so, and for the planner
  that keeps lamps away from it.
*/
namespace vpStripeLimits
{
/*!
  Share of a gap between two exposures within which the edge of a pulse cannot be placed. The walls of such a
  posterior are as sharp as the noise is low, sharper than any model of a lamp and its edges is true.
*/
constexpr double untrue = 0.02;

//! Lit and dark share of a period of any lamp: less is a dim rim, a crossbar.
constexpr double leastDuty = 0.05;

//! How far a duty is from what it should be, a chi-square: it may be any that a lamp has.
inline double unlikely(double duty)
{
  const double spread = 0.3, impossible = 100; // standard deviation; chi-square
  return std::pow((duty - 0.5) / spread, 2) + (std::min(duty, 1 - duty) < leastDuty ? impossible : 0);
}

/*!
  Pulse and exposure are both boxes, and which is which the stripes do not say: how far an exposure and a
  pulse are from what they should be, a chi-square. \param exposure As a share of the stated one. \param sigma
  Of the stated one's logarithm. \param duty Lit share of the period.
*/
inline double unlikely(double exposure, double sigma, double duty)
{
  const double softened = 0.15; // of the exposure's logarithm, by tone curves and blur
  return std::pow(std::log(exposure) / std::hypot(softened, sigma), 2) + unlikely(duty);
}

//! Standard deviation that a choice between two values leaves, the one \e difference in chi-square less
//! likely than the other.
inline double spread(double values, double difference)
{
  const double odds = std::exp(-0.5 * std::abs(difference));
  return std::sqrt(odds) / (1 + odds) * std::abs(values);
}
} // namespace vpStripeLimits

END_VISP_NAMESPACE

#endif
