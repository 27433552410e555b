/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpWordFormats_h
#define vpWordFormats_h

#include <vector>

#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpRollingShutter.h>
#include <visp3/vlp_identification/vpStripeAnalyzer.h>

BEGIN_VISP_NAMESPACE

//! How the map's words are sent, each way once.
std::vector<vpWordFormat> vpWordFormatsOf(const vpLampMap &map, const vpRollingShutter &shutter);

END_VISP_NAMESPACE

#endif
