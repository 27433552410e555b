/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Paths: their length, places, headings and bends agree with each other, and files keep them.

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <visp3/vlp_servo/vpPath.h>

#include "common/vpExpectError.h"
#include "common/vpTemporaryFolder.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
const std::vector<Eigen::Vector2d> squareCorners = {
    {-0.35, -0.35}, {0.35, -0.35}, {0.35, 0.35}, {-0.35, 0.35}};

std::vector<vpPath> paths()
{
  return {vpPath::polyline({{-0.35, 0}, {0.35, -0.005}}),
          vpPath::polyline(squareCorners, true),
          vpPath::polyline({{0, 0}, {1, 0}, {0.5, 0.1}, {0.5, 2}}),
          vpPath::circle({0.1, -0.2}, 0.3),
          vpPath::arc({0, 1}, 0.5, 2, -1),
          vpPath::lemniscate({-0.1, 0.05}, 0.7)};
}
} // namespace

TEST(Path, LengthOfTheShapes)
{
  EXPECT_DOUBLE_EQ(vpPath::polyline(squareCorners, true).length(), 2.8);
  EXPECT_DOUBLE_EQ(vpPath::polyline(squareCorners).length(), 2.1);
  EXPECT_DOUBLE_EQ(vpPath::circle({1, 2}, 0.3).length(), 0.6 * M_PI);
  EXPECT_DOUBLE_EQ(vpPath::arc({1, 2}, 0.3, 1, 0).length(), 0.3);
  // Half of a lemniscate of half-width a is the lemniscate constant times a.
  EXPECT_NEAR(vpPath::lemniscate({0, 0}, 2).length(), 2 * 2.622057554292119, 1e-9);
}

TEST(Path, EveryMillimetreIsOne)
{
  for (const vpPath &path : paths()) {
    const double step = 1e-3;
    for (double s = 0; s + step < path.length(); s += step) {
      const vpPathPoint a = path.at(s), b = path.at(s + step);
      bool corner = false;
      for (const double at : path.corners()) {
        corner = corner || (at > s - 1e-8 && at < s + step + 1e-8);
      }
      if (corner) {
        continue;
      }
      const Eigen::Vector2d way = b.place - a.place;
      EXPECT_NEAR(way.norm(), step, 1e-3 * step);
      EXPECT_NEAR(
          std::remainder(std::atan2(way.y(), way.x()) - a.heading - 0.5 * step * a.curvature, 2 * M_PI), 0,
          1e-4);
      EXPECT_NEAR(std::remainder(b.heading - a.heading, 2 * M_PI), step * 0.5 * (a.curvature + b.curvature),
                  1e-5);
    }
  }
}

TEST(Path, ClosedOnesGoRoundAndOpenOnesEnd)
{
  for (const vpPath &path : paths()) {
    const double all = path.length();
    EXPECT_NEAR((path.at(all + 0.1).place - path.at(path.closed() ? 0.1 : all).place).norm(), 0, 1e-9);
    EXPECT_NEAR((path.at(-0.1).place - path.at(path.closed() ? all - 0.1 : 0).place).norm(), 0, 1e-9);
  }
}

TEST(Path, CornersAreThoseWhereARobotMustTurn)
{
  EXPECT_EQ(vpPath::polyline(squareCorners, true).corners().size(), 4u);
  EXPECT_EQ(vpPath::polyline(squareCorners).corners().size(), 2u);
  EXPECT_TRUE(vpPath::polyline({{0, 0}, {1, 0}, {2, 0.05}}).corners().empty()); // 3 degrees
  EXPECT_EQ(vpPath::polyline({{0, 0}, {1, 0}, {0, 0}}).corners().size(), 1u);   // and back
}

TEST(Path, ACornerIsOneOnEveryLap)
{
  const vpPath path = vpPath::polyline(squareCorners, true);
  for (int lap = 0; lap < 50; ++lap) {
    for (const double corner : path.corners()) {
      const double s = lap * path.length() + corner;
      EXPECT_NEAR(std::remainder(path.at(s).heading - path.at(s + 0.1).heading, 2 * M_PI), 0, 1e-9) << s;
    }
  }
}

