/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <visp3/vlp_core/vpPoseText.h>
#include <visp3/vlp_core/vpTrajectory.h>

#include "common/vpExpectError.h"
#include "common/vpTemporaryFolder.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
vpHomogeneousMatrix pose(double x, double y, double yaw)
{
  return vpPoseOf(Eigen::Vector3d(x, y, 0), Eigen::Vector3d(0, 0, yaw));
}

double largestDifference(const vpHomogeneousMatrix &a, const vpHomogeneousMatrix &b)
{
  double largest = 0;
  for (unsigned int i = 0; i < 16; ++i) {
    largest = std::max(largest, std::abs(a.data[i] - b.data[i]));
  }
  return largest;
}
} // namespace

TEST(PoseText, RollPitchYawAndPoseAreInverse)
{
  std::mt19937 random(4);
  std::uniform_real_distribution<double> angle(-1.5, 1.5);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d angles(2 * angle(random), angle(random), 2 * angle(random));
    const vpHomogeneousMatrix wMb = vpPoseOf(Eigen::Vector3d(1, -2, 3), angles);
    ASSERT_LT((vpRollPitchYaw(wMb) - angles).norm(), 1e-9);
    ASSERT_LT(largestDifference(vpPoseOf(Eigen::Vector3d(1, -2, 3), vpQuaternionOf(wMb)), wMb), 1e-14);
  }
}

TEST(PoseText, RowIsTumWithPositiveW)
{
  EXPECT_EQ(vpTumRow(1.5, vpHomogeneousMatrix()), "1.5 0 0 0 0 0 0 1");
  const std::string row = vpTumRow(0, pose(1, 2, 1.5 * M_PI)); // the same turn as -90 degrees
  EXPECT_EQ(row.rfind("0 1 2 0 0 0 -0.707106781186547", 0), 0u) << row;
}

TEST(Trajectory, ReadsWhatItWrites)
{
  const vpTemporaryFolder folder;
  vpTrajectory trajectory;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d position(normal(random), normal(random), normal(random));
    const Eigen::Vector3d angles(normal(random), 0.3 * normal(random), normal(random));
    trajectory.add(0.1 * i, vpPoseOf(position, angles));
  }
  trajectory.save(folder / "a.tum");
  const vpTrajectory back = vpTrajectory::load(folder / "a.tum");
  ASSERT_EQ(back.size(), 200u);
  for (size_t i = 0; i < back.size(); ++i) {
    EXPECT_EQ(back[i].timestamp, trajectory[i].timestamp);
    EXPECT_LT(largestDifference(back[i].wMb, trajectory[i].wMb), 1e-14);
  }
  EXPECT_EQ(folder.count(), 1u);
  vpExpectError([&] { trajectory.save("/none/a.tum"); }, {"/none/a.tum: cannot be written: No such file"});
}

TEST(Trajectory, ReadsCommentsBlanksAndLineEnds)
{
  const vpTemporaryFolder folder;
  const vpTrajectory trajectory =
      vpTrajectory::load(folder.write("a.tum", "\xEF\xBB\xBF# head\r\n\n  # indented\n"
                                               "-1 1 2 3 0 0 0 1\r\n"
                                               " 0.5\t1  2 3e0 0 0 0.995 0 \n\n"
                                               "7 1 2 3 0 0 0 -1.005"));
  ASSERT_EQ(trajectory.size(), 3u);
  EXPECT_EQ(trajectory[0].timestamp, -1);
  EXPECT_EQ(trajectory[0].wMb[2][3], 3);
  EXPECT_NEAR(trajectory[1].wMb[0][0], -1, 1e-15); // normalised
  EXPECT_NEAR(trajectory[2].wMb[0][0], 1, 1e-15);
  EXPECT_TRUE(vpTrajectory::load(folder.write("b.tum", "")).empty());
  EXPECT_TRUE(vpTrajectory::load(folder.write("c.tum", "# nothing\n")).empty());
}

