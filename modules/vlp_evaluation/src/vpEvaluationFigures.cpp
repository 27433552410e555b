/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_evaluation/vpEvaluationFigures.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_evaluation/vpGnuplot.h>

BEGIN_VISP_NAMESPACE

namespace
{
using Eigen::Vector2d;

constexpr const char *blue = "#2563a8", *red = "#c0392b", *green = "#23895b", *orange = "#d9730d",
                     *grey = "#8a8f98", *dark = "#2b2f36";

//! The unit in which lengths up to some magnitude (m) are read best.
struct Unit {
  const char *name;
  double perMetre;

  static Unit ofErrors(double largest)
  {
    return largest < 0.1 ? Unit{"mm", 1000} : (largest < 1 ? Unit{"cm", 100} : Unit{"m", 1});
  }
  static Unit ofMap(double extent) { return extent < 5 ? Unit{"cm", 100} : Unit{"m", 1}; }
};

std::string number(double value, const char *format = "%.3g")
{
  std::array<char, 64> buffer;
  std::snprintf(buffer.data(), buffer.size(), format, value);
  return buffer.data();
}

std::string length(double metres, const Unit &unit)
{
  return number(metres * unit.perMetre) + " " + unit.name;
}

std::string row(const std::vector<double> &values)
{
  std::string text;
  for (const double value : values) {
    text += (text.empty() ? "" : " ") + vpNumberText(value);
  }
  return text + "\n";
}

std::string block(const std::string &name, const std::string &rows)
{
  return "$" + name + " << END\n" + rows + "END\n";
}

std::string axisLabel(const char *axis, const std::string &text)
{
  return std::string("set ") + axis + "label " + vpGnuplot::quoted(text) + "\n";
}

std::string range(const char *axis, double low, double high)
{
  return std::string("set ") + axis + "range [" + vpNumberText(low) + ":" + vpNumberText(high) + "]\n";
}

std::string title(const std::string &text)
{
  return " title " + vpGnuplot::quoted(text);
}

std::string colour(const char *name)
{
  return std::string(" lc rgb '") + name + "'";
}

std::string joined(const std::vector<std::string> &plots)
{
  std::string text = "plot ";
  for (size_t i = 0; i < plots.size(); ++i) {
    text += (i == 0 ? "" : ", \\\n     ") + plots[i];
  }
  return text + "\n";
}

//! The pairs to draw: all, or of each stretch the first and the worst.
std::vector<const vpPosePair *> thinned(const std::vector<vpPosePair> &pairs)
{
  constexpr size_t most = 4000;
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

//! The part of the plane that a map shows, in units of its axes.
class Box
{
public:
  void hold(const Vector2d &point)
  {
    m_low = m_low.cwiseMin(point);
    m_high = m_high.cwiseMax(point);
  }
  Vector2d size() const { return m_high - m_low; }
  const Vector2d &low() const { return m_low; }
  const Vector2d &high() const { return m_high; }

  //! Adds a margin, and makes the box at least \e least long and no more than three times as long as wide.
  void finish(double least)
  {
    const Vector2d middle = 0.5 * (m_low + m_high);
    Vector2d half = (0.54 * size()).cwiseMax(0.5 * least);
    half = half.cwiseMax(Vector2d(half.y() / 1.2, half.x() / 3));
    m_low = middle - half;
    m_high = middle + half;
  }

  std::string ranges() const
  {
    return "set size ratio -1\n" + range("x", m_low.x(), m_high.x()) + range("y", m_low.y(), m_high.y());
  }

  //! Height of a figure of that width (px) that the box fills: beside it stand the axes' labels and legend.
  int figureHeight(int width) const
  {
    constexpr double beside = 100, below = 130; // px
    return static_cast<int>(below + (width - beside) * size().y() / size().x());
  }

private:
  Vector2d m_low = Vector2d::Constant(INFINITY), m_high = Vector2d::Constant(-INFINITY);
};

vpFigure scatter(const vpEvaluation &evaluation)
{
  const vpDispersion &dispersion = evaluation.dispersion;
  const Unit unit = Unit::ofErrors(evaluation.horizontal.largest);
  Box box;
  std::string points, circle;
  for (const vpPosePair *pair : thinned(evaluation.pairs)) {
    points += row({unit.perMetre * pair->errorX(), unit.perMetre * pair->errorY()});
  }
  constexpr int corners = 180;
  for (int i = 0; i <= corners; ++i) {
    const double angle = 2 * M_PI * i / corners;
    const Vector2d edge =
        unit.perMetre *
        (dispersion.centre + dispersion.circleRadius * Vector2d(std::cos(angle), std::sin(angle)));
    circle += row({edge.x(), edge.y()});
    box.hold(edge);
  }
  box.hold(Vector2d::Zero());
  box.finish(1e-3 * unit.perMetre);
  const Vector2d a = unit.perMetre * dispersion.first, b = unit.perMetre * dispersion.second;

  vpFigure figure;
  figure.name = "scatter";
  figure.height = box.figureHeight(figure.width);
  figure.caption =
      "Horizontal errors. The paper's dispersion radius is half the distance of the farthest pair, " +
      length(dispersion.radius(), unit) + "; the smallest circle that holds all points has radius " +
      length(dispersion.circleRadius, unit) + ".";
  std::vector<std::string> plots = {"$points with points pt 7 ps 0.45" + colour(blue) +
                                        title("estimate minus truth"),
                                    "$truth with points pt 1 ps 1.6 lw 2" + colour(dark) + title("no error")};
  if (dispersion.circleRadius > 0) {
    plots.insert(plots.begin(), "$circle with lines lw 1.6" + colour(red) + title("smallest circle"));
    plots.push_back("$farthest with lines lw 1.6 dt 2" + colour(orange) + title("farthest pair"));
  }
  figure.body = block("points", points) + block("circle", circle) +
                block("farthest", row({a.x(), a.y()}) + row({b.x(), b.y()})) + block("truth", "0 0\n") +
                box.ranges() + axisLabel("x", std::string("error in x (") + unit.name + ")") +
                axisLabel("y", std::string("error in y (") + unit.name + ")") + joined(plots);
  return figure;
}

//! Truth's positions in the order of time, a thousand or two of them.
std::string truthRows(const vpTrajectory &truth, double scale, Box &box)
{
  constexpr size_t most = 2000;
  const size_t step = truth.size() / most + 1;
  std::string rows;
  for (size_t i = 0; i < truth.size();
       i += i + 1 == truth.size() ? 1 : std::min(step, truth.size() - 1 - i)) {
    const Vector2d position = scale * Vector2d(truth[i].wMb[0][3], truth[i].wMb[1][3]);
    rows += row({position.x(), position.y()});
    box.hold(position);
  }
  return rows;
}

vpFigure track(const vpEvaluation &evaluation)
{
  Box extent;
  truthRows(evaluation.truth, 1, extent);
  Box estimated;
  for (const vpPosePair &pair : evaluation.pairs) {
    extent.hold({pair.estimate[0][3], pair.estimate[1][3]});
    estimated.hold({pair.estimate[0][3], pair.estimate[1][3]});
  }
  const Unit unit = Unit::ofMap(extent.size().maxCoeff());

  Box box;
  std::string points, fitted, line;
  const std::string truth = truthRows(evaluation.truth, unit.perMetre, box);
  for (const vpPosePair *pair : thinned(evaluation.pairs)) {
    const Vector2d position = unit.perMetre * Vector2d(pair->estimate[0][3], pair->estimate[1][3]);
    points += row({position.x(), position.y()});
    box.hold(position);
  }
  const bool still = evaluation.truth.size() == 1 || extent.size().maxCoeff() < 1e-3;
  std::vector<std::string> plots = {std::string("$truth with ") +
                                        (still ? "points pt 1 ps 1.6 lw 2" : "lines lw 3") + colour(grey) +
                                        title("truth"),
                                    "$points with points pt 7 ps 0.45" + colour(blue) + title("estimate")};
  if (evaluation.line) {
    for (const Vector2d &end : {evaluation.line->start(), evaluation.line->end()}) {
      line += row({unit.perMetre * end.x(), unit.perMetre * end.y()});
      box.hold(unit.perMetre * end);
    }
    plots.push_back("$line with lines lw 1.4 dt 3" + colour(green) + title("line start to end"));
  }
  if (evaluation.fitted) {
    const int axis = evaluation.fitted->alongY ? 1 : 0;
    for (const double coordinate : {estimated.low()[axis], estimated.high()[axis]}) {
      const Vector2d end = unit.perMetre * evaluation.fitted->at(coordinate);
      fitted += row({end.x(), end.y()});
      box.hold(end);
    }
    plots.push_back("$fitted with lines lw 1.4 dt 2" + colour(orange) + title("fitted line"));
  }
  box.finish(0.01 * unit.perMetre);

  vpFigure figure;
  figure.name = "track";
  figure.height = box.figureHeight(figure.width);
  figure.caption = "Estimated positions and the truth in the map.";
  if (evaluation.fitted) {
    figure.caption += " Fitted line: " + evaluation.fitted->textInCentimetres() + " (x, y in cm).";
  }
  figure.body = block("truth", truth) + block("points", points) + block("line", line) +
                block("fitted", fitted) + box.ranges() +
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
                "set yrange [0:*]\nset key off\nset style fill solid 0.85 border rgb 'white'\n" +
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
  std::vector<std::string> plots = {
      "$levels using 1:2 with lines lw 1 dt 3" + colour(dark) + title("90 % and 95 %"),
      "$errors with steps lw 2.4" + colour(blue) + title("error against the truth")};
  figure.body = block("errors", steps(evaluation.distribution, unit.perMetre, end)) +
                block("levels", row({0, 90}) + row({end, 90}) + "\n" + row({0, 95}) + row({end, 95}));
  if (line) {
    figure.body += block("line", steps(evaluation.offLine, unit.perMetre, end));
    plots.push_back("$line with steps lw 2" + colour(orange) + title("distance from the line"));
    figure.caption += " The distance from the line is the paper's measure.";
  }
  figure.body += range("x", 0, end) + "set yrange [0:101]\nset ytics 20\n" +
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
  const std::string style =
      evaluation.pairs.size() > 300 ? " with points pt 7 ps 0.25" : " with linespoints pt 7 ps 0.35 lw 1";
  const auto panel = [](double bottom, double top) {
    return "set bmargin at screen " + vpNumberText(bottom) + "\nset tmargin at screen " + vpNumberText(top) +
           "\n";
  };
  vpFigure figure;
  figure.name = "error-over-time";
  figure.height = 560;
  figure.caption = "Errors in x, y and yaw over time, from the first position on.";
  figure.body = block("errors", rows) + "set multiplot\nset lmargin 10\nset rmargin 2\n" +
                (duration > 0 ? range("x", 0, duration) : range("x", -1, 1)) + panel(0.44, 0.92) +
                "set key top center outside horizontal\nset format x ''\n" +
                axisLabel("y", std::string("error (") + unit.name + ")") +
                joined({"0 with lines lw 1" + colour(grey) + " notitle",
                        "$errors using 1:2" + style + colour(blue) + title("x"),
                        "$errors using 1:3" + style + colour(orange) + title("y")}) +
                panel(0.13, 0.38) + "set key off\nset format x\n" + axisLabel("x", "time (s)") +
                axisLabel("y", "yaw error (deg)") +
                joined({"0 with lines lw 1" + colour(grey), "$errors using 1:4" + style + colour(green)}) +
                "unset multiplot\n";
  return figure;
}

//! What all figures share.
const char *const look = "set encoding utf8\n"
                         "set border 3 lc rgb '#555b66'\n"
                         "set tics nomirror out scale 0.6 textcolor rgb '#2b2f36'\n"
                         "set grid lc rgb '#dfe3e8' lw 0.8 lt 1\n"
                         "set key bmargin center horizontal samplen 2.2\n";
} // namespace

std::string vpFigure::png() const
{
  return vpGnuplot::draw("set terminal pngcairo noenhanced size " + std::to_string(2 * width) + "," +
                         std::to_string(2 * height) +
                         " font 'DejaVu Sans,20' linewidth 2 pointscale 2 background '#ffffff'\n" + look +
                         body);
}

std::string vpFigure::svg() const
{
  return vpGnuplot::draw(
      "set terminal svg noenhanced dynamic size " + std::to_string(width) + "," + std::to_string(height) +
      " font 'DejaVu Sans, Helvetica, Arial, sans-serif,14' background '#ffffff'\n" + look + body);
}

std::vector<vpFigure> vpFiguresOf(const vpEvaluation &evaluation)
{
  if (evaluation.pairs.empty()) {
    return {};
  }
  return {scatter(evaluation), track(evaluation), pmf(evaluation), cdf(evaluation), overTime(evaluation)};
}

END_VISP_NAMESPACE
