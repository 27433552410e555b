/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_calibration/vpCameraCalibration.h>

#include <algorithm>
#include <cmath>
#include <set>

#include <opencv2/core.hpp>
#include <visp3/core/vpMath.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "vpCameraFit.h"
#include "vpCameraOf.h"

BEGIN_VISP_NAMESPACE

namespace
{
using Model = vpCameraCalibration::Model;

//! kdu that undoes kud over the picture, by least squares over a grid of its pixels.
double wayBack(double px, double py, double u0, double v0, double kud, unsigned int width,
               unsigned int height)
{
  double product = 0, square = 0;
  static const int steps = 40;
  for (int i = 0; i <= steps; ++i) {
    for (int k = 0; k <= steps; ++k) {
      const Eigen::Vector2d distorted((width - 1.) * i / steps - u0, (height - 1.) * k / steps - v0);
      const Eigen::Vector2d d(distorted.x() / px, distorted.y() / py);
      Eigen::Vector2d ray = d;
      for (int round = 0; round < 20; ++round) {
        ray = d / (1 + kud * ray.squaredNorm());
      }
      const Eigen::Vector2d by = d * d.squaredNorm();
      product += (ray - d).dot(by);
      square += by.squaredNorm();
    }
  }
  return square > 0 ? product / square : 0;
}

std::vector<std::string> namesOf(Model model)
{
  std::vector<std::string> names = {"px", "py", "u0", "v0"};
  const std::vector<std::string> more =
      model == Model::visp            ? std::vector<std::string>{"kud"}
      : model == Model::kannalaBrandt ? std::vector<std::string>{"k1", "k2", "k3", "k4"}
      : model == Model::opencv        ? std::vector<std::string>{"k1", "k2", "p1", "p2", "k3"}
                                      : std::vector<std::string>{};
  names.insert(names.end(), more.begin(), more.end());
  return names;
}

//! How many of the boards are held in ways of their own.
size_t waysOf(const std::vector<vpBoardSight> &sights)
{
  // By their outlines: two boards whose points all lie within a few pixels of each other are held alike.
  static const double alike = 10; // px
  std::vector<const vpBoardSight *> ways;
  for (const vpBoardSight &sight : sights) {
    const bool known = std::any_of(ways.begin(), ways.end(), [&sight](const vpBoardSight *other) {
      if (other->pixels.size() != sight.pixels.size()) {
        return false;
      }
      double worst = 0;
      for (size_t i = 0; i < sight.pixels.size(); ++i) {
        worst = std::max(worst, cv::norm(sight.pixels[i] - other->pixels[i]));
      }
      return worst < alike;
    });
    if (!known) {
      ways.push_back(&sight);
    }
  }
  return ways.size();
}
/*!
  Whether the points lie as on a flat board, but for the lens: those of another size are named wrongly, as
  ChArUco's markers are counted line by line.
*/
bool liesOnItsBoard(const vpBoardSight &sight)
{
  static const double most = 0.15; // of the points' spread
  static const size_t fewest = 4;  // points: fewer lie on any board
  if (sight.pixels.size() < fewest) {
    return true;
  }
  const cv::Scalar mean = cv::mean(sight.pixels);
  const cv::Point2f middle(static_cast<float>(mean[0]), static_cast<float>(mean[1]));
  double spread = 0; // px^2
  for (const cv::Point2f &pixel : sight.pixels) {
    spread += (pixel - middle).dot(pixel - middle);
  }
  return vpMath::sqr(sight.offPlane()) * static_cast<double>(sight.pixels.size()) <=
         vpMath::sqr(most) * spread;
}
} // namespace

vpCameraParameters vpCameraOf(vpCameraCalibration::Model model, const Eigen::VectorXd &p, unsigned int width,
                              unsigned int height)
{
  vpCameraParameters camera;
  if (model == Model::visp) {
    camera.initPersProjWithDistortion(p(0), p(1), p(2), p(3), p(4),
                                      wayBack(p(0), p(1), p(2), p(3), p(4), width, height));
  } else if (model == Model::kannalaBrandt) {
    camera.initProjWithKannalaBrandtDistortion(p(0), p(1), p(2), p(3), {p(4), p(5), p(6), p(7), 0});
  } else {
    camera.initPersProjWithoutDistortion(p(0), p(1), p(2), p(3));
  }
  return camera;
}

bool vpCameraCalibration::fit(const std::vector<vpBoardSight> &sights, unsigned int width,
                              unsigned int height, vpCameraEstimate &estimate) const
{
  estimate = vpCameraEstimate();
  bool good = false;
  try {
    good = vpFitCamera(model, sights, width, height, estimate);
  } catch (const cv::Exception &) { // points on one line and the like
    good = false;
  }
  if (good) {
    estimate.names = namesOf(model);
    estimate.camera = vpCameraOf(model, estimate.values, width, height);
  }
  return good;
}

