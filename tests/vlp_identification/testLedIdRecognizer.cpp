/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Recognition: the right lamp where one fits, none where none does or two do, every uncertainty in it.

#include <gtest/gtest.h>
#include <visp3/vlp_identification/vpLedIdRecognizer.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{

vpLamp lamp(const std::string &id, double frequency)
{
  vpLamp lamp;
  lamp.id = id;
  lamp.modulation.kind = vpModulation::Kind::pwm;
  lamp.modulation.frequency = frequency;
  return lamp;
}

vpLamp lamp(const std::string &id, double frequency, double duty)
{
  vpLamp with = lamp(id, frequency);
  with.modulation.duty = duty;
  return with;
}

vpLampObservation stripes(double frequency, double sigma, double duty = 0.5)
{
  vpLampObservation observation;
  observation.features.signal = vpStripeFeatures::Signal::pwm;
  observation.features.frequency = frequency;
  observation.features.frequencySigma = sigma;
  observation.features.duty = duty;
  observation.features.dutySigma = 0.01;
  return observation;
}

vpRollingShutter shutter(double relativeSigma)
{
  vpRollingShutter shutter;
  shutter.rowTime = 40e-6;
  shutter.rowTimeSigma = relativeSigma * shutter.rowTime;
  shutter.exposure = 40e-6;
  return shutter;
}

vpLampObservation recognized(const vpLampMap &map, vpLampObservation observation, double rowTimeSigma = 1e-4)
{
  vpLedIdRecognizer(map, shutter(rowTimeSigma)).recognize(observation);
  return observation;
}

TEST(LedIdRecognizer, NearestLampThatFits)
{
  const vpLampMap map{{lamp("A", 2000), lamp("B", 2100), lamp("C", 3000)}};
  const vpLampObservation seen = recognized(map, stripes(2098, 3));
  EXPECT_EQ(seen.id, "B");
  EXPECT_GT(seen.confidence, 0.99);
  EXPECT_TRUE(seen.remark.empty());
}

TEST(LedIdRecognizer, StripesThatExplainHalfOfTheLightNameNoLamp)
{
  const vpLampMap map{{lamp("A", 2000), lamp("B", 2100), lamp("C", 3000)}};
  vpLampObservation seen = stripes(2098, 3);
  seen.blinking = 0.5;
  seen = recognized(map, seen);
  EXPECT_TRUE(seen.id.empty());
  EXPECT_TRUE(seen.candidates.empty());
  EXPECT_FALSE(seen.remark.empty());
}

TEST(LedIdRecognizer, NoLampFits)
{
  const vpLampMap map{{lamp("A", 2000), lamp("B", 2100)}};
  const vpLampObservation seen = recognized(map, stripes(2050, 3));
  EXPECT_TRUE(seen.id.empty());
  EXPECT_GT(seen.confidence, 0.9); // of being none of them
  EXPECT_FALSE(seen.remark.empty());
}

TEST(LedIdRecognizer, AWindowIsNoDisc)
{
  vpLampMap map{{lamp("disc", 2000), lamp("square", 3000), lamp("unmeasured", 4000)}};
  map.lamps[0].size = map.lamps[1].size = 0.2;
  map.lamps[1].shape = vpLamp::Shape::square;
  auto seen = [&map](double frequency, vpLampOutline::Shape shape, double otherShape, bool cut = false) {
    vpLampObservation observation = stripes(frequency, 3);
    observation.outline.shape = shape;
    observation.outline.otherShape = otherShape;
    observation.cut = cut;
    return recognized(map, observation);
  };
  const auto ellipse = vpLampOutline::Shape::ellipse, sides = vpLampOutline::Shape::quadrilateral;
  EXPECT_EQ(seen(2000, ellipse, 0).id, "disc");
  EXPECT_EQ(seen(2000, sides, 0).id, "");
  EXPECT_EQ(seen(2000, sides, 0).remark, "fits no lamp of the map of its shape");
  EXPECT_EQ(seen(3000, sides, 0).id, "square");
  EXPECT_EQ(seen(3000, ellipse, 0).id, "");
  EXPECT_EQ(seen(4000, sides, 0).id, "unmeasured");
  EXPECT_EQ(seen(2000, sides, 0.01).id, "disc") << "small lamps show no corners";
  EXPECT_EQ(seen(2000, sides, 0, true).id, "disc") << "the border has corners of its own";
}

