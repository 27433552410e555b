/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Lamps that send words: how many are read, and whether a word that the map does not have is taken for one
// that it has. To be run from the top of the repository.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <mutex>

#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_identification/vpLedIdPlanner.h>
#include <visp3/vlp_identification/vpLedIdRecognizer.h>

#include "vpSimulatedStripes.h"

namespace
{
enum class Sender { ofTheMap, oneBitOff, anyWord };

//! A word of the map with one of its bits, past the header, turned around.
vpModulation changed(vpModulation word, std::mt19937_64 &generator)
{
  static const size_t header = 6;
  const size_t bit = header + generator() % (word.bits.size() - header);
  word.bits[bit] = word.bits[bit] == '0' ? '1' : '0';
  return word;
}

void run(const char *name, const std::vector<vpModulation> &words, const vpSimulatedStripes &setting,
         Sender sender, int lamps)
{
  static const double rowTimeSigma = 5e-5; // as a share of it
  const vpLampMap map = vpMapOf(words);
  vpRollingShutter shutter;
  shutter.rowTime = setting.rowTime;
  shutter.rowTimeSigma = rowTimeSigma * shutter.rowTime;
  const vpLedIdRecognizer recognizer(map, shutter);
  std::mutex guard;
  int right = 0, wrong = 0, decoded = 0;
  vpRunTrials(lamps, [&](int, std::mt19937_64 &generator) {
    vpSimulatedStripes stripes = setting;
    stripes.rowTimeError = rowTimeSigma * std::normal_distribution<double>()(generator);
    const vpLamp &lamp = map.lamps[generator() % map.lamps.size()];
    vpModulation sent = lamp.modulation;
    auto known = [&map, &sent] {
      return std::any_of(map.lamps.begin(), map.lamps.end(),
                         [&sent](const vpLamp &other) { return other.modulation.sameSignal(sent); });
    };
    while (sender != Sender::ofTheMap && known()) {
      sent = lamp.modulation;
      if (sender == Sender::oneBitOff) {
        sent = changed(sent, generator);
      } else {
        for (char &bit : sent.bits) {
          bit = generator() % 2 == 0 ? '0' : '1';
        }
      }
    }
    vpStripeAnalyzer analyzer;
    analyzer.searchTwoPulses = false;
    analyzer.words = {{sent.chips().size(), sent.chipRate, std::hypot(rowTimeSigma, 5e-5)}};
    vpLampObservation seen;
    seen.features = analyzer.analyze(stripes.profile(sent, generator));
    recognizer.recognize(seen);
    const std::lock_guard<std::mutex> lock(guard);
    decoded += !seen.features.chips.empty();
    right += sender == Sender::ofTheMap && seen.id == lamp.id;
    wrong += !seen.id.empty() && (sender != Sender::ofTheMap || seen.id != lamp.id);
  });
  std::printf("%-62s %4zu %6d %9.3f %7d %9.3f\n", name, words.size(), lamps, 100. * right / lamps, wrong,
              100. * decoded / lamps);
  std::fflush(stdout);
}
} // namespace

int main(int argc, char **argv)
{
  const int lamps = argc > 1 ? std::atoi(argv[1]) : 5000;
  vpSimulatedStripes full, nearest;
  nearest.lines = 57;
  nearest.step = 2.56;
  const vpLedIdPlanner planner(vpVlpRig::load("data/rigs/ub300-2048x1536.yaml"));
  const std::vector<vpModulation> words = planner.words(full.lines, vpWordScheme()).words;
  std::vector<vpModulation> most; // the others are left to strangers
  for (size_t i = 0; i < words.size(); ++i) {
    if (i % 3 != 2) {
      most.push_back(words[i]);
    }
  }
  std::printf("Manchester words of 14 bits, header 011110, at 8 kHz: 28 chips, 3.5 ms, 81 sensor lines\n");
  std::printf("%-62s %4s %6s %9s %7s %9s\n", "", "map", "lamps", "right %", "wrong", "decoded %");
  for (double snr : {20., 14., 10.}) {
    char name[100];
    vpSimulatedStripes large = full, small = nearest;
    large.snr = small.snr = snr;
    std::snprintf(name, sizeof name, "146 lines at 2048x1536, %.0f dB", snr);
    run(name, words, large, Sender::ofTheMap, lamps);
    std::snprintf(name, sizeof name, "57 lines at 800x600 nearest, %.0f dB", snr);
    run(name, words, small, Sender::ofTheMap, lamps);
  }
  vpSimulatedStripes part = full;
  part.lines = 77; // of the 81 that a word takes
  run("less than a whole word seen (77 lines)", words, part, Sender::ofTheMap, lamps);
  run("strangers: a word of the map with one bit changed", most, full, Sender::oneBitOff, lamps);
  run("strangers: any other word", words, full, Sender::anyWord, lamps);
  run("strangers: any other word, 57 lines at 800x600 nearest", words, nearest, Sender::anyWord, lamps);
  return 0;
}
