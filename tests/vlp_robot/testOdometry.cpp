/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <visp3/vlp_robot/vpOdometry.h>

#include "common/vpExpectError.h"
#include "common/vpTemporaryFolder.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

TEST(OdometryFile, ReadsBackUnchanged)
{
  const vpTemporaryFolder folder;
  const std::vector<vpOdometry> samples = {{0, 0, 0}, {0.02, 1.0 / 3, -1e-9}, {1.7e9 + 0.1, -0.2, 2.5}};
  vpWriteOdometry(folder / "odometry.csv", samples);
  EXPECT_EQ(folder.read("odometry.csv").substr(0, 34), "timestamp_s,v_m_s,w_rad_s\n0,0,0\n0.");
  const std::vector<vpOdometry> back = vpReadOdometry(folder / "odometry.csv");
  ASSERT_EQ(back.size(), samples.size());
  for (size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(back[i].timestamp, samples[i].timestamp);
    EXPECT_EQ(back[i].v, samples[i].v);
    EXPECT_EQ(back[i].w, samples[i].w);
  }
}

TEST(OdometryFile, BadFilesAreRefused)
{
  struct Bad {
    std::string text, part;
  };
  const std::string head = "timestamp_s,v_m_s,w_rad_s\n";
  const std::vector<Bad> all = {
      {"", ":1: header: nothing, expected timestamp_s,v_m_s,w_rad_s"},
      {"time,v,w\n0,0,0\n", ":1: header: time,v,w, expected"},
      {head, ": no samples, expected one or more"},
      {head + "0,0\n", ":2: 2 fields, expected 3"},
      {head + "0,fast,0\n", ":2: v_m_s: fast, expected a finite number"},
      {head + "0,0,nan\n", ":2: w_rad_s: nan, expected a finite number"},
      {head + "1,0,0\n1,0,0\n", ":3: timestamp_s: 1, expected a time after that of the line above"},
      {head + "1,0,0\n2,0,0\n1.5,0,0\n", ":4: timestamp_s: 1.5, expected a time after"},
  };
  for (const Bad &bad : all) {
    SCOPED_TRACE(bad.text);
    const vpTemporaryFolder folder;
    const std::string file = folder.write("odometry.csv", bad.text);
    vpExpectError([&] { vpReadOdometry(file); }, {file + bad.part});
  }
  vpExpectError([] { vpReadOdometry("/none.csv"); }, {"/none.csv: cannot be opened"});
}

TEST(OdometryFile, WhatCouldNotBeReadIsNotWritten)
{
  const vpTemporaryFolder folder;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string file = folder / "odometry.csv";
  vpExpectError(
      [&] {
        vpWriteOdometry(file, {{0, 0, 0}, {0, 1, 1}});
      },
      {"odometry.csv: sample 1: timestamp_s: 0, expected a finite time after"});
  vpExpectError([&] { vpWriteOdometry(file, {{nan, 0, 0}}); }, {"sample 0: timestamp_s: nan"});
  vpExpectError([&] { vpWriteOdometry(file, {{0, nan, 0}}); }, {"sample 0: v_m_s: nan, expected a finite"});
  vpExpectError([&] { vpWriteOdometry(file, {{0, 0, -1 / 0.0}}); }, {"sample 0: w_rad_s: -inf, expected"});
  EXPECT_EQ(folder.count(), 0u);
  vpExpectError([&] { vpWriteOdometry(folder / "a/b.csv", {}); }, {"a/b.csv: cannot be written"});
}
