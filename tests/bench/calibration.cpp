/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Calibration over many rigs: what is recovered, how honest the standard deviations are, what it does to
// positions. bench_calibration [camera|shutter|mount|rendered|lamps|rigs|all] [SEEDS] [SET]: rows of
// Markdown tables; from the top of the repository. SET 1, 2, ...: other worlds for the same seeds.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <visp3/vlp_calibration/vpCameraCalibration.h>
#include <visp3/vlp_calibration/vpLampSurvey.h>
#include <visp3/vlp_calibration/vpMountCalibration.h>
#include <visp3/vlp_calibration/vpShutterCalibration.h>
#include <visp3/vlp_identification/vpLedDetector.h>
#include <visp3/vlp_simulation/vpSimulation.h>

#include "vlp_calibration/boardPictures.h"
#include "vlp_calibration/calibrationRun.h"
#include "vpErrorTable.h"
#include "vpRigAccuracy.h"
#include "vpSimulatedStripes.h"

namespace
{
using namespace calibrationRun;
using namespace vpErrorTable;
using namespace vpRigAccuracy;

unsigned int set = 0; // of worlds

//! As vpRunTrials, in worlds of the set. \param trial Is given a number that no other trial of any set has.
void runTrials(int count, const std::function<void(size_t index, int seed, std::mt19937_64 &)> &trial)
{
  static const int most = 100000; // seeds
  vpRunTrials(
      count,
      [&](int index, std::mt19937_64 &generator) {
        trial(static_cast<size_t>(index), index + most * static_cast<int>(set), generator);
      },
      set);
}

//! ViSP's model with distortion from 15 pictures of a 9x6 board, corners with a noise of 0.2 px.
void camera(int seeds)
{
  const vpCameraParameters truth = boardPictures::camera();
  const std::array<double, 5> exact = {truth.get_px(), truth.get_py(), truth.get_u0(), truth.get_v0(),
                                       truth.get_kud()};
  std::array<Errors, 5> errors;
  for (int seed = 0; seed < seeds; ++seed) {
    const vpCameraEstimate found = vpCameraCalibration().solve(
        boardPictures::sights(vpBoard(), 15, 0.2, 1000 + 100000 * set + static_cast<unsigned int>(seed)),
        boardPictures::width, boardPictures::height);
    if (!found.valid) {
      std::printf("seed %d: %s\n", seed, found.refusal.c_str());
      continue;
    }
    for (size_t i = 0; i < errors.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const double shown = i < 2 ? 100 / exact[i] : 1;
      errors[i].name = found.names[i] + (i < 2 ? ", %" : i < 4 ? ", px" : "");
      errors[i].add(shown * (found.values(k) - exact[i]), shown * std::sqrt(found.covariance(k, k)));
    }
  }
  header("camera, 15 pictures", seeds);
  for (const Errors &error : errors) {
    error.print();
  }
}

//! Row time from ten rendered frames of the paper's room, true row time and clocks drawn.
void shutter(int seeds)
{
  std::vector<std::array<double, 2>> found(static_cast<size_t>(seeds));
  runTrials(seeds, [&](size_t i, int seed, std::mt19937_64 &) {
    vpScenario scenario = vpScenario::load("data/scenarios/spin.yaml");
    scenario.draw.rowTime = 0.01;
    scenario.frames = 10;
    vpSimulation simulation(scenario, static_cast<std::uint64_t>(seed + 1));
    vpVlpRig rig = simulation.rig();
    rig.shutter.rowTime = 0; // unknown
    vpShutterCalibration calibration(rig, simulation.map());
    for (vpVlpFrame frame; simulation.next(frame);) {
      calibration.add(frame);
    }
    const vpShutterEstimate estimate = calibration.solve();
    const double truth = simulation.camera().rig.shutter.rowTime;
    found[i] = {estimate.valid ? 100 * (estimate.rowTime / truth - 1) : 100,
                estimate.valid ? 100 * estimate.rowTimeSigma / truth : 1};
  });
  Errors errors{"row time, %", {}, {}, 1, {}};
  for (const auto &[error, sigma] : found) {
    errors.add(error, sigma);
  }
  header("shutter, ten frames", seeds);
  errors.print();
}

//! A rig that its files do not know: standard deviations of a step.
vpRigVector spread()
{
  const double degree = M_PI / 180;
  vpRigVector sigma;
  sigma << 0.01, 0.01, 0.01, 0.15 * degree, 0.15 * degree, 1 * degree, 3, 3, 0.005;
  return sigma;
}

vpRigVector drawn(const vpRigVector &sigma, std::mt19937_64 &random)
{
  std::normal_distribution<double> normal;
  vpRigVector step;
  for (int i = 0; i < vpRigParameterCount; ++i) {
    step(i) = sigma(i) * normal(random);
  }
  return step;
}

//! How far what was found is off the true steps from the rigs that were given.
void printMounts(const std::string &what, const std::vector<vpRigVector> &steps,
                 const std::vector<vpBundleResult> &found)
{
  std::array<Errors, vpRigParameterCount> errors;
  Errors joint{"all nine together", {}, {}, vpRigParameterCount, {}};
  for (size_t i = 0; i < found.size(); ++i) {
    if (!found[i].valid) {
      std::printf("seed %zu: %s\n", i, found[i].refusal.c_str());
      continue;
    }
    const vpRigVector error = found[i].step - steps[i];
    for (size_t k = 0; k < errors.size(); ++k) {
      const vpRigParameterInfo &info = vpRigParameterInfo::all()[k];
      const auto at = static_cast<Eigen::Index>(k);
      errors[k].name = info.name + ", " + info.unit;
      errors[k].add(info.shown * error(at), info.shown * std::sqrt(found[i].rigCovariance(at, at)));
    }
    const double squared = error.dot(found[i].rigCovariance.inverse() * error) / vpRigParameterCount;
    joint.add(std::sqrt(squared), 1);
  }
  header(what, static_cast<int>(found.size()));
  for (const Errors &error : errors) {
    error.print();
  }
  joint.print();
}

//! Spin and square under lamps of two heights. \param slips Wheels slip by 1 % over 5 cm, too.
void mount(int seeds, bool slips)
{
  std::vector<vpRigVector> steps(static_cast<size_t>(seeds));
  std::vector<vpBundleResult> found(steps.size());
  runTrials(seeds, [&](size_t i, int seed, std::mt19937_64 &random) {
    World world;
    steps[i] = drawn(spread(), random);
    world.rig = vpMovedRig(rig(), steps[i]);
    world.map = lamps(0.2);
    world.robot = robot(static_cast<std::uint64_t>(seed + 1));
    world.robot.slipSigma = slips ? 0.01 : 0;
    world.robot.startX = world.robot.startY = -0.25;
    found[i] = vpMountCalibration().solve({drive(world, spin() + square(), random())}, rig(), world.map);
  });
  printMounts(slips ? "mount, wheels that slip" : "mount, wheels of wrong size", steps, found);
}

//! The same from rendered frames: what the detector makes of them, its systematic errors among it.
void rendered(int seeds)
{
  std::vector<vpRigVector> steps(static_cast<size_t>(seeds));
  std::vector<vpBundleResult> found(steps.size());
  runTrials(seeds, [&](size_t i, int seed, std::mt19937_64 &) {
    vpScenario scenario = vpScenario::load("data/scenarios/calibration.yaml");
    scenario.deviation = {};
    scenario.draw.tilt = 0.15 * M_PI / 180;
    scenario.draw.principalPoint = 3;
    scenario.draw.focalLength = 0.005;
    vpSimulatorTurtleBot3Settings wheels = robot(static_cast<std::uint64_t>(seed + 1));
    wheels.startX = scenario.motion.robot.startX;
    wheels.startY = scenario.motion.robot.startY;
    scenario.motion.robot = wheels;
    vpSimulation simulation(scenario, static_cast<std::uint64_t>(seed + 1));
    vpLedDetector detector(simulation.rig(), simulation.map());
    vpLampRun run;
    for (vpVlpFrame frame; simulation.next(frame);) {
      detector.detect(frame.I);
      run.views.push_back(
          vpLampView::of(frame.timestamp, frame.name, detector.observations(), simulation.map()));
    }
    run.odometry = simulation.odometry();
    steps[i] = vpRigStep(simulation.rig(), simulation.camera().rig);
    found[i] = vpMountCalibration().solve({run}, simulation.rig(), simulation.map());
  });
  printMounts("mount, rendered frames", steps, found);
}

//! Eight lamps over 2.7 m, of two heights.
vpLampMap hall()
{
  vpLampMap map = lamps(0);
  map.lamps.resize(1);
  const vpLamp first = map.lamps[0];
  map.lamps.clear();
  for (int i = 0; i < 8; ++i) {
    vpLamp lamp = first;
    lamp.id = "L" + std::to_string(i + 1);
    lamp.position = {-1.35 + 0.9 * (i / 2), i % 2 == 0 ? 0.45 : -0.45, 1.5 - 0.1 * (i % 3)};
    map.lamps.push_back(lamp);
  }
  return map;
}

//! Three minutes round a rectangle of 1.8 m by 0.4 m.
std::vector<vpTimedVelocity> laps()
{
  std::vector<vpTimedVelocity> commands;
  for (int lap = 0; lap < 4; ++lap) {
    for (int side = 0; side < 4; ++side) {
      commands.push_back({{0.15, 0}, (side % 2 == 0 ? 1.8 : 0.4) / 0.15});
      commands.push_back({{0, 0.6}, 0.5 * M_PI / 0.6});
    }
  }
  return commands;
}

//! Two lamps given, six surveyed: of these the map is no prior.
void survey(int seeds, bool slips)
{
  // A calibrated rig: what vlp-calibrate mount leaves.
  const double degree = M_PI / 180;
  vpRigVector sigma;
  sigma << 0.0002, 0.0002, 0.0002, 0.001 * degree, 0.001 * degree, 0.01 * degree, 0.03, 0.03, 0.0001;
  Errors x{"x, mm", {}, {}, 1, {}}, y{"y, mm", {}, {}, 1, {}}, z{"z, mm", {}, {}, 1, {}};
  std::vector<vpSurveyResult> found(static_cast<size_t>(seeds));
  runTrials(seeds, [&](size_t i, int seed, std::mt19937_64 &random) {
    World world;
    world.rig = vpMovedRig(rig(), drawn(sigma, random));
    world.map = hall();
    world.robot = robot(static_cast<std::uint64_t>(seed + 1));
    world.robot.slipSigma = slips ? 0.01 : 0;
    world.robot.startX = -0.9;
    world.robot.startY = -0.2;
    vpLampMap claimed = world.map;
    std::normal_distribution<double> normal(0, 0.1);
    for (size_t k = 2; k < claimed.lamps.size(); ++k) {
      claimed.lamps[k].position += Eigen::Vector3d(normal(random), normal(random), normal(random));
    }
    vpLampSurvey lamps;
    lamps.bundle.rigSigma = sigma;
    lamps.measured = {0, 1};
    found[i] = lamps.solve({drive(world, laps(), random())}, rig(), claimed);
  });
  const vpLampMap truth = hall();
  Errors joint{"x, y, z of a lamp together", {}, {}, 3, {}};
  for (size_t i = 0; i < found.size(); ++i) {
    if (!found[i].bundle.valid) {
      std::printf("seed %zu: %s\n", i, found[i].bundle.refusal.c_str());
      continue;
    }
    for (size_t k = 2; k < truth.lamps.size(); ++k) {
      if (found[i].lamps[k].images == 0) { // a drive that ended too far from it: told as not seen
        continue;
      }
      const Eigen::Vector3d error = found[i].bundle.map.lamps[k].position - truth.lamps[k].position;
      const Eigen::Vector3d own = found[i].lamps[k].sigma;
      x.add(1000 * error.x(), 1000 * own.x(), i);
      y.add(1000 * error.y(), 1000 * own.y(), i);
      z.add(1000 * error.z(), 1000 * own.z(), i);
      joint.add(std::sqrt(error.dot(found[i].bundle.lampCovariance[k].inverse() * error) / 3), 1, i);
    }
  }
  header(slips ? "lamps, wheels that slip" : "lamps, wheels of wrong size", seeds);
  for (const Errors *errors : {&x, &y, &z, &joint}) {
    errors->print();
  }
}

/*!
  The typical rigs of tests/bench/calibration.md: lean, principal point, focal length and lamps' places drawn;
  mount and lamps calibrated with what such a rig states, two lamps measured by hand to 0.5 mm. Under lamps of
  one height, as the paper's.
*/
void rigs(int seeds)
{
  const double degree = M_PI / 180;
  vpRigVector sigma = vpRigVector::Zero();
  sigma(3) = sigma(4) = 0.15 * degree;
  sigma(6) = sigma(7) = 1 / 2.56; // px of the picture as delivered
  sigma(8) = 0.003;
  struct Result {
    Located before, mount, both;
    std::string refusal;
  };
  std::vector<Result> results(static_cast<size_t>(seeds));
  runTrials(seeds, [&](size_t i, int seed, std::mt19937_64 &random) {
    Result &result = results[i];
    World world;
    world.rig = vpMovedRig(rig(), drawn(sigma, random));
    vpLampMap claimed = lamps(0);
    world.map = claimed;
    std::normal_distribution<double> normal;
    for (size_t k = 0; k < claimed.lamps.size(); ++k) {
      world.map.lamps[k].position += 0.002 * Eigen::Vector3d(normal(random), normal(random), normal(random));
      claimed.lamps[k].positionSigma = 0.002;
    }
    world.robot = robot(static_cast<std::uint64_t>(seed + 1));
    world.robot.startX = world.robot.startY = -0.25;
    result.before = located(world, rig(), claimed, random);

    vpMountCalibration mount;
    mount.bundle.rigSigma = sigma;
    mount.bundle.rigSigma(5) = 0.01; // heading, as little known as the rest
    const vpBundleResult found = mount.solve({drive(world, spin() + square(), random())}, rig(), claimed);
    result.refusal = found.refusal;
    if (!found.valid) {
      return;
    }
    result.mount = located(world, found.rig, claimed, random);

    vpLampMap measured = claimed; // two of them by hand
    for (const size_t k : {0, 3}) {
      measured.lamps[k].position = world.map.lamps[k].position +
                                   0.0005 * Eigen::Vector3d(normal(random), normal(random), normal(random));
    }
    vpLampSurvey survey;
    survey.bundle.rigSigma = found.rigCovariance.diagonal().cwiseSqrt();
    survey.measured = {0, 3};
    const vpSurveyResult surveyed =
        survey.solve({drive(world, spin() + square() + square(), random())}, found.rig, measured);
    result.refusal = surveyed.bundle.refusal;
    if (surveyed.bundle.valid) {
      result.both = located(world, surveyed.bundle.rig, surveyed.bundle.map, random);
    }
  });
  std::printf(
      "\n| %d typical rigs, median | mean error, mm | dispersion radius on one spot, mm |\n|---|---|---|\n",
      seeds);
  const auto row = [&](const char *name, Located Result::*stage) {
    std::vector<double> errors, radii;
    for (const Result &result : results) {
      if (result.refusal.empty()) {
        errors.push_back((result.*stage).error);
        radii.push_back((result.*stage).radius);
      } else {
        std::printf("%s\n", result.refusal.c_str());
      }
    }
    std::printf("| %s | %.2f | %.2f |\n", name, median(errors), median(radii));
  };
  row("as the files say", &Result::before);
  row("after mount", &Result::mount);
  row("after mount and lamps", &Result::both);
  std::fflush(stdout);
}
} // namespace

int main(int argc, char **argv)
{
  const std::string part = argc > 1 ? argv[1] : "all";
  const int seeds = argc > 2 ? std::max(5, std::atoi(argv[2])) : 50;
  set = argc > 3 ? static_cast<unsigned int>(std::max(0, std::atoi(argv[3]))) : 0;
  const std::vector<std::pair<std::string, std::function<void(int)>>> parts = {
      {"camera", camera},
      {"shutter", shutter},
      {"mount", [](int count) { mount(count, false); }},
      {"mount", [](int count) { mount(count, true); }},
      {"rendered", rendered},
      {"lamps", [](int count) { survey(count, false); }},
      {"lamps", [](int count) { survey(count, true); }},
      {"rigs", rigs}};
  for (const auto &[name, print] : parts) {
    if (part == "all" || part == name) {
      print(seeds);
      std::fflush(stdout);
    }
  }
  return 0;
}
