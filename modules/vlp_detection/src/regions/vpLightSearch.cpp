/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vpLedRoiDetector::showsMore(): whether it is worth looking for lamps at all.

#include <visp3/vlp_detection/vpLedRoiDetector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <visp3/core/vpRect.h>

#include <visp3/vlp_core/vpBrighter.h>

BEGIN_VISP_NAMESPACE

namespace
{
//! Whether three samples in a row are brighter, of those from \e first to before \e last.
bool brightRun(const unsigned char *row, int first, int last, unsigned char grey)
{
  if (last <= first || vpBrighter::brightest(row + first, last - first) <= grey) {
    return false; // nearly always
  }
  std::uint64_t before = 0; // the last two samples of the block before, as its two lowest bits
  for (int x = first; x < last; x += vpBrighter::block) {
    const std::uint64_t mask = vpBrighter::mask(row + x, std::min(vpBrighter::block, last - x), grey);
    if (mask != 0) {
      const std::uint64_t once = mask << 1 | before >> 1, twice = mask << 2 | before;
      if ((mask & once & twice) != 0) {
        return true;
      }
    }
    before = mask >> (vpBrighter::block - 2);
  }
  return false;
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

bool vpLedRoiDetector::showsMore(const vpImage<unsigned char> &I, const vpRect &window,
                                 const std::vector<vpRect> &known, double noise)
{
  static const double leastContrast = 8, sigmas = 6; // grey levels; standard deviations
  const int columns = static_cast<int>(I.getWidth()), rows = static_cast<int>(I.getHeight());
  const int left = std::max(0, near(std::floor(window.getLeft()), columns)),
            top = std::max(0, near(std::floor(window.getTop()), rows)),
            right = std::min(columns, near(std::ceil(window.getRight()), columns) + 1),
            bottom = std::min(rows, near(std::ceil(window.getBottom()), rows) + 1);
  const double limit = medianOf(I, left, top, right, bottom) + std::max(leastContrast, sigmas * noise);
  if (limit >= 255) {
    return true; // so bright that nothing would stand out
  }
  const auto grey = static_cast<unsigned char>(limit);
  static thread_local std::vector<std::pair<int, int>> hidden; // samples, of a line; for its memory
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
      if (from > x && brightRun(I[y], x, std::min(from, right), grey)) {
        return true;
      }
      x = std::max(x, to + 1);
    }
    if (x < right && brightRun(I[y], x, right, grey)) {
      return true;
    }
  }
  return false;
}

END_VISP_NAMESPACE
