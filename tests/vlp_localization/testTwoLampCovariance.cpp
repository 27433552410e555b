/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <gtest/gtest.h>

#include <complex>

#include <visp3/vlp_localization/vpTwoLampSolver.h>

#include "lampScene.h"

using namespace lampScene;

namespace
{
using Complex = std::complex<double>;

// Mean NEES over draws of a random robot under two random lamps.
void expectTwoLampsConsistent(unsigned int seed, const Sigmas &sigmas, int degreesOfFreedom,
                              double height = 0)
{
  Random random(seed);
  ChiSquareMean mean;
  while (mean.count < 4000) {
    const vpVlpRig rig = withSigmas(randomRig(random, 0.3), sigmas);
    const vpHomogeneousMatrix wMb = randomBase(random), wMc = wMb * rig.bMc;
    std::vector<Eigen::Vector3d> places;
    while (places.size() < 2) {
      const Eigen::Vector3d place = randomLamp(random, wMb, 1, height);
      if (inFront(place, wMc))
        places.push_back(place);
    }
    if ((places[0] - places[1]).head<2>().norm() < 0.8)
      continue; // where the first order is far enough
    const Draw drawn = draw(random, rig, wMb, places, sigmas);
    const vpVlpFix fix = vpTwoLampSolver().solve(drawn.lamps[0], drawn.lamps[1], rig);
    if (!fix.valid || fix.ambiguous || fix.covariance(2, 2) > 0.0025)
      continue;
    int rows = 0;
    mean.add(nees(fix, drawn.wMb, &rows));
    ASSERT_EQ(rows, degreesOfFreedom);
  }
  EXPECT_NEAR(mean.mean(), degreesOfFreedom, mean.halfWidth(degreesOfFreedom));
  testing::Test::RecordProperty("nees", std::to_string(mean.mean()));
}
} // namespace

// vlp.md: rms = s sigma sqrt(2 (|1 - tau|^2 + |tau|^2)), tau = -q1 / (q2 - q1), s metres per unit of q.
TEST(TwoLampCovariance, PositionIsTheKnownFormula)
{
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const double sigma = 1e-4, height = 2;
    const vpVlpRig rig = rigWith(frame(0, 0, 0.2, 0, 0, random.uniform(-3, 3)));
    const vpHomogeneousMatrix wMb = randomBase(random), wMc = wMb * rig.bMc;
    const vpLampSight first = sightOf("A", randomLamp(random, wMb, 1, height), wMc, sigma);
    const vpLampSight second = sightOf("B", randomLamp(random, wMb, 1, height), wMc, sigma);
    const vpVlpFix fix = vpTwoLampSolver().solve(first, second, rig);
    if (!fix.valid)
      continue; // too close together
    const Complex q1(first.ray.x(), first.ray.y()), q2(second.ray.x(), second.ray.y());
    const Complex tau = -q1 / (q2 - q1);
    const double s = height - wMc[2][3];
    const double rms = s * sigma * std::sqrt(2 * (std::norm(1.0 - tau) + std::norm(tau)));
    EXPECT_NEAR(std::sqrt(fix.covariance(0, 0) + fix.covariance(1, 1)), rms, 1e-6 * rms);
  }
}

// vlp.md: sigma_yaw = sigma_H / H = sqrt(2) sigma / |dq|.
TEST(TwoLampCovariance, YawAndHeightAreTheKnownFormula)
{
  const double sigma = 2e-4;
  const vpHomogeneousMatrix wMb;
  const vpVlpRig rig = rigWith(frame(0.1, 0.05, 0.2, 0, 0, 1));
  const vpLampSight first = sightOf("A", {0.2, 0.4, 1.7}, rig.bMc, sigma);
  const vpLampSight second = sightOf("B", {0.9, -0.3, 1.7}, rig.bMc, sigma);
  const vpVlpFix fix = vpTwoLampSolver().solve(first, second, rig);
  ASSERT_TRUE(fix.valid) << fix.refusal;
  const double known = std::sqrt(2.0) * sigma / (second.ray - first.ray).norm();
  EXPECT_NEAR(std::sqrt(fix.covariance(5, 5)), known, 1e-9);
  EXPECT_NEAR(std::sqrt(fix.covariance(2, 2)) / 1.5, known, 1e-9);
  EXPECT_EQ(fix.covariance(3, 3), 0); // the rig states no sigma of roll and pitch
  EXPECT_EQ(fix.covariance(4, 4), 0);
}

