/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_tracking/vpMeEllipseTracker.h>

#include <algorithm>
#include <cmath>

#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

namespace
{
vpRect boxOf(const vpMeEllipse &ellipse)
{
  const vpColVector abe = ellipse.get_ABE();
  const double width = 2 * std::hypot(abe[0] * std::cos(abe[2]), abe[1] * std::sin(abe[2]));
  const double height = 2 * std::hypot(abe[0] * std::sin(abe[2]), abe[1] * std::cos(abe[2]));
  vpRect box(0, 0, width, height);
  box.moveCenter(ellipse.getCenter());
  return box;
}

//! Whether an ellipse may still be the one it was: its edges can run away to others.
bool plausible(const vpRect &box, const vpRect &first, const vpImage<unsigned char> &I)
{
  static const double most = 3; // times the first size, or a part of it
  auto close = [](double length, double firstLength) {
    return length >= firstLength / most && length <= firstLength * most; // false for NaN
  };
  const vpImagePoint middle = box.getCenter();
  return close(box.getWidth(), first.getWidth()) && close(box.getHeight(), first.getHeight()) &&
         middle.get_u() >= 0 && middle.get_v() >= 0 && middle.get_u() < I.getWidth() &&
         middle.get_v() < I.getHeight();
}
} // namespace

vpMeEllipseTracker::vpMeEllipseTracker()
{
  m_edges.setMaskSize(5);
  m_edges.setMaskNumber(180);
}

void vpMeEllipseTracker::start(const vpImage<unsigned char> &I)
{
  m_edges.setRange(range);
  m_edges.setSampleStep(sampleStep);
  m_edges.setThreshold(threshold);
  m_ellipse = std::make_unique<vpMeEllipse>();
  m_ellipse->setMe(&m_edges);
  m_ellipse->setDisplay(vpMeSite::NONE);
  const double a = m_window.getWidth() / 2, b = m_window.getHeight() / 2;
  vpColVector parameters(5); // middle, and normalized centred moments of second order
  parameters[0] = m_window.getCenter().get_u();
  parameters[1] = m_window.getCenter().get_v();
  parameters[2] = a * a / 4;
  parameters[4] = b * b / 4;
  m_ellipse->initTracking(I, parameters);
  m_expected = m_ellipse->getExpectedDensity();
}

vpTargetTracker::Sighting vpMeEllipseTracker::begin(const vpImage<unsigned char> &I, const vpRect &window)
{
  m_window = m_first = window;
  m_lost = false;
  try {
    start(I);
  } catch (const vpException &error) {
    throw vpException(vpException::badValue,
                      "initTracking: window has no ellipse filling it, expected one (vpMeEllipse)");
  }
  return {window, 1, true};
}

vpTargetTracker::Sighting vpMeEllipseTracker::follow(const vpImage<unsigned char> &I)
{
  Sighting sighting;
  try {
    if (m_lost) {
      start(I);
    }
    m_ellipse->track(I);
    const vpRect box = boxOf(*m_ellipse);
    sighting.similarity = m_expected > 0 ? std::clamp(m_ellipse->getNbPoints() / m_expected, 0.0, 1.0) : 0.0;
    sighting.seen = plausible(box, m_first, I) && sighting.similarity >= leastFound;
    if (sighting.seen) {
      m_window = box;
    }
  } catch (const vpException &) {
    sighting.similarity = 0;
  }
  m_lost = !sighting.seen;
  sighting.window = m_window;
  return sighting;
}

END_VISP_NAMESPACE
