/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpNodeGrid_h
#define vpNodeGrid_h

#include <algorithm>
#include <vector>

#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! Every so many lines and samples of a picture, the last ones among them: what changes slowly is known
//! there.
struct vpNodeGrid {
  std::vector<int> lines, samples;

  vpNodeGrid() = default;
  vpNodeGrid(const cv::Size &picture, int step)
      : lines(nodes(picture.height, step)), samples(nodes(picture.width, step))
  {
  }

  cv::Size size() const { return {static_cast<int>(samples.size()), static_cast<int>(lines.size())}; }

  //! Node at or before \e line, and how far it is on the way to the next, 0 to 1.
  int before(int line, float &way) const
  {
    const auto next = std::upper_bound(lines.begin(), lines.end() - 1, line);
    const int i = std::max(0, static_cast<int>(next - lines.begin()) - 1);
    const int j = std::min(i + 1, static_cast<int>(lines.size()) - 1);
    way = j > i ? static_cast<float>(line - lines[i]) / static_cast<float>(lines[j] - lines[i]) : 0.f;
    return i;
  }

private:
  static std::vector<int> nodes(int count, int step)
  {
    std::vector<int> at;
    for (int k = 0; k < count; k += step) {
      at.push_back(k);
    }
    if (at.back() != count - 1) {
      at.push_back(count - 1);
    }
    return at;
  }
};

END_VISP_NAMESPACE

#endif
