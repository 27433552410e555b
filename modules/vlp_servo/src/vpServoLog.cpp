/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_servo/vpServoLog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpAtomicFile.h>
#include <visp3/vlp_core/vpCsvTable.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpPoseText.h>

BEGIN_VISP_NAMESPACE

namespace
{
//! Columns of commands.csv.
struct Column {
  enum {
    time,
    v,
    w,
    lawV,
    lawW,
    share,
    referenceS,
    referenceV,
    referenceHeading,
    turning,
    x,
    y,
    yaw,
    sigma,
    waiting
  };
};

std::vector<std::string> columnNames()
{
  std::vector<std::string> names;
  std::istringstream header(vpServoLog::columns);
  for (std::string name; std::getline(header, name, ',');) {
    names.push_back(name);
  }
  return names;
}

std::string fileOf(const std::string &folder, const char *name)
{
  return (std::filesystem::path(folder) / name).string();
}

std::string rowOf(const vpServoStep &step)
{
  std::string row;
  for (const double value :
       {step.time, step.told.v, step.told.w, step.wanted.v, step.wanted.w, step.share, step.reference.s,
        step.reference.v, step.reference.heading, step.reference.turning ? 1.0 : 0.0}) {
    row += vpNumberText(value) + ",";
  }
  if (step.located) {
    for (const double value :
         {step.wMb[0][3], step.wMb[1][3], std::atan2(step.wMb[1][0], step.wMb[0][0]), step.sigma}) {
      row += vpNumberText(value) + ",";
    }
  } else {
    row += ",,,,";
  }
  return row + vpCsvTable::field(step.waiting) + "\n";
}

vpServoStep stepOf(const vpCsvTable &table, size_t row)
{
  vpServoStep step;
  step.time = table.number(row, Column::time);
  step.told = {table.number(row, Column::v), table.number(row, Column::w)};
  step.wanted = {table.number(row, Column::lawV), table.number(row, Column::lawW)};
  step.share = table.number(row, Column::share);
  step.reference.s = table.number(row, Column::referenceS);
  step.reference.v = table.number(row, Column::referenceV);
  step.reference.heading = table.number(row, Column::referenceHeading);
  step.reference.turning = table.number(row, Column::turning) != 0;
  step.located = !table.text(row, Column::x).empty();
  if (step.located) {
    step.wMb = vpPoseOf(Eigen::Vector3d(table.number(row, Column::x), table.number(row, Column::y), 0),
                        Eigen::Vector3d(0, 0, table.number(row, Column::yaw)));
    step.sigma = table.number(row, Column::sigma);
  }
  step.waiting = table.text(row, Column::waiting);
  return step;
}
} // namespace

const std::string vpServoLog::columns = "timestamp_s,v_m_s,w_rad_s,law_v_m_s,law_w_rad_s,share,reference_s_m,"
                                        "reference_v_m_s,reference_heading_rad,turning,x_m,y_m,"
                                        "yaw_rad,sigma_m,waiting";

void vpServoLog::save(const std::string &folder) const
{
  path.save(fileOf(folder, "path.yaml"));
  vpAtomicFile commands(fileOf(folder, "commands.csv"));
  commands.stream() << columns << "\n";
  for (const vpServoStep &step : run.steps) {
    commands.stream() << rowOf(step);
  }
  commands.commit();
  vpWriteOdometry(fileOf(folder, "odometry.csv"), run.odometry);
  poses.save(fileOf(folder, "poses.tum"));
  if (!truth.empty()) {
    truth.save(fileOf(folder, "truth.tum"));
  }
}

vpServoLog vpServoLog::load(const std::string &folder)
{
  vpServoLog log{vpPath::load(fileOf(folder, "path.yaml")), {}, {}, {}};
  const vpCsvTable table = vpCsvTable::load(fileOf(folder, "commands.csv"), columnNames());
  for (size_t row = 0; row < table.rows(); ++row) {
    log.run.steps.push_back(stepOf(table, row));
    if (row > 0 && !(log.run.steps[row].time > log.run.steps[row - 1].time)) {
      table.fail(row, Column::time, "expected a time after that of the line above");
    }
  }
  log.poses = vpTrajectory::load(fileOf(folder, "poses.tum"));
  if (std::filesystem::exists(fileOf(folder, "truth.tum"))) {
    log.truth = vpTrajectory::load(fileOf(folder, "truth.tum"));
  }
  return log;
}

std::vector<vpTrackError> vpServoLog::trueErrors() const
{
  if (truth.empty()) {
    return {};
  }
  vpServoRun known; // the truth may end before the run
  for (const vpServoStep &step : run.steps) {
    if (truth.at(step.time)) {
      known.steps.push_back(step);
    }
  }
  return vpTrackErrorsOf(path, known, [this](double when) { return *truth.at(when); });
}

END_VISP_NAMESPACE
