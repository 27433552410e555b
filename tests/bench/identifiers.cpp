/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// How many identifiers single frames tell apart: lamps of a map, each seen once, one lamp a frame or several.

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <mutex>

#include <visp3/vlp_detection/vpLedIdRecognizer.h>

#include "vpSimulatedStripes.h"

namespace
{
//! PWM lamps at even steps from \e lowest to \e highest, Hz, with duties in turn.
vpLampMap lampsOf(int count, double lowest, double highest, const std::vector<double> &duties)
{
  vpLampMap map;
  for (int k = 0; k < count; ++k) {
    vpLamp lamp;
    lamp.id = std::to_string(k);
    lamp.modulation.kind = vpModulation::Kind::pwm;
    lamp.modulation.frequency = lowest + (highest - lowest) * k / (count - 1);
    lamp.modulation.duty = duties[static_cast<size_t>(k) % duties.size()];
    map.lamps.push_back(lamp);
  }
  return map;
}

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
  vpSimulatedStripes full, nearest;
  nearest.lines = 57;
  nearest.step = 2.56;
  std::printf("%-44s %5s %7s %9s %9s %9s   %s\n", "", "ids", "lamps", "right %", "wrong %", "none %",
              "rms Hz, in own sigmas (oscillator and 50 ppm included)");
  for (const std::vector<double> &duties : {std::vector<double>{0.5}, std::vector<double>{0.3, 0.5, 0.7}}) {
    run({"2048x1536, row time known to 0.005 %", full, 5e-5, 1, lampsOf(500, 500, 7000, duties)}, frames);
    run({"800x600 nearest, row time known to 0.005 %", nearest, 5e-5, 1, lampsOf(150, 500, 3900, duties)},
        frames);
    run({"2048x1536, row time to 1 %, four in view", full, 1e-2, 4, lampsOf(500, 500, 7000, duties)},
        frames / 4);
  }
  return 0;
}
