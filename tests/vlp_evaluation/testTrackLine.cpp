/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <gtest/gtest.h>
#include <visp3/vlp_evaluation/vpTrackLine.h>

#include "common/vpExpectError.h"
#include "vlp_evaluation/madeTracks.h"

namespace
{
using namespace madeTracks;
using Eigen::Vector2d;
} // namespace

TEST(TrackLine, DistanceIsThatFromTheWholeLine)
{
  const vpTrackLine line({0, 0}, {4, 3});
  EXPECT_NEAR(line.distance({4, 3}), 0, 1e-15);
  EXPECT_NEAR(line.distance({4, 8}), 4, 1e-12); // 5 above it, 4 from it
  EXPECT_NEAR(line.distance({8, 6}), 0, 1e-12); // beyond its end
  EXPECT_NEAR(line.distance({-3, 4}), 5, 1e-12);
}

TEST(TrackLine, OfOnePointIsRefused)
{
  vpExpectError([] { vpTrackLine({1, 2}, {1, 2}); }, {"line: from (1, 2) to (1, 2), expected two different"});
  vpExpectError([] { vpTrackLine({1, NAN}, {1, 2}); }, {"(1, nan)"});
}

TEST(TrackLine, OfATruthThatIsStraight)
{
  const auto line = vpTrackLine::of(straight({-0.35, 0}, {0.35, -0.005}));
  ASSERT_TRUE(line);
  EXPECT_NEAR(line->end().y(), -0.005, 1e-15);
  EXPECT_FALSE(vpTrackLine::of(vpTrajectory()));
  EXPECT_FALSE(vpTrackLine::of(eight()));
  EXPECT_FALSE(vpTrackLine::of(straight({0, 0}, {0.005, 0}))); // stands still
  vpTrajectory bent = straight({0, 0}, {1, 0});
  bent.add(100, pose(1.5, 0.5, 0));
  EXPECT_FALSE(vpTrackLine::of(bent));
}

TEST(FittedLine, FindsTheLineAlongEitherAxis)
{
  std::vector<Vector2d> flat, steep;
  for (int i = -10; i <= 10; ++i) {
    const double noise = 0.001 * (i % 2 == 0 ? 1 : -1);
    flat.emplace_back(0.035 * i, 0.0051 * 0.035 * i + 0.010714 + noise);
    steep.emplace_back(-0.0171 * 0.035 * i - 0.012286 + noise, 0.035 * i);
  }
  const auto a = vpFittedLine::of(flat), b = vpFittedLine::of(steep);
  ASSERT_TRUE(a && b);
  EXPECT_FALSE(a->alongY);
  EXPECT_NEAR(a->slope, 0.0051, 1e-3);
  EXPECT_NEAR(a->offset, 0.010714, 1e-4);
  EXPECT_TRUE(b->alongY);
  EXPECT_NEAR(b->slope, -0.0171, 1e-3);
  EXPECT_NEAR(b->at(2).y(), 2, 1e-15);
  EXPECT_NEAR(b->at(2).x(), 2 * b->slope + b->offset, 1e-15);
}

TEST(FittedLine, IsTheLeastSquares)
{
  const auto line = vpFittedLine::of({{0, 0}, {1, 2}, {2, 1}, {5, 4}});
  ASSERT_TRUE(line); // numpy.polyfit([0, 1, 2, 5], [0, 2, 1, 4], 1)
  EXPECT_NEAR(line->slope, 5. / 7, 1e-12);
  EXPECT_NEAR(line->offset, 7. / 4 - 2 * 5. / 7, 1e-12);
}

TEST(FittedLine, ReadsAsThePapersEquations)
{
  vpFittedLine line;
  line.slope = 0.0051;
  line.offset = 0.010714;
  EXPECT_EQ(line.textInCentimetres(), "y = 0.0051 x + 1.0714");
  line.alongY = true;
  line.slope = -0.0171;
  line.offset = -0.012286;
  EXPECT_EQ(line.textInCentimetres(), "x = -0.0171 y - 1.2286");
}

TEST(FittedLine, NeedsTwoPoints)
{
  EXPECT_FALSE(vpFittedLine::of({}));
  EXPECT_FALSE(vpFittedLine::of({{1, 2}}));
  EXPECT_FALSE(vpFittedLine::of({{1.1, 2.3}, {1.1, 2.3}, {1.1, 2.3}}));
  EXPECT_TRUE(vpFittedLine::of({{1, 2}, {1, 3}}));
}
