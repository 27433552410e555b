/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_evaluation/vpPosePairs.h>

#include <cmath>

#include <visp3/vlp_core/vpPoseText.h>

BEGIN_VISP_NAMESPACE

namespace
{
using Eigen::Vector2d;
using Eigen::Vector3d;

Vector2d positionOf(const vpHomogeneousMatrix &pose)
{
  return {pose[0][3], pose[1][3]};
}

vpHomogeneousMatrix leastSquares(const std::vector<vpPosePair> &pairs)
{
  const auto n = static_cast<double>(pairs.size());
  Vector2d estimated = Vector2d::Zero(), trueMean = Vector2d::Zero();
  for (const vpPosePair &pair : pairs) {
    estimated += positionOf(pair.estimate) / n;
    trueMean += positionOf(pair.truth) / n;
  }
  double along = 0, across = 0, spread = 0;
  for (const vpPosePair &pair : pairs) {
    const Vector2d e = positionOf(pair.estimate) - estimated, t = positionOf(pair.truth) - trueMean;
    along += e.dot(t);
    across += e.x() * t.y() - e.y() * t.x();
    spread += e.norm() * t.norm();
  }
  const double rounding = 1e-12 * (estimated.norm() + trueMean.norm());
  const bool turns = spread > n * rounding * rounding && std::hypot(along, across) > 1e-12 * spread;
  const double yaw = turns ? std::atan2(across, along) : 0;
  Vector3d shift = Vector3d::Zero();
  shift.head<2>() = trueMean - Eigen::Rotation2Dd(yaw) * estimated;
  return vpPoseOf(shift, Vector3d(0, 0, yaw));
}
} // namespace

double vpPosePair::errorYaw() const
{
  return std::remainder(vpRollPitchYaw(estimate).z() - vpRollPitchYaw(truth).z(), 2 * M_PI);
}

double vpPosePair::distance() const
{
  return std::hypot(errorX(), errorY());
}

vpPosePairs vpPosePairs::of(const vpTrajectory &estimate, const vpTrajectory &truth, double longestGap)
{
  vpPosePairs result;
  for (const vpTimedPose &pose : estimate.poses()) {
    if (truth.empty() || pose.timestamp < truth.poses().front().timestamp ||
        pose.timestamp > truth.poses().back().timestamp) {
      ++result.outside;
    } else if (const auto wMb = truth.at(pose.timestamp, longestGap)) {
      result.pairs.push_back({pose.timestamp, pose.wMb, *wMb});
    } else {
      ++result.inGaps;
    }
  }
  return result;
}

vpHomogeneousMatrix vpAlignmentOf(const std::vector<vpPosePair> &pairs, vpAlignment alignment)
{
  if (pairs.empty() || alignment == vpAlignment::none) {
    return vpHomogeneousMatrix();
  }
  if (alignment == vpAlignment::origin) {
    return pairs.front().truth * pairs.front().estimate.inverse();
  }
  return leastSquares(pairs);
}

END_VISP_NAMESPACE
