/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpPoseText.h>

#include <cmath>

#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

const char *const vpTumHeader =
    "# timestamp tx ty tz qx qy qz qw: s, m; wMb, the pose of the robot base b in the map w";

std::string vpTumRow(double timestamp, const vpHomogeneousMatrix &wMb)
{
  const Eigen::Quaterniond q = vpQuaternionOf(wMb);
  std::string row = vpNumberText(timestamp);
  for (const double value : {wMb[0][3], wMb[1][3], wMb[2][3], q.x(), q.y(), q.z(), q.w()}) {
    row += " " + vpNumberText(value);
  }
  return row;
}

Eigen::Vector3d vpRollPitchYaw(const vpHomogeneousMatrix &wMb)
{
  return {std::atan2(wMb[2][1], wMb[2][2]), std::atan2(-wMb[2][0], std::hypot(wMb[0][0], wMb[1][0])),
          std::atan2(wMb[1][0], wMb[0][0])};
}

Eigen::Quaterniond vpQuaternionOf(const vpHomogeneousMatrix &wMb)
{
  Eigen::Matrix3d R;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      R(i, j) = wMb[static_cast<unsigned int>(i)][j];
    }
  }
  Eigen::Quaterniond q(R); // vpQuaternionVector loses half the digits about a turn of none
  q.normalize();
  if (q.w() < 0) {
    q.coeffs() = -q.coeffs();
  }
  return q;
}

vpHomogeneousMatrix vpPoseOf(const Eigen::Vector3d &position, const Eigen::Quaterniond &rotation)
{
  const Eigen::Matrix3d R = rotation.toRotationMatrix();
  vpHomogeneousMatrix wMb;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      wMb[static_cast<unsigned int>(i)][j] = R(i, j);
    }
    wMb[static_cast<unsigned int>(i)][3] = position[i];
  }
  return wMb;
}

vpHomogeneousMatrix vpPoseOf(const Eigen::Vector3d &position, const Eigen::Vector3d &rollPitchYaw)
{
  using Eigen::Vector3d;
  return vpPoseOf(position, Eigen::Quaterniond(Eigen::AngleAxisd(rollPitchYaw.z(), Vector3d::UnitZ()) *
                                               Eigen::AngleAxisd(rollPitchYaw.y(), Vector3d::UnitY()) *
                                               Eigen::AngleAxisd(rollPitchYaw.x(), Vector3d::UnitX())));
}

END_VISP_NAMESPACE
