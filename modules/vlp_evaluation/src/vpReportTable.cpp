/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_evaluation/vpReportTable.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <visp3/vlp_core/vpPrintable.h>

BEGIN_VISP_NAMESPACE

namespace
{
std::string number(const char *format, double value)
{
  constexpr double largest = 1e12; // beyond it digits say nothing
  std::array<char, 64> buffer;
  std::snprintf(buffer.data(), buffer.size(), std::abs(value) < largest ? format : "%.6g", value);
  const bool zero =
      buffer[0] == '-' && std::string(buffer.data()).find_first_of("123456789") == std::string::npos;
  return zero ? buffer.data() + 1 : buffer.data(); // no -0.000
}

std::string millimetres(double metres)
{
  return number("%.3f", 1000 * metres);
}

std::vector<std::string> errorRow(const std::string &name, const char *format, double scale,
                                  const vpErrorStatistics &errors)
{
  std::vector<std::string> cells = {name};
  for (const double value : {errors.mean, errors.median, errors.rmse, errors.deviation, errors.percentile90,
                             errors.percentile95, errors.largest}) {
    cells.push_back(number(format, scale * value));
  }
  return cells;
}

vpReportTable errorTable(const vpEvaluation &evaluation)
{
  vpReportTable table;
  table.heading = "Errors";
  table.columns = {"", "mean", "median", "RMSE", "std dev", "90 %", "95 %", "max"};
  constexpr double mm = 1000, degrees = 180 / M_PI;
  table.rows = {errorRow("horizontal (mm)", "%.3f", mm, evaluation.horizontal),
                errorRow("x (mm)", "%.3f", mm, evaluation.x), errorRow("y (mm)", "%.3f", mm, evaluation.y),
                errorRow("z (mm)", "%.3f", mm, evaluation.z),
                errorRow("yaw (deg)", "%.4f", degrees, evaluation.yaw)};
  if (evaluation.line) {
    table.rows.push_back(errorRow("from the line (mm)", "%.3f", mm, evaluation.lineDistance));
  }
  table.note = "Errors are estimate minus truth at the same time; 90 %, 95 % and max are of magnitudes.";
  return table;
}

vpReportTable dispersionTable(const vpEvaluation &evaluation)
{
  const vpDispersion &dispersion = evaluation.dispersion;
  vpReportTable table;
  table.heading = "Dispersion of the horizontal error";
  table.columns = {"", "mm"};
  table.rows = {{"farthest pair (the paper's diameter)", millimetres(dispersion.diameter())},
                {"half of it (the paper's dispersion radius)", millimetres(dispersion.radius())},
                {"radius of the smallest circle that holds all", millimetres(dispersion.circleRadius)},
                {"its middle in x", millimetres(dispersion.centre.x())},
                {"its middle in y", millimetres(dispersion.centre.y())}};
  return table;
}

vpReportTable lineTable(const vpEvaluation &evaluation)
{
  const auto point = [](const Eigen::Vector2d &p) {
    return "(" + number("%.2f", 100 * p.x()) + ", " + number("%.2f", 100 * p.y()) + ")";
  };
  vpReportTable table;
  table.heading = "Line";
  table.columns = {"", "x, y in cm"};
  table.rows = {{"from, to", point(evaluation.line->start()) + " to " + point(evaluation.line->end())}};
  if (evaluation.fitted) {
    table.rows.push_back({"fitted to the estimate", evaluation.fitted->textInCentimetres()});
  }
  return table;
}

vpReportTable frameTable(const vpFixStatistics &fixes)
{
  vpReportTable table;
  table.heading = "Frames and time per fix";
  table.columns = {"", ""};
  table.rows = {
      {"frames", std::to_string(fixes.frames)},
      {"with a fix", std::to_string(fixes.fixes) + " (" + number("%.1f", 100 * fixes.share()) + " %)"},
      {"ambiguous", std::to_string(fixes.ambiguous)},
      {"mean time", number("%.1f", 1000 * fixes.compute.mean) + " ms"},
      {"median time", number("%.1f", 1000 * fixes.compute.median) + " ms"},
      {"95 % of the times below", number("%.1f", 1000 * fixes.compute.percentile95) + " ms"},
      {"longest time", number("%.1f", 1000 * fixes.compute.largest) + " ms"}};
  return table;
}

vpReportTable consistencyTable(const vpFixStatistics &fixes)
{
  vpReportTable table;
  table.heading = "Consistency (NEES)";
  table.columns = {"", "count", "mean", "expected", "95 % interval of the mean", "within the 95 % bound"};
  const auto add = [&table](const std::string &name, const vpConsistency &consistency) {
    if (consistency.count() > 0) {
      table.rows.push_back(
          {name, std::to_string(consistency.count()), number("%.3f", consistency.mean()),
           std::to_string(consistency.dimension()),
           number("%.3f", consistency.lower()) + " to " + number("%.3f", consistency.upper()),
           number("%.1f", 100 * consistency.shareWithin95()) + " %"});
    }
  };
  add("x, y", fixes.position);
  add("z", fixes.height);
  add("yaw", fixes.yaw);
  table.note =
      "A mean above the interval: the sigmas are too small; below it: too large. The interval is that "
      "of independent errors.";
  return table;
}

const char *alignmentText(vpAlignment alignment)
{
  switch (alignment) {
  case vpAlignment::origin:
    return "first pose on the first true one";
  case vpAlignment::se2:
    return "least squares in the plane, SE(2)";
  case vpAlignment::none:
    break;
  }
  return "none";
}

vpReportTable dataTable(const vpEvaluation &evaluation)
{
  vpReportTable table;
  table.heading = "Data";
  table.columns = {"", ""};
  table.rows = {{"poses of the truth", std::to_string(evaluation.truthPoses)},
                {"poses of the estimate", std::to_string(evaluation.estimatePoses)},
                {"of these held against the truth", std::to_string(evaluation.pairs.size())},
                {"outside the truth's time", std::to_string(evaluation.outside)},
                {"in gaps of the truth over " + number("%g", evaluation.longestGap) + " s",
                 std::to_string(evaluation.inGaps)},
                {"alignment", alignmentText(evaluation.alignment)}};
  return table;
}

//! Characters of UTF-8 text, each of which a terminal shows one column wide.
size_t widthOf(const std::string &text)
{
  return static_cast<size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}
} // namespace

