/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_evaluation/vpTrackLine.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

namespace
{
using Eigen::Vector2d;

Vector2d positionOf(const vpTimedPose &pose)
{
  return {pose.wMb[0][3], pose.wMb[1][3]};
}

std::string text(const Vector2d &point)
{
  return "(" + vpNumberText(point.x()) + ", " + vpNumberText(point.y()) + ")";
}
} // namespace

vpTrackLine::vpTrackLine(const Vector2d &start, const Vector2d &end) : m_start(start), m_end(end)
{
  constexpr double shortest = 1e-6; // m
  if (!start.allFinite() || !end.allFinite() || (end - start).norm() < shortest) {
    throw vpException(vpException::badValue,
                      "line: from " + text(start) + " to " + text(end) + ", expected two different points");
  }
}

std::optional<vpTrackLine> vpTrackLine::of(const vpTrajectory &trajectory)
{
  constexpr double shortest = 0.01; // m
  constexpr double mostOff = 0.1;   // of its length
  if (trajectory.empty()) {
    return std::nullopt;
  }
  const Vector2d start = positionOf(trajectory.poses().front()), end = positionOf(trajectory.poses().back());
  const double length = (end - start).norm();
  if (length < shortest) {
    return std::nullopt;
  }
  const vpTrackLine line(start, end);
  const bool straight =
      std::all_of(trajectory.poses().begin(), trajectory.poses().end(), [&](const vpTimedPose &pose) {
        return line.distance(positionOf(pose)) <= mostOff * length;
      });
  return straight ? std::optional<vpTrackLine>(line) : std::nullopt;
}

double vpTrackLine::distance(const Vector2d &point) const
{
  const Vector2d along = (m_end - m_start).normalized(), to = point - m_start;
  return std::abs(along.x() * to.y() - along.y() * to.x());
}

std::optional<vpFittedLine> vpFittedLine::of(const std::vector<Vector2d> &points)
{
  Vector2d mean = Vector2d::Zero();
  for (const Vector2d &point : points) {
    mean += point / static_cast<double>(points.size());
  }
  double xx = 0, yy = 0, xy = 0;
  for (const Vector2d &point : points) {
    const Vector2d d = point - mean;
    xx += d.x() * d.x();
    yy += d.y() * d.y();
    xy += d.x() * d.y();
  }
  const double rounding = 1e-12 * mean.norm();
  if (points.size() < 2 || !(std::max(xx, yy) > rounding * rounding * static_cast<double>(points.size()))) {
    return std::nullopt;
  }
  vpFittedLine line;
  line.alongY = yy > xx;
  line.slope = xy / std::max(xx, yy);
  line.offset = line.alongY ? mean.x() - line.slope * mean.y() : mean.y() - line.slope * mean.x();
  return line;
}

Vector2d vpFittedLine::at(double coordinate) const
{
  const double other = slope * coordinate + offset;
  return alongY ? Vector2d(other, coordinate) : Vector2d(coordinate, other);
}

std::string vpFittedLine::textInCentimetres() const
{
  std::array<char, 128> buffer;
  std::snprintf(buffer.data(), buffer.size(), "%s = %.4f %s %s %.4f", alongY ? "x" : "y", slope,
                alongY ? "y" : "x", offset < 0 ? "-" : "+", std::abs(100 * offset));
  return buffer.data();
}

END_VISP_NAMESPACE
