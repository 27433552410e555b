/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Simulated runs from frame to pose: error, consistency, lamps hidden, ids.
// bench_tracking [runs|motion|hidden|nees|ids|all] [SEEDS]: rows of Markdown tables; from the top of the
// repository

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp3/vlp_simulation/vpSimulation.h>

#include "vpSimulatedStripes.h"

namespace
{
struct Settings {
  bool typical = false;
  bool odometry = false;
  bool compensate = true;
  size_t most = 1000000;         // frames
  double from = -1, until = 1e9; // s: frames that count
};

//! Of one run.
struct Run {
  std::vector<double> errors;               // m, horizontal
  std::vector<double> nees;                 // x, y
  size_t frames = 0, fixes = 0, within = 0; // within three of the stated standard deviations
  size_t images = 0;                        // frames that were seen
  size_t ids = 0;                           // lamp images that have one
  size_t swapped = 0, beside = 0;           // of these on another lamp of the map; on none
};

double at(std::vector<double> values, double share)
{
  if (values.empty()) {
    return NAN;
  }
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<size_t>(share * static_cast<double>(values.size())))];
}

double mean(const std::vector<double> &values)
{
  double sum = 0;
  for (double value : values) {
    sum += value;
  }
  return sum / static_cast<double>(values.size());
}

//! Whether a lamp shines there at that time, or some of it that others leave in sight: within its disc.
bool shows(const vpLampObservation &seen, double timestamp, const vpLamp &lamp, vpSimulation &simulation)
{
  const vpHomogeneousMatrix cMw = (simulation.wMb(timestamp + seen.time) * simulation.rig().bMc).inverse();
  const vpColVector c =
      cMw * vpColVector(std::vector<double>{lamp.position.x(), lamp.position.y(), lamp.position.z(), 1});
  const vpCameraParameters &camera = simulation.rig().camera;
  const double u = camera.get_u0() + camera.get_px() * c[0] / c[2],
               v = camera.get_v0() + camera.get_py() * c[1] / c[2];
  const double radius = 0.5 * lamp.size * camera.get_px() / c[2], about = 5; // px
  return std::hypot(seen.outline.centre.x() - u, seen.outline.centre.y() - v) <= radius + about;
}

//! Whether it is out of order then, so that whatever shines in its place is another lamp.
bool dark(const std::string &id, double time, const vpScenario &scenario)
{
  return std::any_of(scenario.lamps.begin(), scenario.lamps.end(), [&](const vpScenario::Lamp &lamp) {
    return lamp.simulated.lamp.id == id &&
           std::any_of(lamp.dark.begin(), lamp.dark.end(),
                       [time](const auto &off) { return time >= off.first && time < off.second; });
  });
}

void countIds(const vpVlpLocation &location, const vpScenario &scenario, vpSimulation &simulation, Run &run)
{
  for (const vpLampObservation &seen : location.observations) {
    if (seen.id.empty()) {
      continue;
    }
    ++run.ids;
    if (dark(seen.id, location.timestamp + seen.time, scenario)) {
      ++run.swapped;
      continue;
    }
    if (shows(seen, location.timestamp, *simulation.map().find(seen.id), simulation)) {
      continue;
    }
    const std::vector<vpLamp> &lamps = simulation.map().lamps;
    const bool another = std::any_of(lamps.begin(), lamps.end(), [&](const vpLamp &lamp) {
      return shows(seen, location.timestamp, lamp, simulation);
    });
    ++(another ? run.swapped : run.beside);
  }
}

Run runOf(const std::string &name, std::uint64_t seed, const Settings &settings)
{
  vpScenario scenario = vpScenario::load("data/scenarios/" + name + ".yaml");
  if (settings.typical) {
    scenario.useTypicalRig();
  }
  vpSimulation simulation(scenario, seed);
  vpVlpLocalizer localizer(simulation.rig(), simulation.map());
  localizer.compensateShutter = settings.compensate;
  Run run;
  size_t odometry = 0;
  for (vpVlpFrame frame; run.images < settings.most && simulation.next(frame); ++run.images) {
    if (settings.odometry) {
      static const double read = 0.08; // s after the time stamp: by then the frame is there
      simulation.wMb(frame.timestamp + read);
      const std::vector<vpOdometry> samples = simulation.odometry();
      for (; odometry < samples.size(); ++odometry) {
        localizer.filter.addOdometry(samples[odometry]);
      }
    }
    const vpVlpLocation location = localizer.process(frame);
    countIds(location, scenario, simulation, run);
    if (frame.timestamp < settings.from || frame.timestamp > settings.until) {
      continue;
    }
    ++run.frames;
    if (!location.fix.valid) {
      continue;
    }
    ++run.fixes;
    const vpHomogeneousMatrix truth = simulation.wMb(frame.timestamp);
    const Eigen::Vector2d error(location.fix.wMb[0][3] - truth[0][3], location.fix.wMb[1][3] - truth[1][3]);
    const Eigen::Matrix2d covariance = location.fix.covariance.topLeftCorner<2, 2>();
    run.errors.push_back(error.norm());
    run.nees.push_back(error.dot(covariance.inverse() * error));
    run.within += std::abs(error.x()) < 3 * std::sqrt(covariance(0, 0)) &&
                  std::abs(error.y()) < 3 * std::sqrt(covariance(1, 1));
  }
  return run;
}

std::vector<Run> runsOf(const std::string &name, int seeds, const Settings &settings)
{
  std::vector<Run> runs(static_cast<size_t>(seeds));
  vpRunTrials(seeds, [&](int seed, std::mt19937_64 &) {
    runs[static_cast<size_t>(seed)] = runOf(name, static_cast<std::uint64_t>(seed + 1), settings);
  });
  return runs;
}

