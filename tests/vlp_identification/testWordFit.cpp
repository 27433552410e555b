/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Words read from the stripes: right, or none, with the chip rate and its honest sigma.

#include "wordProfiles.h"

#include <gtest/gtest.h>
#include <visp3/vlp_identification/vpLedDetector.h>

namespace
{

using Signal = vpStripeFeatures::Signal;

//! What a lamp is read as by who knows the format, or nothing.
vpStripeFeatures read(const SentWord &sent, std::mt19937 &random, bool known, double rateError = 0)
{
  vpStripeAnalyzer analyzer;
  analyzer.searchTwoPulses = false;
  if (known) {
    analyzer.words.push_back(sent.format());
  }
  SentWord really = sent;
  really.chipRate *= 1 + rateError;
  return analyzer.analyze(really.profile(random));
}

SentWord manchesterLamp(std::mt19937 &random)
{
  SentWord sent;
  sent.chips = manchester(random() & 255);
  return sent;
}

TEST(WordFit, ChipsAndRateOfAKnownFormat)
{
  std::mt19937 random(1);
  const SentWord sent = manchesterLamp(random);
  const vpStripeFeatures seen = read(sent, random, true);
  EXPECT_EQ(seen.signal, Signal::coded);
  EXPECT_EQ(seen.chips, sent.canonical());
  EXPECT_GT(seen.chipsConfidence, 0.999);
  EXPECT_NEAR(28 * seen.frequency, 8000, 28 * 4 * seen.frequencySigma);
  EXPECT_LT(seen.frequencySigma, 1e-3 * seen.frequency);
  EXPECT_TRUE(std::isnan(seen.duty));
  EXPECT_LT(seen.misfit, 0.02);
}

TEST(WordFitStatistics, StrangersThatDifferInOneChipAreReadAsWhatTheyAre)
{
  std::mt19937 random(2);
  for (bool known : {true, false}) {
    for (int trial = 0; trial < (known ? 30 : 8); ++trial) {
      SentWord sent = manchesterLamp(random);
      char &chip = sent.chips[random() % sent.chips.size()];
      chip = chip == '1' ? '0' : '1';
      const std::string chips = read(sent, random, known).chips;
      EXPECT_TRUE(sameSignal(chips, sent.canonical()) || (!known && chips.empty()))
          << chips << ", sent " << sent.chips;
    }
  }
}

TEST(WordFit, LessThanOneRepetitionIsRefused)
{
  std::mt19937 random(3);
  for (bool known : {true, false}) {
    for (double repetitions : {0.5, 0.8, 0.97}) {
      for (int trial = 0; trial < 8; ++trial) {
        SentWord sent = manchesterLamp(random);
        sent.lines = static_cast<int>(repetitions * 28 / sent.chipRate / SentWord::rowTime);
        const vpStripeFeatures seen = read(sent, random, known);
        EXPECT_TRUE(seen.chips.empty()) << repetitions;
        EXPECT_EQ(seen.chipsConfidence, 0);
        EXPECT_TRUE(seen.signal != Signal::coded || std::isnan(seen.frequency));
      }
    }
  }
}

TEST(WordFit, ALittleMoreThanOneRepetitionOfAKnownFormatWillDo)
{
  std::mt19937 random(6);
  for (int trial = 0; trial < 20; ++trial) {
    SentWord sent = manchesterLamp(random);
    sent.lines = static_cast<int>(1.05 * 28 / sent.chipRate / SentWord::rowTime);
    EXPECT_EQ(read(sent, random, true).chips, sent.canonical());
  }
}

TEST(WordFit, DetectorTakesEachFormatOfTheMapOnce)
{
  vpLampMap map;
  for (double rate : {8000.0, 8000.0, 5000.0}) {
    vpLamp lamp;
    lamp.modulation.kind = vpModulation::Kind::word;
    lamp.modulation.bits = rate == 8000 ? "01111010110010" : "01010111101100";
    lamp.modulation.code = rate == 8000 ? vpModulation::Code::manchester : vpModulation::Code::ook;
    lamp.modulation.chipRate = rate;
    lamp.oscillatorPpm = map.lamps.empty() ? 50 : 10000;
    map.lamps.push_back(lamp);
  }
  vpVlpRig rig;
  rig.width = rig.height = 100;
  rig.camera.initPersProjWithoutDistortion(100, 100, 50, 50);
  rig.shutter.rowTime = rig.shutter.exposure = SentWord::rowTime;
  rig.shutter.rowTimeSigma = 0;
  const std::vector<vpWordFormat> words = vpLedDetector(rig, map).stripeAnalyzer.words;
  ASSERT_EQ(words.size(), 2u);
  EXPECT_EQ(words[0].chips, 28u);
  EXPECT_EQ(words[0].chipRate, 8000);
  EXPECT_NEAR(words[0].tolerance, 0.01, 1e-9); // of the less certain clock
  EXPECT_EQ(words[1].chips, 14u);
  EXPECT_EQ(words[1].chipRate, 5000);
}

TEST(WordFit, PlainPulsesStayPwmWhateverWordsTheMapHas)
{
  std::mt19937 random(4);
  for (int trial = 0; trial < 40; ++trial) {
    SentWord sent; // one pulse a period, in hundredths
    const int duty = 25 + static_cast<int>(random() % 50);
    sent.chips =
        std::string(static_cast<size_t>(duty), '1') + std::string(static_cast<size_t>(100 - duty), '0');
    const double frequency = 1000 + static_cast<double>(random() % 4000);
    sent.chipRate = 100 * frequency;
    sent.saturation = trial % 2 == 0 ? 1 : 0.7;
    vpStripeAnalyzer analyzer;
    analyzer.words = {{28, 8000, 1e-4}, {14, 5000, 1e-4}};
    const vpStripeFeatures seen = analyzer.analyze(sent.profile(random));
    EXPECT_EQ(seen.signal, Signal::pwm) << frequency << " Hz, " << duty << " %";
    EXPECT_NEAR(seen.frequency, frequency, 0.01 * frequency);
  }
}

struct Case {
  const char *name;
  SentWord sent;       // without its chips
  double known, blind; // least share read right
  double rateError = 0;
  int onOffBits = 0; // after header 01010; 0: Manchester
};

std::vector<Case> cases()
{
  std::vector<Case> all;
  auto add = [&all](const char *name, double known, double blind) -> Case & {
    all.push_back({name, {}, known, blind});
    return all.back();
  };
  auto resized = [](SentWord &sent) {
    sent.lines = 57;
    sent.step = 2.56;
  };
  add("146 lines, 20 dB", 0.995, 0.7);
  add("146 lines, 14 dB", 0.95, 0.7);
  add("146 lines, 10 dB", 0.4, 0);
  for (double decibel : {20.0, 14.0, 10.0}) {
    Case &c = add(decibel == 20   ? "57 of them, 20 dB"
                  : decibel == 14 ? "57 of them, 14 dB"
                                  : "57 of them, 10 dB",
                  decibel == 20 ? 0.95 : 0, decibel == 20 ? 0.7 : 0);
    c.sent.decibel = decibel;
    resized(c.sent);
  }
  all[1].sent.decibel = 14;
  all[2].sent.decibel = 10;
  add("chip rate 1 % too high", 0.99, 0.7).rateError = 0.01;
  Case &slow = add("57 of them, chip rate 1 % too low", 0.9, 0.7);
  slow.rateError = -0.01;
  resized(slow.sent);
  add("exposure 100 us", 0.99, 0.7).sent.exposure = 100e-6;
  Case &misstated = add("exposure 100 us, stated as 43", 0.99, 0.7);
  misstated.sent.exposure = 100e-6;
  misstated.sent.statedExposure = 43e-6;
  add("globe, dimmer by 3 at its rim", 0.99, 0.7).sent.rim = 3;
  Case &saturated = add("exposure 100 us, saturated at 0.7", 0.99, 0.7);
  saturated.sent.exposure = 100e-6;
  saturated.sent.saturation = 0.7;
  Case &quantised = add("30 grey levels, quantised", 0.99, 0.7);
  quantised.sent.amplitude = 30;
  quantised.sent.quantised = true;
  add("read out from the last line", 0.99, 0.7).sent.reversed = true;
  Case &header = add("on-off, header and 9 bits, 5 kHz", 0.95, 0.5);
  header.onOffBits = 9;
  header.sent.chipRate = 5000;
  add("on-off, header and 19 bits", 0.99, 0.7).onOffBits = 19;
  return all;
}

// What no pulses explain may be a word all the same.
TEST(WordFit, WordsUnlikeAnyPulses)
{
  const std::vector<std::pair<std::string, double>> words = {
      {"1001010000001", 3486}, {"0000010011010", 3363}, {"00100110000", 4010}};
  std::mt19937 random(7);
  for (const auto &[chips, rate] : words) {
    SentWord sent;
    sent.chips = chips;
    sent.chipRate = rate;
    sent.decibel = 25;
    sent.rim = 3;
    int coded = 0;
    for (int trial = 0; trial < 15; ++trial) {
      coded += read(sent, random, true, 0).signal == vpStripeFeatures::Signal::coded;
    }
    EXPECT_EQ(coded, 15) << chips;
  }
}

TEST(WordFitStatistics, KnownAndUnknownFormats)
{
  static const int trials = 30, blindTrials = 10;
  for (bool known : {true, false}) {
    std::cout << (known ? "Format known from the map:\n" : "Format unknown:\n");
    for (const Case &c : cases()) {
      std::mt19937 random(5);
      WordScore score;
      for (int trial = 0; trial < (known ? trials : blindTrials); ++trial) {
        SentWord sent = c.sent;
        sent.chips = c.onOffBits > 0 ? onOff(random(), c.onOffBits) : manchester(random() & 255);
        const vpStripeFeatures seen = read(sent, random, known, c.rateError);
        sent.chipRate *= 1 + c.rateError;
        score.add(sent, seen);
      }
      score.print(c.name);
      EXPECT_GE(score.rightShare(), known ? c.known : c.blind) << c.name;
      EXPECT_LE(score.wrong, c.sent.decibel < 20 ? score.trials() / 50 : 0) << c.name;
      EXPECT_LT(score.worstFrequency, 5) << c.name;
    }
  }
}

} // namespace
