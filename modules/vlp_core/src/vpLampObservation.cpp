/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpLampObservation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <visp3/core/vpMeterPixelConversion.h>
#include <visp3/core/vpPixelMeterConversion.h>

BEGIN_VISP_NAMESPACE

namespace
{
constexpr int outlineSamples = 32;

std::array<Eigen::Vector2d, outlineSamples> unitCircle()
{
  std::array<Eigen::Vector2d, outlineSamples> points;
  for (size_t i = 0; i < points.size(); ++i) {
    const double t = 2 * M_PI * static_cast<double>(i) / outlineSamples;
    points[i] = {std::cos(t), std::sin(t)};
  }
  return points;
}

Eigen::Vector2d normalised(const vpCameraParameters &camera, const Eigen::Vector2d &pixel)
{
  Eigen::Vector2d point;
  vpPixelMeterConversion::convertPoint(camera, pixel.x(), pixel.y(), point.x(), point.y());
  return point;
}

/*!
  The pixel that normalised() takes to \e point. vpMeterPixelConversion alone is only nearly that: ViSP's kud
  and kdu are two fitted polynomials and no exact inverses. Newton's steps from there make it exact.
*/
Eigen::Vector2d pixelOf(const vpCameraParameters &camera, const Eigen::Vector2d &point)
{
  Eigen::Vector2d pixel;
  vpMeterPixelConversion::convertPoint(camera, point.x(), point.y(), pixel.x(), pixel.y());
  for (int iteration = 0; iteration < 4; ++iteration) {
    const Eigen::Vector2d error = point - normalised(camera, pixel);
    const Eigen::Vector2d du(0.5, 0), dv(0, 0.5);
    Eigen::Matrix2d slope; // central differences over one pixel
    slope.col(0) = normalised(camera, pixel + du) - normalised(camera, pixel - du);
    slope.col(1) = normalised(camera, pixel + dv) - normalised(camera, pixel - dv);
    const Eigen::Vector2d step = slope.inverse() * error;
    if (!step.allFinite()) {
      break;
    }
    pixel += step;
  }
  return pixel;
}

/*!
  Pole of \e line with respect to the conic through \e points, all in the same plane coordinates. False where
  the points lie on no ellipse, or where the line meets it: then there is no pole inside.
*/
bool poleInside(const std::array<Eigen::Vector2d, outlineSamples> &points, const Eigen::Vector3d &line,
                Eigen::Vector2d &pole)
{
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d &point : points) {
    mean += point / static_cast<double>(points.size());
  }
  double spread = 0;
  for (const Eigen::Vector2d &point : points) {
    spread += (point - mean).norm() / static_cast<double>(points.size());
  }
  if (!(spread > 0) || !std::isfinite(spread)) {
    return false;
  }

  // Centred, scaled coordinates s = (x - mean) / spread: without them the squares drown the constant term.
  using Vector5d = Eigen::Matrix<double, 5, 1>;
  Eigen::Matrix<double, 5, 5> products = Eigen::Matrix<double, 5, 5>::Zero();
  Vector5d sum = Vector5d::Zero();
  for (const Eigen::Vector2d &point : points) {
    const Eigen::Vector2d s = (point - mean) / spread;
    const Vector5d row = (Vector5d() << s.x() * s.x(), s.x() * s.y(), s.y() * s.y(), s).finished();
    products += row * row.transpose();
    sum += row;
  }
  // The points lie on a conic about their mean, row . q = 1, but for rounding and the lens's distortion of
  // one.
  const Vector5d q = products.llt().solve(sum);
  Eigen::Matrix3d conic;
  conic << q(0), q(1) / 2, q(3) / 2, q(1) / 2, q(2), q(4) / 2, q(3) / 2, q(4) / 2, -1;
  if (!(conic(0, 0) > 0) || !(conic.topLeftCorner<2, 2>().determinant() > 0)) {
    return false;
  }

  // The line in those coordinates: line . (spread s + mean, 1).
  const Eigen::Vector3d scaledLine(spread * line.x(), spread * line.y(), line.head<2>().dot(mean) + line.z());
  const Eigen::Vector3d m = conic.inverse() * scaledLine;
  if (!m.allFinite() || !(std::abs(m.z()) > 0)) {
    return false;
  }
  const Eigen::Vector3d inside = m / m.z();
  if (!inside.allFinite() || !(inside.dot(conic * inside) < 0)) {
    return false;
  }
  pole = mean + spread * inside.head<2>();
  return true;
}

