/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpServoTracks.h"

#include <visp3/vlp_evaluation/vpErrorStatistics.h>

#include "common/vpTextBlock.h"

BEGIN_VISP_NAMESPACE

namespace
{
std::vector<std::string> rowOf(const std::string &name, const std::vector<vpTrackError> &errors)
{
  std::vector<double> across, heading;
  for (const vpTrackError &error : errors) {
    across.push_back(1000 * error.across);
    if (!error.turning) {
      heading.push_back(error.heading * 180 / M_PI);
    }
  }
  const vpErrorStatistics off = vpErrorStatistics::of(across), turned = vpErrorStatistics::of(heading);
  return {name,
          vpFormat("%.2f", off.rmse),
          vpFormat("%.2f", off.percentile95),
          vpFormat("%.2f", off.largest),
          vpFormat("%.3f", turned.rmse),
          vpFormat("%.3f", turned.largest)};
}

std::vector<Eigen::Vector2d> trackOf(const vpServoLog &log)
{
  std::vector<Eigen::Vector2d> places;
  if (!log.truth.empty()) {
    for (const vpTimedPose &pose : log.truth.poses()) {
      places.emplace_back(pose.wMb[0][3], pose.wMb[1][3]);
    }
    return places;
  }
  for (const vpServoStep &step : log.run.steps) {
    if (step.located) {
      places.emplace_back(step.wMb[0][3], step.wMb[1][3]);
    }
  }
  return places;
}
} // namespace

vpReportTable vpTrackErrorTable(const std::vector<vpNamedServoLog> &runs)
{
  vpReportTable table;
  table.heading = "Off the path";
  table.columns = {"", "RMS, mm", "95 %, mm", "max, mm", "heading RMS, deg", "max, deg"};
  for (const auto &[name, log] : runs) {
    if (const std::vector<vpTrackError> errors = log.trueErrors(); !errors.empty()) {
      table.rows.push_back(rowOf(name + ", true", errors));
    }
    if (const std::vector<vpTrackError> errors = log.estimatedErrors(); !errors.empty()) {
      table.rows.push_back(rowOf(name + ", as estimated", errors));
    }
  }
  table.note = "Across the path, while the reference moves; headings without turns on the spot.";
  return table;
}

vpFigure vpServoTracksFigure(const std::string &name, const vpPath &path,
                             const std::vector<vpNamedServoLog> &runs)
{
  constexpr int steps = 1000;
  vpNamedTrack wanted{"path", {}};
  for (int i = 0; i <= steps; ++i) {
    wanted.places.push_back(path.at(i * path.length() / steps).place);
  }
  std::vector<vpNamedTrack> tracks;
  std::string caption;
  for (const auto &[run, log] : runs) {
    tracks.push_back({run, trackOf(log)});
    caption += (caption.empty() ? "" : ", ") + run + (log.truth.empty() ? " (as estimated)" : "");
  }
  return vpTracksFigure(name, "The path and the tracks on it: " + caption + ".", wanted, tracks);
}

END_VISP_NAMESPACE
