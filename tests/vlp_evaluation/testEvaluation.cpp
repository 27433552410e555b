/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <algorithm>
#include <optional>

#include <gtest/gtest.h>
#include <visp3/vlp_evaluation/vpEvaluation.h>

#include "common/vpExpectError.h"
#include "vlp_evaluation/madeTracks.h"

namespace
{
using namespace madeTracks;

std::optional<double> valueOf(const vpEvaluation &evaluation, const std::string &name)
{
  for (const vpStatistic &statistic : evaluation.statistics()) {
    if (statistic.name == name) {
      return statistic.value;
    }
  }
  return std::nullopt;
}
} // namespace

TEST(Evaluation, OfAKnownShift)
{
  const vpTrajectory truth = eight();
  vpTrajectory estimate;
  for (const vpTimedPose &at : truth.poses()) {
    estimate.add(at.timestamp, pose(0.003, 0.004, 0, -0.001) * at.wMb);
  }
  const vpEvaluation e = vpEvaluation::of(truth, estimate);
  EXPECT_EQ(e.pairs.size(), truth.size());
  EXPECT_NEAR(e.x.mean, 0.003, 1e-12);
  EXPECT_NEAR(e.y.median, 0.004, 1e-12);
  EXPECT_NEAR(e.z.mean, -0.001, 1e-12);
  EXPECT_NEAR(e.yaw.largest, 0, 1e-12);
  EXPECT_NEAR(e.horizontal.rmse, 0.005, 1e-12);
  EXPECT_NEAR(e.horizontal.percentile95, 0.005, 1e-12);
  EXPECT_NEAR(e.dispersion.diameter(), 0, 1e-12); // all errors are one
  EXPECT_FALSE(e.line);
  EXPECT_FALSE(e.fitted);
  EXPECT_FALSE(e.fixes);
  EXPECT_FALSE(valueOf(e, "line_mean"));
  EXPECT_FALSE(valueOf(e, "frames"));
  EXPECT_NEAR(*valueOf(e, "horizontal_mean"), 0.005, 1e-12);

  vpEvaluationSettings aligned;
  aligned.alignment = vpAlignment::se2;
  EXPECT_NEAR(vpEvaluation::of(truth, estimate, nullptr, aligned).horizontal.largest, 0, 1e-12);
}

TEST(Evaluation, DispersionOfAStandingRobotIsThatOfItsPositions)
{
  const vpTrajectory truth = straight({0.2, 0.1}, {0.2, 0.1}, 400);
  const vpTrajectory estimate = drawnFixes(truth, 1, 21).trajectory();
  std::vector<Eigen::Vector2d> positions;
  for (const vpTimedPose &at : estimate.poses()) {
    positions.push_back(positionOf(at.wMb));
  }
  const vpEvaluation e = vpEvaluation::of(truth, estimate);
  EXPECT_NEAR(e.dispersion.diameter(), vpDispersion::of(positions).diameter(), 1e-12);
  EXPECT_NEAR(e.dispersion.circleRadius, vpDispersion::of(positions).circleRadius, 1e-12);
  EXPECT_FALSE(e.line);
}

TEST(Evaluation, DistanceFromTheLineIsBesideTheErrorAgainstTruth)
{
  const vpTrajectory truth = straight({-0.35, 0}, {0.35, 0});
  vpTrajectory estimate; // late by 5 mm along the line, 2 mm beside it
  for (const vpTimedPose &at : truth.poses()) {
    estimate.add(at.timestamp, pose(at.wMb[0][3] - 0.005, 0.002, 0));
  }
  const vpEvaluation e = vpEvaluation::of(truth, estimate);
  ASSERT_TRUE(e.line && e.fitted);
  EXPECT_NEAR(e.lineDistance.mean, 0.002, 1e-12);
  EXPECT_NEAR(e.horizontal.mean, std::hypot(0.005, 0.002), 1e-12);
  EXPECT_NEAR(e.fitted->slope, 0, 1e-12);
  EXPECT_NEAR(e.fitted->offset, 0.002, 1e-12);
  EXPECT_NEAR(*valueOf(e, "line_p95"), 0.002, 1e-12);

  vpEvaluationSettings settings;
  settings.line.emplace(Eigen::Vector2d(0, 0.012), Eigen::Vector2d(1, 0.012));
  EXPECT_NEAR(vpEvaluation::of(truth, estimate, nullptr, settings).lineDistance.mean, 0.010, 1e-12);
}

TEST(Evaluation, ConsistencyOfDrawnErrorsIsWithinTheInterval)
{
  const vpTrajectory truth = eight(500);
  const vpFixLog log = drawnFixes(truth, 1, 22);
  const vpEvaluation e = vpEvaluation::of(truth, log.trajectory(), &log);
  ASSERT_TRUE(e.fixes);
  EXPECT_EQ(e.fixes->frames, 500u);
  EXPECT_EQ(e.fixes->share(), 1);
  EXPECT_NEAR(e.fixes->compute.mean, 0.03, 1e-12);
  for (const vpConsistency &c : {e.fixes->position, e.fixes->height, e.fixes->yaw}) {
    EXPECT_EQ(c.count(), 500u);
    EXPECT_GT(c.mean(), c.lower());
    EXPECT_LT(c.mean(), c.upper());
    EXPECT_NEAR(c.shareWithin95(), 0.95, 0.03);
  }
  const vpFixLog bold = drawnFixes(truth, 1.5, 22); // errors half as large again as stated
  const vpEvaluation b = vpEvaluation::of(truth, bold.trajectory(), &bold);
  EXPECT_NEAR(b.fixes->position.mean(), 2.25 * e.fixes->position.mean(), 1e-6);
  EXPECT_GT(b.fixes->yaw.mean(), b.fixes->yaw.upper());
}

