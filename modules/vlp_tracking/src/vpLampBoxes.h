/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampBoxes_h
#define vpLampBoxes_h

#include <algorithm>
#include <cmath>

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRect.h>
#include <visp3/vlp_identification/vpLedIdEvidence.h>

BEGIN_VISP_NAMESPACE

//! Where lamps are, as rectangles of the picture.
namespace vpLampBoxes
{
inline vpRect boxOf(const vpLampOutline &outline)
{
  const Eigen::Vector4d box = outline.box();
  return {box(0), box(1), box(2) - box(0), box(3) - box(1)};
}

//! Larger by \e share of its size on each side.
inline vpRect widened(const vpRect &rect, double share)
{
  const double x = share * rect.getWidth(), y = share * rect.getHeight();
  return {rect.getLeft() - x, rect.getTop() - y, rect.getWidth() + 2 * x, rect.getHeight() + 2 * y};
}

//! The part of a rectangle that lies in a picture; of no size where there is none.
inline vpRect inside(const vpRect &rect, const vpImage<unsigned char> &I)
{
  const double left = std::max(0.0, std::ceil(rect.getLeft())), top = std::max(0.0, std::ceil(rect.getTop())),
               right = std::min(I.getWidth() - 1.0, std::floor(rect.getLeft() + rect.getWidth())),
               bottom = std::min(I.getHeight() - 1.0, std::floor(rect.getTop() + rect.getHeight()));
  return {left, top, std::max(0.0, right - left + 1), std::max(0.0, bottom - top + 1)};
}

//! Share of both together that they have in common.
inline double overlap(const vpRect &a, const vpRect &b)
{
  const double x = std::min(a.getLeft() + a.getWidth(), b.getLeft() + b.getWidth()) -
                   std::max(a.getLeft(), b.getLeft()),
               y = std::min(a.getTop() + a.getHeight(), b.getTop() + b.getHeight()) -
                   std::max(a.getTop(), b.getTop());
  const double common = std::max(0.0, x) * std::max(0.0, y);
  return common / std::max(1.0, a.getWidth() * a.getHeight() + b.getWidth() * b.getHeight() - common);
}

//! Whether a region says anything of a lamp that is not followed yet.
inline bool tells(const vpLampObservation &seen)
{
  return seen.outline.shape != vpLampOutline::Shape::region && vpLedIdEvidence::tells(seen.features);
}
} // namespace vpLampBoxes

END_VISP_NAMESPACE

#endif