std::string vpCameraCalibration::degenerate(const vpCameraEstimate &estimate, unsigned int width,
                                            unsigned int height) const
{
  static const std::string tilted = "take pictures with the board tilted by 20 to 40 degrees, to the left, "
                                    "right, front and back, up to the "
                                    "corners of the picture";
  const double px = estimate.values(0), py = estimate.values(1), u0 = estimate.values(2),
               v0 = estimate.values(3);
  const auto sigma = [&](int i) { return std::sqrt(std::max(0.0, estimate.covariance(i, i))); };
  if (!(px > 0 && py > 0) || !(u0 > 0 && u0 < width && v0 > 0 && v0 < height)) {
    return "the pictures lead to a focal length of " + vpNumberText(std::round(px)) +
           " px and a principal point at (" + vpNumberText(std::round(u0)) + ", " +
           vpNumberText(std::round(v0)) + "), which cannot be: " + tilted;
  }
  if (!(sigma(0) < worstFocal * px && sigma(1) < worstFocal * py)) {
    return "the focal length stays uncertain by " + vpNumberText(std::round(1000 * sigma(0) / px) / 10) +
           " %, at most " + vpNumberText(100 * worstFocal) + " % is accepted: " + tilted;
  }
  if (!(sigma(2) < worstPrincipalPoint * width && sigma(3) < worstPrincipalPoint * width)) {
    return "the principal point stays uncertain by " +
           vpNumberText(std::round(10 * std::max(sigma(2), sigma(3))) / 10) + " px, at most " +
           vpNumberText(worstPrincipalPoint * width) + " px are accepted: " + tilted;
  }
  return "";
}

vpCameraEstimate vpCameraCalibration::solve(const std::vector<vpBoardSight> &sights, unsigned int width,
                                            unsigned int height) const
{
  vpCameraEstimate estimate;
  std::vector<vpBoardSight> used;
  for (const vpBoardSight &sight : sights) {
    if (!sight.pixels.empty()) {
      used.push_back(sight);
    }
  }
  if (used.size() < fewestViews) {
    estimate.refusal = "too few pictures: " + std::to_string(used.size()) + " of " +
                       std::to_string(sights.size()) + " show the board, expected " +
                       std::to_string(fewestViews) + " or more, better 15, each from another side" +
                       (used.empty() ? "; check kind and size of the board" : "");
    return estimate;
  }
  const auto fitting = static_cast<size_t>(std::count_if(used.begin(), used.end(), liesOnItsBoard));
  if (2 * fitting < used.size()) {
    estimate.refusal = "the points found in " + std::to_string(used.size() - fitting) + " of " +
                       std::to_string(used.size()) +
                       " pictures do not lie as on the board that is stated; count its inner corners along "
                       "either side, and state its kind and size";
    return estimate;
  }
  static const size_t fewestWays = 3; // Zhang: two of a flat board do, without errors
  if (const size_t ways = waysOf(used); ways < fewestWays) {
    estimate.refusal = "all pictures are from one place: the board is held in " + std::to_string(ways) +
                       " way" + (ways == 1 ? "" : "s") + ", expected " + std::to_string(fewestWays) +
                       " or more, better 15; move and tilt it between the pictures";
    return estimate;
  }
  const std::string noEnd =
      "the fit comes to no end; take other pictures, with the board tilted by 20 to 40 degrees";
  if (!fit(used, width, height, estimate)) {
    estimate.refusal = noEnd;
    return estimate;
  }

  // Pictures far worse than the others: a board that bent, or moved while it was taken.
  std::vector<double> errors;
  for (const vpCalibratedView &view : estimate.views) {
    errors.push_back(view.rms);
  }
  std::nth_element(errors.begin(), errors.begin() + static_cast<long>(errors.size() / 2), errors.end());
  const double limit = outlier * errors[errors.size() / 2];
  std::vector<vpCalibratedView> left;
  std::vector<vpBoardSight> good;
  for (size_t i = 0; i < used.size(); ++i) {
    if (estimate.views[i].rms > limit) {
      left.push_back(estimate.views[i]);
      left.back().used = false;
    } else {
      good.push_back(used[i]);
    }
  }
  if (!left.empty() && (good.size() < fewestViews || !fit(good, width, height, estimate))) {
    estimate.refusal =
        good.size() < fewestViews ? "too few pictures without those far off the others" : noEnd;
    return estimate;
  }
  estimate.refusal = degenerate(estimate, width, height);
  if (!estimate.refusal.empty()) {
    return estimate;
  }
  std::set<int> cells;
  for (const vpCalibratedView &view : estimate.views) {
    for (const Eigen::Vector2d &point : view.points) {
      cells.insert(8 * std::clamp(static_cast<int>(6 * point.y() / height), 0, 5) +
                   std::clamp(static_cast<int>(8 * point.x() / width), 0, 7));
    }
  }
  estimate.coverage = static_cast<double>(cells.size()) / 48;
  estimate.views.insert(estimate.views.end(), left.begin(), left.end());
  estimate.valid = true;
  return estimate;
}

END_VISP_NAMESPACE