TEST(Path, ClosestPlaceIsNoFartherThanAnyOther)
{
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(-0.6, 0.6);
  for (const vpPath &path : paths()) {
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector2d place(uniform(generator), uniform(generator));
      const double best = (path.at(path.closest(place)).place - place).norm();
      for (double s = 0; s <= path.length(); s += 1e-3) {
        EXPECT_LE(best, (path.at(s).place - place).norm() + 1e-7);
      }
    }
  }
}

TEST(Path, OffsetIsToTheLeft)
{
  const vpPath circle = vpPath::circle({0, 0}, 0.3);
  EXPECT_NEAR(circle.offset({0.25, 0}, 0), 0.05, 1e-9); // inside: left of one that turns left
  EXPECT_NEAR(circle.offset({0.35, 0}, 0), -0.05, 1e-9);
}

TEST(Path, FilesReadBackAsTheyWere)
{
  const vpTemporaryFolder folder;
  for (const vpPath &path : paths()) {
    path.save(folder / "path.yaml");
    const vpPath read = vpPath::load(folder / "path.yaml");
    EXPECT_EQ(read.closed(), path.closed());
    ASSERT_DOUBLE_EQ(read.length(), path.length());
    for (double s = 0; s <= path.length(); s += 0.01) {
      EXPECT_NEAR((read.at(s).place - path.at(s).place).norm(), 0, 1e-12);
      EXPECT_NEAR(std::remainder(read.at(s).heading - path.at(s).heading, 2 * M_PI), 0, 1e-12);
    }
  }
}

TEST(Path, ReadyMadeOnesAreThoseOfTheDesign)
{
  const std::string data = std::string(VLP_DATA_DIR) + "/paths/";
  EXPECT_NEAR(vpPath::load(data + "line-a.yaml").length(), std::hypot(0.7, 0.005), 1e-12);
  EXPECT_NEAR(vpPath::load(data + "line-b.yaml").length(), std::hypot(0.7, 0.01), 1e-12);
  EXPECT_NEAR(vpPath::load(data + "square.yaml").length(), 2.8, 1e-12);
  EXPECT_NEAR(vpPath::load(data + "circle.yaml").length(), 0.6 * M_PI, 1e-12);
  EXPECT_TRUE(vpPath::load(data + "lemniscate.yaml").closed());
}

TEST(Path, BadFilesAreOneLine)
{
  const vpTemporaryFolder folder;
  const auto refused = [&folder](const std::string &text, const std::vector<std::string> &parts) {
    const std::string name = folder.write("path.yaml", text + "\n");
    std::vector<std::string> all = parts;
    all.push_back(name);
    vpExpectError([&name] { vpPath::load(name); }, all);
  };
  refused("{type: spiral}", {"type: spiral", "polyline", "lemniscate"});
  refused("{type: polyline}", {"points_m: missing"});
  refused("{type: polyline, points_m: [[0, 0]]}", {"points_m: 1", "two or more"});
  refused("{type: polyline, points_m: [[0, 0], [1]]}", {"points_m[1]", "2 numbers"});
  refused("{type: polyline, points_m: [[0, 0], [1, nan]]}", {"points_m[1]", "2 numbers"});
  refused("{type: polyline, points_m: [[0, 0], [0, 0]]}", {"points_m[1]", "point before"});
  refused("{type: polyline, points_m: [[0, 0], [1, 0]], closed: maybe}", {"closed: maybe"});
  refused("{type: polyline, points_m: [[0, 0], [1, 0]], speed: 1}", {"speed", "unknown key"});
  refused("{type: circle, centre_m: [0, 0], radius_m: 0}", {"radius_m: 0"});
  refused("{type: circle, centre_m: [0, 0], radius_m: -1}", {"radius_m: -1"});
  refused("{type: circle, centre_m: [0, 0, 0], radius_m: 1}", {"centre_m", "2 numbers"});
  refused("{type: arc, centre_m: [0, 0], radius_m: 1, from_deg: 10, to_deg: 10}", {"to_deg"});
  refused("{type: arc, centre_m: [0, 0], radius_m: 1, from_deg: 0, to_deg: 400}", {"to_deg", "360"});
  refused("{type: lemniscate, centre_m: [0, 1e9], width_m: 1}", {"centre_m"});
  refused("", {"nothing"});
  vpExpectError([&folder] { vpPath::load(folder / "none.yaml"); }, {"none.yaml"});
}
