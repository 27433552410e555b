/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef madeTracks_h
#define madeTracks_h

#include <cmath>
#include <random>

#include <visp3/vlp_core/vpPoseText.h>
#include <visp3/vlp_evaluation/vpFixLog.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

//! Trajectories made for tests. m, rad, s.
namespace madeTracks
{
inline vpHomogeneousMatrix pose(double x, double y, double yaw, double z = 0)
{
  return vpPoseOf(Eigen::Vector3d(x, y, z), Eigen::Vector3d(0, 0, yaw));
}

inline Eigen::Vector2d positionOf(const vpHomogeneousMatrix &wMb)
{
  return {wMb[0][3], wMb[1][3]};
}

//! Once around an eight, yaw along the way, ten poses a second.
inline vpTrajectory eight(size_t poses = 200)
{
  vpTrajectory trajectory;
  for (size_t i = 0; i < poses; ++i) {
    const double a = 2 * M_PI * static_cast<double>(i) / static_cast<double>(poses);
    trajectory.add(0.1 * static_cast<double>(i), pose(0.5 * std::sin(a), 0.3 * std::sin(2 * a),
                                                      std::atan2(0.6 * std::cos(2 * a), 0.5 * std::cos(a))));
  }
  return trajectory;
}

//! Evenly along a line.
inline vpTrajectory straight(const Eigen::Vector2d &from, const Eigen::Vector2d &to, size_t poses = 100)
{
  vpTrajectory trajectory;
  for (size_t i = 0; i < poses; ++i) {
    const Eigen::Vector2d p = from + static_cast<double>(i) / static_cast<double>(poses - 1) * (to - from);
    trajectory.add(0.1 * static_cast<double>(i), pose(p.x(), p.y(), 0));
  }
  return trajectory;
}

//! Fixes of a track whose errors are drawn with the covariance that they state, times a factor.
inline vpFixLog drawnFixes(const vpTrajectory &truth, double factor, unsigned int seed)
{
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  vpFixLog log;
  for (const vpTimedPose &at : truth.poses()) {
    const double sx = 0.002, sy = 0.003, sz = 0.001, syaw = 0.004, correlation = 0.6;
    const double a = normal(random), b = normal(random);
    vpLoggedFix fix;
    fix.timestamp = at.timestamp;
    fix.state = vpLoggedFix::State::fix;
    fix.wMb =
        pose(at.wMb[0][3] + factor * sx * a,
             at.wMb[1][3] + factor * sy * (correlation * a + std::sqrt(1 - correlation * correlation) * b),
             vpRollPitchYaw(at.wMb).z() + factor * syaw * normal(random), factor * sz * normal(random));
    fix.sigmaX = sx;
    fix.sigmaY = sy;
    fix.sigmaZ = sz;
    fix.sigmaYaw = syaw;
    fix.covXY = correlation * sx * sy;
    fix.compute = 0.03;
    log.fixes.push_back(fix);
  }
  return log;
}
} // namespace madeTracks

#endif
