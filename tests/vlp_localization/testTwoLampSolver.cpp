/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include <visp3/vlp_localization/vpTwoLampSolver.h>

#include "lampScene.h"

using namespace lampScene;
using testing::HasSubstr;

namespace
{
// The refusal of two lamps seen from straight below by a camera at the origin of a level base.
std::string refusalOf(const vpLampSight &first, const vpLampSight &second,
                      const vpVlpRig &rig = rigWith(vpHomogeneousMatrix()))
{
  const vpVlpFix fix = vpTwoLampSolver().solve(first, second, rig);
  EXPECT_FALSE(fix.valid);
  EXPECT_EQ(fix.refusal.find('\n'), std::string::npos);
  EXPECT_TRUE(fix.lamps.empty());
  return fix.refusal;
}

vpLampSight lampAt(const std::string &id, double x, double y, double z)
{
  return sightOf(id, {x, y, z}, vpHomogeneousMatrix());
}

struct Recovery {
  int exact = 0; // the fix is the truth
  int other = 0; // the fix is ambiguous, and its other pose the truth
  int ambiguous = 0;
  int lost = 0; // a fix that is neither
  int refused = 0;
};

// Random robots, mounts and pairs of lamps; \e height 0: two different ones.
Recovery recover(unsigned int seed, int count, double height)
{
  Random random(seed);
  Recovery recovery;
  while (count > 0) {
    const vpVlpRig rig = randomRig(random, 0.6);
    const vpHomogeneousMatrix wMb = randomBase(random), wMc = wMb * rig.bMc;
    const Eigen::Vector3d first = randomLamp(random, wMb, 1.5, height),
                          second = randomLamp(random, wMb, 1.5, height);
    if ((first - second).head<2>().norm() < 0.2 || !inFront(first, wMc) || !inFront(second, wMc))
      continue;
    --count;
    const vpVlpFix fix = vpTwoLampSolver().solve(sightOf("A", first, wMc), sightOf("B", second, wMc), rig);
    recovery.ambiguous += fix.ambiguous;
    if (!fix.valid)
      ++recovery.refused;
    else if (poseError(wMb, fix.wMb).norm() < 1e-6 && poseError(wMc, fix.wMc).norm() < 1e-6)
      ++recovery.exact;
    else if (fix.ambiguous && poseError(wMb, fix.other).norm() < 1e-6)
      ++recovery.other;
    else
      ++recovery.lost;
    if (fix.valid) {
      EXPECT_EQ(fix.lamps, (std::vector<std::string>{"A", "B"}));
      EXPECT_EQ(fix.degreesOfFreedom, 0);
      EXPECT_LT(fix.residuals.at(0).norm() + fix.residuals.at(1).norm(), 1e-9);
    }
  }
  return recovery;
}
} // namespace

TEST(TwoLampSolver, RecoversPosesUnderLampsOfOneHeight)
{
  const Recovery recovery = recover(1, 2000, 2.2);
  EXPECT_EQ(recovery.exact, 2000);
  EXPECT_EQ(recovery.ambiguous, 0); // one height: one root
}

TEST(TwoLampSolver, RecoversPosesUnderLampsOfDifferentHeights)
{
  const Recovery recovery = recover(2, 2000, 0);
  EXPECT_EQ(recovery.lost, 0);
  EXPECT_GT(recovery.exact, 1900);
  EXPECT_LT(recovery.refused, 40); // pairs at the double root of the quadratic
  RecordProperty("ambiguous", recovery.ambiguous);
  RecordProperty("refused", recovery.refused);
}

// design.md: b has x forward and y left, c has x right in the picture and y down, and a camera that looks
// up with its frame along the base's sees the world unmirrored. A robot in the middle of the floor faces
// east (x of w).
TEST(TwoLampSolver, HandednessOfACameraThatLooksUp)
{
  const vpVlpRig rig = rigWith(frame(0, 0, 0.2, 0, 0, 0));
  const vpHomogeneousMatrix wMc = rig.bMc; // wMb is the identity
  const vpLampSight east = sightOf("east", {0.5, 0, 1.7}, wMc);
  const vpLampSight north = sightOf("north", {0, 0.5, 1.7}, wMc);
  EXPECT_NEAR(east.ray.x(), 1.0 / 3, 1e-12); // right in the picture
  EXPECT_NEAR(east.ray.y(), 0, 1e-12);
  EXPECT_NEAR(north.ray.x(), 0, 1e-12);
  EXPECT_NEAR(north.ray.y(), 1.0 / 3, 1e-12); // down in the picture

  // The same picture after a quarter turn to the left: now the lamp in the east is to the right of the
  // robot, -y.
  const vpHomogeneousMatrix turned = frame(0, 0, 0, 0, 0, M_PI / 2);
  EXPECT_NEAR(sightOf("east", {0.5, 0, 1.7}, turned * rig.bMc).ray.y(), -1.0 / 3, 1e-12);

  // A mirrored picture would give another heading or place; this one gives the robot's own.
  const vpVlpFix fix = vpTwoLampSolver().solve(east, north, rig);
  ASSERT_TRUE(fix.valid) << fix.refusal;
  EXPECT_LT(poseError(vpHomogeneousMatrix(), fix.wMb).norm(), 1e-9);
}

