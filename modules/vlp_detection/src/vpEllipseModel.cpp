/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpOutlineModel.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Eigenvalues>
#include <opencv2/imgproc.hpp>

BEGIN_VISP_NAMESPACE

namespace
{
//! Symmetric matrix with the eigenvectors of \e A and f of its eigenvalues.
template <typename F>
Eigen::Matrix2d onEigenvalues(const Eigen::Matrix2d &A, F f)
{
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(A);
  const Eigen::Vector2d values = eigen.eigenvalues().unaryExpr(f);
  return eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
}

/*!
  Circle of points on an arc, by Taubin's algebraic fit (1991): what is seen of a lamp that the border cuts
  allows no ellipse. Nothing where the points lie on a line.
*/
std::optional<vpEllipseModel> circleOf(const std::vector<cv::Point2f> &points)
{
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::Matrix<double, Eigen::Dynamic, 3> A(n, 3);
  Eigen::RowVector2d middle = Eigen::RowVector2d::Zero();
  for (Eigen::Index i = 0; i < n; ++i) {
    A.row(i) << 0, points[i].x, points[i].y;
    middle += A.row(i).tail<2>() / static_cast<double>(n);
  }
  A.rightCols<2>().rowwise() -= middle;
  A.col(0) = A.rightCols<2>().rowwise().squaredNorm();
  const double mean = A.col(0).mean(), scale = 2 * std::sqrt(std::max(mean, 1e-12));
  A.col(0) = (A.col(0).array() - mean) / scale;
  const Eigen::Matrix3d normal = A.transpose() * A;
  const Eigen::Vector3d p = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(normal).eigenvectors().col(0);
  const double p0 = p(0) / scale;
  if (std::abs(p0) < 1e-9) {
    return std::nullopt;
  }
  const double radius = 0.5 * std::sqrt(p.tail<2>().squaredNorm() + 4 * p0 * p0 * mean) / std::abs(p0);
  const Eigen::Vector2d centre = middle.transpose() - 0.5 * p.tail<2>() / p0;
  return vpEllipseModel(centre, radius, radius, 0);
}

//! Median distance of the points from the outline, px.
double typicalDistance(const vpEllipseModel &model, const std::vector<cv::Point2f> &points)
{
  std::vector<double> distances;
  for (const cv::Point2f &point : points) {
    distances.push_back(std::abs(model.distance({point.x, point.y})));
  }
  const auto middle = distances.begin() + static_cast<long>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}
} // namespace

vpEllipseModel::vpEllipseModel(const Eigen::Vector2d &centre, double a, double b, double angle)
    : m_centre(centre)
{
  Eigen::Matrix2d R;
  R << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  m_shape = R * Eigen::Vector2d(1 / a, 1 / b).asDiagonal() * R.transpose();
}

vpEllipseModel vpEllipseModel::from(const std::vector<cv::Point2f> &points, const cv::Rect &box)
{
  const Eigen::Vector2d middle(box.x + 0.5 * (box.width - 1), box.y + 0.5 * (box.height - 1));
  const double radius = 0.5 * std::max(box.width, box.height);
  std::optional<vpEllipseModel> best;
  if (points.size() >= 6) {
    const cv::RotatedRect e = cv::fitEllipseDirect(points);
    const double a = 0.5 * e.size.width;
    const double b = 0.5 * e.size.height;
    const vpEllipseModel model({e.center.x, e.center.y}, std::max(a, 1.0), std::max(b, 1.0),
                               e.angle * M_PI / 180);
    const double ratio = a / b;
    if (ratio > 0.4 && ratio < 2.5 && model.plausible(box)) {
      best = model;
    }
    // Of an arc alone the ellipse comes out much too small.
    const std::optional<vpEllipseModel> circle = circleOf(points);
    static const double closer = 0.7;
    if (circle && circle->plausible(box) &&
        (!best || typicalDistance(*circle, points) < closer * typicalDistance(*best, points))) {
      best = circle;
    }
  }
  return best.value_or(vpEllipseModel(middle, radius, radius, 0));
}

