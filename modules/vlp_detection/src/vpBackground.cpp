/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpBackground.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

BEGIN_VISP_NAMESPACE

namespace
{

struct Block {
  double mean;
  double noise;
};

/*!
  Standard deviation of Gaussian noise before black clipped it, over that after, where a share of the pixels
  is black. From the moments of the clipped Gaussian, which a straight line follows to 5 % up to the share of
  a mean one deviation below black; past that, nothing is known of the noise but its tail.
*/
double unclipped(double black)
{
  return 1 / (1 - 0.83 * std::min(black, 0.84));
}

Block blockAt(const cv::Mat_<unsigned char> &lines, const cv::Rect &box)
{
  double squares = 0; // about each line's own mean
  int all = 0, black = 0;
  for (int y = box.y; y < box.br().y; ++y) {
    const unsigned char *row = lines[y] + box.x;
    int sum = 0, sumSquares = 0;
    for (int x = 0; x < box.width; ++x) {
      const int grey = row[x];
      sum += grey;
      sumSquares += grey * grey;
      black += grey == 0;
    }
    all += sum;
    squares += sumSquares - static_cast<double>(sum) * sum / box.width;
  }
  const double mean = all;
  const double variance = squares / std::max(1, box.height * (box.width - 1));
  return {mean / box.area(), std::sqrt(variance) * unclipped(static_cast<double>(black) / box.area())};
}

double quantile(std::vector<double> values, double share)
{
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(share * (values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

} // namespace

vpBackground vpBackground::of(const cv::Mat_<unsigned char> &lines)
{
  static const int side = 8; // px
  static const int most = 3000;
  static const double leastNoise = 0.3; // grey levels: that of rounding
  const int width = std::min(side, lines.cols);
  const int height = std::min(side, lines.rows);
  const int step = std::max(side, static_cast<int>(std::sqrt(static_cast<double>(lines.total()) / most)));
  std::vector<Block> blocks;
  for (int y = 0; y + height <= lines.rows; y += step) {
    for (int x = 0; x + width <= lines.cols; x += step) {
      blocks.push_back(blockAt(lines, cv::Rect(x, y, width, height)));
    }
  }
  std::vector<double> means;
  for (const Block &block : blocks) {
    means.push_back(block.mean);
  }
  const double median = quantile(means, 0.5);
  std::vector<double> deviations;
  for (const Block &block : blocks) {
    if (block.mean <= median) {
      deviations.push_back(block.noise);
    }
  }
  vpBackground dark;
  dark.level = quantile(means, 0.03);
  dark.noise = std::max(leastNoise, quantile(deviations, 0.5));
  std::vector<double> gains;
  for (const Block &block : blocks) {
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