TEST(TwoLampSolver, MountTurnedHalfRound)
{
  const vpVlpRig rig = rigWith(frame(0, 0, 0.19, 0, 0, M_PI)); // as the design's example
  const vpHomogeneousMatrix wMb = frame(0.3, -0.2, 0, 0, 0, 0.4), wMc = wMb * rig.bMc;
  const vpVlpFix fix = vpTwoLampSolver().solve(sightOf("A", {-0.33, -0.33, 1.5}, wMc),
                                               sightOf("B", {0.33, -0.33, 1.5}, wMc), rig);
  ASSERT_TRUE(fix.valid) << fix.refusal;
  EXPECT_LT(poseError(wMb, fix.wMb).norm(), 1e-9);
}

TEST(TwoLampSolver, HeightIsEstimatedNotForced)
{
  const vpVlpRig rig = rigWith(frame(0.1, 0, 0.2, 0.1, -0.05, 1));
  const vpHomogeneousMatrix wMb = frame(0.2, 0.1, 0.35, 0, 0, -2), wMc = wMb * rig.bMc;
  const vpVlpFix fix =
      vpTwoLampSolver().solve(sightOf("A", {0, 0, 2}, wMc), sightOf("B", {1, 0, 2.3}, wMc), rig);
  ASSERT_TRUE(fix.valid) << fix.refusal;
  EXPECT_NEAR(fix.wMb[2][3], 0.35, 1e-9);
}

TEST(TwoLampSolver, SaysWhereTwoHeightsFit)
{
  Random random(3);
  int ambiguous = 0, nearer = 0;
  for (int i = 0; i < 3000; ++i) {
    const vpVlpRig rig = randomRig(random, 0.3);
    const vpHomogeneousMatrix wMb = randomBase(random), wMc = wMb * rig.bMc;
    const vpLampSight first = sightOf("A", randomLamp(random, wMb, 2), wMc);
    const vpLampSight second = sightOf("B", randomLamp(random, wMb, 2), wMc);
    const vpVlpFix fix = vpTwoLampSolver().solve(first, second, rig);
    if (!fix.ambiguous)
      continue;
    ++ambiguous;
    nearer += std::abs(fix.wMb[2][3]) <= std::abs(fix.other[2][3]);
    // Both poses are level and see both lamps where they were seen.
    for (const vpHomogeneousMatrix &pose : {fix.wMb, fix.other}) {
      EXPECT_LT(tiltOf(pose), 1e-9);
      EXPECT_LT((sightOf("A", first.position, pose * rig.bMc).ray - first.ray).norm(), 1e-9);
      EXPECT_LT((sightOf("B", second.position, pose * rig.bMc).ray - second.ray).norm(), 1e-9);
    }
    EXPECT_GT((poseError(fix.wMb, fix.other)).norm(), 1e-6);
  }
  EXPECT_GT(ambiguous, 100);
  EXPECT_EQ(nearer, ambiguous);
}

TEST(TwoLampSolver, RefusesOneLampTwice)
{
  EXPECT_THAT(refusalOf(lampAt("A", 0, 0, 2), lampAt("A", 1, 0, 2)), HasSubstr("lamp A is given twice"));
}

TEST(TwoLampSolver, RefusesLampsThatCoincide)
{
  vpLampSight second = lampAt("B", 1, 0, 2);
  second.position = {0, 0, 2};
  EXPECT_THAT(refusalOf(lampAt("A", 0, 0, 2), second),
              HasSubstr("lamps A and B have the same place in the map"));
  second = lampAt("B", 1, 0, 2);
  second.ray = lampAt("A", 0, 0, 2).ray;
  EXPECT_THAT(refusalOf(lampAt("A", 0, 0, 2), second), HasSubstr("same place in the picture"));
}

TEST(TwoLampSolver, RefusesLampsOneAboveTheOther)
{
  EXPECT_THAT(refusalOf(lampAt("A", 0.5, 0, 2), lampAt("B", 0.5, 0, 3)), HasSubstr("one above the other"));
}

TEST(TwoLampSolver, RefusesLampsTooCloseInThePicture)
{
  vpLampSight first = lampAt("A", 0, 0, 2), second = lampAt("B", 0.1, 0, 2);
  first.covariance = second.covariance = 0.02 * 0.02 * Eigen::Matrix2d::Identity();
  EXPECT_THAT(refusalOf(first, second), HasSubstr("sigma apart in the picture, 5 are needed"));
}

TEST(TwoLampSolver, RefusesAnUncertainHeight)
{
  vpLampSight first = lampAt("A", 0, 0, 2), second = lampAt("B", 0.3, 0, 2);
  first.positionSigma = second.positionSigma = 0.05;
  EXPECT_THAT(refusalOf(first, second), HasSubstr("leave the height above the camera uncertain by"));
}

