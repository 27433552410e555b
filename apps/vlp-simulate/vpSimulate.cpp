/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpSimulate.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <vector>

#include <spdlog/spdlog.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpAtomicFile.h>
#include <visp3/vlp_core/vpNewFolder.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpTrajectory.h>
#include <visp3/vlp_sensor/vpWritePicture.h>
#include <visp3/vlp_simulation/vpSimulation.h>

#include "common/vpInterrupt.h"
#include "common/vpProgressBar.h"

BEGIN_VISP_NAMESPACE

namespace
{
std::string pictureName(size_t index, const std::string &format)
{
  static const size_t digits = 6;
  const std::string number = std::to_string(index);
  return "frame" + std::string(number.size() < digits ? digits - number.size() : 0, '0') + number + "." +
         format;
}

//! The truth at each frame; of a driven robot at each of its odometry's times, too.
vpTrajectory truthOf(vpSimulation &simulation, const std::vector<double> &frameTimes)
{
  std::set<double> times(frameTimes.begin(), frameTimes.end());
  for (const vpOdometry &sample : simulation.odometry()) {
    times.insert(sample.timestamp);
  }
  vpTrajectory truth;
  for (double time : times) {
    truth.add(time, simulation.wMb(time));
  }
  return truth;
}

void writeRobotFiles(const vpSimulation &simulation, const vpNewFolder &folder)
{
  vpVlpRig rig = simulation.rig();
  rig.cameraFile = "camera.xml"; // beside the rig, wherever the scenario's was
  rig.save(folder.file("rig.yaml"));
  simulation.map().save(folder.file("lamps.yaml"));
}
} // namespace

vpExitCode vpSimulate(const vpSimulateOptions &options)
{
  vpScenario scenario = vpScenario::load(options.scenario);
  if (options.typical) {
    scenario.useTypicalRig();
  }
  scenario.frameRate /= static_cast<double>(options.every);
  scenario.frames = (scenario.frames + options.every - 1) / options.every;
  const size_t total = options.frames > 0 ? std::min(options.frames, scenario.frames) : scenario.frames;
  scenario.frames = total;
  vpInterrupt::install(); // from here on there is something to take away
  vpNewFolder folder(options.out);
  vpSimulation simulation(scenario, options.seed);
  vpProgressBar progress(total);
  vpAtomicFile list(folder.file("frames.csv"));
  list.stream() << "timestamp_s,file\n";
  std::vector<double> times;
  double drawing = 0; // s
  for (vpVlpFrame frame; !vpInterrupt::requested();) {
    const auto start = std::chrono::steady_clock::now();
    if (!simulation.next(frame)) {
      break;
    }
    drawing += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const std::string name = pictureName(times.size(), options.format);
    vpWritePicture(folder.file(name), cv::Mat(static_cast<int>(frame.I.getHeight()),
                                              static_cast<int>(frame.I.getWidth()), CV_8UC1, frame.I.bitmap));
    list.stream() << vpNumberText(frame.timestamp) << "," << name << "\n";
    times.push_back(frame.timestamp);
    progress.show(times.size());
  }
  progress.clear();
  if (times.empty()) {
    spdlog::warn("stopped before the first frame; nothing is written");
    return vpExitCode::badInput;
  }
  writeRobotFiles(simulation, folder);
  truthOf(simulation, times).save(folder.file("truth.tum"));
  if (const std::vector<vpOdometry> odometry = simulation.odometry(); !odometry.empty()) {
    vpWriteOdometry(folder.file("odometry.csv"), odometry);
  }
  list.commit();
  folder.commit();
  if (times.size() < total) {
    spdlog::warn("stopped after {} of {} frames; what was done so far is kept", times.size(), total);
  }
  spdlog::info("{} frames in {}, each exposed for {:.1f} us a line; {:.1f} ms a frame to draw", times.size(),
               options.out, 1e6 * scenario.rig.shutter.exposure,
               1e3 * drawing / static_cast<double>(times.size()));
  return vpExitCode::done;
}

END_VISP_NAMESPACE
