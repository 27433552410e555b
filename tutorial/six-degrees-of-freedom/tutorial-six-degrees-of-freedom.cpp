/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
//! \example tutorial-six-degrees-of-freedom.cpp
#include <cmath>
#include <cstdio>
#include <iostream>

#include <visp3/core/vpException.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp3/vlp_simulation/vpSimulation.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

double roll(const vpHomogeneousMatrix &wMb)
{
  return vpMath::deg(std::atan2(wMb[2][1], wMb[2][2]));
}

double pitch(const vpHomogeneousMatrix &wMb)
{
  return vpMath::deg(-std::asin(wMb[2][0]));
}

double distance(const vpHomogeneousMatrix &one, const vpHomogeneousMatrix &other)
{
  return std::hypot(one[0][3] - other[0][3], one[1][3] - other[1][3], one[2][3] - other[2][3]);
}

//! The covariance that the first lamps of the map leave, in one frame by itself.
void printCovariance(const vpVlpFrame &frame, const vpVlpRig &rig, vpLampMap map, size_t lamps)
{
  map.lamps.resize(lamps);
  vpVlpLocalizer localizer(rig, map);
  localizer.tracking = false;
  localizer.manyLamps.attitude = vpManyLampSolver::Attitude::free;
  const vpVlpFix fix = localizer.process(frame).fix;
  const auto &P = fix.covariance; // rows: x, y, z (m), roll, pitch, yaw (rad)
  std::printf(
      "%zu lamps: x +/- %.3f mm, roll +/- %.4f, pitch +/- %.4f deg, correlation of x and pitch %.3f%s\n",
      lamps, 1000 * std::sqrt(P(0, 0)), vpMath::deg(std::sqrt(P(3, 3))), vpMath::deg(std::sqrt(P(4, 4))),
      P(0, 4) / std::sqrt(P(0, 0) * P(4, 4)), fix.ambiguous ? ", ambiguous" : "");
}

int main(int argc, char **argv)
{
  if (argc != 2) {
    std::cerr << "usage: " << argv[0] << " SCENARIO" << std::endl;
    return 2;
  }
  try {
    vpSimulation simulation(vpScenario::load(argv[1]), 1); // the seed of all that is left to chance
    vpVlpLocalizer level(simulation.rig(), simulation.map()), free(simulation.rig(), simulation.map());
    free.manyLamps.attitude = vpManyLampSolver::Attitude::free;
    free.filter.tiltDrift = 0.005; // rad/sqrt(s): a floor whose slope hardly changes

    bool good = true;
    vpVlpFrame frame;
    while (simulation.next(frame)) {
      const vpHomogeneousMatrix truth = simulation.wMb(frame.timestamp);
      const vpVlpFix asMounted = level.process(frame).fix, fix = free.process(frame).fix;
      const double sigmaRoll = vpMath::deg(std::sqrt(fix.covariance(3, 3))),
                   sigmaPitch = vpMath::deg(std::sqrt(fix.covariance(4, 4)));
      std::printf(
          "%5.2f s: roll %6.3f +/- %.3f, pitch %6.3f +/- %.3f deg; off by %.2f mm, level by %.1f mm\n",
          frame.timestamp, roll(fix.wMb), sigmaRoll, pitch(fix.wMb), sigmaPitch,
          1000 * distance(fix.wMb, truth), 1000 * distance(asMounted.wMb, truth));
      good = good && fix.valid && std::abs(roll(fix.wMb) - roll(truth)) < 4 * sigmaRoll &&
             std::abs(pitch(fix.wMb) - pitch(truth)) < 4 * sigmaPitch;
    }
    printCovariance(frame, simulation.rig(), simulation.map(), 4);
    printCovariance(frame, simulation.rig(), simulation.map(), 3);
    return good ? 0 : 1;
  } catch (const vpException &error) {
    std::cerr << error.getStringMessage() << std::endl;
    return 2;
  }
}
