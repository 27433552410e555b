/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_evaluation/vpDispersion.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

namespace
{
using Eigen::Vector2d;

double cross(const Vector2d &a, const Vector2d &b)
{
  return a.x() * b.y() - a.y() * b.x();
}

//! Corners of the convex hull, counter-clockwise, none of them between two others (Andrew 1979).
std::vector<Vector2d> hullOf(std::vector<Vector2d> points)
{
  std::sort(points.begin(), points.end(), [](const Vector2d &a, const Vector2d &b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) {
    return points;
  }
  std::vector<Vector2d> hull;
  const auto extend = [&hull](const Vector2d &point, size_t fixed) {
    while (hull.size() > fixed && cross(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0) {
      hull.pop_back();
    }
    hull.push_back(point);
  };
  for (const Vector2d &point : points) {
    extend(point, 1);
  }
  const size_t lower = hull.size();
  for (auto point = points.rbegin() + 1; point != points.rend(); ++point) {
    extend(*point, lower);
  }
  hull.pop_back(); // the first one again
  return hull;
}

//! The farthest pair of a hull's corners: two parallel lines turn around it, and it is where they touch.
void findFarthestPair(const std::vector<Vector2d> &hull, vpDispersion &dispersion)
{
  const size_t n = hull.size();
  const auto take = [&](size_t i, size_t j) {
    if ((hull[i % n] - hull[j % n]).squaredNorm() > (dispersion.first - dispersion.second).squaredNorm()) {
      dispersion.first = hull[i % n];
      dispersion.second = hull[j % n];
    }
  };
  size_t j = 1;
  for (size_t i = 0; i < n; ++i) {
    const Vector2d side = hull[(i + 1) % n] - hull[i];
    j = std::max(j, i + 1);
    take(i, j);
    take(i + 1, j);
    while (j < i + n && cross(side, hull[(j + 1) % n] - hull[j % n]) > 0) { // still away from the side
      ++j;
      take(i, j);
      take(i + 1, j);
    }
    take(i, j + 1); // as far, where its side is parallel
    take(i + 1, j + 1);
  }
}

struct Circle {
  Vector2d centre = Vector2d::Zero();
  double radius = -1; // holds nothing

  bool holds(const Vector2d &point) const
  {
    constexpr double rounding = 1e-12;
    return (point - centre).norm() <= radius * (1 + rounding);
  }
};

Circle through(const Vector2d &a, const Vector2d &b)
{
  return {0.5 * (a + b), 0.5 * (a - b).norm()};
}

//! The circumscribed circle; that of the two farthest where the three lie on a line.
Circle through(const Vector2d &a, const Vector2d &b, const Vector2d &c)
{
  const Vector2d ab = b - a, ac = c - a;
  const double twice = 2 * cross(ab, ac);
  const Vector2d toCentre = Vector2d(ac.y() * ab.squaredNorm() - ab.y() * ac.squaredNorm(),
                                     ab.x() * ac.squaredNorm() - ac.x() * ab.squaredNorm()) /
                            twice;
  if (toCentre.allFinite()) {
    return {a + toCentre, toCentre.norm()};
  }
  const std::vector<Circle> pairs = {through(a, b), through(a, c), through(b, c)};
  return *std::max_element(pairs.begin(), pairs.end(),
                           [](const Circle &one, const Circle &other) { return one.radius < other.radius; });
}

//! Grows a circle point by point: one that it does not hold lies on the edge of the next.
Circle smallestCircle(std::vector<Vector2d> points)
{
  std::mt19937 order(1); // any order does, a random one is fast
  std::shuffle(points.begin(), points.end(), order);
  Circle circle;
  for (size_t i = 0; i < points.size(); ++i) {
    if (circle.holds(points[i])) {
      continue;
    }
    circle = {points[i], 0};
    for (size_t j = 0; j < i; ++j) {
      if (circle.holds(points[j])) {
        continue;
      }
      circle = through(points[i], points[j]);
      for (size_t k = 0; k < j; ++k) {
        if (!circle.holds(points[k])) {
          circle = through(points[i], points[j], points[k]);
        }
      }
    }
  }
  return circle;
}
} // namespace

vpDispersion vpDispersion::of(const std::vector<Vector2d> &points)
{
  vpDispersion dispersion;
  if (points.empty()) {
    return dispersion;
  }
  for (const Vector2d &point : points) {
    if (!point.allFinite()) {
      throw vpException(vpException::badValue, "dispersion: a point that is not finite");
    }
  }
  const Vector2d &origin = points.front(); // near it the differences keep all their digits
  std::vector<Vector2d> shifted;
  for (const Vector2d &point : points) {
    shifted.emplace_back(point - origin);
  }
  const std::vector<Vector2d> hull = hullOf(std::move(shifted));
  dispersion.first = dispersion.second = hull.front();
  if (hull.size() > 1) {
    findFarthestPair(hull, dispersion);
    const Circle circle = smallestCircle(hull);
    dispersion.centre = circle.centre;
    for (const Vector2d &corner : hull) {
      dispersion.circleRadius = std::max(dispersion.circleRadius, (corner - circle.centre).norm());
    }
  } else {
    dispersion.centre = hull.front();
  }
  dispersion.first += origin;
  dispersion.second += origin;
  dispersion.centre += origin;
  return dispersion;
}

END_VISP_NAMESPACE
