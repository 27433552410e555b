/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpSensorGrid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <visp3/core/vpMeterPixelConversion.h>
#include <visp3/core/vpPixelMeterConversion.h>

BEGIN_VISP_NAMESPACE

namespace
{
double longestStep(const std::vector<double> &positions)
{
  double longest = 1;
  for (size_t k = 1; k < positions.size(); ++k) {
    longest = std::max(longest, positions[k] - positions[k - 1]);
  }
  return longest;
}

//! Indices of the positions from \e first to \e last: the first, and one past the last.
std::pair<int, int> between(const std::vector<double> &positions, double first, double last)
{
  const auto from = std::lower_bound(positions.begin(), positions.end(), first);
  const auto to = std::upper_bound(positions.begin(), positions.end(), last);
  return {static_cast<int>(from - positions.begin()), static_cast<int>(to - positions.begin())};
}
} // namespace

vpSensorGrid::vpSensorGrid(const vpVlpRig &rig)
    : m_camera(rig.resize.sensor(rig.camera, rig.width, rig.height)), m_columns(rig.shutter.alongColumns()),
      m_exposure(rig.shutter.exposure)
{
  const bool area = rig.resize.method == vpPictureResize::Method::area; // of every pixel of the sensor
  const unsigned int width = area ? rig.resize.sourceWidth : rig.width;
  const unsigned int height = area ? rig.resize.sourceHeight : rig.height;
  const vpPictureResize resize = area ? vpPictureResize() : rig.resize;
  const vpLineTiming timing(rig.shutter, resize, width, height);
  const unsigned int lines = m_columns ? width : height, samples = m_columns ? height : width;
  const unsigned int sourceLines = m_columns ? resize.sourceWidth : resize.sourceHeight;
  const unsigned int sourceSamples = m_columns ? resize.sourceHeight : resize.sourceWidth;
  for (unsigned int k = 0; k < lines; ++k) {
    m_line.push_back(resize.sensorPosition(k, lines, sourceLines));
    m_start.push_back(timing.middle(k) - 0.5 * m_exposure);
  }
  for (unsigned int k = 0; k < samples; ++k) {
    m_sample.push_back(resize.sensorPosition(k, samples, sourceSamples));
  }
  m_spacing = std::max(longestStep(m_line), longestStep(m_sample));
  m_x.create(static_cast<int>(lines), static_cast<int>(samples));
  m_y.create(m_x.size());
  for (int line = 0; line < m_x.rows; ++line) {
    for (int sample = 0; sample < m_x.cols; ++sample) {
      const Eigen::Vector2d ray = rayAt(pixel(line, sample));
      m_x(line, sample) = ray.x();
      m_y(line, sample) = ray.y();
    }
  }
}

Eigen::Vector2d vpSensorGrid::rayAt(const Eigen::Vector2d &pixel) const
{
  if (m_camera.get_projModel() == vpCameraParameters::perspectiveProjWithoutDistortion) {
    return {(pixel.x() - m_camera.get_u0()) * m_camera.get_px_inverse(),
            (pixel.y() - m_camera.get_v0()) * m_camera.get_py_inverse()};
  }
  double x = 0, y = 0;
  vpPixelMeterConversion::convertPoint(m_camera, pixel.x(), pixel.y(), x, y);
  // Newton's method on ViSP's projection, its derivatives those without distortion: the correction is small.
  static const double close = 1e-9; // px
  for (int iteration = 0; iteration < 50; ++iteration) {
    double u = 0, v = 0;
    vpMeterPixelConversion::convertPoint(m_camera, x, y, u, v);
    const Eigen::Vector2d left(pixel.x() - u, pixel.y() - v);
    x += left.x() * m_camera.get_px_inverse();
    y += left.y() * m_camera.get_py_inverse();
    if (!(left.squaredNorm() > close * close)) {
      break;
    }
  }
  return {x, y};
}

bool vpSensorGrid::project(const Eigen::Vector3d &point, Eigen::Vector2d &pixel) const
{
  static const double nearest = 1e-3; // m
  if (point.z() < nearest) {
    return false;
  }
  const Eigen::Vector2d ray(point.x() / point.z(), point.y() / point.z());
  vpMeterPixelConversion::convertPoint(m_camera, ray.x(), ray.y(), pixel.x(), pixel.y());
  if (!pixel.allFinite()) {
    return false;
  }
  if (m_camera.get_projModel() == vpCameraParameters::perspectiveProjWithoutDistortion) {
    return true;
  }
  // Far off the axis, a polynomial of distortion folds back into the picture, where that pixel sees something
  // else.
  static const double same = 1e-3;
  return (rayAt(pixel) - ray).norm() < same * (1 + ray.norm());
}

cv::Rect vpSensorGrid::within(const Eigen::Vector2d &upperLeft, const Eigen::Vector2d &lowerRight) const
{
  const int along = m_columns ? 1 : 0;
  const auto [left, right] = between(m_sample, upperLeft(along), lowerRight(along));
  const auto [top, bottom] = between(m_line, upperLeft(1 - along), lowerRight(1 - along));
  return {left, top, std::max(0, right - left), std::max(0, bottom - top)};
}

cv::Mat vpSensorGrid::upright(const cv::Mat &linesAndSamples) const
{
  return m_columns ? cv::Mat(linesAndSamples.t()) : linesAndSamples;
}

END_VISP_NAMESPACE