void print(const std::string &what, const std::vector<Run> &runs)
{
  std::vector<double> means, high, worst;
  size_t frames = 0, fixes = 0, within = 0;
  for (const Run &run : runs) {
    frames += run.frames;
    fixes += run.fixes;
    within += run.within;
    means.push_back(1000 * mean(run.errors));
    high.push_back(1000 * at(run.errors, 0.95));
    worst.push_back(1000 * at(run.errors, 1));
  }
  std::printf("| %s | %zu x %zu | %.2f | %.3f | %.3f | %.3f | %.2f |\n", what.c_str(), runs.size(),
              frames / runs.size(), 100. * static_cast<double>(fixes) / static_cast<double>(frames),
              at(means, 0.5), at(high, 0.5), at(worst, 1),
              100. * static_cast<double>(within) / static_cast<double>(fixes));
  std::fflush(stdout);
}

void header()
{
  std::printf("\n| run | seeds x frames | with a fix, %% | mean error, mm | 95 %%, mm | largest of all, mm | "
              "within 3 "
              "sigma, %% |\n|---|---|---|---|---|---|---|\n");
}

void runs(int seeds)
{
  header();
  for (const char *name : {"paper-a", "paper-b", "paper-c", "paper-d", "paper-e", "paper-f"}) {
    print(std::string(name) + ", ideal rig", runsOf(name, 2, {}));
  }
  Settings typical;
  typical.typical = true;
  typical.most = 300;
  for (const char *name : {"paper-a", "paper-b"}) {
    print(std::string(name) + ", typical rigs", runsOf(name, seeds, typical));
  }
}

void motion(int seeds)
{
  header();
  for (const char *name : {"straight", "curve", "circle", "spin", "hall"}) {
    const std::string scenario = name;
    Settings off;
    off.compensate = false;
    print(scenario, runsOf(name, scenario == "hall" ? 2 : seeds / 5, {}));
    print(scenario + ", lines taken as of one time", runsOf(name, scenario == "hall" ? 2 : seeds / 5, off));
  }
}

void hidden(int seeds)
{
  header();
  Settings odometry;
  odometry.odometry = true;
  print("half of one lamp hidden", runsOf("half-hidden", seeds / 5, {}));
  print("people under the lamps", runsOf("people", seeds / 5, {}));
  print("a lamp replaced", runsOf("swapped-lamp", seeds / 5, {}));
  odometry.from = 2;
  odometry.until = 3.99;
  print("all lamps dark for 2 s, wheels", runsOf("all-hidden", seeds / 5, odometry));
  odometry.from = 4.2; // three frames later
  odometry.until = 1e9;
  print("the same, from the third frame on in which they are back",
        runsOf("all-hidden", seeds / 5, odometry));
  odometry.from = 2;
  odometry.until = 22;
  print("one lamp for 20 s, wheels and gyro", runsOf("one-lamp-20s", seeds / 5, odometry));
  Settings none;
  none.from = 2;
  none.until = 22;
  print("one lamp for 20 s, nothing else", runsOf("one-lamp-20s", seeds / 5, none));
}

//! Mean over seeds of each seed's mean, and the interval in which it lies 95 times in 100 if errors of one
//! seed are all alike (Wilson and Hilferty 1931).
void nees(int seeds)
{
  std::printf("\n| run | seeds | mean NEES of x, y | 95 %% interval about 2 |\n|---|---|---|---|\n");
  const double degrees = 2 * seeds;
  auto quantile = [degrees](double z) {
    const double v = 2 / (9 * degrees);
    return degrees * std::pow(1 - v + z * std::sqrt(v), 3);
  };
  for (bool typical : {false, true}) {
    for (const char *name : {"paper-a", "straight", "spin"}) {
      Settings settings;
      settings.typical = typical;
      settings.most = 120;
      std::vector<double> means;
      for (const Run &run : runsOf(name, seeds, settings)) {
        means.push_back(mean(run.nees));
      }
      std::printf("| %s, %s rig | %d | %.2f | %.2f to %.2f |\n", name, typical ? "typical" : "ideal", seeds,
                  mean(means), quantile(-1.96) / seeds, quantile(1.96) / seeds);
      std::fflush(stdout);
    }
  }
}

void ids(int seeds)
{
  std::printf("\n| run | frames | lamp images with an id | of them on another lamp | on none "
              "|\n|---|---|---|---|---|\n");
  for (const char *name : {"crossing", "half-hidden", "people", "swapped-lamp"}) {
    size_t frames = 0, count = 0, swapped = 0, beside = 0;
    for (const Run &run : runsOf(name, seeds, {})) {
      frames += run.images;
      count += run.ids;
      swapped += run.swapped;
      beside += run.beside;
    }
    std::printf("| %s | %zu | %zu | %zu | %zu |\n", name, frames, count, swapped, beside);
    std::fflush(stdout);
  }
}
} // namespace

int main(int argc, char **argv)
{
  const std::string part = argc > 1 ? argv[1] : "all";
  const int seeds = argc > 2 ? std::max(5, std::atoi(argv[2])) : 50;
  const std::vector<std::pair<std::string, std::function<void(int)>>> parts = {
      {"runs", runs}, {"motion", motion}, {"hidden", hidden}, {"nees", nees}, {"ids", ids}};
  for (const auto &[name, print] : parts) {
    if (part == "all" || part == name) {
      print(seeds);
    }
  }
  return 0;
}
