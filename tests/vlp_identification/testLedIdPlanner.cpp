/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Planned identifiers: as far apart as stated, and told apart as often, by draws and by the real analyser.

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/vpExpectError.h"
#include "plannedLamps.h"

using namespace plannedLamps;

namespace
{
//! Share of an exposure from \e start on that falls into pulses.
double sentShare(const vpModulation &lamp, double phase, double start, double exposure)
{
  const auto integral = [&lamp](double x) {
    return std::floor(x) * *lamp.duty + std::min(x - std::floor(x), *lamp.duty);
  };
  const double from = lamp.frequency * start + phase, width = lamp.frequency * exposure;
  return (integral(from + width) - integral(from)) / width;
}

//! At most this many of \e trials where each fails with that probability, at three standard deviations.
double atMost(double probability, int trials)
{
  const double expected = probability * trials;
  return expected + 3 * std::sqrt(expected) + 1;
}
} // namespace

TEST(LedIdPlanner, SettingsAreTheRecognisers)
{
  const vpLedIdRecognizer recognizer({}, {});
  const vpLedIdPlanner planner(rigOf(fullSize));
  EXPECT_LE(planner.gate, recognizer.gate); // the other gate on the frequency is narrower now and then
  EXPECT_EQ(planner.shapeGate, recognizer.shapeGate);
  EXPECT_EQ(planner.minConfidence, recognizer.minConfidence);
  EXPECT_EQ(planner.prediction.dutyError, recognizer.dutyError);
  EXPECT_EQ(planner.prediction.phaseError, recognizer.phaseError);
}

TEST(LedIdPlanner, LinesOfALamp)
{
  const vpStripePrediction full(rigOf(fullSize)), small(rigOf(resized));
  EXPECT_NEAR(full.lines(diameter, height), 145.8, 0.1);
  EXPECT_NEAR(small.lines(diameter, height), 57, 0.1);
  EXPECT_NEAR(small.height(diameter, 57), height, 0.002);
  EXPECT_EQ(full.lines(10, 0.1), 1536); // no more than the picture has
  EXPECT_NEAR(small.lineTime(), 2.56 * 43.1e-6, 1e-9);
  EXPECT_NEAR(small.fold(), 4532, 1);
}

// reference/vlp.md: row time 50 us and known, ten standard deviations from lamp to lamp. Its 20 dB are those
// of the sinusoid's power, A^2 / 2 over sigma^2: 3 dB more here.
TEST(LedIdPlanner, BoundsOfTheLiterature)
{
  const auto identifiers = [](const std::string &name, double lines, double highest) {
    vpVlpRig rig = rigOf(name);
    rig.shutter.rowTime = 50e-6;
    vpStripePrediction prediction(rig);
    prediction.snrDb = 20 + 10 * std::log10(2);
    return (highest - 100) / (10 * prediction.sinusoidBound(lines));
  };
  EXPECT_NEAR(identifiers(fullSize, 146, 7000), 1104, 2);
  EXPECT_NEAR(identifiers(resized, 57, 3900), 380, 2);
}

TEST(LedIdPlanner, ContrastIsThatOfTheExposure)
{
  vpVlpRig rig = rigOf(fullSize);
  rig.shutter.exposure = 200e-6;
  const vpStripePrediction prediction(rig);
  const double expected[] = {0.94, 0.76, 0.50, 0.23, 0};
  for (int kHz = 1; kHz <= 5; ++kHz) {
    EXPECT_NEAR(prediction.contrast(1000 * kHz), expected[kHz - 1], 0.006) << kHz;
  }
  EXPECT_NEAR(prediction.contrast(prediction.frequencyOfContrast(0.2)), 0.2, 1e-9);
}

TEST(LedIdPlanner, EdgesHideAtSimpleFractionsOfTheRateOfLines)
{
  vpStripePrediction prediction(rigOf(resized));
  const double lines = 57, quarter = 0.25 / prediction.lineTime();
  const double there = prediction.hiddenEdges(pwm(quarter, 0.5), lines).frequency;
  const double beside = prediction.hiddenEdges(pwm(quarter - 150, 0.5), lines).frequency;
  EXPECT_GT(there, 3 * beside);
  vpStripePrediction closed(rigOf(fullSize)); // a line is exposed until the next one begins
  closed.exposureTolerance = 0;
  EXPECT_EQ(closed.hiddenEdges(pwm(5800, 0.5), 146).frequency, 0);
}

