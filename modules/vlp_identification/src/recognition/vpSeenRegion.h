/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSeenRegion_h
#define vpSeenRegion_h

#include <visp3/vlp_identification/vpLedDetector.h>
#include <visp3/vlp_identification/vpLedIdEvidence.h>

BEGIN_VISP_NAMESPACE

//! A region as the detector works on it: where it is in the lines, and what it shows.
struct vpLedDetector::Region {
  vpLedRoi roi;
  vpOutlineFit fit;
  vpLampObservation lamp;
};

/*!
  Stripes that were put together of patches. Any texture has shades that some columns agree on, and two steady
  lights above each other are two stripes: a lamp has more, of a frequency that is well known.
*/
namespace vpPatchwork
{
constexpr size_t fewestStripes = 3;
constexpr double least = 0.5; // depth: an emitter that shines steadily is shaded by less

inline bool isLamp(const vpStripeFeatures &seen)
{
  constexpr double vague = 0.01; // share of the frequency
  return seen.stripes >= fewestStripes && vpLedIdEvidence::tells(seen) &&
         seen.frequencySigma <= vague * seen.frequency;
}
} // namespace vpPatchwork

END_VISP_NAMESPACE

#endif
