/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPosePairs_h
#define vpPosePairs_h

#include <vector>

#include <visp3/vlp_core/vpTrajectory.h>

BEGIN_VISP_NAMESPACE

//! An estimated pose and the true one of the same time.
struct VISP_EXPORT vpPosePair {
  double timestamp = 0; // s
  vpHomogeneousMatrix estimate;
  vpHomogeneousMatrix truth;

  double errorX() const { return estimate[0][3] - truth[0][3]; } // m, along the axes of w
  double errorY() const { return estimate[1][3] - truth[1][3]; }
  double errorZ() const { return estimate[2][3] - truth[2][3]; }
  double errorYaw() const; // rad, in [-pi, pi]
  double distance() const; // m, horizontal: of (errorX, errorY)
};

//! The poses of an estimate for which there is truth, and why others are left out.
struct VISP_EXPORT vpPosePairs {
  std::vector<vpPosePair> pairs;
  size_t outside = 0; // poses before the first or after the last of the truth
  size_t inGaps = 0;  // poses in a gap of the truth

  /*!
    Each pose of the estimate with the truth interpolated to its time (vpTrajectory::at). Truth is never
    extrapolated, nor interpolated between two poses more than \e longestGap (s) apart.
  */
  static vpPosePairs of(const vpTrajectory &estimate, const vpTrajectory &truth, double longestGap);
};

//! How an estimate in a map of its own is laid on the truth before the errors are taken.
enum class vpAlignment {
  none,   //!< not at all: both are in the same map
  origin, //!< the first pose on the first true one, all six coordinates, as evo's --align_origin
  se2     //!< turn about z and shift in x, y that make the sum of squared horizontal distances least
};

/*!
  The motion `tTe` that takes poses of the estimate to the truth's map: aligned = tTe estimate. The least
  squares are Umeyama's (1991) without scale, in the plane. Where the positions do not tell the turn, since
  there is one pair or all of them are one point, there is none. Without pairs it is the identity.
*/
VISP_EXPORT vpHomogeneousMatrix vpAlignmentOf(const std::vector<vpPosePair> &pairs, vpAlignment alignment);

END_VISP_NAMESPACE

#endif