TEST(LedIdPlanner, CapacityGrowsWithLinesAndSnrAndFallsWithTheClock)
{
  vpLedIdPlanner planner(rigOf(resized));
  planner.frequencyStep = 2;
  size_t before = 0;
  for (const double lines : {20., 40., 57., 80., 120.}) {
    const std::vector<size_t> counts = planner.capacities(lines, {0, crystal, 1000, rc});
    EXPECT_GE(counts[1], before) << lines;
    EXPECT_TRUE(std::is_sorted(counts.rbegin(), counts.rend())) << lines;
    before = counts[1];
  }
  const size_t noisy = [&] {
    planner.prediction.snrDb = 10;
    return planner.capacities(57, {crystal})[0];
  }();
  planner.prediction.snrDb = 20;
  EXPECT_GT(planner.capacities(57, {crystal})[0], noisy);
}

TEST(LedIdPlanner, AClockMakesEachOfItsFrequencies)
{
  static const double clock = 16e6, hertz = 0.5e-3; // Hz; to the millihertz
  vpLedIdPlanner planner(rigOf(resized));
  const size_t any = planner.largest(57, crystal).identifiers.size();
  planner.clock = clock;
  const std::vector<vpModulation> all = planner.largest(57, crystal).identifiers;
  EXPECT_GE(all.size(), 0.97 * static_cast<double>(any));
  for (const vpModulation &lamp : all) {
    EXPECT_NEAR(lamp.frequency, clock / std::round(clock / lamp.frequency), hertz);
  }
  for (const vpModulation &lamp : planner.spread(57, crystal, 20).identifiers) {
    EXPECT_NEAR(lamp.frequency, clock / std::round(clock / lamp.frequency), hertz);
  }
  vpWordScheme format;
  format.chipRate = 7777;
  EXPECT_NEAR(planner.words(146, format).words.at(0).chipRate, clock / std::round(clock / 7777), hertz);
}

TEST(LedIdPlanner, HoldsWhatIsAskedForOfIt)
{
  vpLedIdPlanner full(rigOf(fullSize)), small(rigOf(resized));
  full.highestFrequency = 7000;
  small.highestFrequency = 3900;
  EXPECT_GE(full.capacities(full.prediction.lines(diameter, height), {crystal})[0], 500u);
  EXPECT_GE(small.capacities(small.prediction.lines(diameter, height), {crystal})[0], 150u);
}

TEST(LedIdPlanner, IdentifiersAreAsFarApartAsStated)
{
  const vpLedIdPlanner planner(rigOf(resized));
  const double lines = planner.prediction.lines(diameter, height);
  for (const double ppm : {crystal, rc}) {
    const vpLedIdPlan plan = planner.largest(lines, ppm);
    EXPECT_LE(plan.error, planner.maxError);
    EXPECT_GE(plan.acceptance, planner.minAcceptance);
    EXPECT_GE(plan.separation, planner.neededDistance(0.9) - 1e-6);
    double nearest = INFINITY;
    for (const vpLedIdPair &pair : planner.confusion(mapOf(plan.identifiers, ppm))) {
      nearest = std::min(nearest, pair.distance);
      EXPECT_LE(pair.error, planner.maxError);
    }
    EXPECT_NEAR(nearest, plan.separation, 0.01 * nearest); // of lamps at 1.5 m, less a rounding of lines
    for (const vpModulation &lamp : plan.identifiers) {
      EXPECT_GE(lamp.frequency, 500);
      EXPECT_LE(lamp.frequency, 0.9 * planner.prediction.fold());
      EXPECT_LE(lamp.frequency * planner.prediction.exposure(), std::min(*lamp.duty, 1 - *lamp.duty) + 1e-9);
    }
  }
}

//! Where sigma peaks between the frequencies at which it is looked at: 250 lines of this rig.
TEST(LedIdPlanner, WhatIsNotToldApartIsLeftOut)
{
  const vpLedIdPlanner planner(rigOf(resized));
  const vpLedIdPlan fewer = planner.largest(230, crystal), plan = planner.largest(250, crystal);
  EXPECT_LE(plan.error, planner.maxError);
  EXPECT_GE(plan.acceptance, planner.minAcceptance);
  EXPECT_GT(plan.identifiers.size(), fewer.identifiers.size());
}

