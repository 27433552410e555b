/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <gtest/gtest.h>
#include <visp3/vlp_evaluation/vpPosePairs.h>

#include "vlp_evaluation/madeTracks.h"

namespace
{
using namespace madeTracks;

//! The trajectory seen from another map, moved by M.
vpTrajectory moved(const vpTrajectory &trajectory, const vpHomogeneousMatrix &M)
{
  vpTrajectory other;
  for (const vpTimedPose &pose : trajectory.poses()) {
    other.add(pose.timestamp, M * pose.wMb);
  }
  return other;
}

double largestError(const std::vector<vpPosePair> &pairs, const vpHomogeneousMatrix &tTe)
{
  double largest = 0;
  for (vpPosePair pair : pairs) {
    pair.estimate = tTe * pair.estimate;
    largest = std::max({largest, pair.distance(), std::abs(pair.errorYaw()), std::abs(pair.errorZ())});
  }
  return largest;
}

double sumOfSquares(const std::vector<vpPosePair> &pairs, const vpHomogeneousMatrix &tTe)
{
  double sum = 0;
  for (vpPosePair pair : pairs) {
    pair.estimate = tTe * pair.estimate;
    sum += std::pow(pair.distance(), 2);
  }
  return sum;
}
} // namespace

TEST(PosePairs, ErrorsAreEstimateMinusTruth)
{
  vpPosePair pair;
  pair.estimate = pose(1.3, 1.6, -3.1, 0.2);
  pair.truth = pose(1, 2, 3.1, 0.5);
  EXPECT_NEAR(pair.errorX(), 0.3, 1e-15);
  EXPECT_NEAR(pair.errorY(), -0.4, 1e-15);
  EXPECT_NEAR(pair.errorZ(), -0.3, 1e-15);
  EXPECT_NEAR(pair.distance(), 0.5, 1e-15);
  EXPECT_NEAR(pair.errorYaw(), 2 * M_PI - 6.2, 1e-14); // the short way round
}

TEST(PosePairs, TruthIsInterpolatedToTheTimeOfTheEstimate)
{
  const vpTrajectory truth = straight({0, 0}, {9.9, 0}, 100); // 1 m/s
  vpTrajectory estimate;
  for (const double time : {0., 0.05, 1.234, 9.9}) {
    estimate.add(time, pose(time, 0, 0));
  }
  const vpPosePairs pairs = vpPosePairs::of(estimate, truth, 1);
  ASSERT_EQ(pairs.pairs.size(), 4u);
  EXPECT_LT(largestError(pairs.pairs, vpHomogeneousMatrix()), 1e-12);
}

TEST(PosePairs, CountsWhatHasNoTruth)
{
  vpTrajectory truth, estimate;
  for (const double time : {1., 2., 5., 6.}) {
    truth.add(time, pose(time, 0, 0));
  }
  for (const double time : {0., 0.999, 1., 1.5, 3., 4., 5., 6., 6.001}) {
    estimate.add(time, pose(time, 0, 0));
  }
  const vpPosePairs pairs = vpPosePairs::of(estimate, truth, 2);
  EXPECT_EQ(pairs.pairs.size(), 4u);
  EXPECT_EQ(pairs.outside, 3u);
  EXPECT_EQ(pairs.inGaps, 2u);
  EXPECT_EQ(vpPosePairs::of(estimate, truth, 3).inGaps, 0u);
  EXPECT_EQ(vpPosePairs::of(estimate, vpTrajectory(), 3).outside, 9u);
  EXPECT_TRUE(vpPosePairs::of(vpTrajectory(), truth, 3).pairs.empty());
}

TEST(Alignment, Se2UndoesAKnownMotionInThePlane)
{
  const vpTrajectory truth = eight();
  for (const double yaw : {0., 0.3, 1.6, 3.1, -2.5}) {
    const vpHomogeneousMatrix M = pose(3, -7, yaw);
    const vpPosePairs pairs = vpPosePairs::of(moved(truth, M), truth, 1);
    const vpHomogeneousMatrix tTe = vpAlignmentOf(pairs.pairs, vpAlignment::se2);
    EXPECT_LT(largestError(pairs.pairs, tTe), 1e-12) << yaw;
    EXPECT_NEAR(std::remainder(vpRollPitchYaw(tTe).z() + yaw, 2 * M_PI), 0, 1e-12);
  }
}

TEST(Alignment, Se2IsTheLeastOfAllMotionsNearby)
{
  const vpTrajectory truth = eight();
  const vpTrajectory noisy = moved(drawnFixes(truth, 10, 11).trajectory(), pose(1, 2, 0.4));
  const std::vector<vpPosePair> pairs = vpPosePairs::of(noisy, truth, 1).pairs;
  const vpHomogeneousMatrix tTe = vpAlignmentOf(pairs, vpAlignment::se2);
  const double least = sumOfSquares(pairs, tTe);
  for (const double step : {-1e-4, 1e-4}) {
    EXPECT_GT(sumOfSquares(pairs, pose(step, 0, 0) * tTe), least);
    EXPECT_GT(sumOfSquares(pairs, pose(0, step, 0) * tTe), least);
    EXPECT_GT(sumOfSquares(pairs, pose(0, 0, step) * tTe), least);
  }
}

TEST(Alignment, OriginLaysTheFirstPoseOnTheFirst)
{
  const vpTrajectory truth = eight();
  const vpHomogeneousMatrix M = vpPoseOf(Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(0.1, -0.2, 0.7));
  const vpPosePairs pairs = vpPosePairs::of(moved(truth, M), truth, 1);
  EXPECT_LT(largestError(pairs.pairs, vpAlignmentOf(pairs.pairs, vpAlignment::origin)), 1e-12);
}

TEST(Alignment, OfNoneOneAndEqualPoints)
{
  for (const vpAlignment alignment : {vpAlignment::none, vpAlignment::origin, vpAlignment::se2}) {
    const vpHomogeneousMatrix tTe = vpAlignmentOf({}, alignment);
    EXPECT_EQ(tTe[0][0], 1);
    EXPECT_EQ(tTe[0][3], 0);
  }
  const vpPosePair pair = {0, pose(1, 2, 0.5), pose(3, 5, 0.25)};
  for (const size_t n : {1u, 3u}) {
    const vpHomogeneousMatrix tTe =
        vpAlignmentOf(std::vector<vpPosePair>(n, pair), vpAlignment::se2); // shifts, does not turn
    EXPECT_EQ(vpRollPitchYaw(tTe).z(), 0);
    EXPECT_NEAR(tTe[0][3], 2, 1e-12);
    EXPECT_NEAR(tTe[1][3], 3, 1e-12);
  }
  EXPECT_EQ(vpAlignmentOf({pair}, vpAlignment::none)[0][3], 0);
}
