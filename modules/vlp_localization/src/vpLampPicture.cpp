/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampPicture.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <visp3/core/vpMeterPixelConversion.h>

BEGIN_VISP_NAMESPACE

vpLampPicture::vpLampPicture(const vpLamp &lamp, const vpBasePose &wMb, const vpVlpRig &rig)
    : m_lamp(lamp), m_pose(wMb), m_size(std::isfinite(lamp.size) ? lamp.size : 1),
      m_along(rig.shutter.alongColumns() ? 0 : 1), m_inFront(true)
{
  const vpMountFrame mount(rig);
  const auto pixelOf = [&](const Eigen::Vector3d &place) {
    const vpPredictedRay seen = predictRay(place, wMb, mount);
    m_inFront = m_inFront && seen.inFront;
    Eigen::Vector2d pixel;
    vpMeterPixelConversion::convertPoint(rig.camera, seen.ray.x(), seen.ray.y(), pixel.x(), pixel.y());
    return pixel;
  };
  m_middle = pixelOf(lamp.position);
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector3d half = 0.5 * m_size * Eigen::Vector3d::Unit(axis);
    m_byPlace.col(axis) = (pixelOf(lamp.position + half) - pixelOf(lamp.position - half)) / m_size;
  }
}

//! Half the sum of the map's singular values.
double vpLampPicture::diameter() const
{
  return 0.5 * m_size * std::sqrt(m_byPlace.squaredNorm() + 2 * std::abs(m_byPlace.determinant()));
}

//! From b, whatever stands still in w moves the other way.
Eigen::Vector2d vpLampPicture::motion(const Eigen::Vector3d &velocity) const
{
  const Eigen::Vector3d b = m_pose.wRb.transpose() * (m_lamp.position - m_pose.wtb);
  const Eigen::Vector3d moves(velocity.z() * b.y() - velocity.x(), -velocity.z() * b.x() - velocity.y(), 0);
  return m_byPlace * (m_pose.wRb * moves).head<2>();
}

double vpLampPicture::stretch(const Eigen::Vector3d &velocity, double lineTime) const
{
  return 1 / std::max(0.1, 1 - motion(velocity)(m_along) * lineTime);
}

Eigen::Vector2d vpLampPicture::extent(const Eigen::Vector3d &velocity, double lineTime) const
{
  if (!m_inFront) {
    return Eigen::Vector2d::Zero();
  }
  Eigen::Vector2d extent = m_byPlace.rowwise().norm(); // of a disc
  if (m_lamp.shape != vpLamp::Shape::disk) {           // the longer of its diagonals
    const double yaw = m_lamp.yaw + M_PI / 4;
    const Eigen::Vector2d diagonal = M_SQRT2 * Eigen::Vector2d(std::cos(yaw), std::sin(yaw));
    extent = (m_byPlace * diagonal)
                 .cwiseAbs()
                 .cwiseMax((m_byPlace * Eigen::Vector2d(-diagonal.y(), diagonal.x())).cwiseAbs());
  }
  extent(m_along) *= stretch(velocity, lineTime);
  return m_size * extent;
}

END_VISP_NAMESPACE
