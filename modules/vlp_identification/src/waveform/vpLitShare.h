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

//! For each line of a picture, the share of its exposure in which a lamp shines, by its features. Empty where
//! they have no phase.
std::vector<float> vpLitShareOf(const vpStripeFeatures &seen, const vpLineTiming &timing);

END_VISP_NAMESPACE

#endif
