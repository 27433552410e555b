/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
//! \example tutorial-two-lamp-pose.cpp
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>

#include <visp3/core/vpException.h>
#include <visp3/vlp_localization/vpTwoLampSolver.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

vpLampSight sight(const std::string &id, double u, double v, const vpLampMap &map, const vpVlpRig &rig)
{
  const vpLamp *lamp = map.find(id);
  if (lamp == nullptr)
    throw vpException(vpException::badValue, id + ": no lamp of the map");
  const double sigma = 0.1; // px, how well the image point is known
  vpLampObservation seen;
  seen.point = {u, v};
  seen.covariance = sigma * sigma * Eigen::Matrix2d::Identity();
  return vpLampSight::from(*lamp, seen, rig.camera);
}

double yawDegrees(const vpHomogeneousMatrix &wMb)
{
  return vpMath::deg(std::atan2(wMb[1][0], wMb[0][0]));
}

int main(int argc, char **argv)
{
  if (argc != 9 && !(argc == 13 && std::string(argv[9]) == "--at")) {
    std::cerr << "usage: " << argv[0] << " RIG LAMPS ID U V ID U V [--at X Y YAW_DEG]" << std::endl;
    return 2;
  }
  try {
    const vpVlpRig rig = vpVlpRig::load(argv[1]);
    const vpLampMap map = vpLampMap::load(argv[2]);
    const vpLampSight first = sight(argv[3], std::atof(argv[4]), std::atof(argv[5]), map, rig);
    const vpLampSight second = sight(argv[6], std::atof(argv[7]), std::atof(argv[8]), map, rig);

    const vpTwoLampSolver solver;
    const vpVlpFix fix = solver.solve(first, second, rig);
    if (!fix.valid) {
      std::cerr << "no pose: " << fix.refusal << std::endl;
      return 1;
    }
    const char *const names[] = {"x", "y", "z"};
    for (int i = 0; i < 3; ++i)
      std::printf("%-3s %8.2f +/- %.2f mm\n", names[i], 1000 * fix.wMb[i][3],
                  1000 * std::sqrt(fix.covariance(i, i)));
    std::printf("yaw %8.2f +/- %.2f deg\n", yawDegrees(fix.wMb),
                vpMath::deg(std::sqrt(fix.covariance(5, 5))));

    // A reflection, say, puts the second lamp where the first one is: no baseline, no pose.
    vpLampSight reflection = second;
    reflection.ray = first.ray;
    const vpVlpFix none = solver.solve(first, reflection, rig);
    std::printf("both at one point: %s\n", none.valid ? "a pose" : none.refusal.c_str());
    if (none.valid)
      return 1;

    if (argc == 13) { // where the robot is known to stand: 5 mm, 0.2 degrees
      const double off = std::hypot(fix.wMb[0][3] - std::atof(argv[10]), fix.wMb[1][3] - std::atof(argv[11]));
      const double turn = std::remainder(yawDegrees(fix.wMb) - std::atof(argv[12]), 360);
      return off < 0.005 && std::abs(turn) < 0.2 ? 0 : 1;
    }
    return 0;
  } catch (const vpException &error) {
    std::cerr << error.getStringMessage() << std::endl;
    return 2;
  }
}
