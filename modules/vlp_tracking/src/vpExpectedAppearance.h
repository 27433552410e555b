/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpExpectedAppearance_h
#define vpExpectedAppearance_h

#include <visp3/core/vpRect.h>

#include "vpTargetModel.h"
#include "vpWindowSums.h"

BEGIN_VISP_NAMESPACE

//! Where mean shift came to rest, and what is there.
struct vpTargetCandidate {
  vpRect window;
  double coefficient = 0; // Bhattacharyya's, with the target
  double visible = 0;     // share of the window, under the kernel
  vpBinShares shares{};
  double mass = 0;         // of the shares, after the model's weights
  vpWindowMoments moments; // over the search window, which is larger
};

/*!
  How the target is expected to look once it is found: running means of the sightings so far; and how
  plausible a sighting is that does not look so.
*/
class vpExpectedAppearance
{
public:
  void begin(const vpTargetCandidate &given);

  /*!
    0 to 1. A part of the target may be hidden: the rest is less alike, and before that, as long as the window
    can move along with the rest, less extended. Or more of its kind than expected is near, where another
    target may pass, and what was found may lie between the two.
  */
  double plausibility(const vpTargetCandidate &candidate) const;

  //! Plausible, and as expected in all: nothing seems to be hidden, or near.
  bool asExpected(const vpTargetCandidate &candidate) const;

  /*!
    Whether it changed its size along both axes alike, as what comes nearer or goes farther does. What hides a
    part of it, or passes by, changes one axis more.
  */
  bool changedAlike(const vpTargetCandidate &candidate) const;

  //! Extent along each axis, as a share of that at the start; 1 where it cannot be told.
  double growthAcross(const vpTargetCandidate &candidate) const;
  double growthDown(const vpTargetCandidate &candidate) const;

  //! Follows what changes slowly and stays.
  void learn(const vpTargetCandidate &seen);

private:
  //! Running mean of a figure, and of its absolute deviation: stripes that change their phase make some.
  struct RunningMean {
    double mean = 0, spread = 0;

    void add(double value, double rate);
    double margin() const { return 2 * spread; }
  };

  RunningMean m_coefficient;
  RunningMean m_crowd;                       // mass in the search window for each of the window
  RunningMean m_extent;                      // spread of the back projection, in window sizes
  double m_firstAcross = 0, m_firstDown = 0; // the same at the start, along each axis
};

END_VISP_NAMESPACE

#endif
