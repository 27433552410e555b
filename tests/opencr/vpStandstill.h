/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpStandstill_h
#define vpStandstill_h

#include <cmath>

#include <visp3/vlp_simulation/vpSimulatorTurtleBot3.h>

//! s from \e time until \e robot was slower than 1 mm/s and 0.01 rad/s for good, as far as it has run.
inline double vpStandstillAfter(const vpSimulatorTurtleBot3 &robot, double time)
{
  double last = time;
  for (double t = time; t <= robot.time(); t += 1e-3) {
    const vpBaseVelocity velocity = robot.twist(t);
    last = std::abs(velocity.v) > 1e-3 || std::abs(velocity.w) > 1e-2 ? t : last;
  }
  return last - time;
}

#endif
