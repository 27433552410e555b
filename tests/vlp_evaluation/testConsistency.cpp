/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <visp3/vlp_evaluation/vpConsistency.h>

#include "common/vpExpectError.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

TEST(ChiSquare, AsInTheTables)
{
  EXPECT_NEAR(vpChiSquareQuantile(0.95, 1), 3.841458820694124, 1e-9);
  EXPECT_NEAR(vpChiSquareQuantile(0.95, 2), 5.991464547107979, 1e-9);
  EXPECT_NEAR(vpChiSquareQuantile(0.95, 3), 7.814727903251179, 1e-9);
  EXPECT_NEAR(vpChiSquareQuantile(0.025, 10), 3.246972780236842, 1e-9);
  EXPECT_NEAR(vpChiSquareQuantile(0.975, 100), 129.5611971858366, 1e-8);
  for (const double x : {0.001, 0.5, 3., 40.}) { // closed forms
    EXPECT_NEAR(vpChiSquareCdf(x, 2), 1 - std::exp(-x / 2), 1e-14);
    EXPECT_NEAR(vpChiSquareCdf(x, 1), std::erf(std::sqrt(x / 2)), 1e-14);
  }
  EXPECT_EQ(vpChiSquareCdf(0, 3), 0);
  EXPECT_EQ(vpChiSquareCdf(-1, 3), 0);
  EXPECT_EQ(vpChiSquareCdf(INFINITY, 3), 1);
}

TEST(ChiSquare, QuantileIsTheInverseForFewAndManyDegrees)
{
  for (const double degrees : {0.5, 1., 2., 7., 100., 1e4, 1e6}) {
    for (const double share : {1e-6, 0.025, 0.5, 0.95, 0.975, 1 - 1e-6}) {
      EXPECT_NEAR(vpChiSquareCdf(vpChiSquareQuantile(share, degrees), degrees), share, 1e-7) << degrees;
    }
  }
  // Near a Gaussian: mean n, variance 2 n.
  EXPECT_NEAR(vpChiSquareQuantile(0.975, 1e6), 1e6 + 1.959964 * std::sqrt(2e6), 3);
}

TEST(ChiSquare, BadArgumentsAreRefused)
{
  vpExpectError([] { vpChiSquareQuantile(1, 2); }, {"quantile 1 with 2 degrees"});
  vpExpectError([] { vpChiSquareQuantile(NAN, 2); }, {"quantile nan"});
  vpExpectError([] { vpChiSquareQuantile(0.5, 0); }, {"0 degrees"});
  vpExpectError([] { vpChiSquareCdf(1, -1); }, {"-1 degrees"});
  vpExpectError([] { vpChiSquareCdf(NAN, 1); }, {"value nan"});
}

TEST(Consistency, DrawnGaussiansAreWithinTheInterval)
{
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  constexpr int trials = 400, samples = 50;
  for (const unsigned int dimension : {1u, 2u}) {
    int inside = 0;
    double within = 0;
    for (int trial = 0; trial < trials; ++trial) {
      vpConsistency consistency(dimension);
      for (int i = 0; i < samples; ++i) {
        double nees = 0;
        for (unsigned int d = 0; d < dimension; ++d) {
          nees += std::pow(normal(random), 2);
        }
        consistency.add(nees);
      }
      inside +=
          consistency.mean() >= consistency.lower() && consistency.mean() <= consistency.upper() ? 1 : 0;
      within += consistency.shareWithin95() / trials;
    }
    EXPECT_NEAR(static_cast<double>(inside) / trials, 0.95, 0.035); // 3 sigma of 400 draws
    EXPECT_NEAR(within, 0.95, 0.005);
  }
}

TEST(Consistency, SigmasThatAreTooSmallAreAboveTheInterval)
{
  std::mt19937 random(9);
  std::normal_distribution<double> normal(0, 1.3);
  vpConsistency consistency(1);
  for (int i = 0; i < 1000; ++i) {
    consistency.add(std::pow(normal(random), 2));
  }
  EXPECT_GT(consistency.mean(), consistency.upper());
  EXPECT_LT(consistency.shareWithin95(), 0.92);
}

TEST(Consistency, OfNone)
{
  const vpConsistency none(2);
  EXPECT_EQ(none.count(), 0u);
  EXPECT_EQ(none.mean(), 0);
  EXPECT_EQ(none.lower(), 0);
  EXPECT_EQ(none.upper(), 0);
  EXPECT_EQ(none.shareWithin95(), 0);
}
