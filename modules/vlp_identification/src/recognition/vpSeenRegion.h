/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSeenRegion_h
#define vpSeenRegion_h

#include <visp3/vlp_identification/vpLedDetector.h>

BEGIN_VISP_NAMESPACE

//! A region as the detector works on it: where it is in the lines, and what it shows.
struct vpLedDetector::Region {
  vpLedRoi roi;
  vpOutlineFit fit;
  vpLampObservation lamp;
};

END_VISP_NAMESPACE

#endif
