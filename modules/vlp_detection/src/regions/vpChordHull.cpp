/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpChordHull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

BEGIN_VISP_NAMESPACE

namespace
{

using Points = vpChordHull::Points;

//! The turn from \e a over \e b to \e c, twice the area of their triangle.
float turn(const cv::Point2f &a, const cv::Point2f &b, const cv::Point2f &c)
{
  return (b - a).cross(c - b);
}

} // namespace

vpChordHull::Points vpChordHull::of(const Points &points)
{
  Points left, right;
  auto add = [](Points &side, const cv::Point2f &point, float sign) {
    while (side.size() > 1 && sign * turn(side[side.size() - 2], side.back(), point) >= 0) {
      side.pop_back();
    }
    side.push_back(point);
  };
  for (size_t i = 0; i < points.size();) {
    size_t end = i + 1;
    while (end < points.size() && points[end].y == points[i].y) {
      ++end;
    }
    add(left, points[i], 1);
    add(right, points[end - 1], -1);
    i = end;
  }
  left.insert(left.end(), right.rbegin(), right.rend());
  left.erase(std::unique(left.begin(), left.end()), left.end());
  if (left.size() > 1 && left.front() == left.back()) {
    left.pop_back();
  }
  return left;
}

vpChordHull::Points vpChordHull::nearIt(const Points &points, const Points &hull, float nearly)
{
  struct Side {
    cv::Point2f from, normal;
  };
  std::vector<Side> sides;
  for (size_t i = 0; i < hull.size(); ++i) {
    const cv::Point2f side = hull[(i + 1) % hull.size()] - hull[i];
    const float length = std::sqrt(side.dot(side));
    if (length > 0) {
      sides.push_back({hull[i], cv::Point2f(-side.y, side.x) / length});
    }
  }
  Points outer;
  if (sides.empty()) {
    return outer;
  }
  // First and last end by turns, one down the hull, the other up: the side of the last but one is likely the
  // next one's, or that after it.
  std::array<size_t, 2> likely{0, sides.size() - 1};
  for (size_t k = 0; k < points.size(); ++k) {
    size_t &begin = likely[k % 2];
    for (size_t tried = 0, i = begin; tried < sides.size(); ++tried) {
      if (std::abs(sides[i].normal.dot(points[k] - sides[i].from)) <= nearly) {
        outer.push_back(points[k]);
        begin = i;
        break;
      }
      i = k % 2 == 0 ? (i + 1) % sides.size() : (i > 0 ? i : sides.size()) - 1;
    }
  }
  return outer;
}

vpChordHull::Extent::Extent(const Points &polygon, const cv::Rect &box)
    : first(box.height, 1e9f), last(box.height, -1e9f)
{
  for (size_t i = 0; i < polygon.size(); ++i) {
    cv::Point2f top = polygon[i];
    cv::Point2f bottom = polygon[(i + 1) % polygon.size()];
    if (top.y > bottom.y) {
      std::swap(top, bottom);
    }
    for (int y = cvRound(top.y); y <= cvRound(bottom.y); ++y) {
      const float share = bottom.y > top.y ? (y - top.y) / (bottom.y - top.y) : 0;
      const float x = top.x + share * (bottom.x - top.x);
      first[y - box.y] = std::min({first[y - box.y], x, bottom.y > top.y ? x : bottom.x});
      last[y - box.y] = std::max({last[y - box.y], x, bottom.y > top.y ? x : bottom.x});
    }
  }
}

std::vector<vpLedChord> vpLedRoi::hull() const
{
  if (chords.empty()) {
    return {};
  }
  Points ends;
  for (const vpLedChord &chord : chords) {
    ends.emplace_back(static_cast<float>(chord.first), static_cast<float>(chord.line));
    ends.emplace_back(static_cast<float>(chord.last), static_cast<float>(chord.line));
  }
  const cv::Rect lines(0, chords.front().line, 0, chords.back().line - chords.front().line + 1);
  const vpChordHull::Extent extent(vpChordHull::of(ends), lines);
  std::vector<vpLedChord> hull;
  for (int i = 0; i < lines.height; ++i) {
    hull.push_back({lines.y + i, cvCeil(extent.first[i]), cvFloor(extent.last[i])});
  }
  return hull;
}

double vpChordHull::solidity(const std::vector<vpLedChord> &chords, const Extent &hull, int firstLine)
{
  double lit = 0;
  double convex = 0;
  for (const vpLedChord &chord : chords) {
    lit += chord.last - chord.first + 1;
    convex += std::max(hull.last[chord.line - firstLine] - hull.first[chord.line - firstLine], 1.0f);
  }
  return std::min(1.0, lit / convex);
}

std::vector<float> vpChordHull::shortfalls(const std::vector<vpLedChord> &chords, const Extent &hull,
                                           int firstLine, double tolerance)
{
  std::vector<float> shortfall;
  shortfall.reserve(chords.size());
  for (const vpLedChord &chord : chords) {
    const int y = chord.line - firstLine;
    const double worse = std::max(chord.first - 0.5 - hull.first[y], hull.last[y] - chord.last - 0.5);
    shortfall.push_back(static_cast<float>(worse / tolerance));
  }
  return shortfall;
}

END_VISP_NAMESPACE
