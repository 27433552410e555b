/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpRimFit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <opencv2/imgproc.hpp>

#include <visp3/vlp_core/vpBrighter.h>

#include "regions/vpChordHull.h"
#include "regions/vpChordShape.h"
#include "vpOutlineModel.h"

BEGIN_VISP_NAMESPACE

namespace
{
//! One of two shapes through the ends.
struct Shape {
  vpLampOutline outline;
  double misfit = 0; // px, root mean square

  double radius() const { return 0.5 * outline.diameter(); }
};

//! The stretch of each line that is brighter than \e level, to a part of a sample; its two ends.
std::vector<cv::Point2f> endsAt(const cv::Mat_<unsigned char> &lines, const vpLedRoi &roi, double level)
{
  std::vector<cv::Point2f> ends;
  for (const vpLedChord &chord : roi.chords) {
    const unsigned char *row = lines[chord.line];
    int first = chord.first, last = chord.last;
    while (first <= last && row[first] <= level) {
      ++first;
    }
    while (last > first && row[last] <= level) {
      --last;
    }
    auto crossing = [&](int inside, int outside) {
      const double above = row[inside] - level, below = level - row[outside];
      return static_cast<float>(inside + (outside - inside) * above / std::max(above + below, 1.0));
    };
    if (first < last && first > 0 && last + 1 < lines.cols) {
      ends.emplace_back(crossing(first, first - 1), static_cast<float>(chord.line));
      ends.emplace_back(crossing(last, last + 1), static_cast<float>(chord.line));
    }
  }
  return ends;
}

//! Of the ends, those that are not far inside their hull.
std::vector<cv::Point2f> rimOf(const std::vector<cv::Point2f> &ends)
{
  static const double share = 0.02, least = 1; // of the size; px
  const cv::Rect box = cv::boundingRect(ends);
  return vpChordHull::nearIt(ends, vpChordHull::of(ends),
                             static_cast<float>(std::max(least, share * std::max(box.width, box.height))));
}

std::optional<Shape> nearest(const std::vector<cv::Point2f> &rim)
{
  static const size_t fewest = 8;
  if (rim.size() < fewest) {
    return std::nullopt;
  }
  static const double independent = 8; // ends, of as many as there are
  const double ellipse = vpChordShape::ellipseMisfit(rim, cv::boundingRect(rim)),
               sides = vpChordShape::rectangleMisfit(rim),
               worse = std::max(sides, ellipse) / std::max(std::min(sides, ellipse), 0.1);
  const double otherShape = 1 / (1 + std::pow(worse, independent));
  if (sides < ellipse) {
    const vpQuadrilateralModel model = vpQuadrilateralModel::from(rim);
    Shape shape{model.outline(Eigen::MatrixXd::Zero(vpQuadrilateralModel::parameters,
                                                    vpQuadrilateralModel::parameters)),
                sides};
    shape.outline.otherShape = otherShape;
    return shape;
  }
  const std::optional<vpEllipseModel> model = vpEllipseModel::through(rim);
  if (!model) {
    return std::nullopt;
  }
  Shape shape{model->outline(Eigen::MatrixXd::Zero(vpEllipseModel::parameters, vpEllipseModel::parameters)),
              ellipse};
  shape.outline.otherShape = otherShape;
  return shape;
}
} // namespace

std::optional<vpOutlineFit> vpRimFit::mostStable(const std::vector<Ends> &levels, size_t &chosen)
{
  static const double far = 0.06, px = 0.5; // misfit, share of the radius, and what samples add
  static const double independent = 2;      // ends, of as many as there are
  static const double halving = std::log(2) / std::log(levelRatio);
  std::vector<std::optional<Shape>> shapes;
  for (const Ends &ends : levels) {
    shapes.push_back(nearest(rimOf(ends)));
  }
  double least = std::numeric_limits<double>::infinity();
  std::optional<vpOutlineFit> best;
  for (size_t k = 0; k < shapes.size(); ++k) {
    if (!shapes[k] || shapes[k]->misfit > far * shapes[k]->radius() + px) {
      continue;
    }
    const Shape &shape = *shapes[k];
    double change = 0.5 * shape.radius(); // of the highest level
    if (k + 1 < shapes.size() && shapes[k + 1]) {
      const Shape &next = *shapes[k + 1];
      change = halving * std::hypot(next.radius() - shape.radius(),
                                    (next.outline.centre - shape.outline.centre).norm());
    }
    const double unknown = std::hypot(change, shape.misfit);
    if (unknown / shape.radius() < least) {
      least = unknown / shape.radius();
      chosen = k;
      best.emplace();
      best->outline = shape.outline;
      best->blur = unknown;
      best->outline.centreCovariance =
          (change * change + shape.misfit * shape.misfit / independent) * Eigen::Matrix2d::Identity();
    }
  }
  return best;
}

