/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
//! \example tutorial-calibration.cpp
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include <visp3/core/vpException.h>
#include <visp3/vlp_calibration/vpMountCalibration.h>
#include <visp3/vlp_calibration/vpShutterCalibration.h>
#include <visp3/vlp_identification/vpLedDetector.h>
#include <visp3/vlp_simulation/vpSimulation.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main(int argc, char **argv)
{
  if (argc != 3 || !(std::atof(argv[2]) > 0)) {
    std::cerr << "usage: " << argv[0] << " SCENARIO FRAMES_PER_SECOND" << std::endl;
    return 2;
  }
  try {
    vpScenario scenario = vpScenario::load(argv[1]);
    scenario.frames =
        static_cast<size_t>(static_cast<double>(scenario.frames) * std::atof(argv[2]) / scenario.frameRate);
    scenario.frameRate = std::atof(argv[2]);
    vpSimulation simulation(scenario, 1);
    const vpVlpRig &rig = simulation.rig(); // as the robot's files state
    const vpLampMap &map = simulation.map();

    vpShutterCalibration shutter(rig, map);
    vpLedDetector detector(rig, map);
    vpLampRun run;
    size_t frames = 0;
    for (vpVlpFrame frame; simulation.next(frame); ++frames) {
      if (frames < 10)
        shutter.add(frame);
      detector.detect(frame.I);
      run.views.push_back(vpLampView::of(frame.timestamp, frame.name, detector.observations(), map));
    }
    run.odometry = simulation.odometry();

    const vpShutterEstimate lines = shutter.solve();
    if (!lines.valid) {
      std::cerr << lines.refusal << std::endl;
      return 1;
    }
    std::printf("row time %.4f +/- %.4f us, truly %.4f\n", 1e6 * lines.rowTime, 1e6 * lines.rowTimeSigma,
                1e6 * simulation.camera().rig.shutter.rowTime);

    const vpMountCalibration calibration;
    const vpBundleResult found = calibration.solve({run}, rig, map);
    if (!found.valid) {
      std::cerr << found.refusal << std::endl;
      return 1;
    }
    const vpRigVector truth = vpRigStep(rig, simulation.camera().rig);
    bool right = true;
    for (int i = 0; i < vpRigParameterCount; ++i) {
      const vpRigParameterInfo &info = vpRigParameterInfo::all()[static_cast<size_t>(i)];
      std::printf("%-5s %+9.4f +/- %.4f %-3s truly %+9.4f\n", info.name.c_str(), info.shown * found.step(i),
                  info.shown * std::sqrt(found.rigCovariance(i, i)), info.unit.c_str(),
                  info.shown * truth(i));
      right =
          right && std::abs(found.step(i) - truth(i)) < 0.1 * info.coarse; // 1 mm, 0.1 degree, 0.4 px, 0.1 %
    }
    return right ? 0 : 1;
  } catch (const vpException &error) {
    std::cerr << error.getStringMessage() << std::endl;
    return 2;
  }
}
