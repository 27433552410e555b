/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPathShape.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <visp3/core/vpMath.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

namespace
{
std::string pointText(const Eigen::Vector2d &point)
{
  return "[" + vpNumberText(point.x()) + ", " + vpNumberText(point.y()) + "]";
}

} // namespace

vpPolylineShape::vpPolylineShape(std::vector<Eigen::Vector2d> points, bool closed)
    : m_points(std::move(points)), m_lengths(1, 0.0), m_closed(closed)
{
  for (size_t i = 1; i < m_points.size(); ++i) {
    m_lengths.push_back(m_lengths.back() + (m_points[i] - m_points[i - 1]).norm());
  }
}

vpPathPoint vpPolylineShape::at(double s) const
{
  const auto later = std::upper_bound(m_lengths.begin() + 1, m_lengths.end() - 1, s + vpPathShape::rounding);
  const size_t end = static_cast<size_t>(later - m_lengths.begin());
  const Eigen::Vector2d way = m_points[end] - m_points[end - 1];
  vpPathPoint point;
  point.place = m_points[end - 1] + (s - m_lengths[end - 1]) * way.normalized();
  point.heading = std::atan2(way.y(), way.x());
  return point;
}

std::string vpPolylineShape::yaml() const
{
  std::string points;
  for (size_t i = 0; i < m_points.size() - (m_closed ? 1 : 0); ++i) {
    points += (i == 0 ? "" : ", ") + pointText(m_points[i]);
  }
  return "{type: polyline, points_m: [" + points + "], closed: " + (m_closed ? "true}" : "false}");
}

vpArcShape::vpArcShape(const Eigen::Vector2d &centre, double radius, double from, double to, bool circle)
    : m_centre(centre), m_radius(radius), m_from(from), m_to(to), m_circle(circle)
{
}

double vpArcShape::length() const
{
  return m_radius * std::abs(m_to - m_from);
}

vpPathPoint vpArcShape::at(double s) const
{
  const double side = m_to > m_from ? 1 : -1;
  const double angle = m_from + side * s / m_radius;
  vpPathPoint point;
  point.place = m_centre + m_radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  point.heading = std::remainder(angle + side * M_PI / 2, 2 * M_PI);
  point.curvature = side / m_radius;
  return point;
}

std::string vpArcShape::yaml() const
{
  const std::string common = "centre_m: " + pointText(m_centre) + ", radius_m: " + vpNumberText(m_radius);
  return m_circle ? "{type: circle, " + common + "}"
                  : "{type: arc, " + common + ", from_deg: " + vpDegreesText(m_from) +
                        ", to_deg: " + vpDegreesText(m_to) + "}";
}

vpLemniscateShape::vpLemniscateShape(const Eigen::Vector2d &centre, double width)
    : m_centre(centre), m_half(width / 2), m_lengths(1, 0.0)
{
  // ds/dt = a / sqrt(1 + sin^2 t), by Simpson's rule; between these points s is linear to 1e-7 of the width.
  constexpr int steps = 4096;
  const double dt = 2 * M_PI / steps;
  const auto speed = [this](double t) { return m_half / std::sqrt(1 + vpMath::sqr(std::sin(t))); };
  for (int i = 0; i < steps; ++i) {
    const double t = i * dt;
    m_lengths.push_back(m_lengths.back() + dt / 6 * (speed(t) + 4 * speed(t + dt / 2) + speed(t + dt)));
  }
}

vpPathPoint vpLemniscateShape::at(double s) const
{
  const auto later = std::upper_bound(m_lengths.begin() + 1, m_lengths.end() - 1, s);
  const double end = static_cast<double>(later - m_lengths.begin());
  const double share = (s - *(later - 1)) / (*later - *(later - 1));
  const double t = 2 * M_PI * (end - 1 + share) / static_cast<double>(m_lengths.size() - 1);
  const double sine = std::sin(t), cosine = std::cos(t), root = std::sqrt(1 + sine * sine);
  vpPathPoint point;
  const double x = m_half * cosine / vpMath::sqr(root);
  point.place = m_centre + Eigen::Vector2d(x, x * sine);
  // The tangent, times (1 + sin^2 t)^2 / a.
  const double dx = -sine * (vpMath::sqr(root) + 2 * vpMath::sqr(cosine));
  const double dy =
      (vpMath::sqr(cosine) - vpMath::sqr(sine)) * vpMath::sqr(root) - 2 * vpMath::sqr(sine * cosine);
  point.heading = std::atan2(dy, dx);
  point.curvature = 3 * cosine / (m_half * root);
  return point;
}

std::string vpLemniscateShape::yaml() const
{
  return "{type: lemniscate, centre_m: " + pointText(m_centre) + ", width_m: " + vpNumberText(2 * m_half) +
         "}";
}

END_VISP_NAMESPACE
