/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>
#include <visp3/vlp_evaluation/vpErrorStatistics.h>

#include "common/vpExpectError.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

TEST(Percentile, IsLinearBetweenTheSortedValues)
{
  const std::vector<double> values = {40, 10, 30, 20};
  EXPECT_EQ(vpPercentile(values, 0), 10);
  EXPECT_EQ(vpPercentile(values, 1), 40);
  EXPECT_EQ(vpPercentile(values, 0.5), 25);
  EXPECT_NEAR(vpPercentile(values, 0.9), 37, 1e-12); // numpy.percentile([10, 20, 30, 40], 90)
  EXPECT_EQ(vpPercentile({7}, 0.95), 7);
  vpExpectError([] { vpPercentile({}, 0.5); }, {"0.5 of 0 values"});
  vpExpectError([] { vpPercentile({1}, 1.1); }, {"share 1.1", "expected a share of 0 to 1"});
  vpExpectError([] { vpPercentile({1}, NAN); }, {"share nan"});
}

TEST(Percentile, GrowsWithTheShareAndStaysWithinTheValues)
{
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (size_t n = 1; n < 40; ++n) {
    std::vector<double> values(n);
    std::generate(values.begin(), values.end(), [&] { return normal(random); });
    double last = *std::min_element(values.begin(), values.end());
    EXPECT_EQ(vpPercentile(values, 0), last);
    for (double share = 0; share <= 1; share += 0.01) {
      const double value = vpPercentile(values, share);
      EXPECT_GE(value, last);
      last = value;
    }
    EXPECT_EQ(vpPercentile(values, 1), *std::max_element(values.begin(), values.end()));
  }
}

TEST(ErrorStatistics, OfKnownErrors)
{
  const vpErrorStatistics s = vpErrorStatistics::of({-3, 1, 1, 5});
  EXPECT_EQ(s.count, 4u);
  EXPECT_EQ(s.mean, 1);
  EXPECT_EQ(s.median, 1);
  EXPECT_NEAR(s.rmse, 3, 1e-12);
  EXPECT_NEAR(s.deviation, std::sqrt(8), 1e-12);
  EXPECT_NEAR(s.percentile90, 4.4, 1e-12); // of 1 1 3 5
  EXPECT_NEAR(s.percentile95, 4.7, 1e-12);
  EXPECT_EQ(s.largest, 5);
  EXPECT_EQ(vpErrorStatistics::of({-6, 1}).largest, 6);
}

TEST(ErrorStatistics, OfNoneAndOne)
{
  const vpErrorStatistics none = vpErrorStatistics::of({});
  EXPECT_EQ(none.count, 0u);
  EXPECT_EQ(none.rmse, 0);
  const vpErrorStatistics one = vpErrorStatistics::of({-2});
  EXPECT_EQ(one.mean, -2);
  EXPECT_EQ(one.median, -2);
  EXPECT_EQ(one.rmse, 2);
  EXPECT_EQ(one.deviation, 0);
  EXPECT_EQ(one.percentile90, 2);
  EXPECT_EQ(one.largest, 2);
}

TEST(ErrorStatistics, OfDrawnGaussians)
{
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0.5, 2);
  std::vector<double> errors(200000);
  std::generate(errors.begin(), errors.end(), [&] { return normal(random); });
  const vpErrorStatistics s = vpErrorStatistics::of(errors);
  EXPECT_NEAR(s.mean, 0.5, 0.02);
  EXPECT_NEAR(s.median, 0.5, 0.02);
  EXPECT_NEAR(s.deviation, 2, 0.02);
  EXPECT_NEAR(s.rmse, std::hypot(0.5, 2), 0.02);
}

TEST(ErrorDistribution, PmfSumsToOneAndCdfCounts)
{
  std::mt19937 random(3);
  std::exponential_distribution<double> exponential(100);
  for (const size_t n : {1u, 2u, 10u, 5000u}) {
    std::vector<double> errors(n);
    std::generate(errors.begin(), errors.end(), [&] { return exponential(random); });
    const vpErrorDistribution distribution(errors);
    const auto &pmf = distribution.pmf();
    EXPECT_NEAR(std::accumulate(pmf.begin(), pmf.end(), 0.), 1, 1e-9);
    EXPECT_GE(pmf.size(), 5u);
    EXPECT_LE(pmf.size(), 21u);
    EXPECT_GT(pmf.back(), 0);
    // The two are one: up to the end of each bin.
    double sum = 0;
    for (size_t i = 0; i < pmf.size(); ++i) {
      sum += pmf[i];
      EXPECT_NEAR(distribution.cdf(static_cast<double>(i + 1) * distribution.binWidth()), sum, 1e-9);
    }
    EXPECT_EQ(distribution.cdf(*std::max_element(errors.begin(), errors.end())), 1);
    EXPECT_EQ(distribution.cdf(-1e-9), 0);
  }
}

TEST(ErrorDistribution, WidthOfBinsIsRound)
{
  EXPECT_NEAR(vpErrorDistribution({0.019}).binWidth(), 0.001, 1e-15);
  EXPECT_NEAR(vpErrorDistribution({0.021}).binWidth(), 0.002, 1e-15);
  EXPECT_NEAR(vpErrorDistribution({0.09}).binWidth(), 0.005, 1e-15);
  EXPECT_NEAR(vpErrorDistribution({0.11}).binWidth(), 0.01, 1e-15);
}

TEST(ErrorDistribution, OfNoErrorsAndOfZeros)
{
  const vpErrorDistribution none{{}};
  EXPECT_TRUE(none.pmf().empty());
  EXPECT_EQ(none.cdf(1), 0);
  const vpErrorDistribution zeros({0, 0, 0});
  ASSERT_EQ(zeros.pmf().size(), 1u);
  EXPECT_NEAR(zeros.pmf()[0], 1, 1e-12);
  EXPECT_EQ(zeros.cdf(0), 1);
}

TEST(ErrorDistribution, OfWhatIsNoDistanceIsRefused)
{
  vpExpectError([] { vpErrorDistribution({1, INFINITY}); }, {"errors: inf m, expected finite distances"});
  vpExpectError([] { vpErrorDistribution({-1}); }, {"errors: -1 m"});
  vpExpectError([] { vpErrorDistribution({NAN}); }, {"errors: nan m"});
}
