/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLitShare_h
#define vpLitShare_h

#include <vector>

#include <visp3/vlp_core/vpLampObservation.h>
#include <visp3/vlp_core/vpRollingShutter.h>

BEGIN_VISP_NAMESPACE

/*!
  The share of each exposure in which a lamp shines, by its features: its pulse (twoPulse: both) averaged over
  vpStripeFeatures::exposure. \param time s, of the exposures' middles, after the start of the frame. \return
  0 to 1 each; empty where the features have no phase.
*/
VISP_EXPORT std::vector<double> vpLitShareOf(const vpStripeFeatures &seen, const std::vector<double> &time);

//! The same for each line of a picture.
VISP_EXPORT std::vector<float> vpLitShareOf(const vpStripeFeatures &seen, const vpLineTiming &timing);

END_VISP_NAMESPACE

#endif