// The errors of the lamps' places are common to x and y of both: straight below the middle of two lamps the
// base moves by their mean.
TEST(TwoLampCovariance, MapSigmaAtTheMiddle)
{
  const vpVlpRig rig = rigWith(vpHomogeneousMatrix());
  vpLampSight first = sightOf("A", {-0.5, 0, 2}, rig.bMc, 1e-9),
              second = sightOf("B", {0.5, 0, 2}, rig.bMc, 1e-9);
  first.positionSigma = second.positionSigma = 0.01;
  const vpVlpFix fix = vpTwoLampSolver().solve(first, second, rig);
  ASSERT_TRUE(fix.valid) << fix.refusal;
  // x takes 1/2 of each lamp's x, and of each lamp's z by its slope 1/4, one up and one down.
  EXPECT_NEAR(fix.covariance(0, 0), 0.0001 * 2 * (0.25 + 0.015625), 1e-9);
  EXPECT_NEAR(fix.covariance(1, 1), 0.0001 * 0.5, 1e-9);
  EXPECT_NEAR(fix.covariance(5, 5), 0.0001 * 2, 1e-9);
}

TEST(TwoLampCovariance, TiltOfTheMountMovesTheBaseByTheHeight)
{
  vpVlpRig rig = rigWith(frame(0, 0, 0.3, 0, 0, 0));
  rig.rotationSigma = {0.002, 0.005, 0}; // roll, pitch
  for (double yaw : {0.0, M_PI / 2}) {
    const vpHomogeneousMatrix wMb = frame(0, 0, 0, 0, 0, yaw);
    const vpVlpFix fix = vpTwoLampSolver().solve(sightOf("A", {-0.2, 0.01, 2}, wMb * rig.bMc, 1e-9),
                                                 sightOf("B", {0.2, -0.01, 2}, wMb * rig.bMc, 1e-9), rig);
    ASSERT_TRUE(fix.valid) << fix.refusal;
    // Of the robot: a pitch moves it along its x, a roll along its y, by angle times height above the camera.
    const int x = yaw == 0 ? 0 : 1, y = 1 - x;
    EXPECT_NEAR(std::sqrt(fix.covariance(x, x)), 1.7 * 0.005, 2e-4);
    EXPECT_NEAR(std::sqrt(fix.covariance(y, y)), 1.7 * 0.002, 2e-4);
    EXPECT_NEAR(fix.covariance(3 + x, 3 + x), 0.002 * 0.002, 1e-12);
    EXPECT_NEAR(fix.covariance(3 + y, 3 + y), 0.005 * 0.005, 1e-12);
    const double correlation =
        fix.covariance(x, 3 + y) / std::sqrt(fix.covariance(x, x) * fix.covariance(3 + y, 3 + y));
    EXPECT_GT(std::abs(correlation), 0.99);
  }
}

TEST(TwoLampCovariance, TranslationAndYawOfTheMount)
{
  vpVlpRig rig = rigWith(frame(0.4, 0, 0.3, 0, 0, 0));
  rig.translationSigma = {0.001, 0.002, 0.003};
  rig.rotationSigma = {0, 0, 0.01};
  const vpVlpFix fix = vpTwoLampSolver().solve(sightOf("A", {-0.5, 0, 2}, rig.bMc, 1e-9),
                                               sightOf("B", {0.5, 0, 2}, rig.bMc, 1e-9), rig);
  ASSERT_TRUE(fix.valid) << fix.refusal;
  EXPECT_NEAR(fix.covariance(0, 0), 1e-6, 1e-9);
  EXPECT_NEAR(fix.covariance(1, 1), 4e-6 + 0.4 * 0.4 * 1e-4,
              1e-9); // the yaw swings the base about the camera
  EXPECT_NEAR(fix.covariance(2, 2), 9e-6, 1e-9);
  EXPECT_NEAR(fix.covariance(5, 5), 1e-4, 1e-9);
}

TEST(TwoLampCovariance, ConsistentWithImagePoints)
{
  expectTwoLampsConsistent(21, {3e-4, 0, {0, 0, 0}, {0, 0, 0}}, 4, 2.1);
  expectTwoLampsConsistent(22, {3e-4, 0, {0, 0, 0}, {0, 0, 0}}, 4);
}

TEST(TwoLampCovariance, ConsistentWithMap)
{
  expectTwoLampsConsistent(23, {3e-4, 0.004, {0, 0, 0}, {0, 0, 0}}, 4);
}

// Position and tilt err together, so what counts is the rest: at twice this tilt the second order, height
// times tilt squared, shows against an image point good to 0.6 mm (mean NEES 6.34 of 6).
TEST(TwoLampCovariance, ConsistentWithTiltOfTheMount)
{
  expectTwoLampsConsistent(24, {3e-4, 0, {0, 0, 0}, {0.002, 0.004, 0}}, 6);
}

TEST(TwoLampCovariance, ConsistentWithTheLens)
{
  expectTwoLampsConsistent(26, {3e-4, 0, {0, 0, 0}, {0, 0, 0}, 0.003, 0.005}, 4);
}

TEST(TwoLampCovariance, ConsistentWithAllSigmasAtOnce)
{
  expectTwoLampsConsistent(25, {5e-4, 0.003, {0.002, 0.004, 0.003}, {0.003, 0.005, 0.006}, 0.002, 0.004}, 6);
}
