/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_evaluation/vpFixLog.h>

#include <algorithm>
#include <cmath>
#include <map>

#include <visp3/vlp_core/vpCsvTable.h>
#include <visp3/vlp_core/vpPoseText.h>

BEGIN_VISP_NAMESPACE

namespace
{
enum Column : size_t {
  timestamp,
  x,
  roll = 4,
  sigmaX = 7,
  sigmaY,
  sigmaZ,
  sigmaYaw,
  covXY,
  state = 13,
  compute
};

//! A sigma of 0 or more, or NaN where the field is empty.
double sigmaOf(const vpCsvTable &table, size_t row, size_t column)
{
  if (table.text(row, column).empty()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double sigma = table.number(row, column);
  if (sigma < 0) {
    table.fail(row, column, "expected a number of 0 or more");
  }
  return sigma;
}

vpLoggedFix::State stateOf(const vpCsvTable &table, size_t row)
{
  using State = vpLoggedFix::State;
  static const std::map<std::string, State> states = {{"fix", State::fix},
                                                      {"tracking", State::tracking},
                                                      {"coasting", State::coasting},
                                                      {"relocated", State::relocated},
                                                      {"ambiguous", State::ambiguous},
                                                      {"none", State::none}};
  const auto found = states.find(table.text(row, state));
  if (found == states.end()) {
    table.fail(row, state, "expected fix, tracking, coasting, relocated, ambiguous or none");
  }
  return found->second;
}

void readPose(const vpCsvTable &table, size_t row, vpLoggedFix &fix)
{
  Eigen::Vector3d position, angles;
  for (int i = 0; i < 3; ++i) {
    position[i] = table.number(row, x + static_cast<size_t>(i));
    angles[i] = table.number(row, roll + static_cast<size_t>(i));
  }
  fix.wMb = vpPoseOf(position, angles);
  fix.sigmaX = sigmaOf(table, row, sigmaX);
  fix.sigmaY = sigmaOf(table, row, sigmaY);
  fix.sigmaZ = sigmaOf(table, row, sigmaZ);
  fix.sigmaYaw = sigmaOf(table, row, sigmaYaw);
  if (table.text(row, covXY).empty()) {
    return;
  }
  fix.covXY = table.number(row, covXY);
  if (std::abs(fix.covXY) > fix.sigmaX * fix.sigmaY) { // never where a sigma is missing
    table.fail(row, covXY, "expected a magnitude of no more than sigma_x sigma_y");
  }
}
} // namespace

const std::vector<std::string> &vpFixLog::columns()
{
  static const std::vector<std::string> names = {"timestamp_s", "x",      "y",       "z",       "roll",
                                                 "pitch",       "yaw",    "sigma_x", "sigma_y", "sigma_z",
                                                 "sigma_yaw",   "cov_xy", "lamps",   "state",   "compute_s"};
  return names;
}

vpFixLog vpFixLog::load(const std::string &filename)
{
  const vpCsvTable table = vpCsvTable::load(filename, columns());
  vpFixLog log;
  for (size_t row = 0; row < table.rows(); ++row) {
    vpLoggedFix fix;
    fix.timestamp = table.number(row, timestamp);
    fix.state = stateOf(table, row);
    if (fix.state != vpLoggedFix::State::none) {
      readPose(table, row, fix);
    }
    for (size_t column = x; fix.state == vpLoggedFix::State::none && column <= covXY; ++column) {
      if (!table.text(row, column).empty()) {
        table.fail(row, column, "expected nothing, since state is none");
      }
    }
    fix.compute = table.number(row, compute);
    if (fix.compute < 0) {
      table.fail(row, compute, "expected a number of 0 or more");
    }
    log.fixes.push_back(fix);
  }
  return log;
}

size_t vpFixLog::count() const
{
  return static_cast<size_t>(
      std::count_if(fixes.begin(), fixes.end(), [](const vpLoggedFix &fix) { return fix.hasPosition(); }));
}

vpTrajectory vpFixLog::trajectory() const
{
  vpTrajectory trajectory;
  for (const vpLoggedFix &fix : fixes) {
    if (fix.hasPosition() && (trajectory.empty() || fix.timestamp > trajectory.poses().back().timestamp)) {
      trajectory.add(fix.timestamp, fix.wMb);
    }
  }
  return trajectory;
}

END_VISP_NAMESPACE