double vpEllipseModel::distance(const Eigen::Vector2d &x, Vector &derivative, Eigen::Vector2d &normal) const
{
  const Eigen::Vector2d y = m_shape * (x - m_centre);
  const double rho = std::max(y.norm(), 1e-6);
  const Eigen::Vector2d gradient = m_shape * y;
  const double slope = std::max(gradient.norm(), 1e-12); // |gradient of rho| times rho
  normal = gradient / slope;
  derivative << -normal, -rho * rho / slope, -0.5 * (y.x() * y.x() - y.y() * y.y()) / slope,
      -y.x() * y.y() / slope;
  return (rho - 1) * rho / slope;
}

void vpEllipseModel::advance(const Vector &step)
{
  m_centre += step.head<2>();
  Eigen::Matrix2d E;
  E << step(3), step(4), step(4), -step(3);
  const Eigen::Matrix2d M =
      std::exp(-step(2)) * onEigenvalues(E, [](double e) { return std::exp(-0.5 * e); }) * m_shape;
  m_shape = onEigenvalues(M.transpose() * M, [](double e) { return std::sqrt(std::max(e, 1e-12)); });
}

double vpEllipseModel::addPrior(double sigma, Eigen::MatrixXd &H, Eigen::VectorXd &g) const
{
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(m_shape);
  const double logRatio = std::log(eigen.eigenvalues()(1) / eigen.eigenvalues()(0)); // log(a / b)
  const Eigen::Vector2d major = eigen.eigenvectors().col(0);
  const double cos2 = major.x() * major.x() - major.y() * major.y();
  const double sin2 = 2 * major.x() * major.y();
  const double weight = 1 / (sigma * sigma);
  H(3, 3) += weight;
  H(4, 4) += weight;
  g(3) -= weight * logRatio * cos2;
  g(4) -= weight * logRatio * sin2;
  return weight * logRatio * logRatio;
}

bool vpEllipseModel::stretch(double v, double distance, double &first, double &last) const
{
  const double grow = 1 + distance / radius();
  if (grow <= 0) {
    return false;
  }
  // |m_shape (x - centre)| = grow with x = (u, v) fixed in v: a quadratic in u.
  const Eigen::Vector2d p = m_shape.col(0);
  const Eigen::Vector2d q = m_shape.col(1) * (v - m_centre.y());
  const double a = p.squaredNorm();
  const double b = p.dot(q);
  const double discriminant = b * b - a * (q.squaredNorm() - grow * grow);
  if (discriminant <= 0) {
    return false;
  }
  first = m_centre.x() + (-b - std::sqrt(discriminant)) / a;
  last = m_centre.x() + (-b + std::sqrt(discriminant)) / a;
  return true;
}

void vpEllipseModel::vertical(double &top, double &bottom) const
{
  const double half = std::sqrt((m_shape * m_shape).inverse()(1, 1));
  top = m_centre.y() - half;
  bottom = m_centre.y() + half;
}

double vpEllipseModel::radius() const
{
  return 1 / std::sqrt(std::max(m_shape.determinant(), 1e-12));
}

bool vpEllipseModel::plausible(const cv::Rect &box) const
{
  const double size = std::max(box.width, box.height);
  const Eigen::Vector2d middle(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(m_shape);
  const double a = 1 / eigen.eigenvalues()(0);
  const double b = 1 / eigen.eigenvalues()(1);
  return std::isfinite(a) && std::isfinite(b) && a < 3 * size && b > 0.2 * std::min(box.width, box.height) &&
         a < 4 * b && (m_centre - middle).norm() < 1.5 * size;
}

vpLampOutline vpEllipseModel::outline(const Eigen::MatrixXd &covariance) const
{
  vpLampOutline outline;
  outline.shape = vpLampOutline::Shape::ellipse;
  outline.centre = m_centre;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(m_shape);
  outline.a = 1 / eigen.eigenvalues()(0);
  outline.b = 1 / eigen.eigenvalues()(1);
  outline.angle = std::atan2(eigen.eigenvectors()(1, 0), eigen.eigenvectors()(0, 0));
  outline.centreCovariance = covariance.topLeftCorner<2, 2>();
  return outline;
}

END_VISP_NAMESPACE
