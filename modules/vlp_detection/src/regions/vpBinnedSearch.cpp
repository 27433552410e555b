/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpBinnedSearch.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

BEGIN_VISP_NAMESPACE

std::vector<int> vpBinnedSearch::widths(const vpBackground &dark)
{
  static const double calm = 3.2; // grey levels: then four deviations are a twentieth of white
  static const int widest = 16;
  std::vector<int> widths;
  for (int width = 1; width < widest && dark.noise > calm * std::sqrt(width);) {
    width *= 2;
    widths.push_back(width);
  }
  return widths;
}

cv::Mat_<unsigned char> vpBinnedSearch::binned(const cv::Mat_<unsigned char> &lines, int width)
{
  cv::Mat_<unsigned char> bins, picture;
  cv::resize(lines, bins, cv::Size(std::max(1, lines.cols / width), lines.rows), 0, 0, cv::INTER_AREA);
  cv::resize(bins, picture, lines.size(), 0, 0, cv::INTER_NEAREST);
  return picture;
}

vpBackground vpBinnedSearch::binned(const vpBackground &dark, int width)
{
  return {dark.level, dark.median, dark.noise / std::sqrt(width), dark.gain / width};
}

std::vector<vpLedRoi> vpBinnedSearch::merged(std::vector<vpLedRoi> narrower,
                                             const std::vector<vpLedRoi> &wider)
{
  static const double larger = 1.2;      // by area: the same lamp is known better with narrow bins
  static const double hardlyWorse = 0.1; // of lampness
  std::vector<vpLedRoi> added;
  for (const vpLedRoi &whole : wider) {
    auto touches = [&whole](const vpLedRoi &piece) { return (piece.box & whole.box).area() > 0; };
    double area = 0, largest = 0, lampness = 0;
    for (const vpLedRoi &piece : narrower) {
      if (touches(piece)) {
        area += piece.box.area();
        largest = std::max<double>(largest, piece.box.area());
        lampness += piece.box.area() * piece.lampness;
      }
    }
    if (whole.box.area() > larger * largest && (whole.lampness + hardlyWorse) * area >= lampness) {
      narrower.erase(std::remove_if(narrower.begin(), narrower.end(), touches), narrower.end());
      added.push_back(whole);
    }
  }
  narrower.insert(narrower.end(), added.begin(), added.end());
  return narrower;
}

END_VISP_NAMESPACE
