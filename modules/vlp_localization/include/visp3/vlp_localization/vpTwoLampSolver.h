/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpTwoLampSolver_h
#define vpTwoLampSolver_h

#include <vector>

#include <visp3/vlp_localization/vpVlpFix.h>

BEGIN_VISP_NAMESPACE

/*!
  The paper's double-lamp positioning (section 2.1.3, equations 1 to 7) in closed form, for any attitude of
  the camera and lamps at different heights.

  With the rays turned upright by the mount's roll and pitch and scaled to q = (x + i y) at unit height,
  lamp k at height d_k above the first one obeys P_k = C + exp(i yaw) (H + d_k) q_k. Two lamps give a
  quadratic equation in H, linear where the heights are equal: then H = |P2 - P1| / |q2 - q1| is equation 1,
  yaw = arg((P2 - P1) / (q2 - q1)) equation 6 with atan2 instead of the acute angles that cost the
  literature its quadrant rules, and C = (P1 q2 - P2 q1) / (q2 - q1) equations 4, 5 and 7.
*/
class VISP_EXPORT vpTwoLampSolver
{
public:
  /*!
    Refuses a pair that leaves the height above the camera less certain than this share of it, or the heading
    less certain than this (rad). Under lamps of one height, seen without other errors, the two are the same
    number.
  */
  double maxRelativeSigma = 0.1;
  double minImageSeparation = 5; // refuses lamps closer in the picture than this many sigma of their distance

  /*!
    The pose x, y, z, yaw of a robot base that stands as level as the map, roll and pitch of the camera
    being those of \e rig's bMc. z is estimated, not taken as 0. Lamps at different heights can leave two
    poses with both lamps above the camera: the fix is then ambiguous, and the pose whose base is nearer to
    the floor z = 0 is preferred.

    Refuses, with one line: a value that is not finite, one id twice, lamps that coincide in the map or in
    the picture or hang one above the other, rays that do not point above the horizon, places that no height
    explains or only one above the lamps, and pairs beyond the two limits.
  */
  vpVlpFix solve(const vpLampSight &first, const vpLampSight &second, const vpVlpRig &rig) const;

  /*!
    The pair with the smallest predicted position covariance (trace over x, y) of all pairs that solve()
    accepts. The paper's node 4 asks for lamps with different x and y instead; that rule does not regard the
    geometry seen. Where solve() accepts none, the refusal is that of the pair which lies widest apart in
    the picture.
  */
  vpVlpFix solveBestPair(const std::vector<vpLampSight> &lamps, const vpVlpRig &rig) const;
};

END_VISP_NAMESPACE

#endif
