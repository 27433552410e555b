/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <visp3/vlp_localization/vpManyLampSolver.h>
#include <visp3/vlp_localization/vpTwoLampSolver.h>

#include "lampScene.h"

using namespace lampScene;
using testing::HasSubstr;

namespace
{
std::vector<Eigen::Vector3d> randomLamps(Random &random, const vpHomogeneousMatrix &wMb, const vpVlpRig &rig,
                                         size_t count, double height = 0)
{
  std::vector<Eigen::Vector3d> places;
  while (places.size() < count) {
    const Eigen::Vector3d place = randomLamp(random, wMb, 1, height);
    bool apart = inFront(place, wMb * rig.bMc);
    for (const Eigen::Vector3d &other : places)
      apart = apart && (place - other).head<2>().norm() > 0.5;
    if (apart)
      places.push_back(place);
  }
  return places;
}

// Mean NEES and mean chi-square over draws of a random robot under four random lamps.
void expectManyLampsConsistent(unsigned int seed, const Sigmas &sigmas, int rows, double height = 0)
{
  Random random(seed);
  ChiSquareMean error, chiSquare;
  while (error.count < 4000) {
    const vpVlpRig rig = withSigmas(randomRig(random, 0.3), sigmas);
    const vpHomogeneousMatrix wMb = randomBase(random);
    const Draw drawn = draw(random, rig, wMb, randomLamps(random, wMb, rig, 4, height), sigmas);
    const vpVlpFix fix = vpManyLampSolver().solve(drawn.lamps, rig);
    ASSERT_TRUE(fix.valid) << fix.refusal;
    ASSERT_EQ(fix.degreesOfFreedom, 4);
    int found = 0;
    error.add(nees(fix, drawn.wMb, &found));
    ASSERT_EQ(found, rows);
    chiSquare.add(fix.chiSquare);
  }
  EXPECT_NEAR(error.mean(), rows, error.halfWidth(rows));
  EXPECT_NEAR(chiSquare.mean(), 4, chiSquare.halfWidth(4));
  testing::Test::RecordProperty("nees", std::to_string(error.mean()));
  testing::Test::RecordProperty("chiSquare", std::to_string(chiSquare.mean()));
}
} // namespace

TEST(ManyLampSolver, RecoversPoses)
{
  Random random(1);
  for (int i = 0; i < 1500; ++i) {
    const vpVlpRig rig = randomRig(random, 0.6);
    const vpHomogeneousMatrix wMb = randomBase(random), wMc = wMb * rig.bMc;
    std::vector<vpLampSight> lamps;
    for (const Eigen::Vector3d &place : randomLamps(random, wMb, rig, 3 + i % 5, i % 2 ? 2.2 : 0))
      lamps.push_back(sightOf(std::to_string(lamps.size()), place, wMc));
    const vpVlpFix fix = vpManyLampSolver().solve(lamps, rig);
    ASSERT_TRUE(fix.valid) << fix.refusal;
    EXPECT_LT(poseError(wMb, fix.wMb).norm(), 1e-8);
    EXPECT_LT(poseError(wMc, fix.wMc).norm(), 1e-8);
    EXPECT_LT(fix.chiSquare, 1e-6);
    EXPECT_EQ(fix.lamps.size(), lamps.size());
    EXPECT_EQ(fix.degreesOfFreedom, 2 * static_cast<int>(lamps.size()) - 4);
  }
}

TEST(ManyLampSolver, TwoLampsAreTheTwoLampSolver)
{
  const vpVlpRig rig = rigWith(frame(0, 0, 0.2, 0.02, 0.01, 1));
  const vpHomogeneousMatrix wMb = frame(0.2, 0.3, 0, 0, 0, 2);
  const std::vector<vpLampSight> lamps = {sightOf("A", {0, 0, 2}, wMb * rig.bMc),
                                          sightOf("B", {1, 0.2, 2.4}, wMb * rig.bMc)};
  const vpVlpFix many = vpManyLampSolver().solve(lamps, rig);
  const vpVlpFix two = vpTwoLampSolver().solve(lamps[0], lamps[1], rig);
  ASSERT_TRUE(many.valid) << many.refusal;
  EXPECT_LT(poseError(many.wMb, two.wMb).norm(), 1e-12);
  EXPECT_LT((many.covariance - two.covariance).norm(), 1e-15);
  EXPECT_EQ(many.degreesOfFreedom, 0);
}

