/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Evidence over frames: what one frame leaves open three decide, and what contradicts begins anew.

#include <cmath>
#include <random>
#include <utility>

#include <gtest/gtest.h>
#include <visp3/vlp_identification/vpLedIdEvidence.h>
#include <visp3/vlp_identification/vpLedIdRecognizer.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
using Signal = vpStripeFeatures::Signal;

vpStripeFeatures frameWith(double frequency, double sigma, double duty = 0.5, double dutySigma = 0.01)
{
  vpStripeFeatures seen;
  seen.signal = Signal::pwm;
  seen.frequency = frequency;
  seen.frequencySigma = sigma;
  seen.duty = duty;
  seen.dutySigma = dutySigma;
  return seen;
}

vpLampMap twoNeighbours(double apart)
{
  vpLampMap map;
  for (double frequency : {2000.0, 2000.0 + apart}) {
    vpLamp lamp;
    lamp.id = map.lamps.empty() ? "A" : "B";
    lamp.modulation.kind = vpModulation::Kind::pwm;
    lamp.modulation.frequency = frequency;
    lamp.oscillatorPpm = 5;
    map.lamps.push_back(lamp);
  }
  return map;
}

TEST(LedIdEvidence, ThreeFramesDecideWhatOneLeavesOpen)
{
  const double sigma = 3;
  const vpLampMap map = twoNeighbours(3 * sigma);
  vpRollingShutter shutter;
  shutter.rowTime = 40e-6;
  const vpLedIdRecognizer recognizer(map, shutter);
  std::mt19937_64 generator(4);
  std::normal_distribution<double> noise(0, sigma);
  const int tracks = 2000;
  int afterOne = 0, afterThree = 0, wrong = 0;
  for (int track = 0; track < tracks; ++track) {
    vpLedIdEvidence evidence;
    for (int frame = 1; frame <= 3; ++frame) {
      evidence.add(frameWith(2000 + noise(generator), sigma));
      vpLampObservation seen;
      seen.features = evidence.features();
      recognizer.recognize(seen);
      afterOne += frame == 1 && seen.id == "A";
      afterThree += frame == 3 && seen.id == "A";
      wrong += frame == 3 && seen.id == "B";
    }
  }
  std::cout << "neighbours 3 sigma apart: " << 100. * afterOne / tracks
            << " % have their id after one frame, " << 100. * afterThree / tracks << " % after three, "
            << wrong << " of " << tracks << " a wrong one\n";
  EXPECT_LT(afterOne, 0.8 * tracks);    // of both likelihoods 0.95 : 0.05 or better: Phi(1.5 - 0.98) = 0.70
  EXPECT_GT(afterThree, 0.93 * tracks); // sigma / sqrt(3): Phi(2.6 - 0.57) = 0.98, less the gate
  EXPECT_LE(wrong, 0.005 * tracks);     // Phi(-2.6 - 0.57) = 0.0008; 0.005 is 5 standard deviations beyond it
}

TEST(LedIdEvidence, MeanAndSigmaAreThoseOfAllFrames)
{
  vpLedIdEvidence evidence;
  EXPECT_TRUE(evidence.add(frameWith(1000, 1, 0.5, 0.02)));
  EXPECT_TRUE(evidence.add(frameWith(1003, 2, 0.52, 0.01)));
  EXPECT_EQ(evidence.frames(), 2u);
  EXPECT_NEAR(evidence.features().frequency, (4 * 1000 + 1003) / 5., 1e-9);
  EXPECT_NEAR(evidence.features().frequencySigma, std::sqrt(1 / (1 + 0.25)), 1e-12);
  EXPECT_NEAR(evidence.features().duty, (0.5 + 4 * 0.52) / 5, 1e-12);
}

