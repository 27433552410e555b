/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_evaluation/vpEvaluationFigures.h>

#include <algorithm>
#include <cmath>

#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_evaluation/vpGnuplot.h>

#include "vpFigureBox.h"
#include "vpFigureScript.h"

BEGIN_VISP_NAMESPACE

namespace
{
using Eigen::Vector2d;

using namespace vpFigureScript;

//! The pairs to draw: all, or of each stretch the first and the worst.
std::vector<const vpPosePair *> thinned(const std::vector<vpPosePair> &pairs)
{
  constexpr size_t most = 2000;
  const size_t stretch = pairs.size() <= most ? 1 : (2 * pairs.size() + most - 1) / most;
  std::vector<const vpPosePair *> chosen;
  for (size_t begin = 0; begin < pairs.size(); begin += stretch) {
    size_t worst = begin;
    for (size_t i = begin; i < std::min(begin + stretch, pairs.size()); ++i) {
      worst = pairs[i].distance() > pairs[worst].distance() ? i : worst;
    }
    chosen.push_back(&pairs[begin]);
    if (worst != begin) {
      chosen.push_back(&pairs[worst]);
    }
  }
  return chosen;
}

//! For the caption, where not all pairs are drawn.
std::string drawnOf(const vpEvaluation &evaluation)
{
  const size_t drawn = thinned(evaluation.pairs).size(), all = evaluation.pairs.size();
  return drawn == all ? ""
                      : " Drawn: " + std::to_string(drawn) + " of " + std::to_string(all) + " positions.";
}

vpFigure scatter(const vpEvaluation &evaluation)
{
  const vpDispersion &dispersion = evaluation.dispersion;
  const Unit unit = Unit::ofErrors(evaluation.horizontal.largest);
  vpFigureBox box;
  std::string rows, circle;
  for (const vpPosePair *pair : thinned(evaluation.pairs)) {
    rows += row({unit.perMetre * pair->errorX(), unit.perMetre * pair->errorY()});
  }
  constexpr int corners = 180;
  for (int i = 0; i <= corners; ++i) {
    const double angle = 2 * M_PI * i / corners;
    const Vector2d edge =
        dispersion.centre + dispersion.circleRadius * Vector2d(std::cos(angle), std::sin(angle));
    circle += row({unit.perMetre * edge.x(), unit.perMetre * edge.y()});
    box.hold(edge);
  }
  // Far from the cloud it would make a dot of it.
  const bool showsZero =
      dispersion.circleRadius == 0 || dispersion.centre.norm() < 4 * dispersion.circleRadius;
  if (showsZero) {
    box.hold(Vector2d::Zero());
  }
  box.finish(1e-6);
  const Vector2d a = unit.perMetre * dispersion.first, b = unit.perMetre * dispersion.second;

  vpFigure figure;
  figure.name = "scatter";
  figure.height = box.figureHeight(figure.width);
  figure.caption =
      "Horizontal errors. The paper's dispersion radius is half the distance of the farthest pair, " +
      length(dispersion.radius(), unit) + "; the smallest circle that holds all points has radius " +
      length(dispersion.circleRadius, unit) + ".";
  figure.caption +=
      showsZero ? ""
                : " No error at all would be " + length(dispersion.centre.norm(), unit) + " from its middle.";
  figure.caption += drawnOf(evaluation);
  std::vector<std::string> plots;
  if (dispersion.circleRadius > 0) {
    plots.push_back("$circle with lines lw 1.6" + colour(red) + title("smallest circle"));
  }
  plots.push_back(points("$points", evaluation.pairs.size(), blue, "estimate minus truth"));
  if (showsZero) {
    plots.push_back("$truth with points pt 1 ps 2.2 lw 2.2" + colour(dark) + title("no error"));
  }
  if (dispersion.circleRadius > 0) {
    plots.push_back("$farthest with linespoints pt 6 ps 1.1 lw 1.6 dt 2" + colour(orange) +
                    title("farthest pair"));
  }
  figure.body = block("points", rows) + block("circle", circle) +
                block("farthest", row({a.x(), a.y()}) + row({b.x(), b.y()})) + block("truth", "0 0\n") +
                box.ranges(unit.perMetre) + axisLabel("x", std::string("error in x (") + unit.name + ")") +
                axisLabel("y", std::string("error in y (") + unit.name + ")") + joined(plots);
  return figure;
}

Vector2d positionOf(const vpHomogeneousMatrix &pose)
{
  return {pose[0][3], pose[1][3]};
}

//! Truth's positions in the order of time, a thousand or two of them; parted where it has a gap.
std::string truthRows(const vpEvaluation &evaluation, double scale)
{
  constexpr size_t most = 2000;
  const vpTrajectory &truth = evaluation.truth;
  const size_t step = truth.size() / most + 1;
  std::string rows;
  for (size_t i = 0; i < truth.size(); ++i) {
    const bool gap = i > 0 && truth[i].timestamp - truth[i - 1].timestamp > evaluation.longestGap;
    if (gap || i % step == 0 || i + 1 == truth.size()) {
      const Vector2d position = scale * positionOf(truth[i].wMb);
      rows += (gap ? "\n" : "") + row({position.x(), position.y()});
    }
  }
  return rows;
}

//! Ends of the fitted line, as far as the estimate goes.
std::vector<Vector2d> endsOf(const vpFittedLine &line, const vpFigureBox &estimate)
{
  const int axis = line.alongY ? 1 : 0;
  return {line.at(estimate.low()[axis]), line.at(estimate.high()[axis])};
}

std::string segment(const std::vector<Vector2d> &ends, double scale)
{
  std::string rows;
  for (const Vector2d &end : ends) {
    rows += row({scale * end.x(), scale * end.y()});
  }
  return rows;
}

vpFigure track(const vpEvaluation &evaluation)
{
  vpFigureBox estimate, truth, box; // m
  for (const vpPosePair &pair : evaluation.pairs) {
    estimate.hold(positionOf(pair.estimate));
    box.hold(positionOf(pair.estimate));
  }
  for (const vpTimedPose &pose : evaluation.truth.poses()) {
    truth.hold(positionOf(pose.wMb));
    box.hold(positionOf(pose.wMb));
  }
  const bool still = truth.size().maxCoeff() < 1e-3;
  std::vector<std::string> plots = {points("$points", evaluation.pairs.size(), pale, "estimate")};
  std::vector<Vector2d> line, fitted;
  if (evaluation.line) {
    line = {evaluation.line->start(), evaluation.line->end()};
    plots.push_back("$line with lines lw 3.5" + colour(green) + title("line from start to end"));
  }
  const std::string truthStyle = still                           ? "points pt 1 ps 2.2 lw 2.2"
                                 : evaluation.truth.size() < 100 ? "linespoints pt 1 ps 0.9 lw 1.3"
                                                                 : "linespoints pt 7 ps 0.12 lw 1.3";
  plots.push_back("$truth with " + truthStyle + colour(dark) + title("truth"));
  if (evaluation.fitted) {
    fitted = endsOf(*evaluation.fitted, estimate);
    plots.push_back("$fitted with lines lw 1.6 dt 2" + colour(orange) + title("fitted to the estimate"));
  }
  for (const Vector2d &end : line) {
    box.hold(end);
  }
  box.finish(0.01);
  const Unit unit = Unit::ofMap(box.size().maxCoeff());
  std::string rows;
  for (const vpPosePair *pair : thinned(evaluation.pairs)) {
    rows += segment({positionOf(pair->estimate)}, unit.perMetre);
  }

  vpFigure figure;
  figure.name = "track";
  figure.height = box.figureHeight(figure.width);
  figure.caption = "Estimated positions and the truth in the map.";
  if (evaluation.fitted) {
    figure.caption += " Fitted line: " + evaluation.fitted->textInCentimetres() + " (x, y in cm).";
  }
  figure.caption += drawnOf(evaluation);
  figure.body = block("truth", truthRows(evaluation, unit.perMetre)) + block("points", rows) +
                block("line", segment(line, unit.perMetre)) +
                block("fitted", segment(fitted, unit.perMetre)) + box.ranges(unit.perMetre) +
                axisLabel("x", std::string("x (") + unit.name + ")") +
                axisLabel("y", std::string("y (") + unit.name + ")") + joined(plots);
  return figure;
}

vpFigure pmf(const vpEvaluation &evaluation)
{
  const vpErrorDistribution &distribution = evaluation.distribution;
  const Unit unit = Unit::ofErrors(evaluation.horizontal.largest);
  const double width = distribution.binWidth() * unit.perMetre;
  std::string bins;
  for (size_t i = 0; i < distribution.pmf().size(); ++i) {
    bins += row({(static_cast<double>(i) + 0.5) * width, 100 * distribution.pmf()[i]});
  }
  vpFigure figure;
  figure.name = "pmf";
  figure.caption = "Probability mass function of the horizontal error, in bins of " +
                   length(distribution.binWidth(), unit) + ".";
  figure.body = block("bins", bins) + range("x", 0, width * static_cast<double>(distribution.pmf().size())) +
                "set yrange [0:*]\nset key off\nset boxwidth " + vpNumberText(width) +
                "\nset style fill solid 0.85 border rgb 'white'\n" +
                axisLabel("x", std::string("horizontal error (") + unit.name + ")") +
                axisLabel("y", "share of the positions (%)") + "plot $bins with boxes" + colour(blue) + "\n";
  return figure;
}

//! Corners of the steps of a cumulative distribution, up to \e end; at most some thousands.
std::string steps(const vpErrorDistribution &distribution, double scale, double end)
{
  constexpr size_t most = 2000;
  const std::vector<double> &errors = distribution.errors();
  const size_t stride = errors.size() / most + 1;
  std::string rows = row({0, 0});
  for (size_t i = 0; i < errors.size(); i += stride) {
    rows += row({scale * errors[i], 100. * static_cast<double>(i + 1) / static_cast<double>(errors.size())});
  }
  return rows + row({scale * errors.back(), 100}) + row({end, 100});
}

vpFigure cdf(const vpEvaluation &evaluation)
{
  const bool line = evaluation.line.has_value();
  const double largest =
      std::max({evaluation.horizontal.largest, line ? evaluation.lineDistance.largest : 0, 1e-9});
  const Unit unit = Unit::ofErrors(largest);
  const double end = 1.05 * largest * unit.perMetre;
  const double p90 = evaluation.horizontal.percentile90, p95 = evaluation.horizontal.percentile95;

  vpFigure figure;
  figure.name = "cdf";
  figure.caption = "Cumulative distribution function of the horizontal error: 90 % below " +
                   length(p90, unit) + ", 95 % below " + length(p95, unit) + ".";
  std::vector<std::string> plots = {"$errors with steps lw 2.4" + colour(blue) +
                                    title("error against the truth")};
  figure.body = block("errors", steps(evaluation.distribution, unit.perMetre, end));
  if (line) {
    figure.body += block("line", steps(evaluation.offLine, unit.perMetre, end));
    plots.push_back("$line with steps lw 2" + colour(orange) + title("distance from the line"));
    figure.caption += " The distance from the line is the paper's measure.";
  }
  figure.body += range("x", 0, end) + "set yrange [0:101]\nset ytics (0, 20, 40, 60, 80, 90, 95, 100)\n" +
                 axisLabel("x", std::string("error (") + unit.name + ")") +
                 axisLabel("y", "share of the positions (%)") + joined(plots);
  return figure;
}

vpFigure overTime(const vpEvaluation &evaluation)
{
  const Unit unit = Unit::ofErrors(evaluation.horizontal.largest);
  std::string rows;
  for (const vpPosePair *pair : thinned(evaluation.pairs)) {
    rows += row({pair->timestamp - evaluation.pairs.front().timestamp, unit.perMetre * pair->errorX(),
                 unit.perMetre * pair->errorY(), pair->errorYaw() * 180 / M_PI});
  }
  const double duration = evaluation.pairs.back().timestamp - evaluation.pairs.front().timestamp;
  const size_t count = evaluation.pairs.size();
  const bool joinedUp = count <= 300;
  const auto panel = [](double bottom, double top) {
    return "set bmargin at screen " + vpNumberText(bottom) + "\nset tmargin at screen " + vpNumberText(top) +
           "\n";
  };
  vpFigure figure;
  figure.name = "error-over-time";
  figure.height = 500;
  figure.caption = "Errors in x, y and yaw over time, from the first position on." + drawnOf(evaluation);
  figure.body = block("errors", rows) + "set multiplot\nset lmargin 10\nset rmargin 2\n" +
                (duration > 0 ? range("x", 0, duration) : range("x", -1, 1)) + panel(0.45, 0.90) +
                "set format x ''\n" + axisLabel("y", std::string("error (") + unit.name + ")") +
                joined({"0 with lines lw 1" + colour(grey) + " notitle",
                        points("$errors using 1:2", count, blue, "x", joinedUp),
                        points("$errors using 1:3", count, orange, "y", joinedUp)}) +
                panel(0.15, 0.39) + "set key off\nset format x '%g'\n" + axisLabel("x", "time (s)") +
                axisLabel("y", "yaw error (deg)") +
                joined({"0 with lines lw 1" + colour(grey),
                        points("$errors using 1:4", count, green, "yaw", joinedUp)}) +
                "unset multiplot\n";
  return figure;
}

//! What all figures share.
const char *const look = "set encoding utf8\n"
                         "set border 3 lc rgb '#555b66'\n"
                         "set tics nomirror out scale 0.6 textcolor rgb '#2b2f36'\n"
                         "set grid lc rgb '#dfe3e8' lw 0.8 lt 1\n"
                         "set key tmargin center horizontal reverse Left samplen 2 height 0.6\n"
                         "set format '%g'\n";
} // namespace