TEST(LedIdRecognizer, TwoLampsFit)
{
  const vpLampMap map{{lamp("A", 2000), lamp("B", 2010)}};
  const vpLampObservation seen = recognized(map, stripes(2005, 10));
  EXPECT_TRUE(seen.id.empty());
  EXPECT_NE(seen.remark.find("2 identifiers"), std::string::npos) << seen.remark;
}

TEST(LedIdRecognizer, DutyTellsLampsOfOneFrequencyApart)
{
  const vpLampMap map{{lamp("A", 2000, 0.3), lamp("B", 2000, 0.7)}};
  EXPECT_EQ(recognized(map, stripes(2001, 3, 0.31)).id, "A");
  EXPECT_EQ(recognized(map, stripes(2001, 3, 0.69)).id, "B");
  EXPECT_TRUE(recognized(map, stripes(2001, 3, 0.5)).id.empty());
}

TEST(LedIdRecognizer, DutyThatNobodyMeasuredTakesNoPart)
{
  const vpLampMap map{{lamp("A", 2000), lamp("B", 3000)}};
  EXPECT_EQ(recognized(map, stripes(2001, 3, 0.1)).id, "A");
}

TEST(LedIdRecognizer, RowTimeAndOscillatorWidenTheMatch)
{
  vpLampMap map{{lamp("A", 2000), lamp("B", 3000)}};
  EXPECT_TRUE(recognized(map, stripes(2030, 2)).id.empty());
  EXPECT_EQ(recognized(map, stripes(2030, 2), 0.01).id, "A"); // row time uncertain by 1 %
  map.lamps[0].oscillatorPpm = 10000;
  EXPECT_EQ(recognized(map, stripes(2030, 2)).id, "A");
}

TEST(LedIdRecognizer, UncertainFrequencyIsNoId)
{
  const vpLampMap map{{lamp("A", 2000)}};
  EXPECT_TRUE(recognized(map, stripes(2000, 400)).id.empty());
}

//! Lamp A of 2000 Hz in a map that has two hundred others.
vpLampMap crowdedMap()
{
  vpLampMap map{{lamp("A", 2000)}};
  for (int i = 0; i < 200; ++i) {
    map.lamps.push_back(lamp("B" + std::to_string(i), 2500 + 20 * i));
  }
  return map;
}

// Where edges hide, a wide posterior must not let strangers in that would be refused elsewhere.
TEST(LedIdRecognizer, GateNoWiderThanEdgesAnywhereLeave)
{
  const vpLampMap map = crowdedMap();
  vpLampObservation seen = stripes(2007, 3);
  EXPECT_EQ(recognized(map, seen).id, "A");
  seen.features.frequencyBound = 2;
  EXPECT_TRUE(recognized(map, seen).id.empty());
  seen.features.frequency = 2004;
  EXPECT_EQ(recognized(map, seen).id, "A");
}

TEST(LedIdRecognizer, HiddenEdgesNameNoLamp)
{
  vpLampObservation seen = stripes(2000, 9);
  seen.features.frequencyBound = 2;
  seen = recognized(crowdedMap(), seen);
  EXPECT_TRUE(seen.id.empty());
  EXPECT_NE(seen.remark.find("hide"), std::string::npos);
}

TEST(LedIdRecognizer, HiddenEdgesOfALoneLampNameIt)
{
  vpLampObservation seen = stripes(2007, 9);
  seen.features.frequencyBound = 2;
  EXPECT_EQ(recognized({{lamp("A", 2000)}}, seen).id, "A"); // no unknown lamp is likely to be so near
  seen.features.frequency = 2030;
  EXPECT_TRUE(recognized({{lamp("A", 2000)}}, seen).id.empty());
}

TEST(LedIdRecognizer, StatedDutySaysWhichFrequencyOfARidge)
{
  // The stripes are those of any duty, each with a frequency of its own.
  vpLampObservation seen = stripes(2003, 4, 0.4);
  seen.features.dutySigma = 0.1;
  for (double duty = 0.2; duty < 0.62; duty += 0.05) {
    seen.features.alongDuty.push_back({duty, 2000 + 50 * (duty - 0.2), 1, 0});
  }
  for (double duty : {0.25, 0.4, 0.55}) {
    const double there = 2000 + 50 * (duty - 0.2);
    EXPECT_EQ(recognized({{lamp("A", there, duty)}}, seen, 1e-6).id, "A") << duty;
    EXPECT_TRUE(recognized({{lamp("A", there + 8, duty)}}, seen, 1e-6).id.empty()) << duty;
  }
  EXPECT_TRUE(recognized({{lamp("A", 2030, 0.8)}}, seen, 1e-6).id.empty()); // no such slice
  EXPECT_EQ(recognized({{lamp("A", 2003)}}, seen, 1e-6).id, "A");
}

