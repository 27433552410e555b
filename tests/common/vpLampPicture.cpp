/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpLampPicture.h"

#include <random>

#include <opencv2/imgproc.hpp>

BEGIN_VISP_NAMESPACE

bool vpPaintedLamp::inside(const Eigen::Vector2d &point) const
{
  for (size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d side = corners[(i + 1) % corners.size()] - corners[i], to = point - corners[i];
    if (side.x() * to.y() - side.y() * to.x() < 0)
      return false;
  }
  if (!corners.empty())
    return true;
  const Eigen::Vector2d d = point - centre; // of few points one has to ask which way the ellipse lies
  if (const double least = std::min(a, b); d.squaredNorm() < least * least)
    return true;
  if (const double most = std::max(a, b); d.squaredNorm() >= most * most)
    return false;
  const double c = std::cos(angle), s = std::sin(angle);
  const double along = (c * d.x() + s * d.y()) / a, across = (-s * d.x() + c * d.y()) / b;
  return along * along + across * across < 1;
}

double vpPaintedLamp::covers(const Eigen::Vector2d &upperLeft, double side) const
{
  static const int points = 89, step = 55;
  int in = 0;
  for (int k = 0; k < points; ++k)
    in += inside(upperLeft + side / points * Eigen::Vector2d(k + 0.5, k * step % points + 0.5));
  return static_cast<double>(in) / points;
}

cv::Mat_<float> vpLampPicture::coverage(const vpPaintedLamp &lamp) const
{
  static const int cells = 4; // of a pixel, along each side
  const int spread = static_cast<int>(std::ceil(5 * blur));
  const int reach = static_cast<int>(std::ceil(lamp.reach())) + spread + 2;
  const int u = cvRound(lamp.centre.x()), v = cvRound(lamp.centre.y());
  const cv::Rect frame(0, 0, width, height);
  const cv::Rect box = cv::Rect(u - reach, v - reach, 2 * reach + 1, 2 * reach + 1) &
                       cv::Rect(-spread, -spread, width + 2 * spread, height + 2 * spread);
  cv::Mat_<float> whole(height, width, 0.f);
  if ((box & frame).empty())
    return whole;
  cv::Mat_<float> mask(box.height * cells, box.width * cells, 0.f);
  cv::Mat_<int> inside(mask.rows + 1, mask.cols + 1); // of the cells' corners, 0 or 1
  auto corner = [&](int y, int x) {
    return Eigen::Vector2d(box.x - 0.5 + double(x) / cells, box.y - 0.5 + double(y) / cells);
  };
  for (int y = 0; y < inside.rows; ++y)
    for (int x = 0; x < inside.cols; ++x)
      inside(y, x) = lamp.inside(corner(y, x));
  for (int y = 0; y < mask.rows; ++y)
    for (int x = 0; x < mask.cols; ++x) {
      // Lamps are convex: with all corners the whole cell is inside. Without any only a tip may be.
      const int in = inside(y, x) + inside(y, x + 1) + inside(y + 1, x) + inside(y + 1, x + 1);
      if (in == 4)
        mask(y, x) = 1;
      else if (in > 0 || lamp.hasTipNear(corner(y, x)))
        mask(y, x) = static_cast<float>(lamp.covers(corner(y, x), 1.0 / cells));
    }
  if (blur > 0) {
    const int size = 2 * spread * cells + 1;
    cv::GaussianBlur(mask, mask, cv::Size(size, size), cells * blur, cells * blur, cv::BORDER_CONSTANT);
  }
  cv::resize(mask, mask, box.size(), 0, 0, cv::INTER_AREA); // the mean of each pixel's cells
  for (int y = 0; y < mask.rows; ++y)
    for (int x = 0; x < mask.cols; ++x)
      mask(y, x) *=
          static_cast<float>(1 + lamp.shading.dot(Eigen::Vector2d(box.x + x, box.y + y) - lamp.centre));
  mask((box & frame) - box.tl()).copyTo(whole(box & frame));
  return whole;
}

cv::Mat_<float> vpLampPicture::exact() const
{
  cv::Mat_<float> grey(height, width, static_cast<float>(background));
  for (const vpPaintedLamp &lamp : lamps) {
    const cv::Mat_<float> share = coverage(lamp);
    for (int line = 0; line < (columns ? width : height); ++line) {
      const double light = lamp.amplitude * lamp.light(start(line), exposure);
      cv::Mat_<float> target = columns ? grey.col(line) : grey.row(line);
      target += light * (columns ? share.col(line) : share.row(line));
    }
  }
  return grey;
}

vpImage<unsigned char> vpLampPicture::render() const
{
  const cv::Mat_<float> grey = exact();
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  vpImage<unsigned char> I(static_cast<unsigned int>(height), static_cast<unsigned int>(width));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      I[y][x] = cv::saturate_cast<unsigned char>(cvRound(grey(y, x) + noise * normal(generator)));
  return I;
}

END_VISP_NAMESPACE
