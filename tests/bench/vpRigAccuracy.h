/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpRigAccuracy_h
#define vpRigAccuracy_h

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <visp3/vlp_evaluation/vpDispersion.h>
#include <visp3/vlp_localization/vpManyLampSolver.h>

#include "vlp_calibration/calibrationRun.h"

//! How well a rig and a map of lamps locate, beside the truth.
namespace vpRigAccuracy
{
//! Turn and shift in the plane that lays \e map on \e truth best, applied to a point.
inline std::function<Eigen::Vector2d(const Eigen::Vector2d &)> aligned(const vpLampMap &map,
                                                                       const vpLampMap &truth)
{
  const auto count = static_cast<double>(map.lamps.size());
  Eigen::Vector2d from(0, 0), to(0, 0);
  for (size_t k = 0; k < map.lamps.size(); ++k) {
    from += map.lamps[k].position.head<2>() / count;
    to += truth.lamps[k].position.head<2>() / count;
  }
  double along = 0, across = 0;
  for (size_t k = 0; k < map.lamps.size(); ++k) {
    const Eigen::Vector2d a = map.lamps[k].position.head<2>() - from,
                          b = truth.lamps[k].position.head<2>() - to;
    along += a.dot(b);
    across += a.x() * b.y() - a.y() * b.x();
  }
  const Eigen::Rotation2Dd turn(std::atan2(across, along));
  return [=](const Eigen::Vector2d &point) { return Eigen::Vector2d(to + turn * (point - from)); };
}

//! How well rig and map locate: mean error over 36 points, and dispersion radius of a robot that turns on one
//! spot.
struct Located {
  double error = 0, radius = 0; // mm
};

inline Located located(const calibrationRun::World &world, const vpVlpRig &rig, const vpLampMap &map,
                       std::mt19937_64 &random)
{
  std::normal_distribution<double> normal(0, world.noise);
  const auto align = aligned(map, world.map);
  const auto errorAt = [&](double x, double y, double yaw, Eigen::Vector2d &error) {
    const vpHomogeneousMatrix wMb(vpTranslationVector(x, y, 0), vpRotationMatrix(0, 0, yaw));
    std::vector<vpLampSight> sights;
    for (size_t k = 0; k < map.lamps.size(); ++k) {
      Eigen::Vector2d pixel;
      if (calibrationRun::imageOf(world.rig, wMb, world.map.lamps[k].position, 0, pixel)) {
        vpLampObservation seen;
        seen.point = pixel + Eigen::Vector2d(normal(random), normal(random));
        seen.covariance = world.noise * world.noise * Eigen::Matrix2d::Identity();
        sights.push_back(vpLampSight::from(map.lamps[k], seen, rig.camera));
      }
    }
    const vpVlpFix fix = vpManyLampSolver().solve(sights, rig);
    error =
        fix.valid
            ? Eigen::Vector2d(align(Eigen::Vector2d(fix.wMb[0][3], fix.wMb[1][3])) - Eigen::Vector2d(x, y))
            : Eigen::Vector2d(1, 1);
  };
  Located result;
  Eigen::Vector2d error;
  for (int i = 0; i < 36; ++i) {
    errorAt(-0.4 + 0.16 * (i % 6), -0.4 + 0.16 * (i / 6), 0, error);
    result.error += 1000 * error.norm() / 36;
  }
  std::vector<Eigen::Vector2d> circle;
  for (int i = 0; i < 36; ++i) {
    errorAt(0, 0, 2 * M_PI * i / 36, error);
    circle.push_back(error);
  }
  result.radius = 1000 * vpDispersion::of(circle).radius();
  return result;
}
} // namespace vpRigAccuracy

#endif
