/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <gtest/gtest.h>
#include <visp3/vlp_evaluation/vpFixLog.h>

#include "common/vpExpectError.h"
#include "common/vpTemporaryFolder.h"
#include "vlp_evaluation/madeTracks.h"

namespace
{
const std::string header =
    "timestamp_s,x,y,z,roll,pitch,yaw,sigma_x,sigma_y,sigma_z,sigma_yaw,cov_xy,lamps,state,compute_s\n";
const std::string good = "0,1,2,3,0.1,0.2,0.3,0.01,0.02,0.03,0.04,0.0001,A;B,fix,0.05\n";
} // namespace

TEST(FixLog, ReadsEachState)
{
  const vpTemporaryFolder folder;
  const vpFixLog log =
      vpFixLog::load(folder.write("fixes.csv", header + good +
                                                   "1,,,,,,,,,,,,,none,0.01\n"
                                                   "2,1,2,3,0,0,0,,,,,,A;B,ambiguous,0.06\n"));
  ASSERT_EQ(log.fixes.size(), 3u);
  EXPECT_EQ(log.count(), 1u);
  const vpLoggedFix &fix = log.fixes[0];
  EXPECT_EQ(fix.state, vpLoggedFix::State::fix);
  EXPECT_EQ(fix.wMb[2][3], 3);
  EXPECT_LT((vpRollPitchYaw(fix.wMb) - Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 1e-14);
  EXPECT_EQ(fix.sigmaY, 0.02);
  EXPECT_EQ(fix.sigmaYaw, 0.04);
  EXPECT_EQ(fix.covXY, 0.0001);
  EXPECT_EQ(fix.compute, 0.05);
  EXPECT_EQ(log.fixes[1].state, vpLoggedFix::State::none);
  EXPECT_EQ(log.fixes[2].state, vpLoggedFix::State::ambiguous);
  EXPECT_TRUE(std::isnan(log.fixes[2].sigmaX));
  const vpTrajectory trajectory = log.trajectory();
  ASSERT_EQ(trajectory.size(), 1u);
  EXPECT_EQ(trajectory[0].timestamp, 0);
  EXPECT_TRUE(vpFixLog::load(folder.write("none.csv", header)).fixes.empty());
}

TEST(FixLog, FramesMayComeLateAndTheTrajectoryIsOfThoseInOrder)
{
  const vpTemporaryFolder folder;
  const vpFixLog log = vpFixLog::load(folder.write("fixes.csv", header + good +
                                                                    "2,5,2,3,0,0,0,,,,,,A;B,fix,0.1\n"
                                                                    "1,,,,,,,,,,,,,none,0.01\n"
                                                                    "1,6,2,3,0,0,0,,,,,,A;B,fix,0.1\n"
                                                                    "2,7,2,3,0,0,0,,,,,,A;B,fix,0.1\n"
                                                                    "3,8,2,3,0,0,0,,,,,,A;B,fix,0.1\n"));
  EXPECT_EQ(log.fixes.size(), 6u);
  EXPECT_EQ(log.count(), 5u);
  const vpTrajectory trajectory = log.trajectory();
  ASSERT_EQ(trajectory.size(), 3u);
  EXPECT_EQ(trajectory[1].wMb[0][3], 5);
  EXPECT_EQ(trajectory[2].wMb[0][3], 8);
}

TEST(FixLog, BadFilesAreRefusedWithFileLineAndColumn)
{
  const std::vector<std::pair<std::string, std::string>> all = {
      {"nan,1,2,3,0,0,0,,,,,,A,fix,0.1\n", ":3: timestamp_s: nan, expected a finite number"},
      {"1,1,2,3,0,0,0,,,,,,A,good,0.1\n",
       ":3: state: good, expected fix, tracking, coasting, relocated, ambiguous or none"},
      {"1,1,2,3,0,0,0,,,,,,A,,0.1\n",
       ":3: state: nothing, expected fix, tracking, coasting, relocated, ambiguous or none"},
      {"1,,2,3,0,0,0,,,,,,A,fix,0.1\n", ":3: x: nothing, expected a finite number"},
      {"1,1,2,nan,0,0,0,,,,,,A,ambiguous,0.1\n", ":3: z: nan, expected a finite number"},
      {"1,1,2,3,0,0,0,-1,,,,,A,fix,0.1\n", ":3: sigma_x: -1, expected a number of 0 or more"},
      {"1,1,2,3,0,0,0,1,1,1,1,1.1,A,fix,0.1\n", ":3: cov_xy: 1.1, expected a magnitude of no more than"},
      {"1,1,,,,,,,,,,,,none,0.1\n", ":3: x: 1, expected nothing, since state is none"},
      {"1,,,,,,,,,,,,,none,\n", ":3: compute_s: nothing, expected a finite number"},
      {"1,,,,,,,,,,,,,none,-1\n", ":3: compute_s: -1, expected a number of 0 or more"},
      {"1,2,3\n", ":3: 3 fields, expected 15"},
  };
  for (const auto &[row, part] : all) {
    SCOPED_TRACE(row);
    const vpTemporaryFolder folder;
    const std::string file = folder.write("fixes.csv", header + good + row);
    vpExpectError([&] { vpFixLog::load(file); }, {file + part});
  }
}
