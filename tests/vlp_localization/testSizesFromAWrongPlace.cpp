/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Lamps' sizes that were learned while the place was wrong.

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/vpSeenLamps.h"

TEST(LampSizes, LearnedFromAWrongPlaceDoNotForbidTheRightOne)
{
  const vpSeenLamps ceiling(4);
  vpVlpLocalizer localizer(ceiling.rig, ceiling.map);
  std::mt19937_64 generator(1);
  const auto stands = [](double) { return vpPlannedPlace(); };
  const Eigen::Vector2d principalPoint(399.5, 299.5); // px
  const double farther = 1.15;                        // of the middles, as of a camera 0.2 m higher
  const int wrong = 20, all = 30;                     // frames
  for (int frame = 0; frame < all; ++frame) {
    const double t = 1 + 0.1 * frame; // s
    localizer.filter.addOdometry({t, 0, 0});
    std::vector<vpLampObservation> seen = ceiling.see(t, stands, generator, std::vector<bool>(4, true));
    for (vpLampObservation &lamp : seen) {
      if (frame < wrong) {
        const Eigen::Vector2d moved = (farther - 1) * (lamp.point - principalPoint);
        lamp.point += moved;
        lamp.outline.centre += moved;
      }
    }
    const vpVlpLocation location = localizer.locate(t, seen);
    ASSERT_TRUE(location.fix.valid) << location.fix.refusal;
    const double z = location.fix.wMb[2][3];
    if (frame < wrong) {
      EXPECT_GT(z, 0.1) << "else the test tests nothing";
    } else if (frame > wrong + 1) {
      EXPECT_NEAR(z, 0, 0.005) << frame;
      EXPECT_EQ(location.fix.lamps.size(), 4u) << frame;
    }
  }
}
