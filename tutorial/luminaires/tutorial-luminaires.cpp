/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
//! \example tutorial-luminaires.cpp
#include <cmath>
#include <cstdio>
#include <iostream>
#include <set>
#include <string>

#include <visp3/core/vpException.h>
#include <visp3/core/vpMeterPixelConversion.h>
#include <visp3/io/vpImageIo.h>
#include <visp3/vlp_identification/vpLedDetector.h>
#include <visp3/vlp_simulation/vpSimulation.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

//! Where a place of the room is in the picture, px, at the time when its own line is exposed.
Eigen::Vector2d project(vpSimulation &simulation, const Eigen::Vector3d &place, double frameTime)
{
  const vpVlpRig &rig = simulation.camera().rig; // as it truly is
  const vpLineTiming timing = rig.lineTiming();
  Eigen::Vector2d pixel(rig.camera.get_u0(), rig.camera.get_v0());
  for (int i = 0; i < 3; ++i) { // the line gives the time, the time gives the line
    const vpHomogeneousMatrix wMc = simulation.wMb(frameTime + timing.middleAt(pixel.y())) * rig.bMc;
    const vpColVector c = wMc.inverse() * vpColVector({place.x(), place.y(), place.z(), 1});
    vpMeterPixelConversion::convertPoint(rig.camera, c[0] / c[2], c[1] / c[2], pixel.x(), pixel.y());
  }
  return pixel;
}

//! Whether a lamp as wide as its diagonal is inside the picture.
bool wholeInView(const vpVlpRig &rig, const vpLamp &lamp, const Eigen::Vector2d &at)
{
  const double diagonal = lamp.shape == vpLamp::Shape::square ? std::sqrt(2.0) * lamp.size : lamp.size; // m
  const double reach = 0.5 * rig.camera.get_px() * diagonal / (lamp.position.z() - rig.bMc[2][3]);      // px
  return at.x() > reach && at.y() > reach && at.x() < rig.width - reach && at.y() < rig.height - reach;
}

void print(const vpLampObservation &seen, const Eigen::Vector2d &truth)
{
  const Eigen::Vector2d sigma = seen.covariance.diagonal().cwiseSqrt(); // px
  std::printf("  %-9s %6.1f Hz, duty %.3f, at (%7.2f +/- %.2f, %7.2f +/- %.2f), off by (%5.2f, %5.2f) px\n",
              seen.id.c_str(), seen.features.frequency, seen.features.duty, seen.point.x(), sigma.x(),
              seen.point.y(), sigma.y(), seen.point.x() - truth.x(), seen.point.y() - truth.y());
}

int main(int argc, char **argv)
{
  if (argc != 3) {
    std::cerr << "usage: " << argv[0] << " SCENARIO PICTURE" << std::endl;
    return 2;
  }
  try {
    vpScenario scenario = vpScenario::load(argv[1]);
    scenario.frames = 2;
    vpSimulation simulation(scenario, 1); // the seed of all that is left to chance
    vpLedDetector detector(simulation.rig(), simulation.map());
    size_t missing = 0;
    for (vpVlpFrame frame; simulation.next(frame);) {
      if (frame.timestamp == 0)
        vpImageIo::write(frame.I, argv[2]);
      std::printf("%.2f s:\n", frame.timestamp);
      detector.detect(frame.I);
      std::set<std::string> named;
      for (const vpLampObservation &seen : detector.observations()) {
        if (const vpLamp *lamp = simulation.map().find(seen.id)) {
          const Eigen::Vector2d truth = project(simulation, lamp->position, frame.timestamp);
          print(seen, truth);
          if ((seen.point - truth).norm() < 5) // px; a ghost image has the id, and is elsewhere
            named.insert(seen.id);
        } else {
          std::printf("  ?         at (%7.2f, %7.2f) px: %s\n", seen.point.x(), seen.point.y(),
                      seen.remark.c_str());
        }
      }
      for (const vpLamp &lamp : simulation.map().lamps)
        if (wholeInView(simulation.rig(), lamp, project(simulation, lamp.position, frame.timestamp)) &&
            named.count(lamp.id) == 0) {
          std::printf("  %s is whole in view, and no region there has its id\n", lamp.id.c_str());
          ++missing;
        }
    }
    return missing == 0 ? 0 : 1;
  } catch (const vpException &error) {
    std::cerr << error.getStringMessage() << std::endl;
    return 2;
  }
}