TEST(LedIdRecognizer, PhaseDifferenceTellsTwoPulseLampsApart)
{
  vpLampMap map{{lamp("A", 1500, 0.3), lamp("B", 1500, 0.3), lamp("C", 1500, 0.3)}};
  map.lamps[0].modulation.kind = map.lamps[1].modulation.kind = vpModulation::Kind::twoPulse;
  map.lamps[0].modulation.phaseDifference = 0.25;
  map.lamps[1].modulation.phaseDifference = 0.35;
  vpLampObservation seen = stripes(1501, 2, 0.3);
  EXPECT_EQ(recognized(map, seen).id, "C");
  seen.features.signal = vpStripeFeatures::Signal::twoPulse;
  seen.features.phaseDifference = 0.345;
  seen.features.phaseDifferenceSigma = 0.003;
  EXPECT_EQ(recognized(map, seen).id, "B");
  seen.features.phaseDifference = 0.30;
  EXPECT_TRUE(recognized(map, seen).id.empty());
}

// Of 25 us of dark between them a line of 40 us shows nothing.
TEST(LedIdRecognizer, TwoPulsesWithoutAGapCompeteForPlainStripes)
{
  vpLampMap map{{lamp("A", 2000, 0.4), lamp("B", 2000, 0.3)}};
  vpModulation &two = map.lamps[1].modulation;
  two.kind = vpModulation::Kind::twoPulse;
  two.phaseDifference = 0.2;
  vpRollingShutter exposed = shutter(1e-5);
  exposed.exposure = 40e-6;
  auto idOf = [&](double duty) {
    vpLampObservation seen = stripes(2000, 0.5, duty);
    vpLedIdRecognizer(map, exposed).recognize(seen);
    return seen.id;
  };
  EXPECT_EQ(idOf(0.4), "");
  EXPECT_EQ(idOf(0.9), ""); // neither
  map.lamps[0].modulation.duty = 0.7;
  EXPECT_EQ(idOf(0.7), "A");
  EXPECT_EQ(idOf(0.35), "B");
  exposed.exposure = 20e-6; // the gap shows
  map.lamps[0].modulation.duty = 0.4;
  EXPECT_EQ(idOf(0.4), "A");
  EXPECT_EQ(idOf(0.3), "A"); // within four standard deviations
}

TEST(LedIdRecognizer, CodedAndSteadyRegionsHaveNoId)
{
  const vpLampMap map{{lamp("A", 2000)}};
  vpLampObservation seen = stripes(2000, 2);
  seen.features.signal = vpStripeFeatures::Signal::coded;
  EXPECT_TRUE(recognized(map, seen).id.empty());
  EXPECT_NE(recognized(map, seen).remark.find("nor a word"), std::string::npos);
  seen.features.signal = vpStripeFeatures::Signal::unmodulated;
  EXPECT_TRUE(recognized(map, seen).id.empty());
}

TEST(LedIdRecognizer, LampsInViewCalibrateTheRowTimeForEachOther)
{
  // Row time 0.5 % too short, known to 1 %: alone each lamp could be any of its neighbours.
  vpLampMap map;
  for (int k = 0; k < 30; ++k) {
    map.lamps.push_back(lamp(std::to_string(k), 1000 * std::pow(1.0037, k * (k + 1) / 2))); // uneven steps
  }
  const double seenFaster = 1.005;
  std::vector<vpLampObservation> seen;
  for (size_t k : {3, 10, 17, 24}) {
    seen.push_back(stripes(seenFaster * map.lamps[k].modulation.frequency, 0.7));
  }
  const vpLedIdRecognizer recognizer(map, shutter(0.01));
  vpLampObservation alone = seen.front();
  recognizer.recognize(alone);
  EXPECT_TRUE(alone.id.empty()) << alone.id;
  EXPECT_GT(alone.candidates.size(), 1u);
  const vpRowTimeError error = recognizer.recognize(seen);
  EXPECT_EQ(seen[0].id, "3");
  EXPECT_EQ(seen[1].id, "10");
  EXPECT_EQ(seen[2].id, "17");
  EXPECT_EQ(seen[3].id, "24");
  EXPECT_NEAR(error.mean, -0.005, 4 * error.sigma); // lines longer than stated make slower stripes
  EXPECT_LT(error.sigma, 5e-4);
}

