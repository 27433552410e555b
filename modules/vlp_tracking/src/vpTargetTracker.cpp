/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_tracking/vpTargetTracker.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include <visp3/core/vpDisplay.h>
#include <visp3/core/vpException.h>
#include <visp3/core/vpImageConvert.h>
#include <visp3/vlp_tracking/vpCamshiftKalmanTracker.h>
#include <visp3/vlp_tracking/vpDot2Tracker.h>
#include <visp3/vlp_tracking/vpMeEllipseTracker.h>

BEGIN_VISP_NAMESPACE

namespace
{
template <class Pixel>
std::string sizeOf(const vpImage<Pixel> &I)
{
  return std::to_string(I.getWidth()) + " x " + std::to_string(I.getHeight()) + " px";
}

std::string describe(const vpRect &window)
{
  std::ostringstream text;
  text << window.getWidth() << " x " << window.getHeight() << " px at (" << window.getLeft() << ", "
       << window.getTop() << ")";
  return text.str();
}

template <class Pixel>
void checkWindow(const vpImage<Pixel> &I, const vpRect &window)
{
  static const double smallest = 4; // px
  // Negated, so that NaN fails too.
  if (!(window.getWidth() >= smallest && window.getHeight() >= smallest)) {
    throw vpException(vpException::badValue,
                      "initTracking: window is " + describe(window) + ", expected 4 x 4 px at least");
  }
  if (!(window.getLeft() >= 0 && window.getTop() >= 0 &&
        window.getLeft() + window.getWidth() <= I.getWidth() &&
        window.getTop() + window.getHeight() <= I.getHeight())) {
    throw vpException(vpException::badValue, "initTracking: window is " + describe(window) +
                                                 ", expected inside the picture of " + sizeOf(I));
  }
}

template <class Pixel>
void displayWindow(const vpImage<Pixel> &I, const vpRect &window, const vpColor &color,
                   unsigned int thickness)
{
  if (window.getWidth() > 0) {
    vpDisplay::displayRectangle(I, window, color, false, thickness);
  }
}
} // namespace

std::unique_ptr<vpTargetTracker> vpTargetTracker::make(Method method)
{
  switch (method) {
  case Method::camshiftKalman:
    return std::make_unique<vpCamshiftKalmanTracker>();
  case Method::dot2:
    return std::make_unique<vpDot2Tracker>();
  case Method::meEllipse:
    return std::make_unique<vpMeEllipseTracker>();
  }
  throw vpException(vpException::badValue,
                    "vpTargetTracker::make: method is %d, expected one of the enumeration",
                    static_cast<int>(method));
}

template <class Pixel>
void vpTargetTracker::beginChecked(const vpImage<Pixel> &I, const vpRect &window)
{
  checkWindow(I, window);
  m_width = 0; // should begin() throw
  const Sighting sighting = begin(I, window);
  m_width = I.getWidth();
  m_height = I.getHeight();
  m_estimate = sighting.window;
  m_similarity = sighting.similarity;
}

void vpTargetTracker::initTracking(const vpImage<unsigned char> &I, const vpRect &window)
{
  beginChecked(I, window);
}

void vpTargetTracker::initTracking(const vpImage<vpRGBa> &I, const vpRect &window)
{
  beginChecked(I, window);
}

void vpTargetTracker::checkBegun() const
{
  if (m_width == 0) {
    throw vpException(vpException::notInitialized, "track: no target yet, expected initTracking() before");
  }
}

template <class Pixel>
void vpTargetTracker::checkTracked(const vpImage<Pixel> &I) const
{
  checkBegun();
  if (I.getWidth() != m_width || I.getHeight() != m_height) {
    throw vpException(vpException::dimensionError, "track: the picture is " + sizeOf(I) + ", expected " +
                                                       std::to_string(m_width) + " x " +
                                                       std::to_string(m_height) + " px as in initTracking()");
  }
}

template <class Pixel>
bool vpTargetTracker::followChecked(const vpImage<Pixel> &I)
{
  checkTracked(I);
  const Sighting sighting = follow(I);
  m_estimate = sighting.window;
  m_similarity = sighting.similarity;
  return sighting.seen;
}

bool vpTargetTracker::track(const vpImage<unsigned char> &I)
{
  return followChecked(I);
}

bool vpTargetTracker::track(const vpImage<vpRGBa> &I)
{
  return followChecked(I);
}

bool vpTargetTracker::goOn(const vpRect &window)
{
  checkBegun();
  const std::optional<Sighting> sighting = seenAt(window);
  if (sighting) {
    m_estimate = sighting->window;
    m_similarity = sighting->similarity;
  }
  return sighting.has_value();
}

void vpTargetTracker::correct(const vpImage<unsigned char> &I, const vpRect &window)
{
  checkTracked(I);
  checkWindow(I, window);
  const Sighting sighting = setRight(I, window);
  m_estimate = sighting.window;
  m_similarity = sighting.similarity;
}

vpTargetTracker::Sighting vpTargetTracker::begin(const vpImage<vpRGBa> &I, const vpRect &window)
{
  vpImageConvert::convert(I, m_grey);
  return begin(m_grey, window);
}

vpTargetTracker::Sighting vpTargetTracker::follow(const vpImage<vpRGBa> &I)
{
  vpImageConvert::convert(I, m_grey);
  return follow(m_grey);
}

vpRect vpTargetTracker::window() const
{
  const double left = std::clamp(m_estimate.getLeft(), 0.0, double(m_width));
  const double top = std::clamp(m_estimate.getTop(), 0.0, double(m_height));
  const double width = std::min(m_estimate.getLeft() + m_estimate.getWidth(), double(m_width)) - left;
  const double height = std::min(m_estimate.getTop() + m_estimate.getHeight(), double(m_height)) - top;
  return width > 0 && height > 0 ? vpRect(left, top, width, height) : vpRect(left, top, 0, 0);
}

void vpTargetTracker::display(const vpImage<unsigned char> &I, const vpColor &color,
                              unsigned int thickness) const
{
  displayWindow(I, window(), color, thickness);
}

void vpTargetTracker::display(const vpImage<vpRGBa> &I, const vpColor &color, unsigned int thickness) const
{
  displayWindow(I, window(), color, thickness);
}

END_VISP_NAMESPACE
