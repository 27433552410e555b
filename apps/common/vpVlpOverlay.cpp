/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpVlpOverlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include <opencv2/imgproc.hpp>

#include "common/vpTextBlock.h"
#include "common/vpVlpColours.h"

BEGIN_VISP_NAMESPACE

namespace
{
constexpr int subPixel = 4;         // bits that OpenCV's drawing takes as the fraction of a coordinate
constexpr size_t mostLabels = 40;   // more would hide the picture
constexpr double farthest = 100000; // px; OpenCV's drawing overflows at a multiple of it

/*!
  Factor that makes a dark picture easy to look at. The 99.9 % quantile becomes white; where lamps are fewer
  pixels than that, half the brightest pixel.
*/
double gain(const cv::Mat &grey)
{
  std::array<size_t, 256> histogram{};
  for (int y = 0; y < grey.rows; ++y) {
    for (int x = 0; x < grey.cols; ++x) {
      ++histogram[grey.at<unsigned char>(y, x)];
    }
  }
  const size_t above = grey.total() / 1000;
  size_t count = 0;
  int quantile = 256;
  while (quantile > 0 && count <= above) {
    count += histogram[static_cast<size_t>(--quantile)];
  }
  double most = 0;
  cv::minMaxLoc(grey, nullptr, &most);
  const double bright = std::max(static_cast<double>(quantile), most / 2);
  return bright > 0 ? std::max(1.0, 255 / bright) : 1;
}

//! A part of the frame as it is shown.
class View
{
public:
  cv::Mat picture; // BGR
  double unit;     // size of text and lines, 1 for a picture of 800 pixels
  double scale;    // shown pixels of a frame's pixel

  //! \e part of the frame, \e scale times as large; whole numbers enlarge without smoothing.
  View(const cv::Mat &grey, const cv::Rect &part, double scale_, double brighter, double unit_)
      : unit(unit_), scale(scale_), m_first(part.x, part.y)
  {
    const cv::Size size(std::max(1, cvRound(part.width * scale)), std::max(1, cvRound(part.height * scale)));
    cv::Mat shown;
    cv::resize(grey(part), shown, size, 0, 0, scale < 1 ? cv::INTER_AREA : cv::INTER_NEAREST);
    shown.convertTo(shown, CV_8U, brighter);
    cv::cvtColor(shown, picture, cv::COLOR_GRAY2BGR);
  }

  //! Where a pixel of the frame went; centres at integers, in the frame and here.
  Eigen::Vector2d operator()(const Eigen::Vector2d &pixel) const
  {
    const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.5);
    return scale * (pixel - m_first + half) - half;
  }

private:
  Eigen::Vector2d m_first; // the frame's pixel in the upper left corner
};

double wholeScale(cv::Size frame)
{
  constexpr int least = 800, most = 1600; // px of the longer side
  const int longest = std::max(frame.width, frame.height);
  return longest > most ? static_cast<double>(most) / longest
                        : (longest < least ? (least + longest - 1) / longest : 1);
}

void drawLines(View &view, const std::vector<Eigen::Vector2d> &points, bool closed, const cv::Scalar &colour,
               int thickness)
{
  std::vector<cv::Point> fixed;
  for (const Eigen::Vector2d &point : points) {
    const Eigen::Vector2d at = view(point);
    if (!at.allFinite() || at.cwiseAbs().maxCoeff() > farthest) {
      return;
    }
    fixed.emplace_back(cvRound(at.x() * (1 << subPixel)), cvRound(at.y() * (1 << subPixel)));
  }
  cv::polylines(view.picture, fixed, closed, colour, thickness, cv::LINE_AA, subPixel);
}

std::vector<Eigen::Vector2d> pointsOf(const vpLampOutline &outline)
{
  if (outline.shape != vpLampOutline::Shape::ellipse) {
    return {outline.corners.begin(), outline.corners.end()};
  }
  constexpr int count = 180;
  const Eigen::Vector2d major(std::cos(outline.angle), std::sin(outline.angle)), minor(-major.y(), major.x());
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < count; ++i) {
    const double t = 2 * M_PI * i / count;
    points.emplace_back(outline.centre + std::cos(t) * outline.a * major + std::sin(t) * outline.b * minor);
  }
  return points;
}

void drawRegion(View &view, const vpLampObservation &lamp)
{
  const int thickness = std::max(1, cvRound(1.2 * view.unit));
  drawLines(view, pointsOf(lamp.outline), true, vpVlpColours::ofLamp(lamp), thickness);

  const double arm = std::min(7 * view.unit / view.scale, 0.2 * lamp.outline.diameter());
  const Eigen::Vector2d across(arm, 0), along(0, arm);
  for (const bool edge : {true, false}) { // a dark edge: the cross lies on bright stripes
    const cv::Scalar colour = edge ? cv::Scalar(0, 0, 0) : vpVlpColours::ofLamp(lamp);
    const int width = edge ? thickness + 2 : thickness;
    drawLines(view, {lamp.point - across, lamp.point + across}, false, colour, width);
    drawLines(view, {lamp.point - along, lamp.point + along}, false, colour, width);
  }
}