TEST(Trajectory, BadFilesAreRefusedWithFileLineAndField)
{
  const std::string good = "# head\n0 1 2 3 0 0 0 1\n";
  const std::vector<std::pair<std::string, std::string>> all = {
      {"1 2 3\n", ":3: 3 fields, expected 8: timestamp tx ty tz qx qy qz qw"},
      {"1\n", ":3: 1 field, expected 8"},
      {"1 1 2 3 0 0 0 1 9\n", ":3: 9 fields, expected 8"},
      {"1,1,2,3,0,0,0,1\n", ":3: 1 field, expected 8"},
      {"1 one 2 3 0 0 0 1\n", ":3: tx: one, expected a finite number"},
      {"nan 1 2 3 0 0 0 1\n", ":3: timestamp: nan, expected a finite number"},
      {"1 1 inf 3 0 0 0 1\n", ":3: ty: inf, expected a finite number"},
      {"1 1 2 3 0 0 0 1e999\n", ":3: qw: 1e999, expected a finite number"},
      {"1 1 2 3 0 0 0 0\n", ":3: qx qy qz qw: of length 0, expected a unit quaternion"},
      {"1 1 2 3 0 0 0 1.02\n", ":3: qx qy qz qw: of length 1.02, expected a unit quaternion"},
      {"1 1 2 3 0 0 0 1e308\n", ":3: qx qy qz qw: of length "},
      {"\n0 1 2 3 0 0 0 1\n", ":4: timestamp: 0, expected a time after that of the row above, 0"},
      {"-1 1 2 3 0 0 0 1\n", ":3: timestamp: -1, expected a time after that of the row above, 0"},
      {"1 1 2 3 0 0 0 1 # end\n", ":3: 10 fields, expected 8"},
  };
  for (const auto &[rows, part] : all) {
    SCOPED_TRACE(rows);
    const vpTemporaryFolder folder;
    const std::string file = folder.write("a.tum", good + rows);
    vpExpectError([&] { vpTrajectory::load(file); }, {file + part});
  }
  vpExpectError([] { vpTrajectory::load("/none.tum"); }, {"/none.tum: cannot be opened: No such file"});
}

TEST(Trajectory, AddRefusesTimesThatDoNotIncrease)
{
  vpTrajectory trajectory;
  vpExpectError([&] { trajectory.add(NAN, vpHomogeneousMatrix()); }, {"timestamp: nan, expected a finite"});
  trajectory.add(1, vpHomogeneousMatrix());
  vpExpectError([&] { trajectory.add(1, vpHomogeneousMatrix()); }, {"timestamp: 1, expected a time after"});
}

TEST(Trajectory, InterpolatesPositionLinearlyAndRotationEvenly)
{
  vpTrajectory trajectory;
  trajectory.add(10, pose(0, 0, 0));
  trajectory.add(12, pose(4, -2, 1));
  const auto middle = trajectory.at(10.5);
  ASSERT_TRUE(middle);
  EXPECT_LT(largestDifference(*middle, pose(1, -0.5, 0.25)), 1e-15);
  EXPECT_LT(largestDifference(*trajectory.at(10), pose(0, 0, 0)), 1e-15);
  EXPECT_LT(largestDifference(*trajectory.at(12), pose(4, -2, 1)), 1e-15);
}

TEST(Trajectory, InterpolatesAcrossTheWrapOfYaw)
{
  vpTrajectory trajectory;
  trajectory.add(0, pose(0, 0, M_PI - 0.1));
  trajectory.add(1, pose(0, 0, -M_PI + 0.3)); // 0.4 rad further
  for (const double share : {0.1, 0.25, 0.5, 0.9}) {
    const double yaw = vpRollPitchYaw(*trajectory.at(share)).z();
    EXPECT_NEAR(std::remainder(yaw - (M_PI - 0.1 + 0.4 * share), 2 * M_PI), 0, 1e-14) << share;
  }
}

TEST(Trajectory, NeitherExtrapolatesNorBridgesLongGaps)
{
  vpTrajectory trajectory;
  EXPECT_FALSE(trajectory.at(0));
  trajectory.add(0, pose(0, 0, 0));
  EXPECT_TRUE(trajectory.at(0));
  EXPECT_FALSE(trajectory.at(1e-9));
  trajectory.add(1, pose(1, 0, 0));
  trajectory.add(5, pose(5, 0, 0));
  EXPECT_FALSE(trajectory.at(-1e-9));
  EXPECT_FALSE(trajectory.at(5.0001));
  EXPECT_FALSE(trajectory.at(NAN));
  EXPECT_TRUE(trajectory.at(3));
  EXPECT_TRUE(trajectory.at(0.5, 1));
  EXPECT_FALSE(trajectory.at(3, 3.9));
  EXPECT_TRUE(trajectory.at(3, 4));
  EXPECT_TRUE(trajectory.at(5, 0.1)); // a row of its own
}
