/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpMeEllipseTracker_h
#define vpMeEllipseTracker_h

#include <memory>

#include <visp3/me/vpMe.h>
#include <visp3/me/vpMeEllipse.h>
#include <visp3/vlp_tracking/vpTargetTracker.h>

BEGIN_VISP_NAMESPACE

/*!
  ViSP's vpMeEllipse, moving edges along an ellipse, as a vpTargetTracker. It starts from the ellipse that
  fills the window, and starts anew from the last one where it lost it. An ellipse should be larger than twice
  the range, and move by less than the range from frame to frame. similarity() is the share of its moving
  edges that found an edge.
*/
class VISP_EXPORT vpMeEllipseTracker : public vpTargetTracker
{
public:
  unsigned int range = 15; // px, to each side of the ellipse, in which an edge is sought
  double sampleStep = 8;   // px, between moving edges
  double threshold = 5000; // likelihood of an edge, as vpMe has it
  double leastFound = 0.3; // share of the moving edges below which the target counts as not seen

  vpMeEllipseTracker();

protected:
  Sighting begin(const vpImage<unsigned char> &I, const vpRect &window) override;
  Sighting follow(const vpImage<unsigned char> &I) override;
  using vpTargetTracker::begin;
  using vpTargetTracker::follow;

private:
  void start(const vpImage<unsigned char> &I);

  vpMe m_edges;
  std::unique_ptr<vpMeEllipse> m_ellipse;
  vpRect m_window;       // around the ellipse as seen last
  vpRect m_first;        // at the start
  double m_expected = 0; // moving edges
  bool m_lost = false;
};

END_VISP_NAMESPACE

#endif