std::string vpReportTable::text() const
{
  std::vector<std::vector<std::string>> lines = rows;
  const bool headed =
      std::any_of(columns.begin(), columns.end(), [](auto &column) { return !column.empty(); });
  if (headed) {
    lines.insert(lines.begin(), columns);
  }
  for (std::vector<std::string> &line : lines) {
    std::transform(line.begin(), line.end(), line.begin(), vpPrintable); // ids and names are among them
  }
  std::vector<size_t> widths(columns.size(), 0);
  for (const std::vector<std::string> &line : lines) {
    for (size_t i = 0; i < line.size(); ++i) {
      widths[i] = std::max(widths[i], widthOf(line[i]));
    }
  }
  std::string text = vpPrintable(heading) + "\n";
  for (const std::vector<std::string> &line : lines) {
    text += "  " + line[0] + std::string(widths[0] - widthOf(line[0]), ' ');
    for (size_t i = 1; i < line.size(); ++i) {
      text += "  " + std::string(widths[i] - widthOf(line[i]), ' ') + line[i];
    }
    text += "\n";
  }
  return note.empty() ? text : text + "  " + note + "\n";
}

std::vector<vpReportTable> vpTablesOf(const vpEvaluation &evaluation)
{
  std::vector<vpReportTable> tables = {dataTable(evaluation)};
  if (!evaluation.pairs.empty()) {
    tables.push_back(errorTable(evaluation));
    tables.push_back(dispersionTable(evaluation));
    if (evaluation.line) {
      tables.push_back(lineTable(evaluation));
    }
  }
  if (evaluation.fixes && evaluation.fixes->frames > 0) {
    tables.push_back(frameTable(*evaluation.fixes));
    const vpReportTable consistency = consistencyTable(*evaluation.fixes);
    if (!consistency.rows.empty()) {
      tables.push_back(consistency);
    }
  }
  return tables;
}

END_VISP_NAMESPACE
