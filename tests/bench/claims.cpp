/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Rigs and maps that claim to be exact and are not: the lamps' middles are simulated, no picture is
// (vpSeenLamps). bench_claims [SEEDS] (12)

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include <visp3/vlp_evaluation/vpErrorStatistics.h>

#include "common/vpSeenLamps.h"
#include "vpSimulatedStripes.h"

namespace
{
//! What is not as it is claimed.
using Flaw = std::function<void(vpSeenLamps &, std::mt19937_64 &)>;

//! Each lamp hangs elsewhere, by \e sigma (m) in each coordinate.
Flaw displaced(double sigma)
{
  return [sigma](vpSeenLamps &world, std::mt19937_64 &generator) {
    std::normal_distribution<double> normal(0, sigma);
    for (size_t k = 0; k < world.map.lamps.size(); ++k) {
      world.hung(k) += Eigen::Vector3d(normal(generator), normal(generator), normal(generator));
    }
  };
}

//! The camera leans towards anywhere, by \e lean (rad).
Flaw leaning(double lean)
{
  return [lean](vpSeenLamps &world, std::mt19937_64 &generator) {
    const double towards = std::uniform_real_distribution<double>(0, 2 * M_PI)(generator);
    world.turn(lean * Eigen::Vector3d(std::cos(towards), std::sin(towards), 0));
  };
}

//! One lamp hangs elsewhere by \e way (m), in any direction of the ceiling.
Flaw oneAside(double way)
{
  return [way](vpSeenLamps &world, std::mt19937_64 &generator) {
    const size_t which = std::uniform_int_distribution<size_t>(0, world.map.lamps.size() - 1)(generator);
    const double towards = std::uniform_real_distribution<double>(0, 2 * M_PI)(generator);
    world.hung(which) += way * Eigen::Vector3d(std::cos(towards), std::sin(towards), 0);
  };
}

struct Outcome {
  double last = 0;              // standard deviations that the last pose is off
  double mean = 0, largest = 0; // m, error of all poses
};

Outcome run(vpSeenLamps world, const vpPlannedDrive &path, double framesPerSecond, const Flaw &flaw,
            std::mt19937_64 &generator)
{
  flaw(world, generator);
  const auto place = [&path](double t) { return path.at(t); };
  vpVlpLocalizer localizer(world.rig, world.map);
  Outcome outcome;
  int fixes = 0;
  for (double t = 0; t < path.duration() - 1e-9; t += 1 / framesPerSecond) {
    const vpVlpFix fix = localizer.locate(t, world.see(t, place, generator)).fix;
    if (fix.valid) {
      const double error = vpErrorOf(fix, place(t));
      outcome.last = vpSigmasOff(fix, place(t));
      outcome.mean += error;
      outcome.largest = std::max(outcome.largest, error);
      ++fixes;
    }
  }
  outcome.mean /= fixes;
  return outcome;
}

void row(const std::string &name, const vpSeenLamps &world, const vpPlannedDrive &path,
         double framesPerSecond, const Flaw &flaw, int seeds)
{
  std::vector<Outcome> all(static_cast<size_t>(seeds));
  vpRunTrials(seeds, [&](int seed, std::mt19937_64 &generator) {
    all[static_cast<size_t>(seed)] = run(world, path, framesPerSecond, flaw, generator);
  });
  std::vector<double> last;
  double mean = 0, largest = 0;
  int beyond = 0; // five standard deviations
  for (const Outcome &outcome : all) {
    last.push_back(outcome.last);
    beyond += outcome.last > 5;
    mean += outcome.mean / seeds;
    largest = std::max(largest, outcome.largest);
  }
  std::printf("| %s | %g | %.2f, %.2f | %d | %.3f | %.1f |\n", name.c_str(), framesPerSecond,
              vpPercentile(last, 0.5), vpPercentile(last, 1), beyond, 1000 * mean, 1000 * largest);
  std::fflush(stdout);
}
} // namespace

int main(int argc, char **argv)
{
  const int seeds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 12;
  const std::vector<Eigen::Vector3d> three = {{-0.4, -0.3, 1.8}, {0.4, -0.3, 1.8}, {0, 0.35, 1.8}};
  std::vector<Eigen::Vector3d> six = three;
  six.insert(six.end(), {{-0.45, 0.4, 1.8}, {0.45, 0.4, 1.8}, {0, -0.45, 1.8}});
  // The arc of tutorial/simulation.
  const vpPlannedDrive arc({-0.2, 0, 0}, {{4, 0.1, 0.4}}),
      stopping({-0.2, 0, 0}, {{1, 0, 0}, {3, 0.1, 0.3}, {1, 0, 0}});

  std::printf(
      "%d seeds each; the last pose's error in its standard deviations, of x, y or yaw.\n\n"
      "| claimed exact, and is not | frames a second | last pose, sigma: median, largest | beyond 5 | mean "
      "error, mm | largest error, mm |\n|---|---|---|---|---|---|\n",
      seeds);
  row("three lamps, 2 mm", vpSeenLamps(three), arc, 5, displaced(0.002), seeds);
  row("three lamps, 5 mm", vpSeenLamps(three), arc, 5, displaced(0.005), seeds);
  row("six lamps, 2 mm", vpSeenLamps(six), arc, 5, displaced(0.002), seeds);
  row("three lamps, 2 mm", vpSeenLamps(three), arc, 12, displaced(0.002), seeds);
  row("camera, 0.3 degree", vpSeenLamps(three), arc, 12, leaning(0.3 * M_PI / 180), seeds);
  for (const double way : {0.002, 0.005, 0.01, 0.02, 0.05, 0.1}) {
    row("one lamp of four, " + std::to_string(std::lround(1000 * way)) + " mm", vpSeenLamps(4), stopping, 10,
        oneAside(way), seeds);
  }
  row("one lamp of three, 20 mm", vpSeenLamps(3), stopping, 10, oneAside(0.02), seeds);
  return 0;
}
