/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Few identifiers over many lamps: none twice in a view, and sets of three that no other set looks like.

#include <algorithm>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <visp3/vlp_identification/vpIdentifierLayout.h>

#include "common/vpExpectError.h"
#include "common/vpLampGrid.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
std::vector<Eigen::Vector3d> randomPlaces(size_t count, double side)
{
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(0, side);
  std::vector<Eigen::Vector3d> places;
  for (size_t k = 0; k < count; ++k) {
    const double y = uniform(generator);
    places.emplace_back(uniform(generator), y, 3);
  }
  return places;
}

//! Repeated identifiers within a distance, counted by comparing all lamps.
size_t repeatedWithin(const std::vector<Eigen::Vector3d> &places, const std::vector<size_t> &identifiers,
                      double distance)
{
  size_t repeated = 0;
  for (size_t i = 0; i < places.size(); ++i) {
    for (size_t j = i + 1; j < places.size(); ++j) {
      repeated += identifiers[i] == identifiers[j] && (places[i] - places[j]).head<2>().norm() <= distance;
    }
  }
  return repeated;
}

//! Sets of three with the given longest side, by brute force: identifiers in order, with the sides between
//! them.
struct Seen {
  std::array<size_t, 3> identifiers;
  std::array<double, 3> sides;
  double area;
};

std::vector<Seen> setsOfThree(const std::vector<Eigen::Vector3d> &places,
                              const std::vector<size_t> &identifiers, double longest)
{
  std::vector<Seen> sets;
  const auto distance = [&](size_t i, size_t j) { return (places[i] - places[j]).head<2>().norm(); };
  for (size_t i = 0; i < places.size(); ++i) {
    for (size_t j = i + 1; j < places.size(); ++j) {
      for (size_t k = j + 1; k < places.size(); ++k) {
        if (std::max({distance(i, j), distance(j, k), distance(k, i)}) > longest) {
          continue;
        }
        std::array<size_t, 3> lamps = {i, j, k};
        std::sort(lamps.begin(), lamps.end(),
                  [&](size_t a, size_t b) { return identifiers[a] < identifiers[b]; });
        const auto &[a, b, c] = lamps;
        const Eigen::Vector3d ab = places[b] - places[a], ac = places[c] - places[a];
        sets.push_back({{identifiers[a], identifiers[b], identifiers[c]},
                        {distance(a, b), distance(b, c), distance(c, a)},
                        ab.x() * ac.y() - ab.y() * ac.x()});
      }
    }
  }
  return sets;
}

size_t alike(const std::vector<Seen> &sets, double tolerance)
{
  size_t count = 0;
  for (size_t i = 0; i < sets.size(); ++i) {
    for (size_t j = i + 1; j < sets.size(); ++j) {
      bool same = sets[i].identifiers == sets[j].identifiers && sets[i].area * sets[j].area > 0;
      for (size_t k = 0; k < 3; ++k) {
        same = same && std::abs(sets[i].sides[k] - sets[j].sides[k]) < tolerance;
      }
      count += same;
    }
  }
  return count;
}

TEST(IdentifierLayout, TwoLampsDiffer)
{
  const vpIdentifierAssignment laid = vpIdentifierLayout().lay(vpLampGrid(2, 1, 0, 1), 2);
  ASSERT_EQ(laid.identifiers.size(), 2u);
  EXPECT_NE(laid.identifiers[0], laid.identifiers[1]);
  EXPECT_EQ(laid.pairsInView, 1u);
  EXPECT_EQ(laid.triples, 0u);
}

TEST(IdentifierLayout, NoIdentifierTwiceWithinTwoViews)
{
  vpIdentifierLayout layout;
  layout.viewRadius = 2;
  for (const auto &places :
       {vpLampGrid(400, 1.2, 0, 1), vpLampGrid(400, 1.2, 0.3, 2), randomPlaces(300, 24)}) {
    const vpIdentifierAssignment laid = layout.lay(places, 50);
    EXPECT_EQ(repeatedWithin(places, laid.identifiers, 4), 0u);
    EXPECT_EQ(laid.repeatedPairs, 0u);
    EXPECT_LT(*std::max_element(laid.identifiers.begin(), laid.identifiers.end()), 50u);
  }
}

