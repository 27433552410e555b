/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpEvaluateOptions.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include <CLI/CLI.hpp>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "common/vpCommandLine.h"
#include "common/vpProgram.h"

BEGIN_VISP_NAMESPACE

namespace
{
const char *const description =
    "Holds an estimated trajectory against the true one: errors, dispersion, figures, a report.\n";

const char *const footer = R"(
Examples:
  vlp-evaluate --truth truth.tum --estimate poses.tum
  vlp-evaluate --truth truth.tum --fixes fixes.csv --out report --title 'Run A'
  vlp-evaluate --truth truth.tum --estimate poses.tum --line -0.35,0,0.35,-0.005
  vlp-evaluate --runs line-a line-a-odometry --out report

Inputs:
  truth, estimate  TUM: timestamp tx ty tz qx qy qz qw (s, m), times increasing, # begins a comment
  fixes            as vlp-locate --fixes writes them; rows whose state is none or ambiguous are no position
  runs             log folders of vlp-servo: how far each was off its path, truly where it is simulated, and
                   as estimated; runs along the same path are drawn in one map
Each pose is held against the truth interpolated to its time, never beyond the truth's ends.
Errors are estimate minus truth. A percentile is linear between the two sorted values around it; 90 %, 95 %
and max are of magnitudes. The dispersion is that of the horizontal errors: for a robot that stands still
the paper's. The consistency (NEES) needs fixes, and no alignment.

The folder --out gets report.html (one page with everything), statistics.csv (name,unit,value; m, rad, s) and
scatter, track, pmf, cdf, error-over-time as .png and .svg, drawn by gnuplot.

Exit code: 0 done; 2 bad usage or bad input; 3 nothing to evaluate: no poses, or none at a time of the truth.
)";

//! x1,y1,x2,y2 in metres.
vpTrackLine lineOf(const std::string &text)
{
  const std::vector<double> values = vpNumbersOf("--line", text, 4, "four numbers x1,y1,x2,y2 (m)");
  if (std::hypot(values[2] - values[0], values[3] - values[1]) < 1e-6) {
    vpBadInput("--line: " + vpShown(text) + ", expected two different points");
  }
  return vpTrackLine({values[0], values[1]}, {values[2], values[3]});
}
} // namespace

bool vpEvaluateOptions::parse(int argc, char **argv)
{
  CLI::App app(description, "vlp-evaluate");
  app.footer(footer);
  app.get_formatter()->column_width(28);
  std::string alignment = "none", line, gap;
  vpAddName(app, "--truth", truth, "FILE", "the true poses, TUM");
  vpAddName(app, "--estimate", estimate, "FILE", "the poses to evaluate, TUM; default: those of --fixes");
  vpAddName(app, "--fixes", fixes, "FILE", "the same run's fixes: time per fix, consistency");
  vpAddChoice(app, "--align", alignment, {"none", "origin", "se2"},
              "lay the estimate on the truth first: not (default), by the first pose, by least squares");
  app.add_option("--runs", runs, "instead: set runs of vlp-servo (its log folders) side by side")
      ->type_name("DIR");
  vpAddName(app, "--line", line, "X1,Y1,X2,Y2",
            "the line (m) that the robot was to drive; default: the truth's, where that is straight");
  vpAddName(app, "--max-gap", gap, "S", "longest gap of the truth to interpolate over (default 1 s)");
  vpAddName(app, "--out", out, "DIR", "write report, statistics and figures");
  vpAddName(app, "--title", title, "TEXT", "of the report; default: the estimate's name");
  if (!vpParseCommandLine(app, argc, argv)) {
    return false;
  }
  if (!runs.empty()) {
    if (!truth.empty() || !poses().empty() || !line.empty() || !gap.empty() || alignment != "none") {
      vpBadInput("--runs: beside other options, expected with it only --out and --title");
    }
    title = title.empty() ? "Runs of vlp-servo" : title;
    return true;
  }
  if (truth.empty()) {
    vpBadInput("--truth: nothing, expected the file of the true poses (--help explains the options)");
  }
  if (estimate.empty() && fixes.empty()) {
    vpBadInput("--estimate: nothing, expected the file of the poses to evaluate, or --fixes");
  }
  settings.alignment = alignment == "origin" ? vpAlignment::origin
                                             : (alignment == "se2" ? vpAlignment::se2 : vpAlignment::none);
  if (!line.empty()) {
    settings.line = lineOf(line);
  }
  if (!gap.empty() && (!vpParseNumber(gap, settings.longestGap) || !std::isfinite(settings.longestGap) ||
                       settings.longestGap <= 0)) {
    vpBadInput("--max-gap: " + vpShown(gap) + ", expected a number of seconds above 0");
  }
  title = title.empty() ? std::filesystem::path(poses()).filename().string() : title;
  return true;
}

END_VISP_NAMESPACE
