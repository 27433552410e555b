/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpRollingShutter.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

namespace
{
void checkSizes(vpPictureResize::Method method, unsigned int delivered, unsigned int source)
{
  if (delivered == 0) {
    throw vpException(vpException::badValue, "delivered picture: 0 pixels, expected at least 1");
  }
  if (method != vpPictureResize::Method::none && source < delivered) {
    throw vpException(vpException::badValue, "resize: the sensor has " + std::to_string(source) +
                                                 " pixels, expected at " + "least the " +
                                                 std::to_string(delivered) + " of the delivered picture");
  }
}

//! Integral from 0 to \e x of the number of the pixel there.
double sumOfPixels(double x)
{
  const double whole = std::floor(x);
  return whole * (whole - 1) / 2 + (x - whole) * whole;
}
} // namespace

double vpPictureResize::sensorPosition(unsigned int k, unsigned int delivered, unsigned int source) const
{
  checkSizes(method, delivered, source);
  switch (method) {
  case Method::nearest: {
    // cv::resize's own arithmetic: 1 / (delivered / source) is not always source / delivered to the last bit.
    const double scale = 1 / (static_cast<double>(delivered) / source);
    return std::min(std::floor(k * scale), static_cast<double>(source) - 1);
  }
  case Method::area: {
    // The mean of the pixel numbers over [k s, (k + 1) s); s (k + 1/2) - 1/2 where s is whole.
    const double scale = static_cast<double>(source) / delivered;
    return (sumOfPixels((k + 1) * scale) - sumOfPixels(k * scale)) / scale;
  }
  case Method::none:
    break;
  }
  return k;
}

void vpPictureResize::sensorAxis(unsigned int delivered, unsigned int source, double &scale,
                                 double &offset) const
{
  checkSizes(method, delivered, source);
  scale = method == Method::none ? 1 : static_cast<double>(source) / delivered;
  switch (method) {
  case Method::nearest: {
    // With s = p / q in lowest terms, k s - floor(k s) runs evenly through 0, 1/q ... (q - 1)/q.
    const double q = delivered / std::gcd(delivered, source);
    offset = -(q - 1) / (2 * q);
    return;
  }
  case Method::area:
    offset = (scale - 1) / 2;
    return;
  case Method::none:
    break;
  }
  offset = 0;
}

vpCameraParameters vpPictureResize::withAxes(vpCameraParameters camera, double px, double py, double u0,
                                             double v0)
{
  switch (camera.get_projModel()) {
  case vpCameraParameters::perspectiveProjWithoutDistortion:
    camera.initPersProjWithoutDistortion(px, py, u0, v0);
    break;
  case vpCameraParameters::perspectiveProjWithDistortion:
    camera.initPersProjWithDistortion(px, py, u0, v0, camera.get_kud(), camera.get_kdu());
    break;
  case vpCameraParameters::ProjWithKannalaBrandtDistortion:
    camera.initProjWithKannalaBrandtDistortion(px, py, u0, v0,
                                               camera.getKannalaBrandtDistortionCoefficients());
    break;
  }
  return camera;
}

vpCameraParameters vpPictureResize::delivered(const vpCameraParameters &sensor, unsigned int width,
                                              unsigned int height) const
{
  double scaleU, offsetU, scaleV, offsetV;
  sensorAxis(width, sourceWidth, scaleU, offsetU);
  sensorAxis(height, sourceHeight, scaleV, offsetV);
  return withAxes(sensor, sensor.get_px() / scaleU, sensor.get_py() / scaleV,
                  (sensor.get_u0() - offsetU) / scaleU, (sensor.get_v0() - offsetV) / scaleV);
}

vpCameraParameters vpPictureResize::sensor(const vpCameraParameters &delivered, unsigned int width,
                                           unsigned int height) const
{
  double scaleU, offsetU, scaleV, offsetV;
  sensorAxis(width, sourceWidth, scaleU, offsetU);
  sensorAxis(height, sourceHeight, scaleV, offsetV);
  return withAxes(delivered, delivered.get_px() * scaleU, delivered.get_py() * scaleV,
                  delivered.get_u0() * scaleU + offsetU, delivered.get_v0() * scaleV + offsetV);
}

vpLineTiming::vpLineTiming(const vpRollingShutter &shutter, const vpPictureResize &resize, unsigned int width,
                           unsigned int height)
    : m_exposure(shutter.exposure), m_logExposureSigma(shutter.logExposureSigma())
{
  const bool columns = shutter.alongColumns();
  const unsigned int lines = columns ? width : height;
  const unsigned int samples = columns ? height : width;
  const unsigned int sourceLines = columns ? resize.sourceWidth : resize.sourceHeight;
  const unsigned int sourceSamples = columns ? resize.sourceHeight : resize.sourceWidth;

  double scale, offset;
  resize.sensorAxis(lines, sourceLines, scale, offset);
  m_lineTime = (shutter.reversed() ? -scale : scale) * shutter.rowTime;
  if (resize.method == vpPictureResize::Method::area && sourceLines > lines) {
    m_averaging = std::sqrt(scale * scale - 1) * shutter.rowTime; // one line's own row is in it already
  }

  const unsigned int sensorLines = resize.method == vpPictureResize::Method::none ? lines : sourceLines;
  m_middle.reserve(lines);
  m_linePosition.reserve(lines);
  for (unsigned int k = 0; k < lines; ++k) {
    const double position = resize.sensorPosition(k, lines, sourceLines);
    const double line = shutter.reversed() ? sensorLines - 1 - position : position;
    m_middle.push_back(line * shutter.rowTime + shutter.exposure / 2);
    m_linePosition.push_back((position - offset) / scale);
  }

  resize.sensorAxis(samples, sourceSamples, scale, offset);
  m_samplePosition.reserve(samples);
  for (unsigned int k = 0; k < samples; ++k) {
    m_samplePosition.push_back((resize.sensorPosition(k, samples, sourceSamples) - offset) / scale);
    m_aligned = m_aligned && m_samplePosition.back() == static_cast<double>(k);
  }
}

double vpLineTiming::middleAt(double line) const
{
  if (m_middle.empty()) {
    throw vpException(vpException::notInitialized, "line timing: it has no lines");
  }
  const double last = static_cast<double>(m_middle.size() - 1);
  if (!(line > 0)) {
    return m_middle.front() + line * m_lineTime;
  }
  if (line >= last) {
    return m_middle.back() + (line - last) * m_lineTime;
  }
  const double below = std::floor(line);
  const size_t k = static_cast<size_t>(below);
  return m_middle[k] + (line - below) * (m_middle[k + 1] - m_middle[k]);
}

double vpLineTiming::meanLineTime() const
{
  return m_lineTime;
}

END_VISP_NAMESPACE
