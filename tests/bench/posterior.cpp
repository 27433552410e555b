/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Whether frequency and duty of a lamp are as good as their standard deviations say, at all phases, beside
// the exact posterior: lamps of 57 lines in the rig ub300-800x600, whose nearest-neighbour resize leaves gaps
// between the lines. bench_posterior [PHASES]

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>

#include <visp3/vlp_core/vpVlpRig.h>

#include "vpExactPosterior.h"
#include "vpSimulatedStripes.h"

namespace
{
//! Errors of one estimate over the phases.
struct Errors {
  double squares = 0, own = 0, worst = 0, sigmas = 0;
  int count = 0;

  void add(double error, double sigma)
  {
    squares += error * error;
    own += error * error / (sigma * sigma);
    worst = std::max(worst, std::abs(error) / sigma);
    sigmas += sigma;
    ++count;
  }
  double rms() const { return std::sqrt(squares / count); }
  double ownRms() const { return std::sqrt(own / count); }
  double sigma() const { return sigmas / count; }
};

//! Frequency and duty by one way.
struct Cell {
  Errors frequency, duty;
  int lost = 0; // lamps of which frequency and duty were not told

  void print() const
  {
    std::printf(" %.2f | %.2f | %.2f (%.1f) | %.4f | %.4f | %.2f (%.1f) |", frequency.rms(),
                frequency.sigma(), frequency.ownRms(), frequency.worst, duty.rms(), duty.sigma(),
                duty.ownRms(), duty.worst);
  }
};

struct Cells {
  Cell told, exact;
};

const int lampLines = 57;
const double amplitude = 75, noise = 7.5; // grey levels: 20 dB

//! A lamp somewhere in the picture. \param phase Periods since a pulse began, at the first line's start.
vpStripeProfile profileOf(const vpVlpRig &rig, double frequency, double duty, double phase,
                          std::mt19937_64 &generator)
{
  vpModulation modulation;
  modulation.kind = vpModulation::Kind::pwm;
  modulation.frequency = frequency;
  modulation.duty = duty;
  const vpLineTiming timing = rig.lineTiming();
  std::normal_distribution<double> normal;
  const unsigned int first =
      std::uniform_int_distribution<unsigned int>(0, timing.lines() - lampLines)(generator);
  const double exposure = timing.exposure(), begin = timing.middle(first) - exposure / 2;
  const double atStart = phase - frequency * begin;
  const vpLampLight light(modulation, 1, atStart - std::floor(atStart));
  vpStripeProfile profile;
  profile.exposure = exposure;
  profile.logExposureSigma = timing.logExposureSigma();
  for (unsigned int i = first; i < first + lampLines; ++i) {
    const double middle = timing.middle(i);
    profile.time.push_back(middle);
    profile.light.push_back(2 * amplitude * light.over(middle - exposure / 2, middle + exposure / 2).share +
                            noise * normal(generator));
    profile.sigma.push_back(noise);
  }
  return profile;
}

Cells measure(const vpVlpRig &rig, double frequency, double duty, int phases)
{
  Cells cells;
  std::mutex guard;
  const double step = std::abs(rig.lineTiming().meanLineTime());
  vpRunTrials(
      phases,
      [&](int k, std::mt19937_64 &generator) {
        const double phase = static_cast<double>(k) / phases;
        const vpStripeProfile profile = profileOf(rig, frequency, duty, phase, generator);
        vpStripeAnalyzer analyzer;
        analyzer.searchTwoPulses = false;
        const vpStripeFeatures seen = analyzer.analyze(profile);
        static const double glow = 0.05; // of the lit lamp
        const double middle = 0.5 * (profile.time.front() + profile.time.back()),
                     begin = profile.time.front() - profile.exposure / 2;
        const vpExactPosterior::Estimate best =
            vpExactPosterior(profile, step, glow * 2 * amplitude)
                .about(frequency, phase + frequency * (middle - begin), duty, profile.exposure);
        const std::lock_guard<std::mutex> lock(guard);
        if (seen.signal != vpStripeFeatures::Signal::pwm || !(seen.frequencySigma < 0.1 * seen.frequency)) {
          ++cells.told.lost;
          return;
        }
        cells.told.frequency.add(seen.frequency - frequency, seen.frequencySigma);
        cells.told.duty.add(seen.duty - duty, seen.dutySigma);
        cells.exact.frequency.add(best.frequency - frequency, best.frequencySigma);
        cells.exact.duty.add(best.duty - duty, best.dutySigma);
      },
      static_cast<unsigned int>(frequency + 1e6 * duty));
  return cells;
}

void table(const char *title, const vpVlpRig &rig, int phases)
{
  std::printf(
      "\n%s\n\n"
      "| Hz | duty | lost | f: error | sigma | own sigmas, rms (max) | duty: error | sigma | own sigmas | "
      "exact f: error | sigma | own sigmas | exact duty: error | sigma | own sigmas |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      title);
  // The last four are near 1/5, 1/4 and 1/3 of the picture's line rate of 9063 Hz, and at 1/10 of the
  // sensor's.
  for (double frequency : {1130., 1500., 2000., 2890., 1814., 2269., 3018., 2320.}) {
    for (double duty : {0.2, 0.35, 0.5, 0.65, 0.8}) {
      const Cells cells = measure(rig, frequency, duty, phases);
      std::printf("| %.0f | %.2f | %d |", frequency, duty, cells.told.lost);
      cells.told.print();
      cells.exact.print();
      std::printf("\n");
      std::fflush(stdout);
    }
  }
}
} // namespace

int main(int argc, char **argv)
{
  const int phases = argc > 1 ? std::max(1, std::atoi(argv[1])) : 64;
  vpVlpRig rig = vpVlpRig::load("data/rigs/ub300-800x600.yaml");
  rig.shutter.exposureSigma = 0;
  table("Exposure known", rig, phases);
  rig.shutter.exposureSigma = vpVlpRig::uncalibratedExposure * rig.shutter.exposure;
  table("Exposure known to a factor of two", rig, phases);
  return 0;
}
