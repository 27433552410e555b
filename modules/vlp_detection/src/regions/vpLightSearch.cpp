/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vpLedRoiDetector::otherLight(): where it is worth looking for lamps at all.

#include <visp3/vlp_detection/vpLedRoiDetector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <opencv2/core.hpp>
#include <visp3/core/vpRect.h>

#include <visp3/vlp_core/vpBrighter.h>

BEGIN_VISP_NAMESPACE

namespace
{
//! Adds samples \e first to before \e last of a line to the box that is near, or as one of its own.
void add(int first, int last, int line, std::vector<cv::Rect> &boxes)
{
  static const int near = 64; // px
  const cv::Rect stretch(first, line, last - first, 1),
      around(first - near, line - near, last - first + 2 * near, near + 1);
  for (cv::Rect &box : boxes) {
    if ((box & around).area() > 0) {
      box |= stretch;
      return;
    }
  }
  boxes.push_back(stretch);
}

//! Adds where three samples in a row are brighter, of those from \e first to before \e last.
void addBright(const unsigned char *row, int line, int first, int last, unsigned char grey,
               std::vector<cv::Rect> &boxes)
{
  if (last <= first || vpBrighter::brightest(row + first, last - first) <= grey) {
    return; // nearly always
  }
  std::uint64_t before = 0; // the last two samples of the block before, as its two lowest bits
  for (int x = first; x < last; x += vpBrighter::block) {
    const std::uint64_t mask = vpBrighter::mask(row + x, std::min(vpBrighter::block, last - x), grey),
                        thirds = mask & (mask << 1 | before >> 1) & (mask << 2 | before);
    if (thirds != 0) {
      add(x + __builtin_ctzll(thirds) - 2, x + vpBrighter::block - __builtin_clzll(thirds), line, boxes);
    }
    before = mask >> (vpBrighter::block - 2);
  }
}

//! Of pixels here and there.
unsigned char medianOf(const vpImage<unsigned char> &I, int left, int top, int right, int bottom)
{
  static const int down = 8, across = 13;
  std::array<int, 256> histogram{};
  int count = 0;
  for (int y = top; y < bottom; y += down) {
    for (int x = left; x < right; x += across, ++count) {
      ++histogram[I[y][x]];
    }
  }
  int grey = 0;
  for (int below = histogram[0]; 2 * below < count; below += histogram[static_cast<size_t>(grey)]) {
    ++grey;
  }
  return static_cast<unsigned char>(grey);
}

//! The nearest pixel, or one outside.
int near(double x, int pixels)
{
  return static_cast<int>(std::clamp(x, -1.0, static_cast<double>(pixels)));
}
} // namespace

void vpLedRoiDetector::otherLight(const vpImage<unsigned char> &I, const vpRect &window,
                                  const std::vector<vpRect> &known, double noise, std::vector<vpRect> &found)
{
  static const double leastContrast = 8, sigmas = 6; // grey levels; standard deviations
  found.clear();
  const int columns = static_cast<int>(I.getWidth()), rows = static_cast<int>(I.getHeight());
  const int left = std::max(0, near(std::floor(window.getLeft()), columns)),
            top = std::max(0, near(std::floor(window.getTop()), rows)),
            right = std::min(columns, near(std::ceil(window.getRight()), columns) + 1),
            bottom = std::min(rows, near(std::ceil(window.getBottom()), rows) + 1);
  const double limit = medianOf(I, left, top, right, bottom) + std::max(leastContrast, sigmas * noise);
  if (limit >= 255) { // so bright that nothing would stand out
    found.push_back(window);
    return;
  }
  const auto grey = static_cast<unsigned char>(limit);
  static thread_local std::vector<std::pair<int, int>> hidden; // samples, of a line; for its memory
  static thread_local std::vector<cv::Rect> boxes;             // likewise
  boxes.clear();
  for (int y = top; y < bottom; ++y) {
    hidden.clear();
    for (const vpRect &box : known) {
      if (y >= box.getTop() && y <= box.getBottom()) {
        hidden.emplace_back(near(std::floor(box.getLeft()), columns),
                            near(std::ceil(box.getRight()), columns));
      }
    }
    std::sort(hidden.begin(), hidden.end());
    int x = left;
    for (const auto &[from, to] : hidden) {
      addBright(I[y], y, x, std::min(from, right), grey, boxes);
      x = std::max(x, to + 1);
    }
    addBright(I[y], y, x, right, grey, boxes);
  }
  for (const cv::Rect &box : boxes) {
    found.emplace_back(box.x, box.y, box.width, box.height);
  }
}

END_VISP_NAMESPACE
