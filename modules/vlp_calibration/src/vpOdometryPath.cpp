/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpOdometryPath.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

BEGIN_VISP_NAMESPACE

namespace
{
//! The pose after an arc of that length and turn.
vpPlanarPose arc(const vpPlanarPose &pose, double length, double turn)
{
  const double half = 0.5 * turn;
  const double chord = std::abs(half) < 1e-9 ? length : length * std::sin(half) / half;
  return {pose(0) + chord * std::cos(pose(2) + half), pose(1) + chord * std::sin(pose(2) + half),
          pose(2) + turn};
}

//! Values at some times, and how fast they change there.
struct Curve {
  std::vector<double> values, slopes;
};

//! What a parabola through the values about each time says of it, and how far off it these are, rms.
struct Smoothed : Curve {
  std::vector<double> residuals;
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
    smooth.slopes.push_back(parabola(1) / reach);
    smooth.residuals.push_back(
        known ? std::sqrt(std::max(0.0, squares - parabola.dot(right)) / static_cast<double>(end - first))
              : std::numeric_limits<double>::infinity());
  }
  return smooth;
}

//! The values as they are, and their mean slope from before to after each.
Curve plain(const std::vector<double> &times, const std::vector<double> &values)
{
  Curve curve;
  curve.values = values;
  for (size_t i = 0; i < times.size(); ++i) {
    const size_t before = i > 0 ? i - 1 : i, after = std::min(i + 1, times.size() - 1);
    const double dt = times[after] - times[before];
    curve.slopes.push_back(dt > 0 ? (values[after] - values[before]) / dt : 0);
  }
  return curve;
}

/*!
  Without the steps of encoders, whose whole ticks are as much in heading as an image point is off by:
  parabolas over as long as the base moves along one (Savitzky and Golay 1964; how long, by the median of
  the residuals).
*/
Curve smoothed(const std::vector<double> &times, const std::vector<double> &values)
{
  Curve smooth = plain(times, values);
  static const double accepted = 1.4;                                 // times the median
  static const double reaches[] = {0.04, 0.06, 0.09, 0.13, 0.2, 0.3}; // s, to either side
  for (const double reach : reaches) {
    const Smoothed wider = parabolas(times, values, reach);
    std::vector<double> sorted = wider.residuals;
    std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
    for (size_t i = 0; i < times.size(); ++i) {
      if (std::isfinite(wider.residuals[i]) && wider.residuals[i] <= accepted * sorted[sorted.size() / 2]) {
        smooth.values[i] = wider.values[i];
        smooth.slopes[i] = wider.slopes[i];
      }
    }
  }
  return smooth;
}

//! How far a value has gone a \e share into an interval (s), by the cubic of its values and slopes (Hermite):
//! speed changes within the time between two readings. \param change Over the whole of it.
double hermite(double share, double interval, double change, double slopeBefore, double slopeAfter)
{
  const double rest = 1 - share;
  return share * share * (3 - 2 * share) * change +
         interval * share * rest * (rest * slopeBefore - share * slopeAfter);
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
  const Curve way = smoothed(times, along), course = smoothed(times, heading);
  const auto point = [&](size_t i, const vpPlanarPose &pose, double length, double turned) {
    m_points.push_back({times[i], pose, way.values[i], length, turned, way.slopes[i], course.slopes[i]});
  };
  point(0, {0, 0, course.values[0]}, 0, 0);
  for (size_t i = 1; i < times.size(); ++i) {
    const Point &before = m_points.back();
    const double length = way.values[i] - before.along, turn = course.values[i] - before.pose(2);
    point(i, arc(before.pose, length, turn), before.length + std::abs(length),
          before.turned + std::abs(turn));
  }
}

vpOdometryPath::Point vpOdometryPath::at(double time) const
{
  const auto next = std::upper_bound(m_points.begin(), m_points.end(), time,
                                     [](double value, const Point &point) { return value < point.time; });
  const Point &before = next == m_points.begin() ? *next : *(next - 1);
  const double dt = time - before.time;
  double length = before.v * dt, turn = before.w * dt; // beyond the ends: on as there
  if (next != m_points.begin() && next != m_points.end()) {
    const double interval = next->time - before.time, share = dt / interval;
    length = hermite(share, interval, next->along - before.along, before.v, next->v);
    turn = hermite(share, interval, next->pose(2) - before.pose(2), before.w, next->w);
  }
  Point point = before;
  point.pose = arc(before.pose, length, turn);
  point.along += length;
  point.length += std::abs(length);
  point.turned += std::abs(turn);
  point.time = time;
  return point;
}

std::optional<vpPlanarStep> vpOdometryPath::roughStep(double from, double until) const
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

std::optional<vpPlanarStep> vpOdometryPath::step(double from, double until) const
{
  static const double gap = 0.5; // s: of a longer interval its mean says little
  const auto later = [](double time, const Point &point) { return time < point.time; };
  auto next = std::upper_bound(m_points.begin(), m_points.end(), std::min(from, until), later);
  for (; next != m_points.end(); ++next) {
    if (next != m_points.begin() && next->time - (next - 1)->time > gap) {
      return std::nullopt;
    }
    if (next->time >= std::max(from, until)) {
      break;
    }
  }
  return roughStep(from, until);
}

END_VISP_NAMESPACE