TEST(LedIdRecognizer, ALampFartherOffThanItSaysHardlyShiftsTheRowTime)
{
  const vpLampMap map{{lamp("A", 2000), lamp("B", 2500), lamp("C", 3100), lamp("D", 3700)}};
  const double sigma = 0.7, off = 4 * sigma; // Hz
  std::vector<vpLampObservation> seen{stripes(2000, sigma), stripes(2500 + off, sigma), stripes(3100, sigma),
                                      stripes(3700, sigma)};
  const vpRowTimeError error = vpLedIdRecognizer(map, shutter(0.01)).recognize(seen);
  EXPECT_LT(std::abs(error.mean), 0.1 * off / 2500) << "a weighted mean shifts by 0.18 of it";
  EXPECT_EQ(seen[0].id, "A");
  EXPECT_EQ(seen[2].id, "C");
  EXPECT_EQ(seen[3].id, "D");
}

TEST(LedIdRecognizer, AStrangerAmongLampsIsNoLampOfTheMap)
{
  const vpLampMap map{{lamp("A", 2000), lamp("B", 2500), lamp("C", 3100)}};
  std::vector<vpLampObservation> seen{stripes(2000, 0.7), stripes(2500, 0.7), stripes(3120, 0.7)};
  vpLedIdRecognizer(map, shutter(0.01)).recognize(seen);
  EXPECT_EQ(seen[0].id, "A");
  EXPECT_EQ(seen[1].id, "B");
  EXPECT_TRUE(seen[2].id.empty()) << "0.65 % off, where the others leave the row time 0.03 %";
  vpLampObservation alone = stripes(3120, 0.7);
  vpLedIdRecognizer(map, shutter(0.01)).recognize(alone);
  EXPECT_EQ(alone.id, "C");
}

TEST(LedIdRecognizer, LampsThatBlinkAlikeAreLeftToGeometry)
{
  const vpLampMap map{{lamp("A", 2000), lamp("B", 3000), lamp("A2", 2000)}};
  const vpLampObservation seen = recognized(map, stripes(2001, 2));
  EXPECT_TRUE(seen.id.empty());
  ASSERT_EQ(seen.candidates.size(), 1u);
  EXPECT_EQ(seen.candidates[0].identifier, 0u);
  EXPECT_GT(seen.candidates[0].probability, 0.99);
  EXPECT_NE(seen.remark.find("alike"), std::string::npos) << seen.remark;
}

vpLampObservation coded(const std::string &chips, double repetition)
{
  vpLampObservation observation;
  observation.features.signal = vpStripeFeatures::Signal::coded;
  observation.features.chips = chips;
  observation.features.chipsConfidence = 0.9999;
  observation.features.frequency = repetition;
  observation.features.frequencySigma = 1e-4 * repetition;
  return observation;
}

TEST(LedIdRecognizer, WordsMatchWhereverTheyBegin)
{
  vpLamp word = lamp("W", 0), other = lamp("X", 0);
  for (vpLamp *of : {&word, &other}) {
    of->modulation.kind = vpModulation::Kind::word;
    of->modulation.chipRate = 8000;
    of->modulation.code = vpModulation::Code::ook;
  }
  word.modulation.bits = "01010011";
  other.modulation.bits = "01010111";
  const vpLampMap map{{word, other, lamp("A", 1000)}};
  EXPECT_EQ(recognized(map, coded("11010100", 1000)).id, "W");
  EXPECT_EQ(recognized(map, coded("11101010", 1000)).id, "X");
  EXPECT_TRUE(recognized(map, coded("11010010", 1000)).id.empty());  // another word
  EXPECT_TRUE(recognized(map, coded("11010100", 1005)).id.empty());  // another rate
  EXPECT_TRUE(recognized(map, coded("1101010011", 800)).id.empty()); // a longer one
  EXPECT_TRUE(recognized(map, coded("", 1000)).id.empty());          // not known
}

TEST(LedIdRecognizer, EmptyMapKnowsNobody)
{
  EXPECT_TRUE(recognized({}, stripes(2000, 2)).id.empty());
}

} // namespace
