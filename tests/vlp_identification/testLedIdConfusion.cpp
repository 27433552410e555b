/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Which lamps of a map are the easiest to confuse.

#include <cmath>

#include <gtest/gtest.h>

#include "plannedLamps.h"

using namespace plannedLamps;

// Two pulses with less than an exposure between them look like one.
TEST(LedIdConfusion, TwoPulsesAndOne)
{
  const vpLedIdPlanner planner(rigOf(fullSize));
  vpModulation two = pwm(2000, 0.3);
  two.kind = vpModulation::Kind::twoPulse;
  auto errorWith = [&](const vpModulation &other, double gap) {
    two.phaseDifference = 0.15 + gap * planner.prediction.exposure() * two.frequency;
    const std::vector<vpLedIdPair> pairs = planner.confusion(mapOf({two, other}, crystal));
    return pairs.empty() ? 0 : pairs.front().error;
  };
  EXPECT_GT(errorWith(pwm(2000, 0.33), 0.5), 0.4);
  EXPECT_LT(errorWith(pwm(2100, 0.33), 0.5), 1e-6);
  EXPECT_LT(errorWith(pwm(2000, 0.9), 0.5), 1e-6);
  EXPECT_EQ(errorWith(pwm(2000, 0.33), 1.1), 0);
  vpModulation other = two;
  other.phaseDifference = 0.16;
  EXPECT_GT(errorWith(other, 0.5), 0.4);
}

TEST(LedIdConfusion, FindsThePairsThatAreNear)
{
  const vpLedIdPlanner planner(rigOf(fullSize));
  vpModulation two = pwm(2000, 0.3), word;
  two.kind = vpModulation::Kind::twoPulse;
  two.phaseDifference = 0.3;
  word.kind = vpModulation::Kind::word;
  word.bits = "01111010110010";
  word.chipRate = 8000;
  vpModulation other = word;
  other.bits = "01111010110001";
  vpLampMap map = mapOf({pwm(2000, 0.5), pwm(2002, 0.5), pwm(2000, 0.8), two, word, other}, crystal);
  const std::vector<vpLedIdPair> pairs = planner.confusion(map);
  ASSERT_EQ(pairs.size(), 4u); // three of pwm, one of words: kinds are told apart
  EXPECT_EQ(pairs[0].first, 0u);
  EXPECT_EQ(pairs[0].second, 1u);
  const double sigma =
      planner.prediction.uncertainty(pwm(2000, 0.5), planner.prediction.lines(diameter, height), crystal)
          .frequency;
  EXPECT_NEAR(pairs[0].distance, 2 / sigma, 0.01);
  EXPECT_NEAR(pairs[0].error, 0.5 * std::erfc(1 / sigma / std::sqrt(2)), 0.005);
  EXPECT_EQ(pairs.back().chips, 4); // 10 and 01 in manchester
  EXPECT_TRUE(vpLedIdPlanner::reuse(map).empty());
  map.lamps.push_back(map.lamps[1]);
  map.lamps.push_back(map.lamps[1]);
  map.lamps.back().position.x() += 3;
  const std::vector<vpLedIdReuse> shared = vpLedIdPlanner::reuse(map);
  ASSERT_EQ(shared.size(), 1u);
  EXPECT_EQ(shared[0].identifier, 1u);
  EXPECT_EQ(shared[0].apart, 0); // the first two hang in one place
}

TEST(LedIdConfusion, StripesTooLongToTellAreNotToldApart)
{
  const vpLedIdPlanner planner(rigOf(fullSize));
  const std::vector<vpLedIdPair> pairs = planner.confusion(mapOf({pwm(20, 0.5), pwm(1000, 0.5)}, crystal));
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].distance, 0);
  EXPECT_EQ(pairs[0].error, 0.5);
}

TEST(LedIdConfusion, AliasesAreNotToldApart)
{
  vpVlpRig rig = rigOf(fullSize);
  rig.shutter.exposure = 5e-6; // short: both make stripes
  const vpLedIdPlanner planner(rig);
  const double other = 2 * planner.prediction.fold() - 3000;
  const std::vector<vpLedIdPair> pairs =
      planner.confusion(mapOf({pwm(3000, 0.5), pwm(other, 0.5), pwm(5000, 0.5)}, crystal));
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(pairs[0].first, 0u);
  EXPECT_EQ(pairs[0].second, 1u);
  EXPECT_GT(pairs[0].error, 0.4);
  EXPECT_LT(pairs[1].error, 1e-3);
}
