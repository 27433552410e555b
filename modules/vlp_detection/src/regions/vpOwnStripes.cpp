/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpOwnStripes.h"

#include <algorithm>
#include <cmath>

#include <visp3/vlp_core/vpBrighter.h>

BEGIN_VISP_NAMESPACE

namespace
{
//! Depth of stripes: standard deviation of the light of lines as a share of its mean.
double depth(const cv::Mat_<unsigned char> &lines, const cv::Rect &box, double dark)
{
  static const double least = 1; // grey levels
  double sum = 0, squares = 0;
  for (int y = box.y; y < box.br().y; ++y) {
    const double light = static_cast<double>(vpBrighter::sum(lines[y] + box.x, box.width)) / box.width;
    sum += light;
    squares += light * light;
  }
  const double mean = sum / box.height;
  return std::sqrt(std::max(0.0, squares / box.height - mean * mean)) / std::max(mean - dark, least);
}

//! Whether a region is lit on most lines of a box, not only to both sides of it, as a ring about its hole.
bool fills(const vpLedRoi &roi, const cv::Mat_<unsigned char> &lines, const cv::Rect &box)
{
  const auto first = std::lower_bound(roi.chords.begin(), roi.chords.end(), box.y,
                                      [](const vpLedChord &chord, int line) { return chord.line < line; });
  int filled = 0;
  for (auto chord = first; chord != roi.chords.end() && chord->line < box.br().y; ++chord) {
    filled += chord->first <= box.x && chord->last >= box.br().x - 1 &&
              vpBrighter::sum(lines[chord->line] + box.x, box.width) > roi.level * box.width;
  }
  return 2 * filled > box.height;
}
} // namespace

bool vpOwnStripes(const vpLedRoi &roi, const vpLedRoi &around, const cv::Mat_<unsigned char> &lines, double dark)
{
  static const double several = 4;
  const cv::Rect &box = roi.box;
  // What a disc fills on all of these lines: its ends would look like stripes.
  const int shorter = box.height / 10, narrower = box.width / 4;
  const cv::Rect middle(box.x + narrower, box.y + shorter, box.width - 2 * narrower,
                        box.height - 2 * shorter);
  if (middle.empty()) {
    return false;
  }
  const int away = 2 + box.width / 8, wide = 4 + box.width / 4; // past a little blur
  double beside = -1;
  for (const int x : {box.x - away - wide, box.br().x + away}) {
    const cv::Rect flank(x, middle.y, wide, middle.height);
    if (x >= 0 && flank.br().x <= lines.cols && fills(around, lines, flank)) {
      beside = std::max(beside, depth(lines, flank, dark));
    }
  }
  return beside >= 0 && depth(lines, middle, dark) > several * beside;
}

END_VISP_NAMESPACE