TEST(TwoLampSolver, RefusesAnUncertainHeading)
{
  vpLampSight first = lampAt("A", 0.5, 0, 1), second = lampAt("B", 0.505, 0, 2);
  first.positionSigma = second.positionSigma = 0.001;
  EXPECT_THAT(refusalOf(first, second), HasSubstr("leave the heading uncertain by"));
}

TEST(TwoLampSolver, RefusesACameraThatLooksDown)
{
  EXPECT_THAT(refusalOf(lampAt("A", 0, 0, 2), lampAt("B", 1, 0, 2), rigWith(frame(0, 0, 0, 0, M_PI, 0))),
              HasSubstr("lamp A: its ray does not point above the horizon"));
}

TEST(TwoLampSolver, RefusesPlacesThatNoHeightExplains)
{
  // One lamp 3 m above the other, 0.1 m beside it, yet seen at opposite ends of the picture.
  vpLampSight first = lampAt("A", -1, 0, 1), second = lampAt("B", 1, 0, 1);
  first.position = {0, 0, 1};
  second.position = {0.1, 0, 4};
  EXPECT_THAT(refusalOf(first, second), HasSubstr("lamps A and B"));
  // The difference of height alone shows as more than the lamps lie apart: above no height is it right.
  first.ray = {1, 0};
  second.ray = {0.8, 0.6};
  EXPECT_THAT(refusalOf(first, second), HasSubstr("no height of the camera fits"));
}

TEST(TwoLampSolver, RefusesPosesAboveTheLamps)
{
  vpLampSight first = lampAt("A", 1, 0, 1), second = lampAt("B", 2.1, 0, 1);
  first.position = {0, 0, 1};
  second.position = {0.1, 0, 2};
  EXPECT_THAT(refusalOf(first, second), HasSubstr("the camera would have to be above them"));
}

TEST(TwoLampSolver, RefusesWhatIsNotANumber)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  vpLampSight bad = lampAt("B", 1, 0, 2);
  bad.ray.x() = nan;
  EXPECT_THAT(refusalOf(lampAt("A", 0, 0, 2), bad), HasSubstr("lamp B: its ray is not finite"));
  bad = lampAt("B", 1, 0, 2);
  bad.position.z() = nan;
  EXPECT_THAT(refusalOf(lampAt("A", 0, 0, 2), bad), HasSubstr("lamp B: its position"));
  bad = lampAt("B", 1, 0, 2);
  bad.positionSigma = -1;
  EXPECT_THAT(refusalOf(lampAt("A", 0, 0, 2), bad), HasSubstr("lamp B: the sigma"));
  bad = lampAt("B", 1, 0, 2);
  bad.covariance(0, 0) = -1;
  EXPECT_THAT(refusalOf(lampAt("A", 0, 0, 2), bad), HasSubstr("lamp B: the covariance"));
}

TEST(TwoLampSolver, BestPairHasTheSmallestPositionCovariance)
{
  Random random(11);
  for (int i = 0; i < 200; ++i) {
    const vpVlpRig rig = randomRig(random, 0.2);
    const vpHomogeneousMatrix wMb = randomBase(random);
    std::vector<vpLampSight> lamps;
    for (int k = 0; k < 5; ++k)
      lamps.push_back(
          sightOf(std::to_string(k), randomLamp(random, wMb, 1), wMb * rig.bMc, random.uniform(1e-4, 2e-3)));
    const vpTwoLampSolver solver;
    const vpVlpFix best = solver.solveBestPair(lamps, rig);
    const auto trace = [](const vpVlpFix &fix) { return fix.covariance(0, 0) + fix.covariance(1, 1); };
    for (int j = 1; j < 5; ++j)
      for (int k = 0; k < j; ++k) {
        const vpVlpFix fix = solver.solve(lamps[k], lamps[j], rig);
        EXPECT_TRUE(!fix.valid || (best.valid && trace(best) <= trace(fix)));
      }
  }
}

TEST(TwoLampSolver, BestPairRefusesWithAReason)
{
  const vpTwoLampSolver solver;
  const vpVlpRig rig = rigWith(vpHomogeneousMatrix());
  EXPECT_THAT(solver.solveBestPair({}, rig).refusal, HasSubstr("needs two lamps, 0 came"));
  EXPECT_THAT(solver.solveBestPair({lampAt("A", 0, 0, 2)}, rig).refusal,
              HasSubstr("needs two lamps, 1 came"));
  std::vector<vpLampSight> lamps = {lampAt("A", 0, 0, 2), lampAt("B", 0.1, 0, 2), lampAt("C", 0, 0.2, 2)};
  for (vpLampSight &lamp : lamps)
    lamp.covariance = 0.05 * 0.05 * Eigen::Matrix2d::Identity();
  EXPECT_THAT(
      solver.solveBestPair(lamps, rig).refusal,
      testing::StartsWith("no pair of the 3 lamps gives a position; the widest: lamps B and C are only"));
}
