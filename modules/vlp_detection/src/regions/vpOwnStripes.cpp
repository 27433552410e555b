/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpOwnStripes.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <visp3/vlp_core/vpBrighter.h>

BEGIN_VISP_NAMESPACE

namespace
{
//! Mean light of each line of a box, grey levels above the picture's darkest places; and its standard
//! deviation.
struct Stripes {
  std::vector<double> light;
  double swing = 0;

  Stripes(const cv::Mat_<unsigned char> &lines, const cv::Rect &box, double dark)
  {
    double sum = 0, squares = 0;
    for (int y = box.y; y < box.br().y; ++y) {
      const double line =
          static_cast<double>(vpBrighter::sum(lines[y] + box.x, box.width)) / box.width - dark;
      light.push_back(line);
      sum += line;
      squares += line * line;
    }
    const double mean = sum / box.height;
    swing = std::sqrt(std::max(0.0, squares / box.height - mean * mean));
  }
};

//! Whether one goes on shining between the stripes of the other.
bool shinesOn(const Stripes &beside, const Stripes &own)
{
  static const double dim = 0.25, bright = 0.5, dark = 0.4; // of the swing; of the light on lit lines
  const auto [least, most] = std::minmax_element(own.light.begin(), own.light.end());
  double onDark = 0, onLit = 0, darkLines = 0, litLines = 0;
  int stripes = 0;
  bool lit = false;
  for (size_t i = 0; i < own.light.size(); ++i) {
    const double share = (own.light[i] - *least) / std::max(*most - *least, 1e-9);
    if (share < dim) {
      onDark += beside.light[i];
      ++darkLines;
      lit = false;
    } else if (share > bright) {
      onLit += beside.light[i];
      ++litLines;
      stripes += lit ? 0 : 1;
      lit = true;
    }
  }
  return stripes > 1 && onDark / darkLines > dark * onLit / litLines;
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

bool vpOwnStripes(const vpLedRoi &roi, const vpLedRoi &around, const cv::Mat_<unsigned char> &lines,
                  double dark)
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
  const Stripes own(lines, middle, dark);
  bool any = false;
  for (const int x : {box.x - away - wide, box.br().x + away}) {
    const cv::Rect flank(x, middle.y, wide, middle.height);
    if (x >= 0 && flank.br().x <= lines.cols && fills(around, lines, flank)) {
      const Stripes beside(lines, flank, dark);
      if (own.swing <= several * beside.swing || !shinesOn(beside, own)) {
        return false;
      }
      any = true;
    }
  }
  return any;
}

END_VISP_NAMESPACE
