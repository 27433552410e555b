/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpPoseText.h"

#include <cmath>

#include <Eigen/Geometry>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

const char *const vpTumHeader =
    "# timestamp tx ty tz qx qy qz qw: s, m; wMb, the pose of the robot base b in the map w";

std::string vpTumRow(double timestamp, const vpHomogeneousMatrix &wMb)
{
  Eigen::Matrix3d R;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      R(i, j) = wMb[i][j];
    }
  }
  Eigen::Quaterniond q(R); // vpQuaternionVector loses half the digits about a turn of none
  q.normalize();
  if (q.w() < 0) {
    q.coeffs() = -q.coeffs();
  }
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

END_VISP_NAMESPACE
