/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpHypotheses_h
#define vpVlpHypotheses_h

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  The hypotheses that vpVlpLocalizer considers, and their prior probabilities. `src/MODEL.md` is the
  model; each member is a rate, a probability, or a length of it.
*/
struct VISP_EXPORT vpVlpHypotheses {
  // How the robot moves: shares of vpVlpFilter's random accelerations. The whole of them: it starts or stops.
  double steady = 0.001; // it keeps its velocity
  double gentle = 0.02;
  double lively = 0.2;
  double onWheels = 0.03; // beyond the latest sample of an odometry that is followed
  double change = 0.5;    // 1/s, at which it leaves one kind of motion for any of the others
  double settling = 3;    // 1/s, at which it comes back to the steady one

  // Whether the odometry measures its velocity.
  double right = 0.95;  // where it begins
  double slip = 0.0003; // 1/s, at which it ceases to
  double grip = 3;      // 1/s, at which it does so again

  // Whether it was put elsewhere, of which wheels that stand tell nothing.
  double relocation = 0.01; // 1/s
  double rolling = 0.05;    // probability that wheels which roll, and are right, roll on while it is carried
  double reach = 0.1;       // m, of a step in x and y: bivariate Cauchy distribution
  double turn = 0.6;        // rad, of a turn: Cauchy distribution
  double floorStep = 0.01;  // m, in z: Cauchy distribution

  // What is seen with a lamp's id.
  double displaced = 0.001; // the lamp, off by vpVlpLocalizer::mapTolerance
  double stranger = 0.001;  // another light, anywhere in the picture
  double staying = 0.99;    // another light still, where it was in the frame before
  double copy = 0.005;      // 1/s, at which two others as far apart replace two lamps: a mirror shows such
  double copyReach = 1;     // m, of the way between them in x and y: bivariate Cauchy distribution

  // Whether rig and map are as exact as they state.
  double claimsOff = 0.01; // they are off by vpVlpFilter's claimedTilt and claimedPlace more

  double negligible = 1e-3; // a hypothesis less probable than this is dropped
  double decided = 0.99;    // else the pose is ambiguous, where the other one is elsewhere
};

END_VISP_NAMESPACE

#endif