TEST(LedIdEvidence, WhatFramesHideAlikeDoesNotAverageOut)
{
  const double noise = 5, hidden = 25, truth = 3800; // Hz
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  const int tracks = 1000;
  double shared = 0, independent = 0; // errors squared, in sigma
  for (int track = 0; track < tracks; ++track) {
    const double common = hidden * normal(generator);
    vpLedIdEvidence same, each;
    for (int frame = 0; frame < 30; ++frame) {
      vpStripeFeatures seen =
          frameWith(truth + common + noise * normal(generator), std::hypot(noise, hidden));
      seen.frequencyNoise = noise;
      seen.frequencyBound = seen.frequencySigma;
      same.add(seen);
      seen = frameWith(truth + noise * normal(generator), noise);
      seen.frequencyNoise = noise;
      each.add(seen);
    }
    for (const auto &[evidence, sum] : {std::pair(&same, &shared), std::pair(&each, &independent)}) {
      const vpStripeFeatures &all = evidence->features();
      *sum += std::pow((all.frequency - truth) / all.frequencySigma, 2) / tracks;
    }
    EXPECT_NEAR(same.features().frequencyBound, hidden, 1);
    EXPECT_NEAR(each.features().frequencySigma, noise / std::sqrt(30), 1e-9);
  }
  EXPECT_NEAR(shared, 1, 0.15); // 3 standard deviations of the mean of 1000 squares
  EXPECT_NEAR(independent, 1, 0.15);
}

TEST(LedIdEvidence, AnotherLampBeginsAnew)
{
  vpLedIdEvidence evidence;
  evidence.add(frameWith(1000, 1));
  evidence.add(frameWith(1001, 1));
  EXPECT_FALSE(evidence.add(frameWith(1050, 1)));
  EXPECT_EQ(evidence.frames(), 1u);
  EXPECT_EQ(evidence.features().frequency, 1050);
  EXPECT_FALSE(evidence.add(frameWith(1050, 1, 0.3)));
  vpStripeFeatures two = frameWith(1050, 1, 0.3);
  two.signal = Signal::twoPulse;
  two.phaseDifference = 0.3;
  two.phaseDifferenceSigma = 0.01;
  EXPECT_FALSE(evidence.add(two));
  EXPECT_EQ(evidence.frames(), 1u);
}

TEST(LedIdEvidence, TwoFramesTellADutyThatEachHides)
{
  // Each frame knows the frequency if it knows the duty, and the two agree about one duty only.
  auto frame = [](double slope) {
    vpStripeFeatures seen = frameWith(5807 + 0.1 * slope, 0.3 * std::abs(slope), 0.3, 0.15);
    for (double duty = 0.1; duty < 0.55; duty += 0.05) {
      seen.alongDuty.push_back({duty, 5807 + slope * (duty - 0.2), 0.5, 0});
    }
    return seen;
  };
  vpLedIdEvidence evidence;
  EXPECT_TRUE(evidence.add(frame(30)));
  EXPECT_GT(evidence.features().frequencySigma, 2);
  EXPECT_TRUE(evidence.add(frame(-40)));
  EXPECT_NEAR(evidence.features().frequency, 5807, 0.6);
  EXPECT_LT(evidence.features().frequencySigma, 0.8);
  EXPECT_NEAR(evidence.features().duty, 0.2, 0.02);
  // A third one that knows the duty leaves no other open.
  EXPECT_TRUE(evidence.add(frameWith(5807, 0.5, 0.2, 0.005)));
  EXPECT_TRUE(evidence.features().alongDuty.empty());
  EXPECT_NEAR(evidence.features().frequency, 5807, 0.5);
}

TEST(LedIdEvidence, FramesThatSayNothingChangeNothing)
{
  vpLedIdEvidence evidence;
  EXPECT_TRUE(evidence.add({}));
  EXPECT_EQ(evidence.frames(), 0u);
  evidence.add(frameWith(1000, 1));
  vpStripeFeatures whole;
  whole.signal = Signal::coded; // a word not seen whole
  EXPECT_TRUE(evidence.add(whole));
  EXPECT_TRUE(evidence.add({}));
  EXPECT_TRUE(evidence.add(frameWith(300, 400)));
  EXPECT_EQ(evidence.frames(), 1u);
  EXPECT_EQ(evidence.features().frequency, 1000);
}

TEST(LedIdEvidence, FramesThatAgreeOnAWordMakeItSurer)
{
  vpStripeFeatures word;
  word.signal = Signal::coded;
  word.chips = "11010100";
  word.chipsConfidence = 0.9;
  word.frequency = 1000;
  word.frequencySigma = 1;
  vpLedIdEvidence evidence;
  evidence.add(word);
  evidence.add(word);
  EXPECT_NEAR(evidence.features().chipsConfidence, 0.99, 1e-12);
  word.chips = "11010000";
  EXPECT_FALSE(evidence.add(word));
  EXPECT_EQ(evidence.features().chips, "11010000");
}

} // namespace
