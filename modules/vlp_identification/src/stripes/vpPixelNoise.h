/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPixelNoise_h
#define vpPixelNoise_h

#include <algorithm>
#include <array>
#include <cstdlib>

#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! Standard deviation of a region's pixels, grey levels: what neighbours differ by, whatever pattern they
//! show.
inline double vpPixelNoise(const cv::Mat_<unsigned char> &lines, const cv::Rect &box)
{
  static const double least = 0.3,
                      perMedian = 0.954; // 8 bits round; median of two Gaussian pixels' difference
  static const int enough = 10000;       // pairs, for a hundredth of it
  const int step = 1 + box.area() / enough;
  std::array<int, 256> pairs{}; // of each difference
  int all = 0;
  for (int line = box.y; line < box.br().y; line += step, all += box.width - 1) {
    const unsigned char *row = lines[line] + box.x;
    for (int x = 0; x + 1 < box.width; ++x) {
      ++pairs[static_cast<size_t>(std::abs(row[x + 1] - row[x]))];
    }
  }
  int median = 0;
  for (int fewer = pairs[0]; 2 * fewer <= all && median < 255;) {
    fewer += pairs[static_cast<size_t>(++median)];
  }
  return std::max(least, median / perMedian);
}

END_VISP_NAMESPACE

#endif