TEST(ManyLampSolver, ResidualsAreMeasuredLessPredictedInTheOrderOfTheLamps)
{
  Random random(3);
  const vpVlpRig rig = randomRig(random, 0.2);
  const vpHomogeneousMatrix wMb = randomBase(random);
  const Draw drawn =
      draw(random, rig, wMb, randomLamps(random, wMb, rig, 5), {1e-3, 0, {0, 0, 0}, {0, 0, 0}});
  const vpVlpFix fix = vpManyLampSolver().solve(drawn.lamps, rig);
  ASSERT_TRUE(fix.valid) << fix.refusal;
  double chiSquare = 0;
  for (size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(fix.lamps[k], drawn.lamps[k].id);
    const Eigen::Vector2d predicted = sightOf("", drawn.lamps[k].position, fix.wMc).ray;
    EXPECT_LT((fix.residuals[k] - (drawn.lamps[k].ray - predicted)).norm(), 1e-12);
    chiSquare += fix.residuals[k].squaredNorm() / 1e-6;
  }
  EXPECT_NEAR(fix.chiSquare, chiSquare, 1e-9);
  EXPECT_GT(fix.chiSquare, 0.1);
}

TEST(ManyLampSolver, BeatsTheBestPair)
{
  Random random(4);
  double many = 0, two = 0;
  for (int i = 0; i < 500; ++i) {
    const vpVlpRig rig = randomRig(random, 0.2);
    const vpHomogeneousMatrix wMb = randomBase(random);
    const Draw drawn =
        draw(random, rig, wMb, randomLamps(random, wMb, rig, 6), {1e-3, 0.003, {0, 0, 0}, {0, 0, 0}});
    const vpVlpFix all = vpManyLampSolver().solve(drawn.lamps, rig);
    const vpVlpFix pair = vpTwoLampSolver().solveBestPair(drawn.lamps, rig);
    ASSERT_TRUE(all.valid && pair.valid);
    many += poseError(wMb, all.wMb).head<2>().squaredNorm();
    two += poseError(wMb, pair.wMb).head<2>().squaredNorm();
    // Never worse by its own word.
    EXPECT_LE(all.covariance(0, 0) + all.covariance(1, 1),
              1.05 * (pair.covariance(0, 0) + pair.covariance(1, 1)));
  }
  EXPECT_LT(std::sqrt(many), 0.8 * std::sqrt(two));
  RecordProperty("rmsMany_mm", std::to_string(1000 * std::sqrt(many / 500)));
  RecordProperty("rmsPair_mm", std::to_string(1000 * std::sqrt(two / 500)));
}

// The better the image point, the more it counts: a lamp of ten times the standard deviation hardly counts.
TEST(ManyLampSolver, WeighsLampsByTheirCovariance)
{
  const vpVlpRig rig = rigWith(vpHomogeneousMatrix());
  std::vector<vpLampSight> lamps = {sightOf("A", {-1, 0, 2}, rig.bMc, 1e-5),
                                    sightOf("B", {1, 0, 2}, rig.bMc, 1e-5),
                                    sightOf("C", {0, 1, 2}, rig.bMc, 1e-3)};
  lamps[2].ray += Eigen::Vector2d(1e-3, 1e-3);
  const vpVlpFix fix = vpManyLampSolver().solve(lamps, rig);
  ASSERT_TRUE(fix.valid) << fix.refusal;
  EXPECT_LT(poseError(vpHomogeneousMatrix(), fix.wMb).norm(), 1e-6);
  lamps[2].covariance = lamps[0].covariance;
  lamps[2].positionSigma = 0.01; // the same said by the map
  EXPECT_LT(poseError(vpHomogeneousMatrix(), vpManyLampSolver().solve(lamps, rig).wMb).norm(), 1e-6);
}

