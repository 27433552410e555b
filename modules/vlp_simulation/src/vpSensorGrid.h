/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSensorGrid_h
#define vpSensorGrid_h

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <visp3/core/vpCameraParameters.h>
#include <visp3/vlp_core/vpVlpRig.h>

BEGIN_VISP_NAMESPACE

/*!
  The sensor's pixels that a picture needs, as lines and samples along them: line k of the grid is exposed as
  a whole, whatever direction the readout runs in. All of the sensor's pixels, or after a nearest-neighbour
  resize those that remain.
*/
class vpSensorGrid
{
public:
  explicit vpSensorGrid(const vpVlpRig &rig);

  int lines() const { return static_cast<int>(m_line.size()); }
  int samples() const { return static_cast<int>(m_sample.size()); }

  //! Start of the exposure of a line, s after the frame's time stamp; and how long it lasts, s.
  double start(int line) const { return m_start[line]; }
  double exposure() const { return m_exposure; }

  //! Sensor coordinates (u, v) of a pixel, px; of a point beside it by \e offset px in u and v.
  Eigen::Vector2d pixel(int line, int sample) const
  {
    return m_columns ? Eigen::Vector2d(m_line[line], m_sample[sample])
                     : Eigen::Vector2d(m_sample[sample], m_line[line]);
  }

  //! Normalised coordinates x / z, y / z of what the sensor's point \e pixel sees: the inverse of ViSP's
  //! projection, which ViSP's own inverse is but an approximation of where the lens distorts.
  Eigen::Vector2d rayAt(const Eigen::Vector2d &pixel) const;
  //! The same for a pixel of the grid, from a table.
  Eigen::Vector2d ray(int line, int sample) const { return {m_x(line, sample), m_y(line, sample)}; }

  //! Sensor pixel at which a point of the camera frame (m) is seen. \return False where it is not before the
  //! camera, or farther off its axis than the lens model holds.
  bool project(const Eigen::Vector3d &point, Eigen::Vector2d &pixel) const;

  //! Lines and samples (x: samples, y: lines) whose pixels lie within the box, clipped to the grid.
  cv::Rect within(const Eigen::Vector2d &upperLeft, const Eigen::Vector2d &lowerRight) const;
  cv::Rect whole() const { return {0, 0, samples(), lines()}; }

  //! A matrix of lines and samples as the picture that it is.
  cv::Mat upright(const cv::Mat &linesAndSamples) const;

  //! px, distance between neighbouring samples, the longest; of lines likewise.
  double spacing() const { return m_spacing; }

private:
  vpCameraParameters m_camera; // of the sensor
  bool m_columns = false;
  std::vector<double> m_line, m_sample; // px on the sensor
  std::vector<double> m_start;          // s
  double m_exposure = 0;
  double m_spacing = 1;
  cv::Mat_<double> m_x, m_y;
};

END_VISP_NAMESPACE

#endif