TEST(IdentifierLayout, NoThreeLampsLookLikeThreeOthers)
{
  vpIdentifierLayout layout;
  layout.viewRadius = 1.5;
  layout.tolerance = 0.1;
  for (const auto &places :
       {vpLampGrid(100, 1.2, 0, 1), vpLampGrid(100, 1.2, 0.3, 2), randomPlaces(100, 12)}) {
    const vpIdentifierAssignment laid = layout.lay(places, 20);
    EXPECT_EQ(laid.repeatedTriples, 0u);
    EXPECT_GT(laid.triples, 100u);
    EXPECT_EQ(alike(setsOfThree(places, laid.identifiers, 1.8), layout.tolerance), 0u);
  }
}

TEST(IdentifierLayout, CountsWhatItCannotTellApart)
{
  vpIdentifierLayout layout;
  layout.viewRadius = 1.5;
  const vpIdentifierAssignment laid = layout.lay(vpLampGrid(100, 1.2, 0, 1), 2);
  EXPECT_GT(laid.repeatedPairs, 0u);
  EXPECT_EQ(laid.repeatedTriples, laid.triples); // of two identifiers each set of three holds one twice
  EXPECT_EQ(laid.repeatedPairs, repeatedWithin(vpLampGrid(100, 1.2, 0, 1), laid.identifiers, 3));
}

TEST(IdentifierLayout, IsFarBetterThanChance)
{
  vpIdentifierLayout layout;
  layout.viewRadius = 2;
  const auto places = vpLampGrid(900, 1.2, 0, 1);
  const size_t laid = layout.lay(places, 30).repeatedTriples;
  layout.choices = 1; // any that no lamp in view has
  layout.passes = 0;
  EXPECT_LT(3 * laid, layout.lay(places, 30).repeatedTriples);
}

TEST(IdentifierLayout, GivesTheSameForTheSameSeedOnly)
{
  vpIdentifierLayout layout;
  const auto places = vpLampGrid(200, 1.2, 0.2, 1);
  const std::vector<size_t> first = layout.lay(places, 40).identifiers;
  EXPECT_EQ(layout.lay(places, 40).identifiers, first);
  layout.seed = 2;
  EXPECT_NE(layout.lay(places, 40).identifiers, first);
}

TEST(IdentifierLayout, TakesLampsInOnePlace)
{
  const std::vector<Eigen::Vector3d> places(4, Eigen::Vector3d(1, 2, 3));
  const std::vector<size_t> laid = vpIdentifierLayout().lay(places, 4).identifiers;
  EXPECT_EQ(std::set<size_t>(laid.begin(), laid.end()).size(), 4u);
}

TEST(IdentifierLayout, NamesTheArgumentThatIsWrong)
{
  const auto places = vpLampGrid(4, 1, 0, 1);
  const auto expectNamed = [](const std::string &name, const std::vector<Eigen::Vector3d> &positions,
                              size_t identifiers, const vpIdentifierLayout &layout = vpIdentifierLayout()) {
    vpExpectError([&] { layout.lay(positions, identifiers); }, {name});
  };
  expectNamed("positions", {places[0]}, 4);
  expectNamed("identifiers", places, 1);
  auto broken = places;
  broken[2].y() = std::numeric_limits<double>::quiet_NaN();
  expectNamed("positions", broken, 4);
  vpIdentifierLayout layout;
  layout.viewRadius = 0;
  expectNamed("viewRadius", places, 4, layout);
  layout = vpIdentifierLayout();
  layout.tolerance = -1;
  expectNamed("tolerance", places, 4, layout);
  layout = vpIdentifierLayout();
  layout.choices = 0;
  expectNamed("choices", places, 4, layout);
}
} // namespace
