/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_tracking/vpDot2Tracker.h>

#include <algorithm>
#include <list>

#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

vpTargetTracker::Sighting vpDot2Tracker::begin(const vpImage<unsigned char> &I, const vpRect &window)
{
  m_dot = vpDot2();
  m_lost = false;
  try {
    m_dot.initTracking(I, window.getCenter());
  } catch (const vpException &error) {
    throw vpException(
        vpException::badValue,
        "initTracking: window has no blob of one grey level in its middle, expected one (vpDot2)");
  }
  m_area = m_dot.getArea();
  return {m_dot.getBBox(), 1, true};
}

vpTargetTracker::Sighting vpDot2Tracker::follow(const vpImage<unsigned char> &I)
{
  m_lost = !find(I);
  Sighting sighting;
  sighting.window = m_dot.getBBox();
  sighting.seen = !m_lost;
  if (sighting.seen && m_dot.getArea() > 0) {
    sighting.similarity = std::min(m_dot.getArea(), m_area) / std::max(m_dot.getArea(), m_area);
  }
  return sighting;
}

bool vpDot2Tracker::find(const vpImage<unsigned char> &I)
{
  vpDot2 dot = m_dot; // an exception leaves it half changed
  try {
    if (!m_lost) {
      dot.track(I);
      m_dot = dot;
      return true;
    }
    const vpRect last = m_dot.getBBox();
    const vpImagePoint middle = last.getCenter();
    const double width = searchScale * last.getWidth(), height = searchScale * last.getHeight();
    const double left = std::max(0.0, middle.get_u() - width / 2),
                 top = std::max(0.0, middle.get_v() - height / 2);
    std::list<vpDot2> found;
    dot.searchDotsInArea(I, static_cast<int>(left), static_cast<int>(top), static_cast<unsigned int>(width),
                         static_cast<unsigned int>(height), found);
    if (found.empty()) {
      return false;
    }
    m_dot = *std::min_element(found.begin(), found.end(), [&middle](const vpDot2 &a, const vpDot2 &b) {
      return vpImagePoint::distance(a.getCog(), middle) < vpImagePoint::distance(b.getCog(), middle);
    });
    return true;
  } catch (const vpException &) {
    return false;
  }
}

END_VISP_NAMESPACE
