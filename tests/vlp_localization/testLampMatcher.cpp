/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Lamps that share an identifier, and reflections, are told apart by geometry: right where one place explains
// the picture, a refusal where several do, and never wrong.

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/vpExpectError.h"
#include "vlp_localization/reuseScene.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
using lampScene::degree;
using reuseScene::Ceiling;
using reuseScene::Errors;
using reuseScene::View;
using testing::HasSubstr;
using Outcome = vpLampMatch::Outcome;

vpLampMap laidMap(size_t lamps, double spacing, double jitter, size_t identifiers)
{
  const std::vector<Eigen::Vector3d> positions = vpLampGrid(lamps, spacing, jitter, 3);
  vpIdentifierLayout layout;
  layout.viewRadius = reuseScene::viewRadius;
  return reuseScene::mapOf(positions, layout.lay(positions, identifiers).identifiers);
}

//! Lamps of their own identifier each.
vpLampMap ownMap(size_t lamps, double spacing, double jitter = 0)
{
  return laidMap(lamps, spacing, jitter, lamps);
}

//! Two rooms of \e lamps each, alike in all, \e apart (m) in x.
vpLampMap twoRooms(size_t lamps, double spacing, double apart)
{
  vpLampMap map = ownMap(lamps, spacing, 0.2);
  for (size_t k = 0; k < lamps; ++k) {
    vpLamp lamp = map.lamps[k];
    lamp.id = "copy of " + lamp.id;
    lamp.position.x() += apart;
    map.lamps.push_back(lamp);
  }
  return map;
}

vpLampMatcher matcherOf(const Ceiling &ceiling)
{
  return vpLampMatcher(reuseScene::rig(), ceiling.map);
}

vpPoseHint hintAt(const vpHomogeneousMatrix &wMb, double reach = 0.3, double turn = 0.3)
{
  vpPoseHint hint;
  hint.wMb = wMb;
  hint.reach = reach;
  hint.turn = turn;
  return hint;
}

vpHomogeneousMatrix base(double x, double y, double yaw)
{
  return lampScene::frame(x, y, 0, 0, 0, yaw);
}

//! A view of \e lamps lamps or more.
View viewOf(Ceiling &ceiling, size_t lamps)
{
  View view;
  do {
    view = ceiling.look(ceiling.randomBase());
  } while (view.observations.size() < lamps);
  return view;
}

struct Tally {
  int unique = 0, wrong = 0, views = 0;

  void add(const vpLampMatch &match, const View &view)
  {
    ++views;
    unique += match.outcome == Outcome::unique;
    wrong += reuseScene::wrong(match, view);
    EXPECT_EQ(match.refusal.empty(), match.outcome == Outcome::unique);
    EXPECT_EQ(match.refusal.find('\n'), std::string::npos);
  }
};

TEST(LampMatcher, ColdStartUnderTwelveIdentifiersOnManyLamps)
{
  Errors errors;
  errors.missing = errors.reflections = 0.02;
  for (double jitter : {0.0, 0.2}) {
    Ceiling ceiling(laidMap(144, 1.8, jitter, 12), errors, 5);
    const vpLampMatcher matcher = matcherOf(ceiling);
    Tally tally;
    while (tally.views < 400) {
      const View view = viewOf(ceiling, 3);
      tally.add(matcher.match(view.observations, view.all()), view);
    }
    EXPECT_EQ(tally.wrong, 0) << jitter;
    EXPECT_GE(tally.unique, 0.95 * tally.views) << jitter;
  }
}

TEST(LampMatcher, IsNeverWrongUnderIdentifiersLaidAtRandomAndCoarseErrors)
{
  Errors errors;
  errors.missing = errors.reflections = 0.1;
  errors.survey = 0.03;
  errors.tilt = 0.4 * degree;
  lampScene::Random random(17);
  const std::vector<Eigen::Vector3d> positions = vpLampGrid(400, 1.8, 0, 3);
  std::vector<size_t> identifiers(positions.size());
  for (size_t &identifier : identifiers) {
    identifier = static_cast<size_t>(random.uniform(0, 10));
  }
  Ceiling ceiling(reuseScene::mapOf(positions, identifiers), errors, 23);
  const vpLampMatcher matcher = matcherOf(ceiling);
  Tally tally;
  while (tally.views < 500) {
    const View view = ceiling.look(ceiling.randomBase());
    tally.add(matcher.match(view.observations, view.all()), view);
  }
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GT(tally.unique, tally.views / 3);
}

