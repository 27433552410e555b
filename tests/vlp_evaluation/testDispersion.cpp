/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <visp3/vlp_evaluation/vpDispersion.h>

#include "common/vpExpectError.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
using Eigen::Vector2d;
using Points = std::vector<Vector2d>;

double farthestByBruteForce(const Points &points)
{
  double farthest = 0;
  for (const Vector2d &a : points) {
    for (const Vector2d &b : points) {
      farthest = std::max(farthest, (a - b).norm());
    }
  }
  return farthest;
}

/*!
  The circle holds all points, and no smaller one does: the points that it touches do not all lie in one half
  of it, so that it cannot move away from them.
*/
void expectSmallestCircle(const Points &points, const vpDispersion &dispersion)
{
  std::vector<double> touching; // angles
  for (const Vector2d &point : points) {
    const Vector2d d = point - dispersion.centre;
    EXPECT_LE(d.norm(), dispersion.circleRadius * (1 + 1e-9));
    if (d.norm() >= dispersion.circleRadius * (1 - 1e-9)) {
      touching.push_back(std::atan2(d.y(), d.x()));
    }
  }
  ASSERT_GE(touching.size(), 2u);
  std::sort(touching.begin(), touching.end());
  touching.push_back(touching.front() + 2 * M_PI);
  for (size_t i = 1; i < touching.size(); ++i) {
    EXPECT_LE(touching[i] - touching[i - 1], M_PI + 1e-6);
  }
}

void expectRight(const Points &points)
{
  const vpDispersion dispersion = vpDispersion::of(points);
  const double farthest = farthestByBruteForce(points);
  EXPECT_NEAR(dispersion.diameter(), farthest, 1e-12 * farthest);
  EXPECT_EQ(dispersion.radius(), 0.5 * dispersion.diameter());
  for (const Vector2d &end : {dispersion.first, dispersion.second}) {
    EXPECT_TRUE(std::any_of(points.begin(), points.end(),
                            [&](const Vector2d &point) { return (point - end).norm() < 1e-12; }));
  }
  EXPECT_GE(dispersion.circleRadius, dispersion.radius() * (1 - 1e-12));
  EXPECT_LE(dispersion.circleRadius, 2 / std::sqrt(3) * dispersion.radius() * (1 + 1e-12)); // Jung
  expectSmallestCircle(points, dispersion);
}
} // namespace

TEST(Dispersion, OfRandomPoints)
{
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    Points points(2 + trial % 50);
    const double flat = std::pow(10., -(trial % 5)); // from round clouds to needles
    for (Vector2d &point : points) {
      point = Vector2d(normal(random), flat * normal(random));
    }
    expectRight(points);
  }
}

TEST(Dispersion, OfGridsRingsAndLines)
{
  Points grid, ring, line, triangle;
  for (int i = 0; i < 15; ++i) {
    for (int j = 0; j < 9; ++j) {
      grid.emplace_back(i, j);
    }
    line.emplace_back(0.1 * i, -0.3 * i);
  }
  for (int i = 0; i < 101; ++i) {
    ring.emplace_back(std::cos(2 * M_PI * i / 101), std::sin(2 * M_PI * i / 101));
  }
  for (const double angle : {0., 2., 4.}) {
    triangle.emplace_back(std::cos(angle * M_PI / 3), std::sin(angle * M_PI / 3));
  }
  expectRight(grid);
  expectRight(ring);
  expectRight(line);
  expectRight(triangle);
  EXPECT_NEAR(vpDispersion::of(ring).circleRadius, 1, 1e-12);
  EXPECT_NEAR(vpDispersion::of(triangle).circleRadius, 1, 1e-12);
  EXPECT_NEAR(vpDispersion::of(triangle).radius(), std::sqrt(3) / 2, 1e-12);
}

TEST(Dispersion, MicrometresFarFromTheOrigin)
{
  const Vector2d away(123.4, -56.7);
  const Points points = {away, away + Vector2d(4e-6, 0), away + Vector2d(0, 3e-6)};
  const vpDispersion dispersion = vpDispersion::of(points);
  EXPECT_NEAR(dispersion.diameter(), 5e-6, 1e-12);
  EXPECT_NEAR(dispersion.circleRadius, 2.5e-6, 1e-12);
  EXPECT_LT((dispersion.centre - away - Vector2d(2e-6, 1.5e-6)).norm(), 1e-12);
}

TEST(Dispersion, OfFewOrEqualPoints)
{
  const vpDispersion none = vpDispersion::of({});
  EXPECT_EQ(none.diameter(), 0);
  EXPECT_EQ(none.circleRadius, 0);
  for (const size_t n : {1u, 2u, 7u}) {
    const vpDispersion same = vpDispersion::of(Points(n, Vector2d(3, 4)));
    EXPECT_EQ(same.diameter(), 0);
    EXPECT_EQ(same.circleRadius, 0);
    EXPECT_EQ(same.centre, Vector2d(3, 4));
  }
  vpExpectError([] { vpDispersion::of({Vector2d(0, NAN)}); }, {"not finite"});
}

TEST(Dispersion, OfManyPointsIsFast)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(0, 2 * M_PI);
  Points points(200000); // all of them on the hull: by pairs it would take minutes
  for (Vector2d &point : points) {
    const double a = angle(random);
    point = Vector2d(std::cos(a), std::sin(a));
  }
  const auto start = std::chrono::steady_clock::now();
  const vpDispersion dispersion = vpDispersion::of(points);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 20);
  EXPECT_NEAR(dispersion.circleRadius, 1, 1e-9);
  EXPECT_NEAR(dispersion.diameter(), 2, 1e-6);
}
