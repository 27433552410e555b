/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPoseText_h
#define vpPoseText_h

#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

/*!
  \file vpPoseText.h
  A pose as the numbers that our files hold: the row of a TUM trajectory; roll, pitch and yaw.
*/

BEGIN_VISP_NAMESPACE

//! Comment line that heads a TUM trajectory of ours.
VISP_EXPORT extern const char *const vpTumHeader;

//! A pose as a row of a TUM trajectory, `timestamp tx ty tz qx qy qz qw` (s, m), with qw >= 0.
VISP_EXPORT std::string vpTumRow(double timestamp, const vpHomogeneousMatrix &wMb);

//! Roll, pitch, yaw about the fixed axes x, y, z (rad): R = Rz(yaw) Ry(pitch) Rx(roll).
VISP_EXPORT Eigen::Vector3d vpRollPitchYaw(const vpHomogeneousMatrix &wMb);

//! Its rotation, normalised, with w >= 0.
VISP_EXPORT Eigen::Quaterniond vpQuaternionOf(const vpHomogeneousMatrix &wMb);

//! The pose of that position (m) and rotation, a unit quaternion.
VISP_EXPORT vpHomogeneousMatrix vpPoseOf(const Eigen::Vector3d &position, const Eigen::Quaterniond &rotation);

//! The pose of that position (m) and roll, pitch, yaw (rad) as above.
VISP_EXPORT vpHomogeneousMatrix vpPoseOf(const Eigen::Vector3d &position,
                                         const Eigen::Vector3d &rollPitchYaw);

END_VISP_NAMESPACE

#endif
