/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpOdometryPath.h"

#include <algorithm>
#include <cmath>

BEGIN_VISP_NAMESPACE

namespace
{
//! Chord of an arc of that length and turn, in the frame of its start.
Eigen::Vector2d chordOf(double length, double turn)
{
  const double half = 0.5 * turn;
  const double chord = std::abs(half) < 1e-9 ? length : length * std::sin(half) / half;
  return {chord * std::cos(half), chord * std::sin(half)};
}
} // namespace

vpPlanarPose vpAfter(const vpPlanarPose &pose, const vpPlanarStep &step)
{
  const double c = std::cos(pose(2)), s = std::sin(pose(2));
  return {pose(0) + c * step.x - s * step.y, pose(1) + s * step.x + c * step.y, pose(2) + step.turn};
}

vpOdometryPath::vpOdometryPath(const std::vector<vpOdometry> &samples)
{
  for (const vpOdometry &sample : samples) {
    if (m_points.empty()) { // opens the first interval
      m_points.push_back({sample.timestamp, vpPlanarPose::Zero(), 0, 0, 0, 0, 0});
      continue;
    }
    Point point = m_points.back();
    const double dt = sample.timestamp - point.time, length = sample.v * dt, turn = sample.w * dt;
    const Eigen::Vector2d chord = chordOf(length, turn);
    point.pose = vpAfter(point.pose, {dt, chord.x(), chord.y(), turn, 0, 0, 0});
    m_points.push_back({sample.timestamp, point.pose, point.along + length, point.length + std::abs(length),
                        point.turned + std::abs(turn), sample.v, sample.w});
  }
}

vpOdometryPath::Point vpOdometryPath::at(double time) const
{
  const auto next = std::upper_bound(m_points.begin(), m_points.end(), time,
                                     [](double value, const Point &point) { return value < point.time; });
  const Point &before = next == m_points.begin() ? *next : *(next - 1);
  const Point &rates = next == m_points.end() ? before : *next; // beyond the end: on as before
  Point point = before;
  const double dt = time - before.time;
  const Eigen::Vector2d chord = chordOf(rates.v * dt, rates.w * dt);
  point.pose = vpAfter(before.pose, {dt, chord.x(), chord.y(), rates.w * dt, 0, 0, 0});
  point.along += rates.v * dt;
  point.length += std::abs(rates.v * dt);
  point.turned += std::abs(rates.w * dt);
  point.time = time;
  return point;
}

std::optional<vpPlanarStep> vpOdometryPath::step(double from, double until) const
{
  static const double beyond = 0.05; // s
  if (m_points.size() < 2 || std::min(from, until) < m_points.front().time - 1e-9 ||
      std::max(from, until) > m_points.back().time + beyond) {
    return std::nullopt;
  }
  const Point a = at(from), b = at(until);
  const double c = std::cos(a.pose(2)), s = std::sin(a.pose(2));
  const Eigen::Vector2d way = (b.pose - a.pose).head<2>();
  return vpPlanarStep{
      until - from,      c * way.x() + s * way.y(),     -s * way.x() + c * way.y(),   b.pose(2) - a.pose(2),
      b.along - a.along, std::abs(b.length - a.length), std::abs(b.turned - a.turned)};
}

END_VISP_NAMESPACE