TEST(LampMatcher, SaysWhereTheRobotIs)
{
  Ceiling ceiling(laidMap(100, 1.5, 0.2, 20), Errors(), 31);
  const View view = viewOf(ceiling, 5);
  const vpLampMatch match = matcherOf(ceiling).match(view.observations, view.all());
  ASSERT_EQ(match.outcome, Outcome::unique) << match.refusal;
  const lampScene::Vector6d error = lampScene::poseError(view.wMb, match.wMb);
  EXPECT_LT(error.head<3>().norm(), 0.05);
  EXPECT_LT(error.tail<3>().norm(), 0.02);
  EXPECT_GT(match.odds, 1e6);
}

TEST(LampMatcher, LeavesOutReflectionsOfLampsWithIdsOfTheirOwn)
{
  for (bool inWall : {false, true}) {
    Ceiling ceiling(ownMap(36, 1.5), Errors(), 37);
    const vpLampMatcher matcher = matcherOf(ceiling);
    int views = 0, kept = 0, taken = 0, wrong = 0;
    while (views < 300) {
      View view = viewOf(ceiling, 3);
      view.observations.resize(3 + static_cast<size_t>(views) % (view.observations.size() - 2));
      view.truth.resize(view.observations.size());
      if (!ceiling.addReflection(view, view.truth[0], inWall)) {
        continue;
      }
      ++views;
      const vpLampMatch match = matcher.match(view.observations, view.all());
      taken += match.lamps.back() != vpLampMatch::noLamp;
      wrong += reuseScene::wrong(match, view);
      kept += match.outcome == Outcome::unique && !reuseScene::wrong(match, view);
    }
    EXPECT_LE(taken, 0.01 * views);
    EXPECT_EQ(wrong, 0);
    EXPECT_GE(kept, 0.98 * views);
  }
}

TEST(LampMatcher, LeavesOutALampAndItsReflectionThatLieTooCloseToTell)
{
  Ceiling ceiling(ownMap(36, 1.5), Errors(), 41);
  View view = viewOf(ceiling, 5);
  view.observations.push_back(view.observations[0]);
  view.observations.back().point.x() += 4; // px: 2 cm on the ceiling
  const vpLampMatch match = matcherOf(ceiling).match(view.observations, view.all());
  ASSERT_EQ(match.outcome, Outcome::unique) << match.refusal;
  EXPECT_EQ(match.lamps[0], vpLampMatch::noLamp);
  EXPECT_EQ(match.lamps.back(), vpLampMatch::noLamp);
  EXPECT_EQ(match.lamps[1], view.truth[1]);
}

TEST(LampMatcher, TwoRoomsAlikeAreAmbiguousUntilTheLastPoseDecides)
{
  const double apart = 30;
  Ceiling ceiling(twoRooms(25, 1.5, apart), Errors(), 43);
  const vpLampMatcher matcher = matcherOf(ceiling);
  for (double x : {3.0, 3.0 + apart}) {
    const View view = ceiling.look(base(x, 3.2, 0.4));
    ASSERT_GE(view.observations.size(), 4u);
    const vpLampMatch cold = matcher.match(view.observations, view.all());
    EXPECT_EQ(cold.outcome, Outcome::ambiguous);
    EXPECT_THAT(cold.refusal, HasSubstr("2 places"));
    const vpLampMatch warm = matcher.match(view.observations, view.all(), hintAt(base(x + 0.1, 3.1, 0.5)));
    EXPECT_EQ(warm.outcome, Outcome::unique) << warm.refusal;
    EXPECT_FALSE(reuseScene::wrong(warm, view));
    EXPECT_TRUE(warm.byHint);
    const vpLampMatch lost = matcher.match(view.observations, view.all(), hintAt(base(x + 2, 4.5, 0.5)));
    EXPECT_EQ(lost.outcome, Outcome::ambiguous);
  }
}