std::vector<std::string> signalText(const vpStripeFeatures &features)
{
  if (features.signal == vpStripeFeatures::Signal::unmodulated) {
    return {"unmodulated"};
  }
  if (features.signal == vpStripeFeatures::Signal::coded) { // frequency and duty say nothing of it
    return {"coded"};
  }
  std::vector<std::string> lines = {
      vpFormat("%.1f +/- %.1f Hz", features.frequency, features.frequencySigma)};
  if (std::isfinite(features.duty)) {
    lines.push_back(vpFormat("duty %.3f +/- %.3f", features.duty, features.dutySigma));
  }
  return lines;
}

//! \param said What stands beside the picture already. \param chart Of that lamp, or nullptr.
vpTextBlock labelOf(const vpLampObservation &lamp, const std::string &said, const vpLampChart *chart,
                    double unit)
{
  std::vector<std::string> lines = signalText(lamp.features);
  if (!lamp.remark.empty() && lamp.remark.rfind(lines[0], 0) == 0) { // the remark says it, and more
    lines.clear();
  }
  if (chart == nullptr) {
    lines.push_back(vpFormat("confidence %.3f", lamp.confidence));
  }
  if (!lamp.remark.empty() && lamp.remark != said) {
    lines.push_back(lamp.remark);
  }
  if (chart != nullptr) {
    lines.insert(lines.end(), chart->caption.begin(), chart->caption.end());
  }
  const size_t columns = chart != nullptr ? 29 : 26; // letters, as wide as what stands above
  return vpTextBlock(lamp.id.empty() ? "?" : lamp.id.substr(0, 40), lines, vpVlpColours::ofLamp(lamp), unit,
                     columns);
}

//! Where an outline is in the view; empty where it is nowhere.
cv::Rect boxOf(const View &view, const vpLampOutline &outline)
{
  const Eigen::Vector4d box = outline.box();
  const Eigen::Vector2d first = view(box.head<2>()), last = view(box.tail<2>());
  const bool drawn = first.allFinite() && last.allFinite() && first.cwiseAbs().maxCoeff() < farthest &&
                     last.cwiseAbs().maxCoeff() < farthest;
  return drawn ? cv::Rect(cv::Point(cvFloor(first.x()), cvFloor(first.y())),
                          cv::Point(cvCeil(last.x()) + 1, cvCeil(last.y()) + 1))
               : cv::Rect();
}

//! Where lamps were looked for; behind the lamps themselves.
void drawWindows(View &view, const vpVlpLocation &location)
{
  const cv::Mat before = view.picture.clone();
  for (const vpRect &window : location.searched) {
    const double left = std::max(-1.0, window.getLeft()), top = std::max(-1.0, window.getTop());
    const double right = window.getLeft() + window.getWidth() - 1,
                 low = window.getTop() + window.getHeight() - 1;
    drawLines(view, {{left, top}, {right, top}, {right, low}, {left, low}}, true, vpVlpColours::blue, 1);
  }
  for (const vpLampObservation &lamp : location.observations) {
    const cv::Rect box = boxOf(view, lamp.outline) & cv::Rect(cv::Point(), before.size());
    before(box).copyTo(view.picture(box));
  }
}

cv::Point2d middleOf(const cv::Rect &box)
{
  return 0.5 * cv::Point2d(box.tl() + box.br());
}

//! A small lamp once more, enlarged, so that its stripes and outline can be seen; empty where it is large
//! enough.
cv::Mat enlarged(const cv::Mat &grey, const View &view, double brighter, const vpLampObservation &lamp)
{
  const double least = 48 * view.unit, side = 88 * view.unit; // px
  const cv::Rect box = boxOf(view, lamp.outline);
  const Eigen::Vector4d outline = lamp.outline.box();
  if (box.empty() || std::max(box.width, box.height) >= least) {
    return {};
  }
  const double reach = 0.65 * (outline.tail<2>() - outline.head<2>()).maxCoeff() + 2;
  const Eigen::Vector2d middle = 0.5 * (outline.head<2>() + outline.tail<2>());
  const cv::Rect part = cv::Rect(cvFloor(middle.x() - reach), cvFloor(middle.y() - reach),
                                 cvCeil(2 * reach) + 1, cvCeil(2 * reach) + 1) &
                        cv::Rect(cv::Point(), grey.size());
  if (part.empty()) {
    return {};
  }
  View close(grey, part, side / std::max(part.width, part.height), brighter, view.unit);
  drawRegion(close, lamp);
  return close.picture;
}

//! A lamp's text, with its chart or its enlarged picture above.
struct Label {
  vpTextBlock block;
  cv::Mat close; // may be empty
  bool chart;    // and not its enlarged picture
  cv::Rect lamp;
  cv::Rect place = {};

  cv::Size size() const
  {
    return {std::max(block.size().width, close.cols), block.size().height + close.rows};
  }
};

