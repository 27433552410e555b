/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPlanPicture.h"

#include <algorithm>
#include <cmath>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_evaluation/vpCapacityFigure.h>

#include "common/vpInterrupt.h"
#include "common/vpProgressBar.h"

BEGIN_VISP_NAMESPACE

namespace
{
//! Sizes of a lamp to draw, even on a logarithmic scale, those of the rig's lamps among them.
std::vector<double> linesToDraw(const vpLedIdPlanner &planner, const std::vector<double> &lamps)
{
  static const double smallest = 15; // lines: five for each of three stripes
  static const int steps = 24;
  const double from = std::min(smallest, lamps.front());
  const double to = std::min(planner.prediction.pictureLines(), std::max(250., 1.3 * lamps.back()));
  std::vector<double> lines = lamps;
  for (int i = 0; i <= steps; ++i) {
    lines.push_back(from * std::pow(to / from, static_cast<double>(i) / steps));
  }
  std::sort(lines.begin(), lines.end());
  lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
  return lines;
}
} // namespace

std::string vpPlanPicture(const vpPlanOptions &options, const vpLedIdPlanner &planner,
                          const std::vector<double> &lamps, size_t words)
{
  static const double crystal = 50, rc = 10000; // ppm
  std::vector<double> oscillators = {options.oscillatorPpm};
  for (const double ppm : {crystal, rc}) {
    if (ppm != options.oscillatorPpm) {
      oscillators.push_back(ppm);
    }
  }
  std::vector<vpCapacityCurve> curves;
  for (const double ppm : oscillators) {
    const std::string kind = ppm == crystal ? "crystal, " : (ppm == rc ? "RC, " : "");
    curves.push_back({kind + vpNumberText(ppm) + " ppm", {}, false});
  }
  const double chips =
      options.format.bits * (options.format.code == vpModulation::Code::manchester ? 2. : 1.);
  const double wordLines = chips / (options.format.chipRate * planner.prediction.lineTime());
  if (options.words) {
    curves.push_back({"words", {}, false});
  }
  vpCapacityCurve others{"others: stripes counted, or FFT bins", {}, true};
  const std::vector<double> drawn = linesToDraw(planner, lamps);
  vpProgressBar progress(drawn.size());
  for (size_t i = 0; i < drawn.size(); ++i) {
    const double lines = drawn[i];
    const std::vector<size_t> counts = planner.capacities(lines, oscillators);
    for (size_t j = 0; j < counts.size(); ++j) {
      curves[j].points.push_back({lines, static_cast<double>(counts[j])});
    }
    if (options.words) {
      const bool shown = lines >= wordLines;
      curves.back().points.push_back({lines, shown ? static_cast<double>(words) : 0});
    }
    others.points.push_back({lines, static_cast<double>(planner.bins(lines))});
    progress.show(i + 1);
    if (vpInterrupt::requested()) {
      throw vpException(vpException::fatalError, "stopped, nothing was written");
    }
  }
  progress.clear();
  curves.push_back(others);
  return vpCapacityFigure(curves, lamps).png();
}

END_VISP_NAMESPACE
