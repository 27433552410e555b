/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSteadyLight_h
#define vpSteadyLight_h

#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_identification/vpStripeAnalyzer.h>

BEGIN_VISP_NAMESPACE

//! s, the longest stretch of a profile's lines that are nearer to its brightest than to its darkest one.
double vpLongestLit(const vpStripeProfile &profile);

/*!
  Lines of the picture that the longest period of the map's lamps takes, 2 ms at least: a lamp that the map
  does not know is shown whole, and noise may hide a stripe. Infinite without lamps or row time.
*/
double vpLongestPeriodLines(const vpLampMap &map, const vpVlpRig &rig);

/*!
  s, the longest period of the map's lamps, as far as the row time is known: what shines on end for longer is
  none of them. Infinite without lamps, and where one may be dark for so short that every line sees some
  light.
*/
double vpLongestPeriod(const vpLampMap &map, const vpVlpRig &rig);

END_VISP_NAMESPACE

#endif
