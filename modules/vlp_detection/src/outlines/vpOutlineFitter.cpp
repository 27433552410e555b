/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_detection/vpOutlineFitter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include "regions/vpChordShape.h"
#include "vpEdgeFit.h"
#include "vpRimFit.h"
#include <visp3/vlp_core/vpBrighter.h>

BEGIN_VISP_NAMESPACE

namespace
{

//! Enough of the points to start from.
std::vector<cv::Point2f> thinned(std::vector<cv::Point2f> points)
{
  static const size_t enough = 100;
  const size_t step = points.size() / enough;
  if (step < 2) {
    return points;
  }
  // First and last ends come by turns: pairs are kept.
  std::vector<cv::Point2f> few;
  for (size_t i = 0; i < points.size(); ++i) {
    if (i / 2 % step == 0) {
      few.push_back(points[i]);
    }
  }
  return few;
}

/*!
  The likelier of the two shapes, data and prior together. What thin stripes do not tell apart adds to the
  covariance: the distance of the two middles, by the other shape's probability.
*/
vpOutlineFit likelier(const vpEdgeFit<vpEllipseModel> &ellipse, const vpEdgeFit<vpQuadrilateralModel> &sides)
{
  static const double comparable = 0.5; // share of the ellipse's pixels; on fewer, corners may be anything
  if (sides.pixels() < comparable * ellipse.pixels()) {
    return ellipse.result();
  }
  const double pixels = std::min(ellipse.pixels(), sides.pixels());
  static const double least = 0.05; // grey levels^2
  const double ratio = std::max(ellipse.misfit(), least) / std::max(sides.misfit(), least);
  // A quadrilateral has more parameters to fit noise with (Schwarz's criterion), whose variance is not known
  // either.
  const double penalty = (vpQuadrilateralModel::parameters - vpEllipseModel::parameters) * std::log(pixels);
  const double gain = pixels * std::log(ratio) + ellipse.prior() - sides.prior() - penalty;
  vpOutlineFit best = gain > 0 ? sides.result() : ellipse.result();
  const vpOutlineFit other = gain > 0 ? ellipse.result() : sides.result();
  const double otherProbability = 1 / (1 + std::exp(0.5 * std::abs(gain)));
  const Eigen::Vector2d apart = other.outline.centre - best.outline.centre;
  best.outline.otherShape = otherProbability;
  best.outline.centreCovariance +=
      otherProbability * (other.outline.centreCovariance + apart * apart.transpose());
  return best;
}

const double rare = 6; // chi-square of the shape's prior

//! Whether the region's lit lines all cross the outline: one that leaves some out was fitted to a part of the
//! lamp.
bool holds(const vpOutlineFit &fit, const vpLedRoi &roi)
{
  static const double most = 0.9; // share of the lines
  const double margin = 1 + 3 * fit.blur;
  const Eigen::Vector4d box = fit.outline.box();
  const auto inside = std::count_if(roi.chords.begin(), roi.chords.end(), [&](const vpLedChord &chord) {
    return chord.line > box(1) - margin && chord.line < box(3) + margin;
  });
  return static_cast<double>(inside) >= most * static_cast<double>(roi.chords.size());
}

const double evenEdge = 0.45; // evenness below which a lamp glows about a bright core

//! Whether an edge is that of a lamp: a bright core in a glow has none of its own.
bool isSharp(const vpOutlineFit &fit)
{
  static const double sharp = 0.1; // share of the radius
  return fit.blur <= std::max(1.0, sharp * 0.5 * fit.outline.diameter());
}

//! How much brighter than its level the brightest of a region is, grey levels.
double lightOf(const cv::Mat_<unsigned char> &lines, const vpLedRoi &roi)
{
  double brightest = roi.level;
  for (const vpLedChord &chord : roi.chords) {
    const int samples = chord.last - chord.first + 1;
    brightest = std::max<double>(brightest, vpBrighter::brightest(lines[chord.line] + chord.first, samples));
  }
  return brightest - roi.level;
}

//! What of each line is brighter than half of its light, of lines half as bright as the brightest.
vpLedRoi brightHalf(const cv::Mat_<unsigned char> &lines, const vpLedRoi &roi)
{
  const double least = roi.level + 0.5 * lightOf(lines, roi);
  vpLedRoi half = roi;
  half.chords.clear();
  half.box = cv::Rect();
  for (vpLedChord chord : roi.chords) {
    const unsigned char *row = lines[chord.line];
    const int brightest = vpBrighter::brightest(row + chord.first, chord.last - chord.first + 1);
    if (brightest < least) {
      continue;
    }
    const double level = 0.5 * (roi.level + brightest);
    while (row[chord.first] < level) {
      ++chord.first;
    }
    while (row[chord.last] < level) {
      --chord.last;
    }
    half.chords.push_back(chord);
    half.box |= cv::Rect(chord.first, chord.line, chord.last - chord.first + 1, 1);
  }
  return half;
}

const double nearlyPerfect = 0.93; // share of the ends
const double alone = 0.8;          // evenness of a lamp without other light beside it

//! The likelier shape with edges where a region has them.
struct Edges {
  vpOutlineFit fit;    // a region of unknown extent where neither shape fits
  double evenness = 0; // of the edges
  double kept = 0;     // share of the ends
  double misfit = 0;   // of an ellipse, grey levels^2
  bool round = false;  // no rectangle is as near to the ends as an ellipse
  bool ofLamp = false; // sharp, and even enough to be a lamp's
};

//! \param likelyBlur As vpOutlineFitter::fit()'s.
Edges edgesOf(const vpEdgeFitPicture &picture, const vpLedRoi &roi, const vpOutlineFitter &settings,
              double likelyBlur)
{
  Edges found;
  const std::vector<cv::Point2f> ends = thinned(vpChordShape::outerEnds(roi, picture.lines.cols));
  if (ends.size() < 6) {
    return found;
  }
  const double shapeSigma = settings.shapeSigma;
  const vpEllipseModel start = vpEllipseModel::from(ends, roi.box);
  vpEdgeFit<vpEllipseModel>::Memory memory;
  vpEdgeFit<vpEllipseModel> ellipse(picture, start, memory);
  // What is partly hidden has ends of other edges, from which a sharp edge finds no way.
  static const double nearlyAll = 0.97;
  bool isEllipse = vpOutlineFitter::looksWhole(roi) &&
                   ellipse.run(roi.box, shapeSigma, {settings.maxIterations, 2, 0.005, true}, likelyBlur) &&
                   ellipse.kept() >= nearlyAll && holds(ellipse.result(), roi);
  if (!isEllipse) {
    ellipse = vpEdgeFit<vpEllipseModel>(picture, start, memory);
    isEllipse = ellipse.run(roi.box, shapeSigma, {settings.maxIterations}) && holds(ellipse.result(), roi);
  }
  if (isEllipse) {
    found.fit = ellipse.result();
    found.evenness = ellipse.evenness().edges;
    found.kept = ellipse.kept();
    found.misfit = ellipse.misfit();
  }
  const bool even = found.evenness > evenEdge;
  found.ofLamp = isEllipse && (even || (ellipse.prior() < rare && ellipse.kept() > nearlyPerfect));
  static const double near = 0.015; // share of the radius: no rectangle is that near to an ellipse
  const double misfit = vpChordShape::ellipseMisfit(ends, roi.box);
  found.round = (even && misfit <= near * start.radius()) || vpChordShape::rectangleMisfit(ends) > 3 * misfit;
  if (!found.round) {
    vpEdgeFit<vpQuadrilateralModel>::Memory ofSides;
    vpEdgeFit<vpQuadrilateralModel> sides(picture, vpQuadrilateralModel::from(ends), ofSides);
    if (sides.run(roi.box, shapeSigma, {settings.maxIterations}) && sides.evenness().edges > evenEdge &&
        holds(sides.result(), roi)) {
      found.fit = even ? likelier(ellipse, sides) : sides.result();
      if (!even) {
        found.fit.outline.otherShape = 0; // no ellipse fits at all
      }
      if (found.fit.outline.shape == vpLampOutline::Shape::quadrilateral) {
        found.kept = sides.kept();
        found.evenness = sides.evenness().edges;
        found.ofLamp = true;
      }
    }
  }
  found.ofLamp = found.ofLamp && isSharp(found.fit);
  found.fit.sound = found.ofLamp && found.kept >= nearlyPerfect && found.evenness >= alone;
  return found;
}

//! Where edges are uneven and leave much of the light about them unexplained, some are not the lamp's.
void addGhostVariance(vpLampOutline &ellipse, double misfit, double light)
{
  static const double normal = 0.03; // share of the light
  const double unexplained = std::sqrt(misfit) / std::max(light, 1.0);
  if (unexplained > normal) {
    const double sigma = 0.5 * ellipse.diameter() * unexplained;
    ellipse.centreCovariance += sigma * sigma * Eigen::Matrix2d::Identity();
  }
}

/*!
  Whether the picture shows enough of each side of a quadrilateral. Where one that is not shown lies, nothing
  but the shapes that lamps have would say.
*/
bool showsSides(const vpLampOutline &quadrilateral, const cv::Size &picture)
{
  static const double enough = 0.1; // of a side
  static const int points = 40;     // along it
  for (size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d &from = quadrilateral.corners[i], &to = quadrilateral.corners[(i + 1) % 4];
    int shown = 0;
    for (int k = 0; k < points; ++k) {
      const Eigen::Vector2d point = from + (k + 0.5) / points * (to - from);
      shown +=
          point.x() > 0 && point.y() > 0 && point.x() < picture.width - 1 && point.y() < picture.height - 1;
    }
    if (shown < enough * points) {
      return false;
    }
  }
  return true;
}

//! Whether each sample lies where its number says.
bool isAligned(const std::vector<double> &positions)
{
  for (size_t i = 0; i < positions.size(); ++i) {
    if (positions[i] != static_cast<double>(i)) {
      return false;
    }
  }
  return true;
}
} // namespace

