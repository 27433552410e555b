/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpChordShape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "outlines/vpOutlineModel.h"
#include "vpChordHull.h"

BEGIN_VISP_NAMESPACE

namespace
{

using vpChordHull::Points;

const double noFit = 1e6; // px

//! How far samples outside and inside an end tell its edge: past a little blur.
int reachOf(const vpLedRoi &roi)
{
  return 2 + roi.box.width / 50;
}

/*!
  How the light falls off at the ends of the chords.
  \param[out] light Mean of each chord, above the background.
*/
vpChordShape::Edge edgeOf(const vpLedRoi &roi, const cv::Mat_<unsigned char> &lines, double dark,
                          std::vector<float> &light)
{
  vpChordShape::Edge edge;
  const int reach = reachOf(roi);
  std::array<int, 256> differences{}; // of neighbours, along the lines
  int pairs = 0;
  int count = 0;
  double sum = 0;
  light.clear();
  light.reserve(roi.chords.size());
  for (const vpLedChord &chord : roi.chords) {
    const unsigned char *row = lines[chord.line];
    const int step = 1 + (chord.last - chord.first) / 32;
    int ofChord = 0, samples = 0;
    for (int x = chord.first; x < chord.last; x += step) {
      ofChord += row[x];
      ++differences[static_cast<size_t>(std::abs(row[x + 1] - row[x]))];
      ++samples;
    }
    sum += ofChord;
    pairs += samples;
    const double mean = samples > 0 ? static_cast<double>(ofChord) / samples : row[chord.first];
    light.push_back(static_cast<float>(mean - dark));
    for (int side = -1; side <= 1; side += 2) {
      const int end = side < 0 ? chord.first : chord.last;
      const int in = end - side * reach;
      const int out = end + side * reach;
      if (out < 0 || out >= lines.cols || in < chord.first || in > chord.last) {
        continue;
      }
      edge.step += row[in] - row[out];
      edge.inside += row[in] - dark;
      ++count;
    }
  }
  edge.ends = count;
  edge.light = pairs > 0 ? sum / pairs - dark : 0;
  if (count > 0) {
    edge.step /= count;
    edge.inside /= count;
  }
  // The median of |difference| of two Gaussian pixels is 0.954 sigma; it comes in whole grey levels, so
  // interpolate.
  int fewer = 0;
  for (size_t d = 0; d < differences.size() && pairs > 0; ++d) {
    if (2 * (fewer + differences[d]) > pairs) {
      const double within = (0.5 * pairs - fewer) / differences[d];
      edge.noise = std::max(0.0, (d - 0.5 + within) / 0.954);
      break;
    }
    fewer += differences[d];
  }
  return edge;
}

//! The most of \e values within \e near of each place, by the largest of those still ahead (Lemire 2006).
std::vector<float> mostNear(const std::vector<float> &values, size_t near)
{
  std::vector<float> most(values.size());
  std::vector<size_t> falling(values.size()); // places of which each has more than the next
  size_t first = 0, last = 0, taken = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    for (; taken < values.size() && taken <= i + near; ++taken) {
      while (last > first && values[falling[last - 1]] <= values[taken]) {
        --last;
      }
      falling[last++] = taken;
    }
    while (falling[first] + near < i) {
      ++first;
    }
    most[i] = values[falling[first]];
  }
  return most;
}

/*!
  Which chords are lit about as brightly as the brightest near them. Others are lit for a part of their
  exposure: an edge that is not quite sharp sinks below the level nearer to the middle there.
*/
std::vector<bool> fullyLit(const vpLedRoi &roi, const std::vector<float> &light)
{
  static const float full = 0.7f;
  std::vector<float> ofLines(static_cast<size_t>(roi.box.height), 0);
  for (size_t i = 0; i < light.size(); ++i) {
    ofLines[static_cast<size_t>(roi.chords[i].line - roi.box.y)] = light[i];
  }
  const std::vector<float> brightest = mostNear(ofLines, static_cast<size_t>(2 + roi.box.height / 8));
  std::vector<bool> lit(light.size());
  for (size_t i = 0; i < light.size(); ++i) {
    lit[i] = light[i] >= full * brightest[static_cast<size_t>(roi.chords[i].line - roi.box.y)];
  }
  return lit;
}