TEST(LedIdPlanner, FewerLampsAreFartherApart)
{
  const vpLedIdPlanner planner(rigOf(resized));
  double before = INFINITY;
  for (const size_t count : {2u, 10u, 150u}) {
    const vpLedIdPlan plan = planner.spread(57, crystal, count);
    EXPECT_EQ(plan.identifiers.size(), count);
    EXPECT_LE(plan.separation, before);
    EXPECT_LE(plan.error, planner.maxError);
    before = plan.separation;
  }
  EXPECT_GT(planner.spread(57, crystal, 10).separation, 50);
  EXPECT_LT(planner.spread(57, crystal, 100000).identifiers.size(), 100000u);
}

TEST(LedIdPlannerStatistics, RecogniserErrsNoMoreThanStated)
{
  const vpVlpRig rig = rigOf(resized);
  vpLedIdPlanner planner(rig);
  planner.duties = {0.5, 0.8};
  const vpLedIdPlan plan = planner.largest(57, crystal);
  const vpLampMap map = mapOf(plan.identifiers, crystal);
  const vpLedIdRecognizer recognizer(map, rig.shutter);
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  const int trials = 15000;
  int wrong = 0, refused = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const vpLamp &lamp = map.lamps[generator() % map.lamps.size()];
    const double f = lamp.modulation.frequency;
    const vpStripeUncertainty sigma = planner.prediction.together(
        lamp.modulation, 57, crystal, planner.prediction.shapeSigma(lamp.modulation, 57));
    const double others = std::hypot(f * rig.shutter.rowTimeSigma / rig.shutter.rowTime, 1e-6 * crystal * f);
    vpLampObservation seen;
    seen.features.signal = vpStripeFeatures::Signal::pwm;
    seen.features.frequency = f + sigma.frequency * normal(generator);
    seen.features.frequencySigma = std::sqrt(sigma.frequency * sigma.frequency - others * others);
    seen.features.duty = *lamp.modulation.duty + sigma.duty * normal(generator);
    seen.features.dutySigma = std::sqrt(sigma.duty * sigma.duty - std::pow(planner.prediction.dutyError, 2));
    recognizer.recognize(seen);
    refused += seen.id.empty();
    wrong += !seen.id.empty() && seen.id != lamp.id;
  }
  EXPECT_LE(wrong, atMost(plan.error, trials));
  EXPECT_LE(refused + wrong, atMost(1 - plan.acceptance, trials));
}

// From light on lines to an id, on the planned lamps of the smallest sigmas allowed: clocks, row time and
// phase are drawn, too.
TEST(LedIdPlannerStatistics, AnalyserAndRecogniserTellTheLampsApart)
{
  for (const std::string name : {fullSize, resized}) {
    const vpVlpRig rig = rigOf(name);
    vpLedIdPlanner planner(rig);
    planner.highestFrequency = name == fullSize ? 7000 : 3900;
    const double lines = planner.prediction.lines(diameter, height);
    const vpLampMap map = mapOf(planner.largest(lines, crystal).identifiers, crystal);
    const vpLedIdRecognizer recognizer(map, rig.shutter);
    const vpLineTiming timing = rig.lineTiming();
    std::mt19937_64 generator(11);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(0, 1);
    const double amplitude = 75, noise = amplitude / 10; // grey levels: 20 dB
    const int trials = 250;
    int wrong = 0, refused = 0;
    for (int trial = 0; trial < trials; ++trial) {
      const vpLamp &lamp = map.lamps[generator() % map.lamps.size()];
      vpModulation sent = lamp.modulation;
      sent.frequency *= 1 + 1e-6 * crystal * normal(generator);
      const double slower = 1 + rig.shutter.rowTimeSigma / rig.shutter.rowTime * normal(generator);
      const double phase = uniform(generator);
      const auto first = static_cast<unsigned int>(generator() % (timing.lines() - 200));
      vpStripeProfile profile;
      profile.exposure = timing.exposure();
      for (unsigned int i = first; i < first + static_cast<unsigned int>(lines); ++i) {
        const double start = slower * timing.middle(i) - profile.exposure / 2;
        profile.time.push_back(timing.middle(i));
        profile.light.push_back(2 * amplitude * sentShare(sent, phase, start, profile.exposure) +
                                noise * normal(generator));
        profile.sigma.push_back(noise);
      }
      vpStripeAnalyzer analyzer;
      analyzer.searchTwoPulses = false;
      vpLampObservation seen;
      seen.features = analyzer.analyze(profile);
      recognizer.recognize(seen);
      refused += seen.id.empty();
      wrong += !seen.id.empty() && seen.id != lamp.id;
    }
    EXPECT_LE(wrong, atMost(planner.maxError, trials)) << name;
    EXPECT_LE(refused + wrong, atMost(1 - planner.minAcceptance, trials)) << name;
  }
}

