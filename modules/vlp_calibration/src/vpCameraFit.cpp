/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpCameraFit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>
#include <ceres/autodiff_cost_function.h>
#include <ceres/rotation.h>
#include <ceres/solver.h>
#include <opencv2/calib3d.hpp>

#include "vpCameraModel.h"
#include "vpNormalEquations.h"

BEGIN_VISP_NAMESPACE

namespace
{
using Model = vpCameraCalibration::Model;

//! Where OpenCV says that all is.
struct Start {
  std::vector<double> parameters;
  std::vector<std::array<double, 6>> poses; // rotation vector, translation (m)
};

//! \throw cv::Exception where OpenCV sees no way.
Start startOf(Model model, const std::vector<vpBoardSight> &sights, cv::Size size)
{
  std::vector<std::vector<cv::Point3f>> boards;
  std::vector<std::vector<cv::Point2f>> pixels;
  for (const vpBoardSight &sight : sights) {
    boards.push_back(sight.board);
    pixels.push_back(sight.pixels);
  }
  cv::Mat K = cv::Mat::eye(3, 3, CV_64F), D;
  std::vector<cv::Mat> turns, ways;
  int flags = 0;
  if (model != Model::opencv) {
    flags |= cv::CALIB_FIX_K2 | cv::CALIB_FIX_K3 | cv::CALIB_ZERO_TANGENT_DIST;
    flags |= model == Model::perspective ? cv::CALIB_FIX_K1 : 0;
  }
  cv::calibrateCamera(boards, pixels, size, K, D, turns, ways, flags);
  Start start;
  start.parameters = {K.at<double>(0, 0), K.at<double>(1, 1), K.at<double>(0, 2), K.at<double>(1, 2)};
  D = D.reshape(1, 1);
  if (model == Model::visp) {
    start.parameters.push_back(D.at<double>(0));
  } else if (model == Model::kannalaBrandt) { // of an ideal lens tan(angle) = angle + angle^3 / 3 + ...
    start.parameters.insert(start.parameters.end(), {1.0 / 3 + D.at<double>(0), 0, 0, 0});
  } else if (model == Model::opencv) {
    for (int i = 0; i < 5; ++i) {
      start.parameters.push_back(D.at<double>(i));
    }
  }
  for (size_t i = 0; i < turns.size(); ++i) {
    std::array<double, 6> pose{};
    for (int k = 0; k < 3; ++k) {
      pose[static_cast<size_t>(k)] = turns[i].at<double>(k);
      pose[static_cast<size_t>(k) + 3] = ways[i].at<double>(k);
    }
    start.poses.push_back(pose);
  }
  return start;
}

Eigen::Matrix3d rotationOf(const std::array<double, 6> &pose)
{
  const Eigen::Vector3d turn(pose[0], pose[1], pose[2]);
  return Eigen::AngleAxisd(turn.norm(),
                           turn.norm() > 0 ? Eigen::Vector3d(turn.normalized()) : Eigen::Vector3d::UnitX())
      .toRotationMatrix();
}

template <Model model>
struct PointResidual {
  Eigen::Vector3d board;
  Eigen::Vector2d pixel;

  template <typename T>
  bool operator()(const T *parameters, const T *pose, T *residual) const
  {
    const T point[3] = {T(board.x()), T(board.y()), T(board.z())};
    T c[3];
    ceres::AngleAxisRotatePoint(pose, point, c);
    const T z = c[2] + pose[5];
    const Eigen::Matrix<T, 2, 1> at =
        vpPixelOf<model>(parameters, T((c[0] + pose[3]) / z), T((c[1] + pose[4]) / z));
    residual[0] = T(pixel.x()) - at(0);
    residual[1] = T(pixel.y()) - at(1);
    return true;
  }
};

//! Fits all to the points from where it starts. \return False where that comes to no end.
template <Model model>
bool adjust(const std::vector<vpBoardSight> &sights, Start &start, vpCameraEstimate &estimate)
{
  ceres::Problem problem;
  std::vector<ceres::ResidualBlockId> blocks;
  std::vector<double *> poses;
  for (size_t i = 0; i < sights.size(); ++i) {
    poses.push_back(start.poses[i].data());
    for (size_t k = 0; k < sights[i].board.size(); ++k) {
      const cv::Point3f &board = sights[i].board[k];
      const cv::Point2f &pixel = sights[i].pixels[k];
      auto *residual = new PointResidual<model>{{board.x, board.y, board.z}, {pixel.x, pixel.y}};
      blocks.push_back(problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<PointResidual<model>, 2, vpParametersOf(model), 6>(residual),
          nullptr, start.parameters.data(), start.poses[i].data()));
    }
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) {
    return false;
  }
  const vpNormalEquations equations(problem, poses, {start.parameters.data()}, blocks);
  const std::vector<double> &residuals = equations.residuals();
  double squares = 0;
  for (const double residual : residuals) {
    squares += residual * residual;
  }
  const double freedom =
      static_cast<double>(residuals.size()) - vpParametersOf(model) - 6. * static_cast<double>(poses.size());
  estimate.values = Eigen::Map<Eigen::VectorXd>(start.parameters.data(), vpParametersOf(model));
  estimate.covariance = squares / std::max(1.0, freedom) * vpInverseOf(equations.information());
  estimate.rms = std::sqrt(squares / static_cast<double>(residuals.size()));
  estimate.views.clear();
  size_t row = 0;
  for (size_t i = 0; i < sights.size(); ++i) {
    vpCalibratedView view;
    view.picture = sights[i].picture;
    view.tilt = std::acos(std::min(1.0, std::abs(rotationOf(start.poses[i])(2, 2))));
    double own = 0;
    for (const cv::Point2f &pixel : sights[i].pixels) {
      view.points.emplace_back(pixel.x, pixel.y);
      view.residuals.emplace_back(residuals[row], residuals[row + 1]);
      own += view.residuals.back().squaredNorm();
      row += 2;
    }
    view.rms = std::sqrt(own / (2. * static_cast<double>(view.points.size())));
    estimate.views.push_back(view);
  }
  return true;
}

