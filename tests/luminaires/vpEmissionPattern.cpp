/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "luminaires/vpEmissionPattern.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>
#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE
namespace
{
using Picture = Eigen::MatrixXd; // a row per line

//! Light of the lines as a function of their phase alone.
struct Fold {
  double period = 0;     // lines
  Eigen::VectorXd light; // of each line, 1 at the brightest phase
  double explained = 0;  // grey levels squared
};

//! Of each pixel's light over S, the mean over a line, weighted as least squares wants it.
Eigen::VectorXd consensus(const Picture &I, const Picture &S)
{
  return I.cwiseProduct(S).rowwise().sum().cwiseQuotient((S.rowwise().squaredNorm().array() + 1e-9).matrix());
}

Fold fold(const Eigen::VectorXd &lines, const Eigen::VectorXd &weight, double period)
{
  static const double width = 0.03; // periods, of the kernel that joins lines of like phase
  Fold result;
  result.period = period;
  result.light.resize(lines.size());
  for (Eigen::Index i = 0; i < lines.size(); ++i) {
    double sum = 0, total = 1e-12;
    for (Eigen::Index k = 0; k < lines.size(); ++k) {
      const double turns = static_cast<double>(i - k) / period, off = (turns - std::round(turns)) / width;
      if (std::abs(off) < 4) {
        const double share = weight(k) * std::exp(-0.5 * off * off);
        sum += share * lines(k);
        total += share;
      }
    }
    result.light(i) = sum / total;
    result.explained += weight(i) * result.light(i) * result.light(i);
  }
  result.light /= result.light.maxCoeff();
  return result;
}

Fold bestFold(const Picture &I, const Picture &S, double nominal)
{
  static const double range = 0.015; // share of the period
  static const int steps = 15;       // to each side
  const Eigen::VectorXd lines = consensus(I, S), weight = S.rowwise().squaredNorm();
  Fold best;
  for (int i = -steps; i <= steps; ++i) {
    const Fold tried = fold(lines, weight, nominal * (1 + range * i / steps));
    best = tried.explained > best.explained ? tried : best;
  }
  return best;
}

//! The second step of vpTakePattern(): all columns share one matrix.
Picture fillColumns(const Picture &I, const Eigen::VectorXd &light)
{
  static const double lit = 0.4; // share of the brightest line's; darker ones say more of noise than of S
  static const double tension = 0.02, stiffness = 1; // lines^2 and lines^4: smoothing over about one line
  const Eigen::Index n = I.rows();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  Picture right = Picture::Zero(n, I.cols());
  for (Eigen::Index i = 0; i < n; ++i) {
    A(i, i) += 1e-6; // columns without any lit line are dark
    if (light(i) > lit) {
      A(i, i) += light(i) * light(i);
      right.row(i) = light(i) * I.row(i);
    }
    if (i + 1 < n) {
      const Eigen::Vector2d d(-1, 1);
      A.block<2, 2>(i, i) += tension * d * d.transpose();
    }
    if (i + 2 < n) {
      const Eigen::Vector3d d(1, -2, 1);
      A.block<3, 3>(i, i) += stiffness * d * d.transpose();
    }
  }
  return A.llt().solve(right).cwiseMax(0);
}

cv::Mat_<float> square(const vpStripedLamp &lamp, cv::Point &corner)
{
  const int side = 2 * lamp.reach + 1;
  corner = {cvRound(lamp.middle.x()) - lamp.reach, cvRound(lamp.middle.y()) - lamp.reach};
  cv::Mat_<float> grey(side, side);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      grey(y, x) = lamp.grey(std::clamp(corner.y + y, 0, lamp.grey.rows - 1),
                             std::clamp(corner.x + x, 0, lamp.grey.cols - 1));
    }
  }
  return grey;
}

double percentile(const cv::Mat_<float> &values, double share)
{
  std::vector<float> sorted(values.begin(), values.end());
  const auto at = sorted.begin() + static_cast<long>(share * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), at, sorted.end());
  return *at;
}

