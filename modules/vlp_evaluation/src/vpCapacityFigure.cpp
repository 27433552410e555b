/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_evaluation/vpCapacityFigure.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <visp3/vlp_core/vpNumberText.h>

#include "vpFigureScript.h"

BEGIN_VISP_NAMESPACE

using namespace vpFigureScript;

namespace
{
//! A band from the smallest to the largest lamp, behind all else; a line where they are one.
std::string band(double from, double to)
{
  const std::string low = vpNumberText(std::min(from, to)), high = vpNumberText(std::max(from, to));
  if (low == high) {
    return "set arrow from " + low + ", graph 0 to " + low + ", graph 1 nohead lw 2" + colour(grey) + "\n";
  }
  return "set object rectangle from " + low + ", graph 0 to " + high +
         ", graph 1 behind fc rgb '#eef1f5' fs solid noborder\n";
}
} // namespace

vpFigure vpCapacityFigure(const std::vector<vpCapacityCurve> &curves, const std::vector<double> &lamps)
{
  static const std::array<const char *, 5> colours = {blue, red, green, orange, dark};
  vpFigure figure;
  figure.name = "capacity";
  figure.caption = "Identifiers that a rig tells apart, by the lines that a lamp has in the picture.";
  std::vector<std::string> plots;
  double first = INFINITY, last = 0;
  for (size_t i = 0; i < curves.size(); ++i) {
    std::string rows;
    for (const vpCapacityCurve::Point &point : curves[i].points) {
      if (point.identifiers > 0) {
        rows += row({point.lines, point.identifiers});
        first = std::min(first, point.lines);
        last = std::max(last, point.lines);
      }
    }
    if (rows.empty()) {
      continue;
    }
    const std::string name = "curve" + std::to_string(i);
    figure.body += block(name, rows);
    plots.push_back("$" + name + " with lines lw 2.4" + (curves[i].dashed ? " dt 2" : "") +
                    colour(curves[i].dashed ? grey : colours[i % colours.size()]) + title(curves[i].name));
  }
  if (plots.empty()) {
    plots.emplace_back("1 notitle");
    last = first = 1;
  }
  figure.body += range("x", 0.95 * first, 1.02 * last) + "set yrange [1:*]\nset logscale y\n" +
                 axisLabel("x", "lines of the lamp in the picture") + axisLabel("y", "identifiers") +
                 "set key vertical\n";
  if (!lamps.empty()) {
    figure.body += band(lamps.front(), lamps.back());
    figure.caption += " Shaded: lamps as far as they will hang.";
  }
  figure.body += joined(plots);
  return figure;
}

END_VISP_NAMESPACE