//! Middle of the picture of a disc, whose middle and radius (m) are on the board: of the area that it covers.
template <Model model>
Eigen::Vector2d discMiddle(const std::vector<double> &parameters, const Eigen::Matrix3d &R,
                           const Eigen::Vector3d &t, const Eigen::Vector3d &middle, double radius)
{
  static const int corners = 48; // of a polygon in its place
  std::array<Eigen::Vector2d, corners> rim;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * M_PI * i / corners;
    const Eigen::Vector3d c =
        R * (middle + radius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0)) + t;
    rim[static_cast<size_t>(i)] = vpPixelOf<model>(parameters.data(), c.x() / c.z(), c.y() / c.z());
  }
  const Eigen::Vector2d &base = rim[0];
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  double area = 0;
  for (size_t i = 2; i < rim.size(); ++i) {
    const Eigen::Vector2d a = rim[i - 1] - base, b = rim[i] - base;
    const double cross = a.x() * b.y() - a.y() * b.x();
    area += cross;
    moment += cross * (a + b) / 3;
  }
  return base + moment / area;
}

//! The points, those of discs as if the middles themselves had been seen.
template <Model model>
std::vector<vpBoardSight> middlesOf(const std::vector<vpBoardSight> &sights, const Start &fit)
{
  std::vector<vpBoardSight> middles = sights;
  for (size_t i = 0; i < sights.size(); ++i) {
    const std::array<double, 6> &pose = fit.poses[i];
    const Eigen::Matrix3d R = rotationOf(pose);
    const Eigen::Vector3d t(pose[3], pose[4], pose[5]);
    for (size_t k = 0; sights[i].discRadius > 0 && k < sights[i].board.size(); ++k) {
      const cv::Point3f &board = sights[i].board[k];
      const Eigen::Vector3d middle(board.x, board.y, board.z), c = R * middle + t;
      const Eigen::Vector2d off = discMiddle<model>(fit.parameters, R, t, middle, sights[i].discRadius) -
                                  vpPixelOf<model>(fit.parameters.data(), c.x() / c.z(), c.y() / c.z());
      middles[i].pixels[k] -= cv::Point2f(static_cast<float>(off.x()), static_cast<float>(off.y()));
    }
  }
  return middles;
}

template <Model model>
bool fitTo(const std::vector<vpBoardSight> &sights, cv::Size size, vpCameraEstimate &estimate)
{
  Start fit = startOf(model, sights, size);
  if (!adjust<model>(sights, fit, estimate)) {
    return false;
  }
  static const int rounds = 2;
  const bool discs = std::any_of(sights.begin(), sights.end(),
                                 [](const vpBoardSight &sight) { return sight.discRadius > 0; });
  for (int round = 0; round < rounds && discs; ++round) {
    if (!adjust<model>(middlesOf<model>(sights, fit), fit, estimate)) {
      return false;
    }
  }
  return true;
}
} // namespace

bool vpFitCamera(Model model, const std::vector<vpBoardSight> &sights, unsigned int width,
                 unsigned int height, vpCameraEstimate &estimate)
{
  const cv::Size size(static_cast<int>(width), static_cast<int>(height));
  switch (model) {
  case Model::perspective:
    return fitTo<Model::perspective>(sights, size, estimate);
  case Model::visp:
    return fitTo<Model::visp>(sights, size, estimate);
  case Model::kannalaBrandt:
    return fitTo<Model::kannalaBrandt>(sights, size, estimate);
  case Model::opencv:
    return fitTo<Model::opencv>(sights, size, estimate);
  }
  return false;
}

END_VISP_NAMESPACE