//! Mean square of the shortfalls of the lines that are fully lit.
double hollowness(const std::vector<float> &shortfall, const std::vector<bool> &lit)
{
  static const double worst = 4; // what is missing there is no longer a matter of degree
  double sum = 0;
  for (size_t i = 0; i < shortfall.size(); ++i) {
    if (lit[i]) {
      sum += std::min(worst * worst, static_cast<double>(shortfall[i]) * shortfall[i]);
    }
  }
  return sum / shortfall.size();
}

//! Of the sides: 1 for a lamp no flatter than most; a side that the border cuts may be of any length.
double roundness(const vpLedRoi &roi)
{
  const bool flat = roi.box.height < roi.box.width;
  if (flat ? roi.cutAlong : roi.cutAcross) {
    return 1;
  }
  return std::min(1.0,
                  1.6 * std::min(roi.box.width, roi.box.height) / std::max(roi.box.width, roi.box.height));
}

Points endsOf(const std::vector<vpLedChord> &chords, int first, int last)
{
  Points points;
  points.reserve(2 * chords.size());
  for (const vpLedChord &chord : chords) {
    if (chord.first > first) {
      points.emplace_back(chord.first - 0.5f, static_cast<float>(chord.line));
    }
    if (chord.last < last) {
      points.emplace_back(chord.last + 0.5f, static_cast<float>(chord.line));
    }
  }
  return points;
}

//! First and last line of the ellipse through the ends of the chords; of the region, where none fits.
std::pair<double, double> ellipseLines(const std::vector<cv::Point2f> &points, const cv::Rect &box)
{
  double top = box.y, bottom = box.br().y - 1;
  if (const std::optional<vpEllipseModel> ellipse = vpEllipseModel::through(points)) {
    ellipse->vertical(top, bottom);
  }
  return {std::min<double>(box.y, top), std::max<double>(box.br().y - 1, bottom)};
}

/*!
  How many more lines the chords may last beyond the first one in \e widths, if the shape is convex: they
  close at least as fast as they have from a quarter of the lit lines further in.
*/
double linesToClose(const std::vector<cv::Point2d> &widths)
{
  const cv::Point2d &end = widths.front();
  const cv::Point2d &inner = widths[widths.size() / 4];
  const double closing = (inner.x - end.x) / std::max(1.0, std::abs(inner.y - end.y));
  return closing > 0 ? end.x / closing : noFit;
}

} // namespace

std::vector<cv::Point2f> vpChordShape::ends(const vpLedRoi &roi, int samples)
{
  return endsOf(roi.chords, 0, samples - 1);
}

std::vector<cv::Point2f> vpChordShape::outerEnds(const vpLedRoi &roi, int samples)
{
  Points points = ends(roi, samples);
  if (points.size() < 3) {
    return points;
  }
  return vpChordHull::nearIt(points, vpChordHull::of(points),
                             0.7f + 0.01f * static_cast<float>(std::max(roi.box.width, roi.box.height)));
}

double vpChordShape::ellipseMisfit(const std::vector<cv::Point2f> &points, const cv::Rect &box)
{
  if (points.size() < 6) {
    return noFit;
  }
  const std::optional<vpEllipseModel> ellipse = vpEllipseModel::through(points);
  static const double smallest = 1; // px
  const double longest = 0.75 * std::max(box.width, box.height) + 2;
  if (!ellipse || !(ellipse->axes().y() > smallest) || !(ellipse->axes().x() < longest)) {
    return noFit;
  }
  double sum = 0;
  for (const cv::Point2f &point : points) {
    const double distance = ellipse->distance({point.x, point.y});
    sum += distance * distance;
  }
  return std::sqrt(sum / points.size());
}