//! Radius about the middle at which the light, on average over all directions, falls most steeply by its
//! logarithm, px.
double outlineRadius(const vpEmissionPattern &pattern)
{
  static const double dark = 0.02; // share of the brightest: what is darker counts as dark
  static const int reach = 3;      // px to both sides
  const int size = std::min(pattern.light.rows, pattern.light.cols) / 2;
  std::vector<double> sum(size + 1), count(size + 1);
  for (int y = 0; y < pattern.light.rows; ++y) {
    for (int x = 0; x < pattern.light.cols; ++x) {
      const int r = cvRound(std::hypot(x - pattern.middle.x(), y - pattern.middle.y()));
      if (r <= size) {
        sum[r] += std::log(pattern.light(y, x) + dark);
        ++count[r];
      }
    }
  }
  double best = 0, steepest = 0;
  for (int r = size / 4; r + reach <= size; ++r) {
    const double fall = sum[r - reach] / count[r - reach] - sum[r + reach] / count[r + reach];
    if (fall > steepest) {
      steepest = fall;
      best = r;
    }
  }
  return best;
}

//! Fades what is farther from the middle than the lamp's own glow.
void mask(vpEmissionPattern &pattern)
{
  static const double whole = 1.15, none = 1.4; // radii of the outline
  for (int y = 0; y < pattern.light.rows; ++y) {
    for (int x = 0; x < pattern.light.cols; ++x) {
      const double r = 2 * std::hypot(x - pattern.middle.x(), y - pattern.middle.y()) / pattern.diameter;
      const double t = std::clamp((none - r) / (none - whole), 0., 1.);
      pattern.light(y, x) *= static_cast<float>(t * t * (3 - 2 * t));
    }
  }
}
} // namespace

vpEmissionPattern vpTakePattern(const vpStripedLamp &lamp)
{
  cv::Point corner;
  cv::Mat_<float> grey = square(lamp, corner);
  grey -= percentile(grey, 0.2);
  Picture I;
  cv::cv2eigen(cv::Mat_<double>(grey), I);
  cv::Mat_<float> smooth; // a first S, over one period
  cv::GaussianBlur(grey, smooth, cv::Size(0, 0), 1, 0.5 * lamp.period);
  Picture S;
  cv::cv2eigen(cv::Mat_<double>(cv::max(smooth, 0)), S);
  for (int round = 0; round < 6; ++round) {
    S = fillColumns(I, bestFold(I, S, lamp.period).light);
  }
  const double brightest = S.maxCoeff();
  if (!(brightest > 1)) {
    throw vpException(vpException::badValue,
                      "vpTakePattern: the brightest pixel is %g grey levels above its "
                      "surroundings, expected a lamp",
                      brightest);
  }
  vpEmissionPattern pattern;
  cv::Mat taken;
  cv::eigen2cv(S, taken);
  taken.convertTo(pattern.light, CV_32F);
  cv::GaussianBlur(pattern.light, pattern.light, cv::Size(0, 0), 0.7, 0.7); // what JPEG leaves
  pattern.middle = lamp.middle - Eigen::Vector2d(corner.x, corner.y);
  pattern.light /= static_cast<float>(brightest);
  pattern.diameter = 2 * outlineRadius(pattern);
  pattern.lit = Eigen::Vector2d::Constant(pattern.diameter);
  mask(pattern);
  double most = 0;
  cv::minMaxLoc(pattern.light, nullptr, &most);
  pattern.light /= static_cast<float>(most);
  return pattern;
}

cv::Mat vpPatternPicture(const vpEmissionPattern &pattern)
{
  cv::Mat_<float> bright;
  cv::sqrt(pattern.light, bright);
  cv::Mat picture;
  bright.convertTo(picture, CV_8U, 255);
  cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  const cv::Point middle(cvRound(pattern.middle.x()), cvRound(pattern.middle.y()));
  cv::drawMarker(picture, middle, cv::Scalar(0, 0, 255), cv::MARKER_CROSS, 7);
  cv::circle(picture, middle, cvRound(0.5 * pattern.diameter), cv::Scalar(0, 90, 0));
  return picture;
}

END_VISP_NAMESPACE
