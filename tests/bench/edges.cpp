/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What a lamp's electronics cost: edges that come early or late, as interrupts make them, and slow ones, as a
// large resistor before the transistor makes them. To be run from the top of the repository.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mutex>

#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_identification/vpLedIdPlanner.h>
#include <visp3/vlp_identification/vpLedIdRecognizer.h>

#include "vpSimulatedStripes.h"

namespace
{
struct Electronics {
  const char *name;
  double jitter = 0;   // s, each edge is late by 0 to so much
  double edgeTime = 0; // s, in which light rises and falls, evenly
};

//! Light of a lamp whose edges are where its electronics put them.
class EdgeLight
{
public:
  EdgeLight(const vpModulation &modulation, const Electronics &electronics, double rate, double phase,
            double until, std::mt19937_64 &generator)
      : m_edgeTime(electronics.edgeTime)
  {
    std::uniform_real_distribution<double> late(0, electronics.jitter);
    const double period = 1 / (rate * modulation.repetitionFrequency());
    const std::string chips = modulation.chips();
    for (double begin = -(1 + phase) * period; begin < until; begin += period) {
      if (chips.empty()) {
        m_edges.push_back({begin + late(generator), 1});
        m_edges.push_back({begin + modulation.duty.value() * period + late(generator), -1});
      }
      for (size_t k = 0; k < chips.size(); ++k) {
        const int step = (chips[k] == '1') - (chips[(k + chips.size() - 1) % chips.size()] == '1');
        if (step != 0) {
          m_edges.push_back(
              {begin + period * static_cast<double>(k) / static_cast<double>(chips.size()) + late(generator),
               step});
        }
      }
    }
    m_before = !chips.empty() && chips.back() == '1';
  }

  double share(double from, double to) const { return (since(to) - since(from)) / (to - from); }

private:
  struct Edge {
    double time; // s, at which it begins
    int step;    // 1: to lit, -1: to dark
  };

  //! Lit time until \e time, s, but for a constant.
  double since(double time) const
  {
    double sum = m_before ? time : 0;
    for (const Edge &edge : m_edges) {
      const double after = time - edge.time;
      if (after > 0) {
        sum += edge.step * (after < m_edgeTime ? after * after / (2 * m_edgeTime) : after - m_edgeTime / 2);
      }
    }
    return sum;
  }

  std::vector<Edge> m_edges;
  double m_edgeTime;
  bool m_before; // it was lit before its first edge
};

struct Outcome {
  int right = 0, wrong = 0;
  double squares = 0; // Hz^2, of the frequency
};

Outcome run(const vpLampMap &map, const Electronics &electronics, int lamps)
{
  static const double rowTimeSigma = 5e-5; // as a share of it
  const vpSimulatedStripes stripes;
  vpRollingShutter shutter;
  shutter.rowTime = stripes.rowTime;
  shutter.rowTimeSigma = rowTimeSigma * shutter.rowTime;
  const vpLedIdRecognizer recognizer(map, shutter);
  std::mutex guard;
  Outcome all;
  vpRunTrials(lamps, [&](int, std::mt19937_64 &generator) {
    vpSimulatedStripes seen = stripes;
    seen.rowTimeError = rowTimeSigma * std::normal_distribution<double>()(generator);
    const vpLamp &lamp = map.lamps[generator() % map.lamps.size()];
    const double rate = 1 + 1e-6 * seen.oscillator * std::normal_distribution<double>()(generator);
    const EdgeLight light(lamp.modulation, electronics, rate,
                          std::uniform_real_distribution<double>(0, 1)(generator),
                          (1000 + seen.lines) * 1.01 * seen.rowTime, generator);
    vpStripeAnalyzer analyzer;
    analyzer.searchTwoPulses = false;
    if (lamp.modulation.kind == vpModulation::Kind::word) {
      analyzer.words = {
          {lamp.modulation.chips().size(), lamp.modulation.chipRate, std::hypot(rowTimeSigma, 5e-5)}};
    }
    vpLampObservation observation;
    observation.features = analyzer.analyze(
        seen.profile([&light](double from, double to) { return light.share(from, to); }, generator));
    recognizer.recognize(observation);
    const double error = observation.features.frequency / (1 + seen.rowTimeError) - lamp.modulation.frequency;
    const std::lock_guard<std::mutex> lock(guard);
    all.right += observation.id == lamp.id;
    all.wrong += !observation.id.empty() && observation.id != lamp.id;
    all.squares += std::isfinite(error) ? error * error : 0;
  });
  return all;
}
} // namespace

int main(int argc, char **argv)
{
  const int lamps = argc > 1 ? std::atoi(argv[1]) : 5000;
  static const double crystal = 50; // ppm
  const vpSimulatedStripes full;
  vpLedIdPlanner planner(vpVlpRig::load("data/rigs/ub300-2048x1536.yaml"));
  planner.lowestFrequency = 500;
  planner.highestFrequency = 7000;
  const vpLampMap frequencies = vpMapOf(planner.spread(full.lines, crystal, 500).identifiers),
                  words = vpMapOf(planner.words(full.lines, vpWordScheme()).words);
  std::printf("%d lamps a value; 500 frequencies, 228 words\n", lamps);
  std::printf("%-44s %9s %9s %9s   %9s %9s\n", "", "right %", "wrong %", "Hz rms", "words %", "wrong %");
  for (const Electronics &electronics : {Electronics{"edges as the map has them"},
                                         {"late by 0 to 1 cycle of 16 MHz", 1 / 16e6},
                                         {"late by 0 to 1 us", 1e-6},
                                         {"late by 0 to 4 us", 4e-6},
                                         {"late by 0 to 10 us", 10e-6},
                                         {"late by 0 to 20 us", 20e-6},
                                         {"light rises and falls in 3 us", 0, 3e-6},
                                         {"in 30 us", 0, 30e-6},
                                         {"in 60 us", 0, 60e-6},
                                         {"in 100 us", 0, 100e-6}}) {
    const Outcome pulse = run(frequencies, electronics, lamps), word = run(words, electronics, lamps);
    std::printf("%-44s %9.2f %9.3f %9.2f   %9.2f %9.3f\n", electronics.name, 100. * pulse.right / lamps,
                100. * pulse.wrong / lamps, std::sqrt(pulse.squares / lamps), 100. * word.right / lamps,
                100. * word.wrong / lamps);
    std::fflush(stdout);
  }
  return 0;
}