//! From the label to the lamp it speaks of.
void drawLeader(cv::Mat &picture, const Label &label)
{
  const cv::Rect &from = label.place, &to = label.lamp;
  const cv::Point middle(to.x + to.width / 2, to.y + to.height / 2);
  const cv::Point start(std::clamp(middle.x, from.x, from.x + from.width),
                        std::clamp(middle.y, from.y, from.y + from.height));
  const cv::Point end(std::clamp(start.x, to.x, to.x + to.width),
                      std::clamp(start.y, to.y, to.y + to.height));
  cv::line(picture, start, end, label.block.colour(), 1, cv::LINE_AA);
}

void drawLabel(cv::Mat &picture, const Label &label)
{
  label.block.draw(picture, label.place.tl() + cv::Point(0, label.close.rows));
  const cv::Rect close =
      cv::Rect(label.place.tl(), label.close.size()) & cv::Rect(cv::Point(), picture.size());
  if (!close.empty()) {
    const cv::Mat above = label.close(cv::Rect(cv::Point(), close.size()));
    cv::Mat shown = picture(close);
    if (label.chart) { // dims what is below, as text does
      cv::max(0.3 * shown, above, shown);
    } else {
      above.copyTo(shown);
    }
  }
  cv::rectangle(picture, label.place, 0.5 * label.block.colour(), 1);
}

//! The chart of that observation, or nullptr.
const vpLampChart *chartOf(const std::vector<vpLampChart> &charts, size_t lamp)
{
  const auto found = std::find_if(charts.begin(), charts.end(),
                                  [lamp](const vpLampChart &chart) { return chart.lamp == lamp; });
  return found == charts.end() ? nullptr : &*found;
}

/*!
  A label for each lamp, most of them beside theirs. What counts for the position gets its place first, and of
  those the outermost, which leave the room inside to the others.
*/
std::vector<Label> labelsOf(const vpVlpLocation &location, const std::vector<vpLampChart> &charts,
                            const cv::Mat &grey, const View &view, double brighter, vpTextLayout &layout)
{
  struct Turn {
    int rank;
    double outwards; // px from the middle of all, negative
    const vpLampObservation *lamp;
    const vpLampChart *chart; // or nullptr
    cv::Rect box;
  };
  std::vector<Turn> turns;
  cv::Point2d crowd;
  for (size_t i = 0; i < location.observations.size(); ++i) {
    const vpLampObservation &lamp = location.observations[i];
    const vpLampChart *chart = chartOf(charts, i);
    const bool tells = !lamp.id.empty() || chart != nullptr;
    turns.push_back({lamp.accepted ? 0 : (tells ? 1 : 2), 0, &lamp, chart, boxOf(view, lamp.outline)});
    crowd += middleOf(turns.back().box) / static_cast<double>(location.observations.size());
  }
  for (Turn &turn : turns) {
    turn.outwards = -cv::norm(middleOf(turn.box) - crowd);
  }
  std::stable_sort(turns.begin(), turns.end(), [](const Turn &one, const Turn &other) {
    return std::tie(one.rank, one.outwards) < std::tie(other.rank, other.outwards);
  });
  turns.resize(std::min(turns.size(), mostLabels));

  const int gap = cvRound(6 * view.unit);
  std::vector<Label> labels;
  for (const Turn &turn : turns) {
    Label label = {labelOf(*turn.lamp, location.fix.refusal, turn.chart, view.unit),
                   turn.chart != nullptr ? turn.chart->draw(view.unit)
                                         : enlarged(grey, view, brighter, *turn.lamp),
                   turn.chart != nullptr, turn.box};
    label.place = layout.beside(turn.box, label.size(), gap, crowd);
    constexpr double crowded = 0.05;
    if (!label.chart && !label.close.empty() && layout.covered(label.place) > crowded) { // text goes first
      label.close = cv::Mat();
      label.place = layout.beside(turn.box, label.size(), gap, crowd);
    }
    layout.avoid(label.place);
    labels.push_back(label);
  }
  return labels;
}
} // namespace

cv::Mat vpDrawVlpOverlay(const vpImage<unsigned char> &I, const vpVlpLocation &location,
                         const std::vector<vpLampChart> &charts)
{
  const cv::Mat grey(static_cast<int>(I.getRows()), static_cast<int>(I.getCols()), CV_8UC1, I.bitmap);
  if (grey.empty()) {
    return {};
  }
  const double scale = wholeScale(grey.size()), brighter = gain(grey);
  View view(grey, cv::Rect(cv::Point(), grey.size()), scale, brighter,
            scale * std::max(grey.cols, grey.rows) / 800);

  vpTextLayout layout(view.picture.size());
  for (const vpLampObservation &lamp : location.observations) {
    layout.avoid(boxOf(view, lamp.outline));
  }
  const std::vector<Label> labels = labelsOf(location, charts, grey, view, brighter, layout);

  drawWindows(view, location);
  for (const vpLampObservation &lamp : location.observations) {
    drawRegion(view, lamp);
  }
  for (const Label &label : labels) {
    drawLeader(view.picture, label);
  }
  for (const Label &label : labels) {
    drawLabel(view.picture, label);
  }
  return view.picture;
}

END_VISP_NAMESPACE
