/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpChordShape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

BEGIN_VISP_NAMESPACE

namespace
{

const double noFit = 1e6; // px

//! The points no farther than \e nearly from their convex hull.
std::vector<cv::Point2f> onHull(const std::vector<cv::Point2f> &points, const std::vector<cv::Point2f> &hull,
                                double nearly)
{
  std::vector<cv::Point2f> outer;
  for (const cv::Point2f &p : points) {
    double nearest = 1e9;
    for (size_t i = 0; i < hull.size(); ++i) {
      const cv::Point2f side = hull[(i + 1) % hull.size()] - hull[i];
      const double length = std::hypot(side.x, side.y);
      if (length > 0) {
        nearest = std::min(nearest, std::abs(side.cross(p - hull[i])) / length);
      }
    }
    if (nearest <= nearly) {
      outer.push_back(p);
    }
  }
  return outer;
}

//! Lit length over the length of the convex hull, summed over the lit lines: 1 for a convex region.
double solidity(const vpLedRoi &roi, const std::vector<cv::Point2f> &hull)
{
  // Left and right end of the hull on each line of the box, side by side.
  std::vector<double> first(roi.box.height, 1e9);
  std::vector<double> last(roi.box.height, -1e9);
  for (size_t i = 0; i < hull.size(); ++i) {
    cv::Point2f top = hull[i];
    cv::Point2f bottom = hull[(i + 1) % hull.size()];
    if (top.y > bottom.y) {
      std::swap(top, bottom);
    }
    for (int y = cvRound(top.y); y <= cvRound(bottom.y); ++y) {
      const double share = bottom.y > top.y ? (y - top.y) / (bottom.y - top.y) : 0;
      const double x = top.x + share * (bottom.x - top.x);
      first[y - roi.box.y] = std::min({first[y - roi.box.y], x, bottom.y > top.y ? x : bottom.x});
      last[y - roi.box.y] = std::max({last[y - roi.box.y], x, bottom.y > top.y ? x : bottom.x});
    }
  }
  double lit = 0;
  double convex = 0;
  for (const vpLedChord &chord : roi.chords) {
    lit += chord.last - chord.first + 1;
    convex += std::max(last[chord.line - roi.box.y] - first[chord.line - roi.box.y], 1.0);
  }
  return std::min(1.0, lit / convex);
}

//! Mean share of a line's light, just inside its chord, that is gone just outside: 1 for a sharp edge, 0 for
//! a glow.
double sharpness(const vpLedRoi &roi, const cv::Mat_<unsigned char> &lines, double dark)
{
  const int reach = 2 + roi.box.width / 50;
  double drop = 0;
  double inside = 0;
  for (const vpLedChord &chord : roi.chords) {
    const unsigned char *row = lines[chord.line];
    for (int side = -1; side <= 1; side += 2) {
      const int end = side < 0 ? chord.first : chord.last;
      const int in = end - side * reach;
      const int out = end + side * reach;
      if (out < 0 || out >= lines.cols || in < chord.first || in > chord.last) {
        continue;
      }
      drop += row[in] - row[out];
      inside += row[in] - dark;
    }
  }
  return inside > 0 ? std::clamp(drop / inside, 0.0, 1.0) : 0;
}

} // namespace

std::vector<cv::Point2f> vpChordShape::ends(const vpLedRoi &roi, int samples)
{
  std::vector<cv::Point2f> points;
  points.reserve(2 * roi.chords.size());
  for (const vpLedChord &chord : roi.chords) {
    if (chord.first > 0) {
      points.emplace_back(chord.first - 0.5f, static_cast<float>(chord.line));
    }
    if (chord.last < samples - 1) {
      points.emplace_back(chord.last + 0.5f, static_cast<float>(chord.line));
    }
  }
  return points;
}

std::vector<cv::Point2f> vpChordShape::outerEnds(const vpLedRoi &roi, int samples)
{
  const std::vector<cv::Point2f> points = ends(roi, samples);
  if (points.size() < 3) {
    return points;
  }
  std::vector<cv::Point2f> hull;
  cv::convexHull(points, hull);
  return onHull(points, hull, 0.7 + 0.01 * std::max(roi.box.width, roi.box.height));
}

double vpChordShape::ellipseMisfit(const std::vector<cv::Point2f> &points, const cv::Rect &box)
{
  if (points.size() < 6) {
    return noFit;
  }
  const cv::RotatedRect e = cv::fitEllipseDirect(points);
  const double longest = 1.5 * std::max(box.width, box.height) + 4;
  if (!(e.size.width > 2) || !(e.size.height > 2) || e.size.width > longest || e.size.height > longest) {
    return noFit;
  }
  const double c = std::cos(e.angle * CV_PI / 180);
  const double s = std::sin(e.angle * CV_PI / 180);
  double sum = 0;
  for (const cv::Point2f &p : points) {
    const double x = 2 * (c * (p.x - e.center.x) + s * (p.y - e.center.y)) / e.size.width;
    const double y = 2 * (-s * (p.x - e.center.x) + c * (p.y - e.center.y)) / e.size.height;
    const double rho = std::hypot(x, y);
    const double gradient = 2 * std::hypot(x / e.size.width, y / e.size.height) / std::max(rho, 1e-9);
    const double distance = (rho - 1) / std::max(gradient, 1e-9);
    sum += distance * distance;
  }
  return std::sqrt(sum / points.size());
}

double vpChordShape::rectangleMisfit(const std::vector<cv::Point2f> &points)
{
  if (points.size() < 6) {
    return noFit;
  }
  const cv::RotatedRect r = cv::minAreaRect(points);
  const double c = std::cos(r.angle * CV_PI / 180);
  const double s = std::sin(r.angle * CV_PI / 180);
  double sum = 0;
  for (const cv::Point2f &p : points) {
    const double x = std::abs(c * (p.x - r.center.x) + s * (p.y - r.center.y));
    const double y = std::abs(-s * (p.x - r.center.x) + c * (p.y - r.center.y));
    const double inside = std::min(0.5 * r.size.width - x, 0.5 * r.size.height - y);
    sum += inside * inside;
  }
  return std::sqrt(sum / points.size());
}

double vpChordShape::lampness(const vpLedRoi &roi, const cv::Mat_<unsigned char> &lines, double dark)
{
  if (roi.box.width < 4 || roi.box.height < 3) {
    return 0;
  }
  const size_t lit = roi.chords.size();
  const std::vector<cv::Point2f> points = ends(roi, lines.cols);
  if (5 * points.size() <= lit) {
    static const double fillsPicture = 0.5; // from border to border: no outline to judge by
    return fillsPicture;
  }
  std::vector<cv::Point2f> hull;
  cv::convexHull(points, hull);
  if (points.size() < 6 || hull.size() < 3) {
    return 0;
  }
  const double convex = std::clamp((solidity(roi, hull) - 0.4) / 0.5, 0.0, 1.0);
  if (convex <= 0) {
    return 0;
  }
  const double size = std::max(roi.box.width, roi.box.height);
  const std::vector<cv::Point2f> outer = onHull(points, hull, 0.7 + 0.01 * size);
  const double tolerance = 0.6 + 0.02 * size;
  const double misfit = std::min(ellipseMisfit(outer, roi.box), rectangleMisfit(outer)) / tolerance;
  const double aspect = std::min(1.0, 1.6 * std::min(roi.box.width, roi.box.height) / size);
  const double evidence = 1 - 4.0 / (4.0 + outer.size());
  return std::exp(-0.5 * misfit * misfit) * convex * aspect * evidence *
         (0.4 + 0.6 * sharpness(roi, lines, dark));
}

END_VISP_NAMESPACE
