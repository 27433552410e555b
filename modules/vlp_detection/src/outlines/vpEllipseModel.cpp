/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpOutlineModel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/LU>

BEGIN_VISP_NAMESPACE

namespace
{
//! Root of a symmetric positive definite matrix, by Cayley and Hamilton.
Eigen::Matrix2d rootOf(const Eigen::Matrix2d &A)
{
  const double det = std::sqrt(std::max(A.determinant(), 1e-24));
  return (A + det * Eigen::Matrix2d::Identity()) / std::sqrt(A.trace() + 2 * det);
}

//! Eigenvectors of the greatest and of the least eigenvalue, and the greatest.
struct Eigen3 {
  Eigen::Vector3d most, least;
  double value;
};

//! \param A Symmetric.
Eigen3 eigenOf(const Eigen::Matrix3d &A)
{
  cv::Vec3d values; // descending
  cv::Matx33d vectors;
  cv::eigen(cv::Matx33d(A.data()), values, vectors);
  return {{vectors(0, 0), vectors(0, 1), vectors(0, 2)},
          {vectors(2, 0), vectors(2, 1), vectors(2, 2)},
          values(0)};
}

/*!
  The conic A x^2 + B x y + C y^2 + D x + E y + F = 0 of least algebraic distance, under 4 A C - B^2 = 1, an
  ellipse.
  Nothing where the sums say nothing of one.
  \param S1, S2, S3 Sums of products of (x^2, x y, y^2) with themselves, with (x, y, 1), and of these.
*/
std::optional<Eigen::Matrix<double, 6, 1>> ellipticConic(const Eigen::Matrix3d &S1, const Eigen::Matrix3d &S2,
                                                         const Eigen::Matrix3d &S3)
{
  static const double least = 1e-9; // of points of unit spread: less is a line
  if (!(std::abs(S3.determinant()) > least)) {
    return std::nullopt;
  }
  const Eigen::Matrix3d T = -S3.inverse() * S2.transpose();
  Eigen::Matrix3d M = S1 + S2 * T;
  M.diagonal().array() += 1e-12 * M.trace(); // of points that lie on an ellipse it is singular
  // The most of a' C a, which is 4 A C - B^2, for a given a' M a.
  const Eigen::LLT<Eigen::Matrix3d> root(M);
  if (root.info() != Eigen::Success) {
    return std::nullopt;
  }
  Eigen::Matrix3d C;
  C << 0, 0, 2, 0, -1, 0, 2, 0, 0;
  const Eigen::Matrix3d half = root.matrixL().solve(C);
  const Eigen::Matrix3d scaled = root.matrixL().solve(Eigen::Matrix3d(half.transpose()));
  const Eigen3 eigen = eigenOf(scaled);
  const Eigen::Vector3d a = root.matrixU().solve(eigen.most);
  if (!(eigen.value > 0)) {
    return std::nullopt;
  }
  Eigen::Matrix<double, 6, 1> conic;
  conic << a, T * a;
  return conic;
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
  const Eigen::Vector3d p = eigenOf(normal).least;
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

std::optional<vpEllipseModel> vpEllipseModel::through(const std::vector<cv::Point2f> &points)
{
  if (points.size() < 5) {
    return std::nullopt;
  }
  const auto n = static_cast<double>(points.size());
  cv::Point2d middle(0, 0);
  for (const cv::Point2f &point : points) {
    middle += cv::Point2d(point) / n;
  }
  double spread = 0;
  for (const cv::Point2f &point : points) {
    spread += (std::abs(point.x - middle.x) + std::abs(point.y - middle.y)) / (2 * n);
  }
  const double perSpread = 1 / std::max(spread, 1e-9);
  std::array<std::array<double, 5>, 5> sum{}; // of x^i y^k, means
  for (const cv::Point2f &point : points) {
    const double x = (point.x - middle.x) * perSpread, y = (point.y - middle.y) * perSpread, xx = x * x,
                 xy = x * y, yy = y * y;
    sum[1][0] += x;
    sum[0][1] += y;
    sum[2][0] += xx;
    sum[1][1] += xy;
    sum[0][2] += yy;
    sum[3][0] += xx * x;
    sum[2][1] += xx * y;
    sum[1][2] += x * yy;
    sum[0][3] += yy * y;
    sum[4][0] += xx * xx;
    sum[3][1] += xx * xy;
    sum[2][2] += xx * yy;
    sum[1][3] += xy * yy;
    sum[0][4] += yy * yy;
  }
  for (auto &ofX : sum) {
    for (double &ofY : ofX) {
      ofY /= n;
    }
  }
  Eigen::Matrix3d S1, S2, S3;
  S1 << sum[4][0], sum[3][1], sum[2][2], sum[3][1], sum[2][2], sum[1][3], sum[2][2], sum[1][3], sum[0][4];
  S2 << sum[3][0], sum[2][1], sum[2][0], sum[2][1], sum[1][2], sum[1][1], sum[1][2], sum[0][3], sum[0][2];
  S3 << sum[2][0], sum[1][1], sum[1][0], sum[1][1], sum[0][2], sum[0][1], sum[1][0], sum[0][1], 1;
  const std::optional<Eigen::Matrix<double, 6, 1>> conic = ellipticConic(S1, S2, S3);
  if (!conic) {
    return std::nullopt;
  }
  Eigen::Matrix2d Q;
  Q << (*conic)(0), 0.5 * (*conic)(1), 0.5 * (*conic)(1), (*conic)(2);
  const Eigen::Vector2d linear(0.5 * (*conic)(3), 0.5 * (*conic)(4));
  const Eigen::Vector2d centre = -Q.inverse() * linear;
  Q /= -(linear.dot(centre) + (*conic)(5)); // 1 on the outline
  if (!Q.allFinite() || !centre.allFinite() || !(Q.trace() > 0)) {
    return std::nullopt;
  }
  return vpEllipseModel(Eigen::Vector2d(middle.x, middle.y) + centre / perSpread,
                        Eigen::Matrix2d(rootOf(Q) * perSpread));
}

vpEllipseModel vpEllipseModel::from(const std::vector<cv::Point2f> &points, const cv::Rect &box)
{
  const Eigen::Vector2d middle(box.x + 0.5 * (box.width - 1), box.y + 0.5 * (box.height - 1));
  const double radius = 0.5 * std::max(box.width, box.height);
  std::optional<vpEllipseModel> best;
  if (points.size() >= 6) {
    static const double longest = 2.5, smallest = 1; // a / b; px
    best = through(points);
    const Eigen::Vector2d axes = best ? best->axes() : Eigen::Vector2d::Zero();
    if (!(axes.y() > smallest) || axes.x() > longest * axes.y() || !best->plausible(box)) {
      best.reset();
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
  // exp(-E / 2): the square of E is a multiple of the identity.
  const double half = 0.5 * std::hypot(step(3), step(4));
  const double perHalf = half > 1e-9 ? std::sinh(half) / half : 1;
  const Eigen::Matrix2d M =
      std::exp(-step(2)) * (std::cosh(half) * Eigen::Matrix2d::Identity() - 0.5 * perHalf * E) * m_shape;
  m_shape = rootOf(M.transpose() * M);
}

double vpEllipseModel::addPrior(double sigma, Eigen::Ref<Eigen::MatrixXd> H,
                                Eigen::Ref<Eigen::VectorXd> g) const
{
  const double logRatio = std::log(axes().x() / axes().y()), twice = 2 * angle();
  const double weight = 1 / (sigma * sigma);
  H(3, 3) += weight;
  H(4, 4) += weight;
  g(3) -= weight * logRatio * std::cos(twice);
  g(4) -= weight * logRatio * std::sin(twice);
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

Eigen::Vector2d vpEllipseModel::axes() const
{
  // Eigenvalues of the shape are 1 / a and 1 / b.
  const double mean = 0.5 * m_shape.trace(),
               apart = std::hypot(0.5 * (m_shape(0, 0) - m_shape(1, 1)), m_shape(0, 1));
  return {1 / (mean - apart), 1 / (mean + apart)};
}

double vpEllipseModel::angle() const
{
  return 0.5 * std::atan2(-2 * m_shape(0, 1), m_shape(1, 1) - m_shape(0, 0));
}

double vpEllipseModel::radius() const
{
  return 1 / std::sqrt(std::max(m_shape.determinant(), 1e-12));
}

bool vpEllipseModel::plausible(const cv::Rect &box) const
{
  const double size = std::max(box.width, box.height);
  const Eigen::Vector2d middle(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  const double a = axes().x(), b = axes().y();
  return std::isfinite(a) && std::isfinite(b) && a > 0 && a < 3 * size &&
         b > 0.2 * std::min(box.width, box.height) && a < 4 * b && (m_centre - middle).norm() < 1.5 * size;
}

vpLampOutline vpEllipseModel::outline(const Eigen::Ref<const Eigen::MatrixXd> &covariance) const
{
  vpLampOutline outline;
  outline.shape = vpLampOutline::Shape::ellipse;
  outline.centre = m_centre;
  outline.a = axes().x();
  outline.b = axes().y();
  outline.angle = angle();
  outline.centreCovariance = covariance.topLeftCorner<2, 2>();
  return outline;
}

END_VISP_NAMESPACE
