/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
//! \example tutorial-simulation.cpp
#include <cmath>
#include <cstdio>
#include <iostream>

#include <visp3/core/vpException.h>
#include <visp3/io/vpImageIo.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp3/vlp_simulation/vpSimulation.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

vpLamp lamp(const std::string &id, double x, double y, double frequency)
{
  vpLamp lamp;
  lamp.id = id;
  lamp.position = {x, y, 1.8}; // m
  lamp.size = 0.15;            // m
  lamp.modulation.kind = vpModulation::Kind::pwm;
  lamp.modulation.frequency = frequency; // Hz
  return lamp;
}

vpScenario smallWorld()
{
  vpScenario scenario; // what the robot's files state, and where the world differs
  scenario.rig.width = 640, scenario.rig.height = 480;
  scenario.rig.camera.initPersProjWithoutDistortion(600, 600, 319.5, 239.5);
  scenario.rig.shutter.rowTime = scenario.rig.shutter.exposure = 30e-6; // s
  scenario.rig.bMc[2][3] = 0.2;                                         // m up, looking up
  scenario.map.lamps = {lamp("A", -0.4, -0.3, 1500), lamp("B", 0.4, -0.3, 2200), lamp("C", 0, 0.35, 3100)};
  for (const vpLamp &known : scenario.map.lamps) {
    scenario.lamps.emplace_back(); // one that truly hangs there
    scenario.lamps.back().simulated.lamp = known;
  }
  scenario.draw.lampShift = 0.002; // m, by which lamps truly hang elsewhere
  scenario.motion.robot.startX = -0.2;
  scenario.motion.commands = {{{0.1, 0.4}, 4}}; // m/s and rad/s, for so many s
  scenario.frameRate = 5, scenario.frames = 20;
  return scenario;
}

int main(int argc, char **argv)
{
  if (argc != 2) {
    std::cerr << "usage: " << argv[0] << " PICTURE" << std::endl;
    return 2;
  }
  try {
    vpSimulation simulation(smallWorld(), 1); // the seed of all that is left to chance
    vpVlpLocalizer localizer(simulation.rig(), simulation.map());
    double worst = 0; // m
    size_t found = 0;
    for (vpVlpFrame frame; simulation.next(frame);) {
      if (frame.timestamp == 0)
        vpImageIo::write(frame.I, argv[1]);
      const vpVlpFix fix = localizer.process(frame).fix;
      if (!fix.valid)
        continue; // fix.refusal says why
      const vpHomogeneousMatrix truth = simulation.wMb(frame.timestamp);
      const double error = std::hypot(fix.wMb[0][3] - truth[0][3], fix.wMb[1][3] - truth[1][3]);
      std::printf("%4.1f s: x %7.4f y %7.4f m, off by %.2f mm\n", frame.timestamp, fix.wMb[0][3],
                  fix.wMb[1][3], 1000 * error);
      worst = std::max(worst, error);
      ++found;
    }
    std::printf("%zu of %zu frames, worst error %.2f mm\n", found, simulation.size(), 1000 * worst);
    return found == simulation.size() && worst < 0.01 ? 0 : 1;
  } catch (const vpException &error) {
    std::cerr << error.getStringMessage() << std::endl;
    return 2;
  }
}