double vpChordShape::rectangleMisfit(const std::vector<cv::Point2f> &points)
{
  if (points.size() < 6) {
    return noFit;
  }
  const cv::RotatedRect r = cv::minAreaRect(vpChordHull::of(points)); // of fewer points
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

double vpChordShape::mostLampness(int ends)
{
  return 1 - 4.0 / (4.0 + ends);
}

vpChordShape::Score vpChordShape::score(const vpLedRoi &roi, const cv::Mat_<unsigned char> &lines,
                                        double dark)
{
  Score score;
  score.shortfall.assign(roi.chords.size(), 0);
  std::vector<float> light;
  score.edge = edgeOf(roi, lines, dark, light);
  if (roi.box.width < 4 || roi.box.height < 3) {
    return score;
  }
  const std::vector<vpLedChord> &chords = roi.chords;
  const Points points = endsOf(chords, 0, lines.cols - 1);
  if (5 * points.size() <= chords.size()) {
    score.lampness = 0.5; // from border to border: no outline to judge by
    return score;
  }
  // That of a lamp cut by the border is convex as well.
  const Points hull = vpChordHull::of(endsOf(chords, -1, lines.cols));
  if (points.size() < 6 || hull.size() < 3) {
    return score;
  }
  const double size = std::max(roi.box.width, roi.box.height);
  const vpChordHull::Extent extent(hull, roi.box);
  score.shortfall = vpChordHull::shortfalls(chords, extent, roi.box.y, 1 + 0.03 * size);
  const double hollow = hollowness(score.shortfall, fullyLit(roi, light));
  const double convex = std::clamp((vpChordHull::solidity(chords, extent, roi.box.y) - 0.4) / 0.5, 0.0, 1.0);
  if (convex <= 0) {
    return score;
  }
  const Points outer = vpChordHull::nearIt(points, hull, static_cast<float>(0.7 + 0.01 * size));
  const double tolerance = 0.6 + 0.02 * size;
  static const double hardlyAny = 0.2; // misfit in tolerances: no rectangle would be a better lamp by 2 %
  double misfit = ellipseMisfit(outer, roi.box) / tolerance;
  if (misfit > hardlyAny) {
    misfit = std::min(misfit, rectangleMisfit(outer) / tolerance);
  }
  const double evidence = mostLampness(static_cast<int>(outer.size()));
  score.lampness = std::exp(-0.5 * (misfit * misfit + hollow)) * convex * roundness(roi) * evidence *
                   (0.4 + 0.6 * score.edge.sharpness());
  return score;
}

int vpChordShape::longestGap(const vpLedRoi &roi)
{
  int gap = 0;
  for (size_t i = 1; i < roi.chords.size(); ++i) {
    gap = std::max(gap, roi.chords[i].line - roi.chords[i - 1].line - 1);
  }
  if (gap == 0 && 2 * roi.box.height < roi.box.width) {
    gap = roi.box.height;
  }
  return gap;
}

namespace
{
//! Whether a dark stripe may part the region from the rest of its lamp, beyond the first or last line.
bool mayGoOn(const vpLedRoi &roi, const cv::Size &picture)
{
  const int before = roi.box.y;
  const int after = picture.height - roi.box.br().y;
  const int gap = vpChordShape::longestGap(roi);
  static const int more = 1; // lines, half lit at either end of a gap
  if (gap == 0 || std::min(before, after) > gap + more) {
    return false;
  }
  const std::vector<cv::Point2f> outer = vpChordShape::outerEnds(roi, picture.width);
  const double tolerance = 0.6 + 0.02 * std::max(roi.box.width, roi.box.height);
  cv::Rect longer = roi.box; // the part within the picture may be the smaller one
  longer.height *= 3;
  const bool ellipse = vpChordShape::ellipseMisfit(outer, longer) < tolerance;
  std::pair<double, double> lines(-1, picture.height);
  if (ellipse) {
    lines = ellipseLines(outer, roi.box);
  }
  std::vector<cv::Point2d> widths; // and lines
  for (const vpLedChord &chord : roi.chords) {
    widths.emplace_back(chord.last - chord.first + 1, chord.line);
  }
  const bool first = before <= gap + more && lines.first < 0 && linesToClose(widths) > before;
  std::reverse(widths.begin(), widths.end());
  const bool last = after <= gap + more && lines.second > picture.height - 1 && linesToClose(widths) > after;
  return first || last;
}
} // namespace

void vpChordShape::markCuts(vpLedRoi &roi, const cv::Size &picture)
{
  roi.cutAcross = roi.box.x <= 0 || roi.box.br().x >= picture.width;
  roi.cutAlong = roi.box.y <= 0 || roi.box.br().y >= picture.height || mayGoOn(roi, picture);
}

END_VISP_NAMESPACE
