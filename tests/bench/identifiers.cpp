/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// How many identifiers single frames tell apart: planned lamps, each seen once, one lamp a frame or several.
// To be run from the top of the repository.

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <mutex>

#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_identification/vpLedIdPlanner.h>
#include <visp3/vlp_identification/vpLedIdRecognizer.h>

#include "vpSimulatedStripes.h"

namespace
{
struct Setting {
  const char *name;
  vpSimulatedStripes stripes;
  double rowTimeSigma; // as a share of it, stated and true
  int lampsInView;
  vpLampMap map;
};

void run(const Setting &setting, int frames)
{
  std::mutex guard;
  int right = 0, wrong = 0, none = 0;
  double squares = 0, squaresInSigmas = 0;
  vpRollingShutter shutter;
  shutter.rowTime = setting.stripes.rowTime;
  shutter.rowTimeSigma = setting.rowTimeSigma * shutter.rowTime;
  const vpLedIdRecognizer recognizer(setting.map, shutter);
  vpRunTrials(frames, [&](int, std::mt19937_64 &generator) {
    vpSimulatedStripes stripes = setting.stripes;
    stripes.rowTimeError = setting.rowTimeSigma * std::normal_distribution<double>()(generator);
    std::uniform_int_distribution<size_t> any(0, setting.map.lamps.size() - 1);
    vpStripeAnalyzer analyzer;
    analyzer.searchTwoPulses = false;
    std::vector<vpLampObservation> seen(static_cast<size_t>(setting.lampsInView));
    std::vector<const vpLamp *> sent;
    for (vpLampObservation &lamp : seen) {
      sent.push_back(&setting.map.lamps[any(generator)]);
      lamp.features = analyzer.analyze(stripes.profile(sent.back()->modulation, generator));
    }
    recognizer.recognize(seen);
    const std::lock_guard<std::mutex> lock(guard);
    for (size_t i = 0; i < seen.size(); ++i) {
      right += seen[i].id == sent[i]->id;
      none += seen[i].id.empty();
      wrong += !seen[i].id.empty() && seen[i].id != sent[i]->id;
      const double error =
          seen[i].features.frequency / (1 + stripes.rowTimeError) - sent[i]->modulation.frequency;
      if (std::isfinite(error)) {
        squares += error * error;
        squaresInSigmas += std::pow(error / seen[i].features.frequencySigma, 2);
      }
    }
  });
  const int lamps = frames * setting.lampsInView;
  std::printf("%-44s %5zu %7d %9.3f %9.4f %9.3f   %6.2f %6.2f\n", setting.name, setting.map.lamps.size(),
              lamps, 100. * right / lamps, 100. * wrong / lamps, 100. * none / lamps,
              std::sqrt(squares / lamps), std::sqrt(squaresInSigmas / lamps));
  std::fflush(stdout);
}
} // namespace

int main(int argc, char **argv)
{
  const int frames = argc > 1 ? std::atoi(argv[1]) : 20000;
  static const double rowTimeSigma = 5e-5, crystal = 50; // share of the row time; ppm
  vpSimulatedStripes full, nearest;
  nearest.lines = 57;
  nearest.step = 2.56;
  auto plannerOf = [](const char *rigFile, double highest) {
    vpVlpRig rig = vpVlpRig::load(rigFile);
    rig.shutter.rowTimeSigma = rowTimeSigma * rig.shutter.rowTime;
    vpLedIdPlanner planner(rig);
    planner.lowestFrequency = 500;
    planner.highestFrequency = highest;
    return planner;
  };
  const vpLedIdPlanner large = plannerOf("data/rigs/ub300-2048x1536.yaml", 7000),
                       small = plannerOf("data/rigs/ub300-800x600.yaml", 3900);
  const vpLampMap fiveHundred = vpMapOf(large.spread(full.lines, crystal, 500).identifiers);
  const vpLampMap fifty = vpMapOf(large.spread(full.lines, crystal, 50).identifiers);
  std::printf("stripe counting in the same ranges: %zu and %zu\n", large.bins(full.lines),
              small.bins(nearest.lines));
  std::printf("%-44s %5s %7s %9s %9s %9s   %s\n", "", "ids", "lamps", "right %", "wrong %", "none %",
              "rms Hz, in own sigmas (oscillator included)");
  run({"2048x1536, row time to 0.005 %", full, rowTimeSigma, 1, fiveHundred}, frames);
  run({"2048x1536, all that the planner finds", full, rowTimeSigma, 1,
       vpMapOf(large.largest(full.lines, crystal).identifiers)},
      frames);
  run({"800x600 nearest, row time to 0.005 %", nearest, rowTimeSigma, 1,
       vpMapOf(small.spread(nearest.lines, crystal, 150).identifiers)},
      frames);
  run({"800x600 nearest, all that the planner finds", nearest, rowTimeSigma, 1,
       vpMapOf(small.largest(nearest.lines, crystal).identifiers)},
      frames);
  static const double arduino = 16e6;   // Hz, of its timers
  for (double ppm : {crystal, 5000.}) { // its ceramic resonator
    for (vpLedIdPlanner planner : {large, small}) {
      planner.clock = arduino;
      const bool whole = planner.highest() == large.highest();
      vpSimulatedStripes stripes = whole ? full : nearest;
      stripes.oscillator = ppm;
      char name[80];
      std::snprintf(name, sizeof name, "%s, clock of 16 MHz, %g ppm", whole ? "2048x1536" : "800x600 nearest",
                    ppm);
      run({name, stripes, rowTimeSigma, 1, vpMapOf(planner.largest(stripes.lines, ppm).identifiers, ppm)},
          frames);
    }
  }
  for (const vpLampMap *map : {&fifty, &fiveHundred}) {
    for (double known : {1e-3, 1e-2}) {
      for (int inView : {1, 2, 4}) {
        char name[80];
        std::snprintf(name, sizeof name, "2048x1536, row time to %g %%, %d in view", 100 * known, inView);
        run({name, full, known, inView, *map}, frames / 5);
      }
    }
  }
  return 0;
}