std::string vpFigure::png() const
{
  return vpGnuplot::draw("set terminal pngcairo noenhanced size " + std::to_string(2 * width) + "," +
                         std::to_string(2 * height) +
                         " font 'DejaVu Sans,20' rounded linewidth 2 pointscale 2 background '#ffffff'\n" +
                         look + body);
}

std::string vpFigure::svg() const
{
  std::string text = vpGnuplot::draw(
      "set terminal svg noenhanced dynamic size " + std::to_string(width) + "," + std::to_string(height) +
      " font 'DejaVu Sans, Helvetica, Arial, sans-serif,14' rounded background '#ffffff'\n" + look + body);
  // gnuplot names each curve, which browsers show where the mouse rests.
  for (size_t begin; (begin = text.find("<title>gnuplot_plot_")) != std::string::npos;) {
    text.erase(begin, text.find("</title>", begin) + std::string("</title>").size() - begin);
  }
  const std::string title = "<title>Gnuplot</title>";
  const size_t begin = text.find(title);
  return begin == std::string::npos ? text : text.replace(begin, title.size(), "<title>" + name + "</title>");
}

std::vector<vpFigure> vpFiguresOf(const vpEvaluation &evaluation)
{
  if (evaluation.pairs.empty()) {
    return {};
  }
  return {scatter(evaluation), track(evaluation), pmf(evaluation), cdf(evaluation), overTime(evaluation)};
}

END_VISP_NAMESPACE