bool vpOutlineFitter::looksWhole(const vpLedRoi &roi)
{
  static const double nearly = 0.93; // of what a perfect shape has
  return roi.lampness > nearly * vpChordShape::mostLampness(2 * roi.box.height);
}

double vpOutlineFitter::noiseOf(const cv::Mat_<unsigned char> &lines, const cv::Rect &box)
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
  for (int fewer = pairs[0]; 2 * fewer <= all && fewer < all;) {
    fewer += pairs[static_cast<size_t>(++median)];
  }
  return std::max(least, median / perMedian);
}

std::optional<double> vpOutlineFitter::backgroundOf(const cv::Mat_<unsigned char> &lines, const cv::Rect &box,
                                                    int gap)
{
  static const int stretch = 5; // samples
  std::vector<double> beside;
  const int left = std::max(0, box.x - gap - stretch),
            right = std::min(lines.cols - stretch, box.br().x + gap);
  for (const int from : {left, right}) {
    if (from + stretch <= box.x || from >= box.br().x) {
      for (int line = box.y; line < box.br().y; ++line) {
        beside.push_back(static_cast<double>(vpBrighter::sum(lines[line] + from, stretch)) / stretch);
      }
    }
  }
  if (beside.empty()) {
    return std::nullopt;
  }
  const auto middle = beside.begin() + static_cast<long>(beside.size() / 2);
  std::nth_element(beside.begin(), middle, beside.end());
  return *middle;
}