TEST(Evaluation, ConsistencyLeavesOutWhatHasNoSigmaOrNoSinglePose)
{
  const vpTrajectory truth = eight(100);
  vpFixLog log = drawnFixes(truth, 1, 23);
  log.fixes[0].state = vpLoggedFix::State::ambiguous;
  log.fixes[1] = vpLoggedFix();
  log.fixes[1].timestamp = truth[1].timestamp;
  log.fixes[2].sigmaX = NAN;
  log.fixes[3].covXY = NAN;
  log.fixes[4].sigmaYaw = 0;
  const vpEvaluation e = vpEvaluation::of(truth, log.trajectory(), &log);
  EXPECT_EQ(e.pairs.size(), 98u);
  EXPECT_EQ(e.fixes->fixes, 98u);
  EXPECT_EQ(e.fixes->ambiguous, 1u);
  EXPECT_NEAR(e.fixes->share(), 0.98, 1e-12);
  EXPECT_EQ(e.fixes->position.count(), 96u);
  EXPECT_EQ(e.fixes->height.count(), 98u);
  EXPECT_EQ(e.fixes->yaw.count(), 97u);

  vpEvaluationSettings aligned;
  aligned.alignment = vpAlignment::origin;
  const vpEvaluation other = vpEvaluation::of(truth, log.trajectory(), &log, aligned);
  EXPECT_EQ(other.fixes->position.count(), 0u);
  EXPECT_EQ(other.fixes->frames, 100u);
  EXPECT_FALSE(valueOf(other, "nees_xy_mean"));
}

TEST(Evaluation, OfOnePoseIsSane)
{
  vpTrajectory truth, estimate;
  truth.add(3, pose(1, 2, 0.5));
  estimate.add(3, pose(1.003, 2.004, 0.5));
  vpEvaluationSettings settings;
  for (const vpAlignment alignment : {vpAlignment::none, vpAlignment::origin, vpAlignment::se2}) {
    settings.alignment = alignment;
    const vpEvaluation e = vpEvaluation::of(truth, estimate, nullptr, settings);
    EXPECT_EQ(e.pairs.size(), 1u);
    EXPECT_NEAR(e.horizontal.mean, alignment == vpAlignment::none ? 0.005 : 0, 1e-12);
    EXPECT_EQ(e.horizontal.deviation, 0);
    EXPECT_EQ(e.dispersion.diameter(), 0);
    EXPECT_EQ(e.dispersion.circleRadius, 0);
    EXPECT_FALSE(e.fitted);
    for (const vpStatistic &statistic : e.statistics()) {
      EXPECT_TRUE(std::isfinite(statistic.value)) << statistic.name;
    }
  }
}

TEST(Evaluation, OfNothingIsSane)
{
  const vpTrajectory truth = eight();
  vpTrajectory late;
  late.add(1000, pose(0, 0, 0));
  for (const vpTrajectory &estimate : {vpTrajectory(), late}) {
    for (const vpTrajectory &base : {truth, vpTrajectory()}) {
      const vpEvaluation e = vpEvaluation::of(base, estimate);
      EXPECT_TRUE(e.pairs.empty());
      EXPECT_EQ(e.outside, estimate.size());
      EXPECT_EQ(e.horizontal.count, 0u);
      EXPECT_FALSE(e.fitted);
      EXPECT_FALSE(valueOf(e, "horizontal_mean"));
    }
  }
  vpEvaluationSettings bad;
  bad.longestGap = 0;
  vpExpectError([&] { vpEvaluation::of(truth, truth, nullptr, bad); }, {"longest gap", "0 s"});
}

TEST(Evaluation, CsvHasARowForEachStatistic)
{
  const vpTrajectory truth = straight({0, 0}, {1, 0});
  const vpFixLog log = drawnFixes(truth, 1, 24);
  const vpEvaluation e = vpEvaluation::of(truth, log.trajectory(), &log);
  const std::string csv = e.csv();
  EXPECT_EQ(csv.rfind("name,unit,value\ntruth_poses,1,100\n", 0), 0u);
  EXPECT_EQ(static_cast<size_t>(std::count(csv.begin(), csv.end(), '\n')), e.statistics().size() + 1);
  for (const char *part :
       {"\nhorizontal_p95,m,", "\nyaw_rmse,rad,", "\ndispersion_radius,m,", "\nfit_slope,1,",
        "\ncompute_mean,s,0.03", "\nnees_xy_upper,1,", "\nfix_share,1,1\n"}) {
    EXPECT_NE(csv.find(part), std::string::npos) << part;
  }
}
