/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpServoSummary.h"

#include <cmath>
#include <filesystem>
#include <iostream>

#include <spdlog/spdlog.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpAtomicFile.h>
#include <visp3/vlp_evaluation/vpGnuplot.h>
#include <visp3/vlp_evaluation/vpReportTable.h>

#include "common/vpServoTracks.h"
#include "common/vpTextBlock.h"

BEGIN_VISP_NAMESPACE

namespace
{
std::string percentileText(const std::vector<double> &values)
{
  return values.empty() ? "-"
                        : vpFormat("%.1f, %.1f, %.1f ms", 1e3 * vpPercentile(values, 0.5),
                                   1e3 * vpPercentile(values, 0.99), 1e3 * vpPercentile(values, 1));
}

vpReportTable loopTable(const vpServoLog &log, double period)
{
  const vpServoRun &run = log.run;
  const double seconds = static_cast<double>(run.steps.size()) * period;
  std::vector<double> toCommand, toPose, compute;
  for (const vpPictureDelay &picture : run.pictures) {
    compute.push_back(picture.compute);
    if (picture.fix) {
      toPose.push_back(picture.known - picture.timestamp);
      toCommand.push_back(picture.command - picture.timestamp);
    }
  }
  size_t waited = 0;
  for (const vpServoStep &step : run.steps) {
    waited += step.share == 0;
  }
  vpReportTable table;
  table.heading = "Loop";
  table.columns = {"", ""};
  table.rows = {
      {"time", vpFormat("%.2f s", seconds)},
      {"of it standing for safety", vpFormat("%.2f s", static_cast<double>(waited) * period)},
      {"periods", vpFormat("%zu of %g ms, %zu begun late", run.steps.size(), 1e3 * period, run.missed)},
      {"pictures", vpFormat("%zu, %zu with a pose", run.pictures.size(), toCommand.size())},
      {"poses per second",
       vpFormat("%.2f", static_cast<double>(toCommand.size()) / std::max(seconds, period))},
      {"picture to pose: median, 99 %, longest", percentileText(toPose)},
      {"picture to command: median, 99 %, longest", percentileText(toCommand)},
      {"of it the localizer: median, 99 %, longest", percentileText(compute)}};
  table.note = "A picture's time is the beginning of its first line's exposure.";
  return table;
}
} // namespace

void vpPrintServoSummary(const vpServoLog &log, double period)
{
  std::cout << vpTrackErrorTable({{"this run", log}}).text() << "\n" << loopTable(log, period).text();
}

void vpDrawServoTracks(const vpServoLog &log, const std::string &folder)
{
  try {
    vpGnuplot::check();
  } catch (const vpException &error) {
    spdlog::warn("no picture of the track: {}", error.getStringMessage());
    return;
  }
  const vpFigure figure = vpServoTracksFigure("track", log.path, {{"this run", log}});
  for (const auto &[ending, bytes] :
       {std::make_pair(".svg", figure.svg()), std::make_pair(".png", figure.png())}) {
    vpAtomicFile file((std::filesystem::path(folder) / (figure.name + ending)).string());
    file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.commit();
  }
}

END_VISP_NAMESPACE
