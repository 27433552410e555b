/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_servo/vpPath.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpAtomicFile.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpYamlNode.h>

#include "vpPathShape.h"

BEGIN_VISP_NAMESPACE

namespace
{
const double degree = M_PI / 180;
constexpr double farthest = 1000;    // m, of a path from the map's origin
constexpr double shortest = 1e-3;    // m, of a leg or a radius
const double smoothest = 5 * degree; // of a corner: a robot drives through less

[[noreturn]] void refuse(const std::string &problem)
{
  throw vpException(vpException::badValue, "path: " + problem);
}

void expectPlace(const std::string &name, const Eigen::Vector2d &place)
{
  if (!(place.cwiseAbs().maxCoeff() <= farthest)) {
    refuse(name + ": " + vpNumberText(place.x()) + ", " + vpNumberText(place.y()) +
           ", expected two numbers of at most " + vpNumberText(farthest) + " m either way");
  }
}

void expectSize(const std::string &name, double size)
{
  if (!(size >= shortest && size <= farthest)) {
    refuse(name + ": " + vpNumberText(size) + ", expected a number of " + vpNumberText(shortest) + " to " +
           vpNumberText(farthest) + " m");
  }
}

Eigen::Vector2d pointOf(const std::vector<double> &numbers)
{
  return {numbers[0], numbers[1]};
}

vpPath read(const vpYamlNode &node)
{
  switch (node.choice("type", {"polyline", "circle", "arc", "lemniscate"})) {
  case 0: {
    std::vector<Eigen::Vector2d> points;
    for (const std::vector<double> &point : node.numberLists("points_m", 2)) {
      points.push_back(pointOf(point));
    }
    return vpPath::polyline(points, node.has("closed") && node.boolean("closed"));
  }
  case 1:
    return vpPath::circle(pointOf(node.numbers("centre_m", 2)), node.number("radius_m"));
  case 2:
    return vpPath::arc(pointOf(node.numbers("centre_m", 2)), node.number("radius_m"),
                       degree * node.number("from_deg"), degree * node.number("to_deg"));
  default:
    return vpPath::lemniscate(pointOf(node.numbers("centre_m", 2)), node.number("width_m"));
  }
}
} // namespace

vpPath::vpPath(std::shared_ptr<const vpPathShape> shape, bool closed, std::vector<double> corners)
    : m_shape(std::move(shape)), m_closed(closed), m_corners(std::move(corners))
{
}

vpPath vpPath::polyline(const std::vector<Eigen::Vector2d> &points, bool closed)
{
  std::vector<Eigen::Vector2d> all = points;
  if (closed && !points.empty()) {
    all.push_back(points.front());
  }
  if (points.size() < 2) {
    refuse("points_m: " + std::to_string(points.size()) + ", expected two or more");
  }
  for (size_t i = 0; i < all.size(); ++i) {
    const std::string name = "points_m[" + std::to_string(i % points.size()) + "]";
    expectPlace(name, all[i]);
    if (i > 0 && !((all[i] - all[i - 1]).norm() >= shortest)) {
      refuse(name + ": that of the point before it, expected one at least " + vpNumberText(shortest) +
             " m away");
    }
  }
  const auto shape = std::make_shared<vpPolylineShape>(all, closed);
  std::vector<double> corners;
  for (size_t i = 1; i < all.size(); ++i) {
    const bool end = i + 1 == all.size();
    if (end && !closed) {
      break;
    }
    const Eigen::Vector2d before = all[i] - all[i - 1], after = end ? all[1] - all[0] : all[i + 1] - all[i];
    const double turn = std::atan2(before.x() * after.y() - before.y() * after.x(), before.dot(after));
    if (std::abs(turn) > smoothest) {
      corners.push_back(shape->lengths()[i]);
    }
  }
  return vpPath(shape, closed, corners);
}

vpPath vpPath::circle(const Eigen::Vector2d &centre, double radius)
{
  expectPlace("centre_m", centre);
  expectSize("radius_m", radius);
  return vpPath(std::make_shared<vpArcShape>(centre, radius, 0, 2 * M_PI, true), true, {});
}

vpPath vpPath::arc(const Eigen::Vector2d &centre, double radius, double from, double to)
{
  expectPlace("centre_m", centre);
  expectSize("radius_m", radius);
  if (!(radius * std::abs(to - from) >= shortest && std::abs(to - from) <= 2 * M_PI)) {
    refuse("to_deg: " + vpDegreesText(to) + ", expected another angle than from_deg, " + vpDegreesText(from) +
           ", and at most 360 degrees from it");
  }
  return vpPath(std::make_shared<vpArcShape>(centre, radius, from, to, false), false, {});
}

vpPath vpPath::lemniscate(const Eigen::Vector2d &centre, double width)
{
  expectPlace("centre_m", centre);
  expectSize("width_m", width);
  return vpPath(std::make_shared<vpLemniscateShape>(centre, width), true, {});
}

vpPath vpPath::load(const std::string &filename)
{
  const vpYamlNode node = vpYamlNode::load(filename);
  try {
    vpPath path = read(node);
    node.finish();
    return path;
  } catch (const vpException &error) { // what a shape refuses knows no file
    const std::string &problem = error.getStringMessage(), own = "path: ";
    if (problem.rfind(own, 0) == 0) {
      node.fail("", problem.substr(own.size()));
    }
    throw;
  }
}

void vpPath::save(const std::string &filename) const
{
  vpAtomicFile file(filename);
  file.stream() << m_shape->yaml() << "\n";
  file.commit();
}

double vpPath::length() const
{
  return m_shape->length();
}

vpPathPoint vpPath::at(double s) const
{
  const double all = length();
  const double lap = m_closed ? all * std::floor((s + vpPathShape::rounding) / all) : 0;
  return m_shape->at(std::clamp(s - lap, 0.0, all));
}

double vpPath::closest(const Eigen::Vector2d &place, double from, double to) const
{
  if (!m_closed) {
    from = std::clamp(from, 0.0, length());
    to = std::clamp(to, 0.0, length());
  }
  const auto distance = [&](double s) { return (at(s).place - place).norm(); };
  // Along steps that no shape bends much in, then by golden sections about those that may be the best: within
  // a step it comes no nearer than by the step.
  constexpr double step = 0.01; // m
  const int steps = std::max(1, static_cast<int>(std::ceil((to - from) / step)));
  const double width = (to - from) / steps;
  std::vector<double> away;
  for (int i = 0; i <= steps; ++i) {
    away.push_back(distance(from + i * width));
  }
  const double most = *std::min_element(away.begin(), away.end()) + width;
  double best = from, nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= steps; ++i) {
    const auto here = away.begin() + i;
    if (*here > most || (i > 0 && here[-1] < *here) || (i < steps && here[1] < *here)) {
      continue;
    }
    double low = std::max(from, from + (i - 1) * width), high = std::min(to, from + (i + 1) * width);
    constexpr double golden = 0.6180339887498949, precise = 1e-7; // m
    while (high - low > precise) {
      const double left = high - golden * (high - low), right = low + golden * (high - low);
      (distance(left) < distance(right) ? high : low) = distance(left) < distance(right) ? right : left;
    }
    const double middle = 0.5 * (low + high);
    if (distance(middle) < nearest) {
      nearest = distance(middle);
      best = middle;
    }
  }
  return best;
}

double vpPath::offset(const Eigen::Vector2d &place, double s) const
{
  const vpPathPoint point = at(s);
  const Eigen::Vector2d left(-std::sin(point.heading), std::cos(point.heading));
  return left.dot(place - point.place);
}

END_VISP_NAMESPACE
