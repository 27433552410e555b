/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpEvaluate.h"

#include <iostream>
#include <optional>

#include <spdlog/spdlog.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_evaluation/vpEvaluationFigures.h>
#include <visp3/vlp_evaluation/vpGnuplot.h>
#include <visp3/vlp_evaluation/vpHtmlReport.h>
#include <visp3/vlp_evaluation/vpReportTable.h>

#include "common/vpInterrupt.h"
#include "common/vpProgressBar.h"
#include "vpEvaluateFolder.h"
#include "vpEvaluateRuns.h"

BEGIN_VISP_NAMESPACE

namespace
{
//! Why there is nothing to evaluate, or empty.
std::string emptiness(const vpEvaluateOptions &options, const vpEvaluation &evaluation)
{
  if (evaluation.truthPoses == 0) {
    return options.truth + ": no poses, nothing to evaluate against";
  }
  if (evaluation.estimatePoses == 0) {
    return options.poses() + ": no poses, nothing to evaluate" +
           (evaluation.fixes && options.estimate.empty()
                ? " (" + std::to_string(evaluation.fixes->frames) + " frames, none with a fix)"
                : "");
  }
  if (!evaluation.pairs.empty()) {
    return "";
  }
  return options.poses() + ": none of the " + std::to_string(evaluation.estimatePoses) +
         " poses is at a time of the truth: " + std::to_string(evaluation.outside) + " outside " +
         vpNumberText(evaluation.truth.poses().front().timestamp) + " to " +
         vpNumberText(evaluation.truth.poses().back().timestamp) + " s, " +
         std::to_string(evaluation.inGaps) + " in gaps of the truth longer than " +
         vpNumberText(evaluation.longestGap) + " s (--max-gap)";
}

void print(const vpEvaluation &evaluation)
{
  bool first = true;
  for (const vpReportTable &table : vpTablesOf(evaluation)) {
    std::cout << (first ? "" : "\n") << table.text();
    first = false;
  }
}

std::vector<std::string> sources(const vpEvaluateOptions &options)
{
  std::vector<std::string> lines = {"Truth: " + options.truth};
  if (!options.estimate.empty()) {
    lines.push_back("Estimate: " + options.estimate);
  }
  if (!options.fixes.empty()) {
    lines.push_back("Fixes: " + options.fixes);
  }
  return lines;
}

void writeReport(const vpEvaluateOptions &options, const vpEvaluation &evaluation, vpEvaluateFolder &folder)
{
  const std::vector<vpFigure> figures = vpFiguresOf(evaluation);
  std::vector<vpReportFigure> shown;
  vpProgressBar progress(figures.size());
  for (const vpFigure &figure : figures) {
    const std::string svg = figure.svg();
    folder.add(figure.name + ".svg", svg);
    folder.add(figure.name + ".png", figure.png());
    shown.push_back({figure.name, figure.caption, svg});
    progress.show(shown.size());
    if (vpInterrupt::requested()) {
      throw vpException(vpException::fatalError, "stopped, nothing was written");
    }
  }
  folder.add("statistics.csv", evaluation.csv());
  folder.add("report.html", vpHtmlReport(options.title, sources(options), evaluation, shown));
  folder.write();
}
} // namespace

vpExitCode vpEvaluate(const vpEvaluateOptions &options)
{
  if (!options.runs.empty()) {
    return vpEvaluateRuns(options);
  }
  vpInterrupt::install();
  const vpTrajectory truth = vpTrajectory::load(options.truth);
  const std::optional<vpFixLog> log =
      options.fixes.empty() ? std::nullopt : std::make_optional(vpFixLog::load(options.fixes));
  const vpTrajectory estimate =
      options.estimate.empty() ? log->trajectory() : vpTrajectory::load(options.estimate);
  const vpEvaluation evaluation = vpEvaluation::of(truth, estimate, log ? &*log : nullptr, options.settings);

  if (const std::string reason = emptiness(options, evaluation); !reason.empty()) {
    spdlog::error(reason);
    return vpExitCode::nothingFound;
  }
  if (options.out.empty()) {
    print(evaluation);
    return vpExitCode::done;
  }
  vpGnuplot::check();
  vpEvaluateFolder folder(options.out);
  writeReport(options, evaluation, folder);
  print(evaluation);
  spdlog::info(options.out + ": report.html, statistics.csv and figures");
  return vpExitCode::done;
}

END_VISP_NAMESPACE