//! Crossing of the diagonals; false where they are parallel.
bool crossing(const std::array<Eigen::Vector2d, 4> &corners, Eigen::Vector2d &point)
{
  const Eigen::Vector3d first = corners[0].homogeneous().cross(corners[2].homogeneous());
  const Eigen::Vector3d second = corners[1].homogeneous().cross(corners[3].homogeneous());
  point = first.cross(second).hnormalized();
  return point.allFinite();
}
} // namespace

double vpLampOutline::diameter() const
{
  if (shape != Shape::quadrilateral) {
    return a + b;
  }
  double around = 0;
  for (size_t i = 0; i < corners.size(); ++i) {
    around += (corners[(i + 1) % corners.size()] - corners[i]).norm();
  }
  return around / static_cast<double>(corners.size());
}

Eigen::Vector4d vpLampOutline::box() const
{
  if (shape == Shape::ellipse) {
    const double halfWidth = std::hypot(a * std::cos(angle), b * std::sin(angle));
    const double halfHeight = std::hypot(a * std::sin(angle), b * std::cos(angle));
    return {centre.x() - halfWidth, centre.y() - halfHeight, centre.x() + halfWidth, centre.y() + halfHeight};
  }
  Eigen::Vector2d least = corners[0], most = corners[0];
  for (const Eigen::Vector2d &corner : corners) {
    least = least.cwiseMin(corner);
    most = most.cwiseMax(corner);
  }
  return {least.x(), least.y(), most.x(), most.y()};
}

vpOutlineLines::vpOutlineLines(const vpLampOutline &outline) : m_outline(outline)
{
  if (outline.shape == vpLampOutline::Shape::ellipse) {
    // |D R^T (x - centre)| = 1 with x = (u, v): a quadratic in u - centre.
    const double c = std::cos(outline.angle), s = std::sin(outline.angle);
    const Eigen::Vector2d p(c / outline.a, -s / outline.b), q(s / outline.a, c / outline.b);
    const double square = p.squaredNorm(), product = p.dot(q);
    m_slope = -product / square;
    m_square = 1 / square;
    m_loss = (square * q.squaredNorm() - product * product) / (square * square);
  }
}

bool vpOutlineLines::stretch(double v, double &first, double &last) const
{
  if (m_outline.shape == vpLampOutline::Shape::ellipse) {
    const double below = v - m_outline.centre.y(), square = m_square - m_loss * below * below;
    if (!(square > 0)) {
      return false;
    }
    const double middle = m_outline.centre.x() + m_slope * below, half = std::sqrt(square);
    first = middle - half;
    last = middle + half;
    return true;
  }
  const std::array<Eigen::Vector2d, 4> &corners = m_outline.corners;
  first = std::numeric_limits<double>::infinity();
  last = -first;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d &from = corners[i], &to = corners[(i + 1) % corners.size()];
    if ((from.y() - v) * (to.y() - v) <= 0 && from.y() != to.y()) {
      const double u = from.x() + (to.x() - from.x()) * (v - from.y()) / (to.y() - from.y());
      first = std::min(first, u);
      last = std::max(last, u);
    }
  }
  return first <= last;
}

Eigen::Vector2d vpLampOutline::middle(const vpCameraParameters &camera, const Eigen::Vector3d &cNormal) const
{
  Eigen::Vector2d point;
  if (shape == Shape::quadrilateral) {
    std::array<Eigen::Vector2d, 4> undistorted;
    for (size_t i = 0; i < corners.size(); ++i) {
      undistorted[i] = normalised(camera, corners[i]);
    }
    return crossing(undistorted, point) ? pixelOf(camera, point) : centre;
  }
  if (shape != Shape::ellipse || !cNormal.allFinite() || !(cNormal.norm() > 0) || !(b > 0)) {
    return centre;
  }
  const Eigen::Vector2d major = a * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  const Eigen::Vector2d minor = b * Eigen::Vector2d(-std::sin(angle), std::cos(angle));
  static const std::array<Eigen::Vector2d, outlineSamples> circle = unitCircle();
  std::array<Eigen::Vector2d, outlineSamples> points;
  std::transform(circle.begin(), circle.end(), points.begin(), [&](const Eigen::Vector2d &at) {
    return normalised(camera, centre + at.x() * major + at.y() * minor);
  });

  // The vanishing line of the lamp's plane is the plane's normal itself: n . (x, y, 1) = 0.
  if (!poleInside(points, cNormal.normalized(), point)) {
    return centre;
  }
  const Eigen::Vector2d pixel = pixelOf(camera, point);
  return pixel.allFinite() ? pixel : centre;
}

END_VISP_NAMESPACE