TEST(LampMatcher, LastPoseDecidesWithAReflectionInThePictureToo)
{
  Ceiling ceiling(twoRooms(25, 1.5, 30), Errors(), 47);
  View view = ceiling.look(base(33, 3.2, 0.4));
  ASSERT_TRUE(ceiling.addReflection(view, view.truth[0], false));
  const vpLampMatch match =
      matcherOf(ceiling).match(view.observations, view.all(), hintAt(base(33.1, 3.2, 0.4)));
  ASSERT_EQ(match.outcome, Outcome::unique) << match.refusal;
  EXPECT_FALSE(reuseScene::wrong(match, view));
  EXPECT_EQ(match.lamps.back(), vpLampMatch::noLamp);
}

TEST(LampMatcher, IsFoundWhereItWasCarried)
{
  Errors errors;
  errors.missing = errors.reflections = 0.05;
  Ceiling ceiling(laidMap(400, 2, 0, 20), errors, 53);
  const vpLampMatcher matcher = matcherOf(ceiling);
  Tally tally;
  while (tally.views < 500) {
    const View view = viewOf(ceiling, 3);
    const vpPoseHint elsewhere = hintAt(ceiling.randomBase(), 0.5, 0.6);
    tally.add(matcher.match(view.observations, view.all(), elsewhere), view);
  }
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GE(tally.unique, 0.9 * tally.views);
}

TEST(LampMatcher, FollowsTwoLampsFromTheLastPoseOnly)
{
  Ceiling ceiling(laidMap(400, 2, 0, 20), Errors(), 59);
  const vpLampMatcher matcher = matcherOf(ceiling);
  Tally cold, warm;
  while (cold.views < 100) {
    View view = viewOf(ceiling, 3);
    view.observations.resize(2);
    view.truth.resize(2);
    cold.add(matcher.match(view.observations, view.all()), view);
    warm.add(matcher.match(view.observations, view.all(), hintAt(view.wMb)), view);
  }
  EXPECT_EQ(cold.wrong + warm.wrong, 0);
  EXPECT_LE(cold.unique, 0.2 * cold.views);
  EXPECT_EQ(warm.unique, warm.views);
}

TEST(LampMatcher, OneOfTwoRegionsThatIsAReflectionStaysOpen)
{
  Ceiling ceiling(ownMap(25, 1.5), Errors(), 61);
  View view = viewOf(ceiling, 4);
  view.observations.resize(2);
  view.truth.resize(2);
  // The reflection mirrored at the line through the second lamp and the picture's middle: as far from it.
  vpLampObservation mirrored = view.observations[0];
  const Eigen::Vector2d other = view.observations[1].point;
  const Eigen::Vector2d across = Eigen::Rotation2Dd(0.8) * (mirrored.point - other);
  mirrored.point = other + across;
  view.observations.push_back(mirrored);
  const vpLampMatch match = matcherOf(ceiling).match(view.observations, view.all());
  EXPECT_EQ(match.outcome, Outcome::ambiguous);
}

TEST(LampMatcher, AMirroredWorldIsHardlyEverAPlaceOfTheMap)
{
  vpLampMap map = laidMap(100, 1.5, 0.3, 20);
  vpLampMap mirrored = map;
  for (vpLamp &lamp : mirrored.lamps) {
    lamp.position.x() = -lamp.position.x();
  }
  const vpLampMatcher matcher(reuseScene::rig(), map);
  const int ceilings = 20, views = 300;
  int unique = 0;
  for (unsigned int seed = 1; seed <= ceilings; ++seed) {
    Ceiling ceiling(mirrored, Errors(), seed);
    for (int k = 0; k < views; ++k) {
      const View view = viewOf(ceiling, 5);
      unique += matcher.match(view.observations, view.all()).outcome == Outcome::unique;
    }
  }
  // Rows of lamps look the same in a mirror. Were it one view in a hundred, so many came once in 50 times.
  const double expected = 0.01 * ceilings * views;
  EXPECT_LE(unique, expected + 2 * std::sqrt(expected));
}

