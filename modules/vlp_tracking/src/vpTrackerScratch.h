/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpTrackerScratch_h
#define vpTrackerScratch_h

#include <complex>
#include <utility>
#include <vector>

#include <visp3/vlp_tracking/vpLampTracker.h>

BEGIN_VISP_NAMESPACE

//! What vpLampTracker works on within a frame, kept so that the next one takes no memory.
struct vpLampTracker::Scratch {
  std::vector<vpLampObservation> spare; // of frames before
  std::vector<char> another;            // reacquire(): of each observation, whether it is another lamp's
  std::vector<vpRect> known, steady, light, open;                           // search(), px
  std::vector<std::pair<std::complex<double>, std::complex<double>>> moves; // moveSteady(): px, from, to
};

END_VISP_NAMESPACE

#endif
