/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpBackground.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include <opencv2/core/hal/intrin.hpp>

BEGIN_VISP_NAMESPACE

namespace
{

/*!
  Standard deviation of Gaussian noise before black clipped it, over that after, where a share of the pixels
  is black. From the moments of the clipped Gaussian, which a straight line follows to 5 % up to the share of
  a mean one deviation below black; past that, nothing is known of the noise but its tail.
*/
double unclipped(double black)
{
  return 1 / (1 - 0.83 * std::min(black, 0.84));
}

//! Over a block: of the grey values, of their squares, of the squares of each line's own sum; how many are
//! black.
struct Sums {
  int grey = 0, squares = 0, black = 0;
  std::int64_t ofLines = 0;
};

Sums sumsOf(const cv::Mat_<unsigned char> &lines, const cv::Rect &box)
{
  Sums sums;
  for (int y = box.y; y < box.br().y; ++y) {
    const unsigned char *row = lines[y] + box.x;
    int sum = 0;
    for (int x = 0; x < box.width; ++x) {
      const int grey = row[x];
      sum += grey;
      sums.squares += grey * grey;
      sums.black += grey == 0;
    }
    sums.grey += sum;
    sums.ofLines += static_cast<std::int64_t>(sum) * sum;
  }
  return sums;
}

constexpr int side = 8; // px, of a block; of smaller pictures their own

//! Of eight bytes: in pairs, then the four sums by one product.
int sumOf(const unsigned char *row)
{
  std::uint64_t all;
  std::memcpy(&all, row, sizeof(all));
  const std::uint64_t pairs = (all & 0x00ff00ff00ff00ffU) + (all >> 8 & 0x00ff00ff00ff00ffU);
  return static_cast<int>(pairs * 0x0001000100010001U >> 48);
}

//! The same of a block of \e side lines and samples, from \e first on.
Sums sumsOfWhole(const unsigned char *first, size_t step)
{
  Sums sums;
  cv::v_int32x4 squares = cv::v_setzero_s32();
  cv::v_int16x8 black = cv::v_setzero_s16();
  for (size_t y = 0; y < side; ++y) {
    const unsigned char *row = first + y * step;
    const cv::v_int16x8 line = cv::v_reinterpret_as_s16(cv::v_load_expand(row));
    squares += cv::v_dotprod(line, line);
    black += line == cv::v_setzero_s16(); // -1 where it is
    const int sum = sumOf(row);
    sums.grey += sum;
    sums.ofLines += static_cast<std::int64_t>(sum) * sum;
  }
  sums.squares = cv::v_reduce_sum(squares);
  sums.black = -cv::v_reduce_sum(black);
  return sums;
}

double noiseOf(const Sums &sums, int width, int height)
{
  const double squares = sums.squares - static_cast<double>(sums.ofLines) / width; // about each line's mean
  const double variance = std::max(0.0, squares) / std::max(1, height * (width - 1));
  return std::sqrt(variance) * unclipped(sums.black / static_cast<double>(width * height));
}

double quantile(std::vector<double> values, double share)
{
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(share * (values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

} // namespace

std::vector<vpPictureBlock> vpPictureBlock::of(const cv::Mat_<unsigned char> &lines)
{
  static const int most = 800; // blocks
  const int width = std::min(side, lines.cols);
  const int height = std::min(side, lines.rows);
  const int step = std::max(side, static_cast<int>(std::sqrt(static_cast<double>(lines.total()) / most)));
  std::vector<vpPictureBlock> blocks;
  const bool whole = width == side && height == side;
  for (int y = 0; y + height <= lines.rows; y += step) {
    for (int x = 0; x + width <= lines.cols; x += step) {
      const Sums sums =
          whole ? sumsOfWhole(lines[y] + x, lines.step) : sumsOf(lines, cv::Rect(x, y, width, height));
      blocks.push_back({(2. * x + width) / lines.cols - 1, (2. * y + height) / lines.rows - 1,
                        sums.grey / static_cast<double>(width * height), noiseOf(sums, width, height)});
    }
  }
  return blocks;
}

vpBackground vpBackground::of(const std::vector<vpPictureBlock> &blocks)
{
  static const double leastNoise = 0.3; // grey levels: that of rounding
  std::vector<double> means;
  for (const vpPictureBlock &block : blocks) {
    means.push_back(block.mean);
  }
  vpBackground dark;
  dark.level = quantile(means, 0.03);
  dark.median = quantile(means, 0.5);
  std::vector<double> deviations;
  for (const vpPictureBlock &block : blocks) {
    if (block.mean <= dark.median) {
      deviations.push_back(block.noise);
    }
  }
  dark.noise = std::max(leastNoise, quantile(deviations, 0.5));
  std::vector<double> gains;
  for (const vpPictureBlock &block : blocks) {
    const double light = block.mean - dark.level;
    if (light > 6 * dark.noise && block.mean < 200) {
      gains.push_back((block.noise * block.noise - dark.noise * dark.noise) / light);
    }
  }
  if (gains.size() >= 8) {
    dark.gain = std::max(0.0, quantile(gains, 0.3));
  }
  return dark;
}

END_VISP_NAMESPACE