vpOutlineFit vpOutlineFitter::boxOf(const cv::Mat_<unsigned char> &lines, const vpLedRoi &roi)
{
  vpOutlineFit fit;
  const int gap = 2 + roi.box.width / 20;
  fit.background = std::min(roi.level, backgroundOf(lines, roi.box, gap).value_or(roi.level));
  fit.noise = noiseOf(lines, roi.box);
  vpLampOutline &outline = fit.outline;
  const double left = roi.box.x - 0.5, top = roi.box.y - 0.5;
  const double right = left + roi.box.width, bottom = top + roi.box.height;
  outline.corners = {Eigen::Vector2d(left, top), Eigen::Vector2d(right, top), Eigen::Vector2d(right, bottom),
                     Eigen::Vector2d(left, bottom)};
  outline.centre = Eigen::Vector2d(0.5 * (left + right), 0.5 * (top + bottom));
  outline.a = 0.5 * std::max(roi.box.width, roi.box.height);
  outline.b = 0.5 * std::min(roi.box.width, roi.box.height);
  outline.centreCovariance =
      Eigen::Vector2d(roi.box.width * roi.box.width, roi.box.height * roi.box.height).asDiagonal();
  outline.centreCovariance /= 12;
  if (roi.cutAcross || roi.cutAlong) { // it may lie as far beyond the border as the lamp is large
    outline.centreCovariance += 4 * outline.a * outline.a * Eigen::Matrix2d::Identity();
  }
  return fit;
}

vpOutlineFit vpOutlineFitter::fit(const cv::Mat_<unsigned char> &lines,
                                  const std::vector<double> &linePositions,
                                  const std::vector<double> &samplePositions, const vpLedRoi &roi,
                                  double likelyBlur) const
{
  const bool fromBorderToBorder = roi.box.width >= lines.cols - 2 || roi.box.height >= lines.rows - 2;
  if (fromBorderToBorder) {
    return boxOf(lines, roi);
  }
  const vpEdgeFitPicture picture{lines, linePositions, samplePositions, isAligned(samplePositions)};
  Edges edges = edgesOf(picture, roi, *this, likelyBlur);
  if (!edges.fit.sound) { // a lamp's ghost in a pane, or a housing that it lights, is dimmer than half of it
    const Edges bright = edgesOf(picture, brightHalf(lines, roi), *this, 0);
    if (bright.round && bright.fit.sound) {
      static const double pulled = 0.04; // px, by what light there is beside the edge
      edges = bright;
      edges.fit.sound = false; // what is dimmer may be the lamp's as well
      edges.fit.outline.centreCovariance += pulled * pulled * Eigen::Matrix2d::Identity();
    }
  }
  vpOutlineFit best = edges.fit.outline.shape == vpLampOutline::Shape::region ? boxOf(lines, roi) : edges.fit;
  const bool cut = roi.cutAcross || roi.cutAlong;
  if (!cut && !edges.ofLamp) {
    if (const auto rim = vpRimFit::of(lines, roi)) {
      return *rim;
    }
  }
  const bool sided = best.outline.shape == vpLampOutline::Shape::quadrilateral;
  if (cut && (!(edges.evenness > evenEdge) || (sided && !showsSides(best.outline, lines.size())))) {
    best.outline = boxOf(lines, roi).outline; // what is seen of its light says nothing of its middle
  } else if (edges.evenness < alone && best.outline.shape == vpLampOutline::Shape::ellipse) {
    addGhostVariance(best.outline, edges.misfit, lightOf(lines, roi));
  }
  if (best.outline.shape == vpLampOutline::Shape::quadrilateral) {
    vpRimFit::addHiddenSides(best.outline, vpChordShape::longestGap(roi));
  }
  return best;
}

END_VISP_NAMESPACE
