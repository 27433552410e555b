/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
//! \example tutorial-line-following.cpp
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include <visp3/core/vpException.h>
#include <visp3/vlp_servo/vpServoLoop.h>
#include <visp3/vlp_servo/vpServoSimulation.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

vpServoSimulationSettings beside(const vpPath &path)
{
  const vpPathPoint begin = path.at(0);
  vpServoSimulationSettings settings; // the robot stands 5 cm to the left of the line, turned by 20 degrees
  settings.start.x = begin.place.x() - 0.05 * std::sin(begin.heading);
  settings.start.y = begin.place.y() + 0.05 * std::cos(begin.heading);
  settings.start.yaw = begin.heading + 20 * M_PI / 180;
  return settings;
}

int main(int argc, char **argv)
{
  if (argc != 2) {
    std::cerr << "usage: " << argv[0] << " SCENARIO" << std::endl;
    return 2;
  }
  try {
    const vpPath path = vpPath::polyline({{-0.35, 0}, {0.35, -0.005}}); // the paper's line A
    vpServoSimulation world(vpScenario::load(argv[1]), 1, beside(path));

    vpVlpPose poses(world); // what the loop knows of where the base is
    vpServoLoopSettings settings;
    settings.follower.reference.speed = 0.1; // m/s
    settings.follower.servo.gain = 2.5;      // 1/s, lambda
    vpServoLoop loop(world.robot(), poses, world, path, settings);
    const vpServoRun run = loop.run();

    double worst = 0; // m, in the second half
    int step = 0;
    const auto truth = [&world](double time) { return world.wMb(time); };
    for (const vpTrackError &error : vpTrackErrorsOf(path, run, truth)) {
      if (step++ % 50 == 0)
        std::printf("%4.1f s, %5.1f cm: %6.2f mm and %6.2f degrees off the line\n", error.time, 100 * error.s,
                    1000 * error.across, error.heading * 180 / M_PI);
      if (error.s > path.length() / 2)
        worst = std::max(worst, std::abs(error.across));
    }
    std::printf("%s, %zu pictures, worst of the second half %.2f mm\n",
                run.end == vpServoRun::End::arrived ? "arrived" : run.reason.c_str(), run.pictures.size(),
                1000 * worst);
    return run.end == vpServoRun::End::arrived && worst < 0.01 ? 0 : 1;
  } catch (const vpException &error) {
    std::cerr << error.getStringMessage() << std::endl;
    return 2;
  }
}