TEST(LedIdPlanner, WordsHaveOneBeginningAndDifferHoweverTurned)
{
  const vpLedIdPlanner planner(rigOf(fullSize));
  vpWordScheme format;
  for (const unsigned int apart : {2u, 4u}) {
    format.minDistance = apart;
    const vpWordPlan plan = planner.words(146, format);
    ASSERT_EQ(plan.refusal, "");
    EXPECT_GE(plan.distance, apart);
    EXPECT_LT(plan.error, 1e-6);
    EXPECT_EQ(plan.words.size(), apart == 2 ? 228u : plan.words.size());
    const std::string header = "011010101001"; // 011110 in manchester
    for (const vpModulation &word : plan.words) {
      const std::string twice = word.chips() + word.chips();
      size_t beginnings = 0;
      for (size_t at = 0; at < word.chips().size(); ++at) {
        beginnings += twice.compare(at, header.size(), header) == 0;
      }
      EXPECT_EQ(beginnings, 1u) << word.bits;
      for (const vpModulation &other : plan.words) {
        EXPECT_EQ(word.sameSignal(other), word.bits == other.bits) << word.bits << " " << other.bits;
      }
    }
  }
  EXPECT_NE(planner.words(60, vpWordScheme()).refusal.find("the smallest lamp has 60"), std::string::npos);
  format.chipRate = 30000;
  EXPECT_FALSE(planner.words(146, format).refusal.empty());
}

TEST(LedIdPlanner, BadSettingsAreRefused)
{
  vpLedIdPlanner planner(rigOf(fullSize));
  planner.maxError = 0;
  vpExpectError([&] { planner.largest(146, crystal); }, {"error: 0", "expected a probability"});
  planner.maxError = 1e-3;
  planner.duties = {0.5, 1};
  vpExpectError([&] { planner.spread(146, crystal, 3); }, {"duties: 1", "between 0 and 1"});
  planner.duties.clear();
  vpExpectError([&] { planner.capacities(146, {crystal}); }, {"duties: number of them: 0"});
  planner.duties = {0.5};
  planner.clock = -1;
  vpExpectError([&] { planner.spread(146, crystal, 3); }, {"clock: -1", "expected a number of Hz"});
  planner.clock = 0;
  vpWordScheme format;
  format.bits = 6;
  vpExpectError([&] { planner.words(146, format); }, {"bits: 6, expected 7 to 18"});
  format.header = "012";
  vpExpectError([&] { planner.words(146, format); }, {"header: \"012\", expected"});
  vpExpectError([&] { planner.prediction.lines(0, 1); }, {"size of the lamp (m): 0"});
  vpLampMap map = mapOf({pwm(1000, 0.5), pwm(1100, 0.5)}, crystal);
  map.lamps[1].size = NAN;
  vpExpectError([&] { planner.confusion(map); }, {"lamp 1: no size"});
  map.lamps[0].position.z() = 0.1;
  vpExpectError([&] { planner.confusion(map); }, {"lamp 0: -0.09 m above the camera"});
}

TEST(LedIdPlanner, NoFrequencyLeftIsAnEmptyPlan)
{
  const vpLedIdPlanner planner(rigOf(resized));
  EXPECT_TRUE(planner.largest(4, crystal).identifiers.empty()); // three stripes on four lines
  EXPECT_TRUE(planner.spread(4, crystal, 3).identifiers.empty());
  EXPECT_EQ(planner.bins(4), 0u);
}
