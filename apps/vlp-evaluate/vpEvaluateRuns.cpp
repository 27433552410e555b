/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpEvaluateRuns.h"

#include <filesystem>
#include <iostream>

#include <spdlog/spdlog.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpReadFile.h>
#include <visp3/vlp_evaluation/vpGnuplot.h>
#include <visp3/vlp_evaluation/vpHtmlReport.h>

#include "common/vpInterrupt.h"
#include "common/vpServoTracks.h"
#include "vpEvaluateFolder.h"

BEGIN_VISP_NAMESPACE

namespace
{
namespace fs = std::filesystem;

//! Runs along one path.
struct Group {
  std::string path; // the bytes of its file
  std::vector<vpNamedServoLog> runs;
};

std::string nameOf(const std::string &folder)
{
  const fs::path path = fs::path(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

std::vector<Group> groupsOf(const std::vector<std::string> &folders)
{
  std::vector<Group> groups;
  for (const std::string &folder : folders) {
    const vpNamedServoLog run(nameOf(folder), vpServoLog::load(folder));
    const std::string path = vpReadFile((fs::path(folder) / "path.yaml").string());
    Group *group = nullptr;
    for (Group &other : groups) {
      group = other.path == path ? &other : group;
    }
    if (!group) {
      groups.push_back({path, {}});
      group = &groups.back();
    }
    group->runs.push_back(run);
  }
  return groups;
}
} // namespace

vpExitCode vpEvaluateRuns(const vpEvaluateOptions &options)
{
  vpInterrupt::install();
  const std::vector<Group> groups = groupsOf(options.runs);
  std::vector<vpNamedServoLog> all;
  for (const Group &group : groups) {
    all.insert(all.end(), group.runs.begin(), group.runs.end());
  }
  const vpReportTable table = vpTrackErrorTable(all);
  if (table.rows.empty()) {
    spdlog::error("--runs: none of them moved, nothing to evaluate");
    return vpExitCode::nothingFound;
  }
  if (!options.out.empty()) {
    vpGnuplot::check();
    vpEvaluateFolder folder(options.out);
    std::vector<vpReportFigure> figures;
    for (const Group &group : groups) {
      const std::string name = "tracks-" + std::to_string(figures.size() + 1);
      const vpFigure figure = vpServoTracksFigure(name, group.runs.front().second.path, group.runs);
      const std::string svg = figure.svg();
      folder.add(name + ".svg", svg);
      folder.add(name + ".png", figure.png());
      figures.push_back({name, figure.caption, svg});
    }
    std::vector<std::string> sources;
    for (const std::string &run : options.runs) {
      sources.push_back("Run: " + run);
    }
    folder.add("report.html", vpHtmlPage(options.title, sources, {}, figures, {table}));
    folder.write();
    spdlog::info(options.out + ": report.html and figures");
  }
  std::cout << table.text();
  return vpExitCode::done;
}

END_VISP_NAMESPACE