std::optional<Eigen::Vector2d> vpRimFit::middleOfLight(const cv::Mat_<unsigned char> &lines,
                                                       const vpLedRoi &roi)
{
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 0;
  for (const vpLedChord &chord : roi.chords) {
    for (int x = chord.first; x <= chord.last; ++x) {
      const double light = std::max(0.0, lines(chord.line, x) - roi.level);
      sum += light * Eigen::Vector2d(x, chord.line);
      weight += light;
    }
  }
  return weight > 0 ? std::make_optional<Eigen::Vector2d>(sum / weight) : std::nullopt;
}

void vpRimFit::addHiddenSides(vpLampOutline &outline, double gap)
{
  for (size_t side = 0; side < 2 && gap > 0; ++side) {
    const Eigen::Vector2d along = outline.corners[side + 1] - outline.corners[side],
                          axis = (outline.corners[(side + 2) % 4] - outline.corners[side + 1]).normalized();
    const double hidden = gap - 0.5 * std::abs(along.y()); // half of a side tells where it is
    if (hidden > 0) {
      const double reach = hidden / std::max(std::abs(axis.y()), 0.1);
      outline.centreCovariance += reach * reach / 24 * axis * axis.transpose();
    }
  }
}

void vpRimFit::allowForGlow(vpOutlineFit &fit, const Eigen::Vector2d &light)
{
  static const double sharp = 0.02;   // share of the radius, that half of all edges are known to
  static const double steep = 4;      // power by which a sharper one is that of the lamp
  static const double ofLight = 0.05; // share of the radius, standard deviation
  const double radius = 0.5 * fit.outline.diameter(),
               glow = 1 / (1 + std::pow(sharp * radius / std::max(fit.blur, 1e-6), steep));
  const Eigen::Vector2d apart = light - fit.outline.centre;
  fit.outline.centre += glow * apart;
  fit.outline.centreCovariance = (1 - glow) * fit.outline.centreCovariance +
                                 glow * std::pow(ofLight * radius, 2) * Eigen::Matrix2d::Identity() +
                                 glow * (1 - glow) * apart * apart.transpose();
}

std::optional<vpOutlineFit> vpRimFit::of(const cv::Mat_<unsigned char> &lines, const vpLedRoi &roi)
{
  const vpOutlineFit box = vpOutlineFitter::boxOf(lines, roi);
  double brightest = 0;
  for (const vpLedChord &chord : roi.chords) {
    brightest = std::max<double>(
        brightest, vpBrighter::brightest(lines[chord.line] + chord.first, chord.last - chord.first + 1));
  }
  std::vector<Ends> levels;
  static const double most = 0.5; // share of the brightest light
  for (double light = std::max(1.0, roi.level - box.background); light < most * (brightest - box.background);
       light *= levelRatio) {
    levels.push_back(endsAt(lines, roi, box.background + light));
  }
  size_t chosen = 0;
  std::optional<vpOutlineFit> fit = mostStable(levels, chosen);
  if (fit) {
    fit->background = box.background;
    fit->noise = box.noise;
    allowForGlow(*fit, middleOfLight(lines, roi).value_or(fit->outline.centre));
    if (fit->outline.shape ==
        vpLampOutline::Shape::quadrilateral) { // a side along the lines may lie in the dark
      addHiddenSides(fit->outline, vpChordShape::longestGap(roi));
    }
  }
  return fit;
}

END_VISP_NAMESPACE
