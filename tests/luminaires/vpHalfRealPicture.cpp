/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "luminaires/vpHalfRealPicture.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <visp3/vlp_simulation/vpLampLight.h>

BEGIN_VISP_NAMESPACE
namespace
{
Eigen::Matrix2d turn(double angle)
{
  Eigen::Matrix2d matrix;
  matrix << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return matrix;
}

void addBackground(const vpHalfRealPicture &picture, cv::Mat_<float> &grey)
{
  for (int v = 0; v < grey.rows; ++v) {
    for (int u = 0; u < grey.cols; ++u) {
      const Eigen::Vector2d off(u - 0.5 * grey.cols, v - 0.5 * grey.rows);
      grey(v, u) = static_cast<float>(std::max(0., picture.background + picture.gradient.dot(off)));
    }
  }
}

void addLamp(const vpHalfRealPicture &picture, const vpHalfRealLamp &lamp, cv::Mat_<float> &grey)
{
  cv::Rect box;
  const cv::Mat_<float> light = picture.unstriped(lamp, box);
  const vpLampLight blinking(lamp.modulation, lamp.rate, lamp.phase);
  const cv::Rect seen = box & cv::Rect(0, 0, grey.cols, grey.rows);
  for (int v = seen.y; v < seen.y + seen.height; ++v) {
    const double start = v * picture.rowTime;
    const auto share = static_cast<float>(blinking.over(start, start + picture.exposure).share);
    for (int u = seen.x; u < seen.x + seen.width; ++u) {
      grey(v, u) += share * light(v - box.y, u - box.x);
    }
  }
}

cv::Mat_<unsigned char> developed(const vpHalfRealPicture &picture, cv::Mat_<float> grey)
{
  if (picture.gamma != 1) {
    cv::pow(cv::max(grey, 0) / 255, 1 / picture.gamma, grey);
    grey *= 255;
  }
  std::mt19937_64 generator(picture.seed);
  std::normal_distribution<float> normal;
  for (float &value : grey) {
    const double shot = picture.electrons > 0 ? std::max(value, 0.f) / picture.electrons : 0;
    value += static_cast<float>(std::sqrt(picture.noise * picture.noise + shot)) * normal(generator);
  }
  cv::Mat_<unsigned char> bytes(grey); // rounded and clipped
  if (picture.jpeg > 0) {
    std::vector<unsigned char> file;
    cv::imencode(".jpg", bytes, file, {cv::IMWRITE_JPEG_QUALITY, picture.jpeg});
    bytes = cv::imdecode(file, cv::IMREAD_GRAYSCALE);
  }
  return bytes;
}
} // namespace

Eigen::Matrix2d vpHalfRealLamp::warp() const
{
  const Eigen::DiagonalMatrix<double, 2> shortened(std::cos(tilt), 1);
  return diameter / pattern->diameter * turn(tiltAxis) * shortened * turn(-tiltAxis) * turn(angle);
}

double vpHalfRealLamp::lines() const
{
  return (warp().row(1).transpose().cwiseProduct(pattern->lit)).norm();
}

double vpHalfRealLamp::reach() const
{
  double farthest = 0;
  for (double x : {-0.5, pattern->light.cols - 0.5}) {
    for (double y : {-0.5, pattern->light.rows - 0.5}) {
      farthest = std::max(farthest, (warp() * (Eigen::Vector2d(x, y) - pattern->middle)).norm());
    }
  }
  return farthest;
}

cv::Mat_<float> vpHalfRealPicture::unstriped(const vpHalfRealLamp &lamp, cv::Rect &box) const
{
  const Eigen::Matrix2d back = lamp.warp().inverse();
  // Cells of a pixel along each side: no farther apart than the pattern's own pixels, and 4 at least.
  const int cells = std::max(4, static_cast<int>(std::ceil(back.norm() / std::sqrt(2))));
  const int reach = static_cast<int>(std::ceil(lamp.reach() + 4 * blur)) + 1;
  box = {cvRound(lamp.middle.x()) - reach, cvRound(lamp.middle.y()) - reach, 2 * reach + 1, 2 * reach + 1};
  // Cell x of the box lies at (x + 0.5) / cells - 0.5 px from its first pixel's centre.
  const Eigen::Matrix2d step = back / cells;
  const Eigen::Vector2d first = Eigen::Vector2d::Constant(0.5 / cells - 0.5) + Eigen::Vector2d(box.x, box.y);
  const Eigen::Vector2d origin = lamp.pattern->middle + back * (first - lamp.middle);
  const cv::Matx23d map(step(0, 0), step(0, 1), origin.x(), step(1, 0), step(1, 1), origin.y());
  cv::Mat_<float> fine, light;
  const int smooth = back.norm() < std::sqrt(2) ? cv::INTER_CUBIC : cv::INTER_LINEAR; // where it is enlarged
  cv::warpAffine(lamp.pattern->light, fine, map, box.size() * cells, smooth | cv::WARP_INVERSE_MAP,
                 cv::BORDER_CONSTANT);
  cv::resize(fine, light, box.size(), 0, 0, cv::INTER_AREA);
  if (blur > 0) {
    cv::GaussianBlur(light, light, cv::Size(0, 0), blur, blur, cv::BORDER_CONSTANT);
  }
  double most = 0;
  cv::minMaxLoc(light, nullptr, &most);
  return cv::max(light, 0) * (lamp.level / std::max(most, 1e-6));
}

vpImage<unsigned char> vpHalfRealPicture::render() const
{
  cv::Mat_<float> grey(height, width);
  addBackground(*this, grey);
  for (const vpHalfRealLamp &lamp : lamps) {
    addLamp(*this, lamp, grey);
  }
  const cv::Mat_<unsigned char> bytes = developed(*this, grey);
  return vpImage<unsigned char>(bytes.data, static_cast<unsigned int>(height),
                                static_cast<unsigned int>(width), true);
}

END_VISP_NAMESPACE