// A map in surveyors' coordinates leaves nine digits less, and a wrong id a chi-square of millions.
TEST(ManyLampSolver, FarMapOriginAndGrossOutlier)
{
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    const vpVlpRig rig = randomRig(random, 0.1);
    const vpHomogeneousMatrix wMb = frame(4.5e5, 5.4e6, 0, 0, 0, 1);
    Draw drawn = draw(random, rig, wMb, randomLamps(random, wMb, rig, 5), {1e-5, 0, {0, 0, 0}, {0, 0, 0}});
    const vpVlpFix fix = vpManyLampSolver().solve(drawn.lamps, rig);
    ASSERT_TRUE(fix.valid) << fix.refusal;
    EXPECT_LT(poseError(wMb, fix.wMb).head<3>().norm(), 1e-3);
    std::swap(drawn.lamps[0].ray, drawn.lamps[1].ray);
    const vpVlpFix swapped = vpManyLampSolver().solve(drawn.lamps, rig);
    EXPECT_TRUE(!swapped.valid || swapped.chiSquare > 1e4);
  }
}

TEST(ManyLampSolver, ChiSquareShowsAnOutlier)
{
  Random random(5);
  const vpVlpRig rig = randomRig(random, 0.1);
  const vpHomogeneousMatrix wMb = randomBase(random);
  Draw drawn = draw(random, rig, wMb, randomLamps(random, wMb, rig, 5), {3e-4, 0, {0, 0, 0}, {0, 0, 0}});
  drawn.lamps[3].ray.x() += 0.02;
  const vpVlpFix fix = vpManyLampSolver().solve(drawn.lamps, rig);
  ASSERT_TRUE(fix.valid) << fix.refusal;
  EXPECT_GT(fix.chiSquare, 100);
}

TEST(ManyLampSolver, Refuses)
{
  const vpManyLampSolver solver;
  const vpVlpRig rig = rigWith(vpHomogeneousMatrix());
  const vpLampSight a = sightOf("A", {-1, 0, 2}, rig.bMc), b = sightOf("B", {1, 0, 2}, rig.bMc);
  EXPECT_THAT(solver.solve({}, rig).refusal, HasSubstr("0 came"));
  EXPECT_THAT(solver.solve({a, b, a}, rig).refusal, HasSubstr("lamp A is given twice"));
  vpLampSight c = sightOf("C", {0, 1, 2}, rig.bMc);
  c.covariance.setZero();
  EXPECT_THAT(solver.solve({a, b, c}, rig).refusal,
              HasSubstr("lamp C: the covariance of its ray is singular"));
  c = sightOf("C", {0, 1, 2}, rig.bMc);
  c.position.z() = -2; // the map has it under the floor
  EXPECT_THAT(solver.solve({a, b, c}, rig).refusal,
              HasSubstr("no pose has the 3 lamps in front of the camera"));
}

TEST(ManyLampSolver, ConsistentWithImagePoints)
{
  expectManyLampsConsistent(31, {1e-3, 0, {0, 0, 0}, {0, 0, 0}}, 4, 2.2);
  expectManyLampsConsistent(32, {1e-3, 0, {0, 0, 0}, {0, 0, 0}}, 4);
}

TEST(ManyLampSolver, ConsistentWithMap)
{
  expectManyLampsConsistent(33, {5e-4, 0.005, {0, 0, 0}, {0, 0, 0}}, 4);
}

TEST(ManyLampSolver, ConsistentWithTiltOfTheMount)
{
  expectManyLampsConsistent(34, {5e-4, 0, {0, 0, 0}, {0.002, 0.004, 0}}, 6);
}

TEST(ManyLampSolver, ConsistentWithAllSigmasAtOnce)
{
  expectManyLampsConsistent(35, {5e-4, 0.003, {0.002, 0.004, 0.003}, {0.004, 0.003, 0.006}}, 6);
}
