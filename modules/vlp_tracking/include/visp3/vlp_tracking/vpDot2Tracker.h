/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpDot2Tracker_h
#define vpDot2Tracker_h

#include <visp3/blob/vpDot2.h>
#include <visp3/vlp_tracking/vpTargetTracker.h>

BEGIN_VISP_NAMESPACE

/*!
  ViSP's vpDot2, a connected blob of one grey level, as a vpTargetTracker. The middle of the window given at
  the start has to lie in the blob, which need not fill the window. Where vpDot2 loses it, the next picture is
  searched around the last window. similarity() is the smaller of the blob's areas, now and at the start, as a
  share of the larger.
*/
class VISP_EXPORT vpDot2Tracker : public vpTargetTracker
{
public:
  double searchScale = 3; // window sizes on a side, around the last window, where the blob was lost

protected:
  Sighting begin(const vpImage<unsigned char> &I, const vpRect &window) override;
  Sighting follow(const vpImage<unsigned char> &I) override;
  using vpTargetTracker::begin;
  using vpTargetTracker::follow;

private:
  bool find(const vpImage<unsigned char> &I);

  vpDot2 m_dot; // as seen last
  bool m_lost = false;
  double m_area = 0; // px, at the start
};

END_VISP_NAMESPACE

#endif
