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

//! What a parabola through the values about each time says of it, and how far off it these are, rms.
struct Smoothed {
  std::vector<double> values, residuals;
};

//! \param reach s, to either side.
Smoothed parabolas(const std::vector<double> &times, const std::vector<double> &values, double reach)
{
  Smoothed smooth;
  size_t first = 0, end = 0;
  for (size_t i = 0; i < times.size(); ++i) {
    for (; first < i && times[first] < times[i] - reach; ++first) {
    }
    for (; end < times.size() && times[end] <= times[i] + reach; ++end) {
    }
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero(), inverse;
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double squares = 0;
    for (size_t k = first; k < end; ++k) {
      const double t = (times[k] - times[i]) / reach, change = values[k] - values[i];
      const Eigen::Vector3d row(1, t, t * t);
      normal += row * row.transpose();
      right += change * row;
      squares += change * change;
    }
    bool known = false; // fewer than three do not tell one
    normal.computeInverseWithCheck(inverse, known, 1e-6);
    const Eigen::Vector3d parabola = known ? Eigen::Vector3d(inverse * right) : Eigen::Vector3d::Zero();
    smooth.values.push_back(values[i] + parabola(0));
    smooth.residuals.push_back(
        std::sqrt(std::max(0.0, squares - parabola.dot(right)) / static_cast<double>(end - first)));
  }
  return smooth;
}

/*!
  Without the steps of encoders, whose whole ticks are as much in heading as an image point is off by:
  parabolas over as long as the base moves along one (Savitzky and Golay 1964; how long, by what is usual of
  the residuals).
*/
std::vector<double> smoothed(const std::vector<double> &times, const std::vector<double> &values)
{
  std::vector<double> smooth = values;
  static const double usual = 1.3;                                    // times the median
  static const double reaches[] = {0.04, 0.06, 0.09, 0.13, 0.2, 0.3}; // s, to either side
  for (const double reach : reaches) {
    const Smoothed wider = parabolas(times, values, reach);
    std::vector<double> sorted = wider.residuals;
    std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
    for (size_t i = 0; i < times.size(); ++i) {
      if (wider.residuals[i] <= usual * sorted[sorted.size() / 2]) {
        smooth[i] = wider.values[i];
      }
    }
  }
  return smooth;
}
} // namespace

vpPlanarPose vpAfter(const vpPlanarPose &pose, const vpPlanarStep &step)
{
  const double c = std::cos(pose(2)), s = std::sin(pose(2));
  return {pose(0) + c * step.x - s * step.y, pose(1) + s * step.x + c * step.y, pose(2) + step.turn};
}

vpOdometryPath::vpOdometryPath(const std::vector<vpOdometry> &samples)
{
  if (samples.empty()) {
    return;
  }
  // The first sample opens the first interval.
  std::vector<double> times, along(1, 0), heading(1, 0); // s, m, rad
  for (const vpOdometry &sample : samples) {
    if (!times.empty()) {
      along.push_back(along.back() + sample.v * (sample.timestamp - times.back()));
      heading.push_back(heading.back() + sample.w * (sample.timestamp - times.back()));
    }
    times.push_back(sample.timestamp);
  }
  along = smoothed(times, along);
  heading = smoothed(times, heading);
  m_points.push_back({times[0], {0, 0, heading[0]}, along[0], 0, 0, 0, 0});
  for (size_t i = 1; i < times.size(); ++i) {
    const Point &before = m_points.back();
    const double dt = times[i] - before.time, length = along[i] - before.along,
                 turn = heading[i] - before.pose(2);
    const Eigen::Vector2d chord = chordOf(length, turn);
    m_points.push_back({times[i], vpAfter(before.pose, {dt, chord.x(), chord.y(), turn, 0, 0, 0}), along[i],
                        before.length + std::abs(length), before.turned + std::abs(turn),
                        dt > 0 ? length / dt : 0.0, dt > 0 ? turn / dt : 0.0});
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
