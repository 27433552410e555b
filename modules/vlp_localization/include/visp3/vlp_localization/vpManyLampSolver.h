/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpManyLampSolver_h
#define vpManyLampSolver_h

#include <vector>

#include <visp3/vlp_localization/vpVlpFix.h>

BEGIN_VISP_NAMESPACE

/*!
  Weighted least squares over all lamps seen: minimises the Mahalanobis distances between the rays measured
  and the rays to the lamps, by Levenberg-Marquardt. Their covariance holds the image points, the lamps'
  positions where the map states a sigma, and the mount's roll and pitch where the rig does. Rejects no
  outlier: chiSquare shows one.
*/
class VISP_EXPORT vpManyLampSolver
{
public:
  enum class Attitude {
    mount, //!< roll and pitch from the rig; x, y, z, yaw estimated; two lamps or more
    free   //!< all six estimated; three lamps or more, not on one line
  };

  Attitude attitude = Attitude::mount;
  double maxTilt = 1.0472;         // rad, free attitude: how far the base may lean from the vertical
  double maxTiltSigma = 0.1;       // rad, free attitude: refuses lamps that leave roll or pitch less certain
  double ambiguityLikelihood = 20; // ambiguous where another pose is not this many times less likely

  /*!
    Mount attitude: starts from vpTwoLampSolver::solveBestPair, whose refusals it passes on, and from its
    second pose where there is one. Two lamps: that pair's fix.

    Free attitude: starts from all poses that each three lamps in a row leave, and compares all minima with
    every lamp in front of the camera. Three lamps fit up to
    four poses exactly; a flat group seen almost head-on has two that hardly differ. The rig's
    rotationSigma of roll and pitch is a prior of estimate and comparison. Without it, of poses that
    the picture does not tell apart the most upright one is the fix, the next one `other`. A tilt that the
    picture shows in the second order only, as that of a small flat group seen head-on, is in the covariance
    by the likelihood's own spread about the fix.
  */
  vpVlpFix solve(const std::vector<vpLampSight> &lamps, const vpVlpRig &rig) const;

private:
  vpVlpFix solveMount(const std::vector<vpLampSight> &lamps, const vpVlpRig &rig) const;
  vpVlpFix solveFree(const std::vector<vpLampSight> &lamps, const vpVlpRig &rig) const;
};

END_VISP_NAMESPACE

#endif
