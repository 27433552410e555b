/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpOutlineModel.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

BEGIN_VISP_NAMESPACE

namespace
{
const double alongLines =
    0.12; // sine of seven degrees: sides closer to the lines' direction show no clear ends

double wrapped(double angle)
{
  return std::remainder(angle, 2 * M_PI);
}

//! px, between two lines that follow each other and have points.
double longestGap(const std::vector<cv::Point2f> &points)
{
  std::vector<float> lines;
  for (const cv::Point2f &point : points) {
    lines.push_back(point.y);
  }
  std::sort(lines.begin(), lines.end());
  float gap = 0;
  for (size_t i = 1; i < lines.size(); ++i) {
    gap = std::max(gap, lines[i] - lines[i - 1]);
  }
  return gap;
}
} // namespace

vpQuadrilateralModel vpQuadrilateralModel::from(const std::vector<cv::Point2f> &points)
{
  const cv::RotatedRect r = cv::minAreaRect(points);
  vpQuadrilateralModel model;
  model.m_inside = Eigen::Vector2d(r.center.x, r.center.y);
  model.m_scale = 0.25 * (r.size.width + r.size.height);
  for (int i = 0; i < 4; ++i) {
    model.m_angle[i] = r.angle * M_PI / 180 + i * M_PI / 2;
    model.m_offset[i] = 0.5 * (i % 2 == 0 ? r.size.width : r.size.height);
  }
  model.turnNormals();
  for (int axis = 0; axis < 2; ++axis) {
    model.m_middleSigma[axis] = model.m_scale;
    if (std::abs(model.m_normal[axis].x()) < alongLines) {
      // Where the lamp is dark no line shows these sides: each lies anywhere in the gap beyond the last lit
      // line.
      static const double blurred = 1; // px, that light may reach over them or fall short of them
      model.m_middleSigma[axis] = blurred + longestGap(points) / std::sqrt(24.0);
    }
  }
  return model;
}

void vpQuadrilateralModel::turnNormals()
{
  for (size_t i = 0; i < m_normal.size(); ++i) {
    m_normal[i] = {std::cos(m_angle[i]), std::sin(m_angle[i])};
  }
}

//! Signed distance of a point, from m_inside, and the side that it is nearest to.
double vpQuadrilateralModel::distance(const Eigen::Vector2d &fromInside, size_t &side) const
{
  double farthest = -std::numeric_limits<double>::max();
  for (size_t i = 0; i < m_normal.size(); ++i) {
    const double distance = m_normal[i].dot(fromInside) - m_offset[i];
    if (distance > farthest) {
      farthest = distance;
      side = i;
    }
  }
  return farthest;
}

double vpQuadrilateralModel::distance(const Eigen::Vector2d &x) const
{
  size_t side = 0;
  return distance(x - m_inside, side);
}

double vpQuadrilateralModel::distance(const Eigen::Vector2d &x, Vector &derivative,
                                      Eigen::Vector2d &normal) const
{
  const Eigen::Vector2d d = x - m_inside;
  size_t side = 0;
  const double farthest = distance(d, side);
  normal = m_normal[side];
  derivative.setZero();
  derivative(static_cast<Eigen::Index>(2 * side)) = (-normal.y() * d.x() + normal.x() * d.y()) / m_scale;
  derivative(static_cast<Eigen::Index>(2 * side + 1)) = -1;
  return farthest;
}

void vpQuadrilateralModel::advance(const Vector &step)
{
  for (int i = 0; i < 4; ++i) {
    m_angle[i] = wrapped(m_angle[i] + step(2 * i) / m_scale);
    m_offset[i] += step(2 * i + 1);
  }
  turnNormals();
}

double vpQuadrilateralModel::addPrior(double sigma, Eigen::Ref<Eigen::MatrixXd> H,
                                      Eigen::Ref<Eigen::VectorXd> g) const
{
  double cost = 0;
  auto pull = [&](const Vector &direction, double value, double deviation) {
    const double weight = 1 / (deviation * deviation);
    H.topLeftCorner<parameters, parameters>() += weight * direction * direction.transpose();
    g.head<parameters>() -= weight * value * direction;
    cost += weight * value * value;
  };
  static const double skew = 0.05;        // rad, between neighbouring sides
  static const double convergence = 0.01; // rad, between opposite ones
  for (int i = 0; i < 4; ++i) {
    for (int apart = 1; apart <= (i < 2 ? 2 : 1); ++apart) {
      const int j = (i + apart) % 4;
      Vector direction = Vector::Zero();
      direction(2 * i) = -1;
      direction(2 * j) = 1;
      pull(direction, m_scale * wrapped(m_angle[j] - m_angle[i] - apart * M_PI / 2),
           (apart == 1 ? skew : convergence) * m_scale);
    }
  }
  Vector direction = Vector::Zero(); // as high as wide
  direction(1) = direction(5) = 0.5;
  direction(3) = direction(7) = -0.5;
  pull(direction, 0.5 * (m_offset[0] + m_offset[2] - m_offset[1] - m_offset[3]), sigma * m_scale);
  for (int axis = 0; axis < 2; ++axis) { // somewhere about where it was found
    direction.setZero();
    direction(1 + 2 * axis) = 0.5;
    direction(5 + 2 * axis) = -0.5;
    pull(direction, 0.5 * (m_offset[axis] - m_offset[axis + 2]), m_middleSigma[axis]);
  }
  return cost;
}

