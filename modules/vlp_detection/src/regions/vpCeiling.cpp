/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpCeiling.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <opencv2/imgproc.hpp>
#include <visp3/core/vpMath.h>
#include <visp3/core/vpRobust.h>

BEGIN_VISP_NAMESPACE

vpCeiling::Terms vpCeiling::termsAt(double x, double y)
{
  return (Terms() << 1, x, y, x * x, x * y, y * y).finished();
}

std::optional<vpCeiling> vpCeiling::of(const std::vector<vpPictureBlock> &blocks, double noise)
{
  static const size_t fewest = 60; // blocks, that tell a surface
  static const unsigned int rounds = 10;
  static const double rounding = 0.3; // grey levels
  static const double ridge = 1e-6;   // in blocks: a picture of one or two columns of them tells no bend
  if (blocks.size() < fewest) {
    return std::nullopt;
  }
  vpCeiling ceiling;
  std::vector<Terms> terms;
  const auto n = static_cast<unsigned int>(blocks.size());
  vpColVector off(n), weights(n, 1);
  for (unsigned int i = 0; i < n; ++i) {
    terms.push_back(termsAt(blocks[i].x, blocks[i].y));
    off[i] = blocks[i].mean;
  }
  vpRobust robust;
  robust.setMinMedianAbsoluteDeviation(rounding);
  for (unsigned int round = 0; round < rounds; ++round) {
    robust.MEstimator(vpRobust::CAUCHY, off, weights);
    Eigen::Matrix<double, 6, 6> A = ridge * Eigen::Matrix<double, 6, 6>::Identity();
    A(0, 0) = 0; // any level
    Terms b = Terms::Zero();
    for (unsigned int i = 0; i < n; ++i) {
      A += weights[i] * terms[i] * terms[i].transpose();
      b += weights[i] * blocks[i].mean * terms[i];
    }
    ceiling.m_surface = A.ldlt().solve(b);
    for (unsigned int i = 0; i < n; ++i) {
      off[i] = blocks[i].mean - terms[i].dot(ceiling.m_surface);
    }
  }
  std::vector<double> sizes;
  for (unsigned int i = 0; i < n; ++i) {
    const double light = terms[i].dot(ceiling.m_surface);
    ceiling.m_darkest = i == 0 ? light : std::min(ceiling.m_darkest, light);
    sizes.push_back(std::abs(off[i]));
  }
  return vpMath::getMedian(sizes) < noise ? std::make_optional(ceiling) : std::nullopt;
}

double vpCeiling::above(const cv::Point2d &point, const cv::Size &picture) const
{
  return termsAt(2 * point.x / picture.width - 1, 2 * point.y / picture.height - 1).dot(m_surface) -
         m_darkest;
}

cv::Mat_<unsigned char> vpCeiling::takenOff(const cv::Mat_<unsigned char> &lines) const
{
  static const int side = 32; // places, between which it hardly bends
  cv::Mat_<unsigned char> coarse(side, side), fine, even;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      coarse(y, x) = cv::saturate_cast<unsigned char>(above({x + 0.5, y + 0.5}, coarse.size()));
    }
  }
  cv::resize(coarse, fine, lines.size(), 0, 0, cv::INTER_LINEAR);
  cv::subtract(lines, fine, even);
  return even;
}

END_VISP_NAMESPACE