TEST(LampMatcher, ChoosesAmongSeveralIdentifiersOfARegion)
{
  Ceiling ceiling(laidMap(225, 1.5, 0.2, 20), Errors(), 71);
  const vpLampMatcher matcher = matcherOf(ceiling);
  Tally tally;
  while (tally.views < 100) {
    View view = viewOf(ceiling, 4);
    for (vpLampObservation &lamp : view.observations) {
      const size_t right = lamp.candidates[0].identifier;
      lamp.candidates = {{(right + 1) % 20, 0.5}, {right, 0.3}, {(right + 7) % 20, 0.15}};
    }
    const vpLampMatch match = matcher.match(view.observations, view.all());
    tally.add(match, view);
    if (match.outcome == Outcome::unique) {
      EXPECT_EQ(match.probabilities[0], 0.3);
    }
  }
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GE(tally.unique, 0.95 * tally.views);
}

TEST(LampMatcher, TakesTheIdOfAnObservationWithoutCandidates)
{
  Ceiling ceiling(ownMap(25, 1.5), Errors(), 73);
  View view = viewOf(ceiling, 4);
  for (vpLampObservation &lamp : view.observations) {
    lamp.candidates.clear();
  }
  view.observations[0].id = "nobody";
  const vpLampMatch match = matcherOf(ceiling).match(view.observations, view.all());
  ASSERT_EQ(match.outcome, Outcome::unique) << match.refusal;
  EXPECT_EQ(match.lamps[0], vpLampMatch::noLamp);
  EXPECT_EQ(match.lamps[1], view.truth[1]);
}

TEST(LampMatcher, RefusesInOneLineWhatIsTooLittle)
{
  Ceiling ceiling(laidMap(100, 1.5, 0.2, 20), Errors(), 79);
  View view = viewOf(ceiling, 3);
  const vpLampMatcher matcher = matcherOf(ceiling);
  EXPECT_THAT(matcher.match({}, {}).refusal, HasSubstr("no lamp"));
  EXPECT_THAT(matcher.match(view.observations, {1}).refusal, HasSubstr("one lamp"));
  view.observations[0].point.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(matcher.match(view.observations, {0, 1}).refusal, HasSubstr("one lamp"));
  const vpLampMatcher empty(reuseScene::rig(), vpLampMap());
  EXPECT_THAT(empty.match(view.observations, view.all()).refusal, HasSubstr("no lamp"));
}

TEST(LampMatcher, GivesUpOnACeilingOfOneIdentifier)
{
  Ceiling ceiling(reuseScene::mapOf(vpLampGrid(2500, 1.2, 0, 3), std::vector<size_t>(2500, 0)), Errors(), 83);
  const View view = viewOf(ceiling, 6);
  const vpLampMatch match = matcherOf(ceiling).match(view.observations, view.all());
  EXPECT_EQ(match.outcome, Outcome::ambiguous);
  EXPECT_LE(match.hypotheses, 20001u);
}

TEST(LampMatcher, NamesASettingOutOfItsRange)
{
  Ceiling ceiling(ownMap(4, 1), Errors(), 89);
  const View view = ceiling.look(base(0.5, 0.5, 0));
  const auto expectNamed = [&](const std::string &name, const std::function<void(vpLampMatcher &)> &set) {
    vpLampMatcher matcher = matcherOf(ceiling);
    set(matcher);
    vpExpectError([&] { matcher.match(view.observations, view.all()); }, {name});
  };
  expectNamed("mapTolerance", [](vpLampMatcher &m) { m.mapTolerance = 0; });
  expectNamed("tiltTolerance", [](vpLampMatcher &m) { m.tiltTolerance = -1; });
  expectNamed("baseHeightSigma", [](vpLampMatcher &m) { m.baseHeightSigma = 0; });
  expectNamed("strangers", [](vpLampMatcher &m) { m.strangers = 0; });
  expectNamed("minOdds", [](vpLampMatcher &m) { m.minOdds = 0.5; });
  expectNamed("minShare", [](vpLampMatcher &m) { m.minShare = 2; });
  const vpLampMatcher matcher = matcherOf(ceiling);
  vpExpectError([&] { matcher.match(view.observations, {99}); }, {"usable"});
}
} // namespace
