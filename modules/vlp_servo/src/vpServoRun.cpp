/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_servo/vpServoRun.h>

#include <cmath>

BEGIN_VISP_NAMESPACE

namespace
{
vpTrackError errorOf(const vpPath &path, const vpServoStep &step, double end, const vpHomogeneousMatrix &wMb)
{
  constexpr double reach = 0.3; // m along the path, either way
  const Eigen::Vector2d place(wMb[0][3], wMb[1][3]);
  vpTrackError error;
  error.time = step.time;
  error.s =
      path.closest(place, std::max(0.0, step.reference.s - reach), std::min(step.reference.s + reach, end));
  const vpPathPoint point = path.at(error.s);
  error.across = std::copysign((place - point.place).norm(), path.offset(place, error.s));
  // Of a polyline the closest place may lie on the leg beyond a corner already.
  const double heading = path.corners().empty() ? point.heading : step.reference.heading;
  error.heading = std::remainder(std::atan2(wMb[1][0], wMb[0][0]) - heading, 2 * M_PI);
  error.turning = step.reference.turning;
  return error;
}
} // namespace

std::vector<vpTrackError> vpTrackErrorsOf(const vpPath &path, const vpServoRun &run,
                                          const std::function<vpHomogeneousMatrix(double)> &wMb)
{
  std::vector<vpTrackError> errors;
  const double end = run.steps.empty() ? 0 : run.steps.back().reference.s;
  for (const vpServoStep &step : run.steps) {
    if (!errors.empty() || step.reference.v > 0) {
      errors.push_back(errorOf(path, step, end, wMb(step.time)));
    }
  }
  return errors;
}

std::vector<vpTrackError> vpTrackErrorsOf(const vpPath &path, const vpServoRun &run)
{
  std::vector<vpTrackError> errors;
  const double end = run.steps.empty() ? 0 : run.steps.back().reference.s;
  for (const vpServoStep &step : run.steps) {
    if (step.located && (!errors.empty() || step.reference.v > 0)) {
      errors.push_back(errorOf(path, step, end, step.wMb));
    }
  }
  return errors;
}

END_VISP_NAMESPACE
