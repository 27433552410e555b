/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPoseText_h
#define vpPoseText_h

#include <string>

#include <Eigen/Core>
#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! Comment line that heads a TUM trajectory of ours.
extern const char *const vpTumHeader;

//! A pose as a row of a TUM trajectory, `timestamp tx ty tz qx qy qz qw` (s, m), with qw >= 0.
std::string vpTumRow(double timestamp, const vpHomogeneousMatrix &wMb);

//! Roll, pitch, yaw about the fixed axes x, y, z (rad): R = Rz(yaw) Ry(pitch) Rx(roll).
Eigen::Vector3d vpRollPitchYaw(const vpHomogeneousMatrix &wMb);

END_VISP_NAMESPACE

#endif