bool vpQuadrilateralModel::stretch(double v, double distance, double &first, double &last) const
{
  first = -1e9;
  last = 1e9;
  for (int i = 0; i < 4; ++i) {
    const double c = m_normal[i].x();
    const double limit = m_offset[i] + distance - m_normal[i].y() * (v - m_inside.y());
    if (std::abs(c) < 1e-6) {
      if (limit < 0) {
        return false;
      }
    } else if (c > 0) {
      last = std::min(last, m_inside.x() + limit / c);
    } else {
      first = std::max(first, m_inside.x() + limit / c);
    }
  }
  return first < last;
}

bool vpQuadrilateralModel::crossedWell(double v, bool first, bool last) const
{
  static const double fromCorner = 2.5; // px, blurred corners
  double from = -1e9, to = 1e9;
  int firstSide = -1, lastSide = -1;
  for (int i = 0; i < 4; ++i) {
    const double c = m_normal[i].x();
    if (std::abs(c) < alongLines) {
      continue;
    }
    const double u = m_inside.x() + (m_offset[i] - m_normal[i].y() * (v - m_inside.y())) / c;
    if (c > 0 && u < to) {
      to = u;
      lastSide = i;
    } else if (c < 0 && u > from) {
      from = u;
      firstSide = i;
    }
  }
  const auto corners = cornersAt(Vector::Zero());
  auto well = [&](int side) {
    // Corner i lies between sides i and i + 1.
    const double a = corners[(side + 3) % 4].y(), b = corners[side].y();
    return v > std::min(a, b) + fromCorner && v < std::max(a, b) - fromCorner;
  };
  return (!first || (firstSide >= 0 && well(firstSide))) && (!last || (lastSide >= 0 && well(lastSide)));
}

std::array<Eigen::Vector2d, 4> vpQuadrilateralModel::cornersAt(const Vector &step) const
{
  std::array<Eigen::Vector2d, 4> corners;
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    Eigen::Matrix2d normals;
    Eigen::Vector2d offsets;
    for (int k = 0; k < 2; ++k) {
      const int side = k == 0 ? i : j;
      const double angle = m_angle[side] + step(2 * side) / m_scale;
      normals.row(k) << std::cos(angle), std::sin(angle);
      offsets(k) = m_offset[side] + step(2 * side + 1);
    }
    corners[i] = m_inside + normals.inverse() * offsets;
  }
  return corners;
}

void vpQuadrilateralModel::vertical(double &top, double &bottom) const
{
  const auto corners = cornersAt(Vector::Zero());
  top = bottom = corners[0].y();
  for (const Eigen::Vector2d &corner : corners) {
    top = std::min(top, corner.y());
    bottom = std::max(bottom, corner.y());
  }
}

double vpQuadrilateralModel::radius() const
{
  return m_scale;
}

bool vpQuadrilateralModel::plausible(const cv::Rect &box) const
{
  const double size = std::max(box.width, box.height);
  const Eigen::Vector2d middle(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  for (int i = 0; i < 4; ++i) {
    if (std::abs(wrapped(m_angle[(i + 1) % 4] - m_angle[i] - M_PI / 2)) > M_PI / 4) {
      return false;
    }
  }
  for (const Eigen::Vector2d &corner : cornersAt(Vector::Zero())) {
    if (!corner.allFinite() || (corner - middle).norm() > 2 * size) {
      return false;
    }
  }
  return m_offset[0] + m_offset[2] > 2 && m_offset[1] + m_offset[3] > 2;
}

vpLampOutline vpQuadrilateralModel::outline(const Eigen::Ref<const Eigen::MatrixXd> &covariance) const
{
  auto crossing = [](const std::array<Eigen::Vector2d, 4> &c) {
    Eigen::Matrix2d diagonals;
    diagonals << c[2] - c[0], c[1] - c[3];
    return Eigen::Vector2d(c[0] + (c[2] - c[0]) * (diagonals.inverse() * (c[1] - c[0]))(0));
  };
  vpLampOutline outline;
  outline.shape = vpLampOutline::Shape::quadrilateral;
  outline.corners = cornersAt(Vector::Zero());
  outline.centre = crossing(outline.corners);
  outline.a = outline.b = m_scale;
  outline.angle = m_angle[0];
  Eigen::Matrix<double, 2, parameters> J;
  static const double h = 1e-4;
  for (int i = 0; i < parameters; ++i) {
    J.col(i) =
        (crossing(cornersAt(h * Vector::Unit(i))) - crossing(cornersAt(-h * Vector::Unit(i)))) / (2 * h);
  }
  outline.centreCovariance = J * covariance.topLeftCorner<parameters, parameters>() * J.transpose();
  return outline;
}

END_VISP_NAMESPACE
