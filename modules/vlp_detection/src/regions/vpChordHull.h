/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpChordHull_h
#define vpChordHull_h

#include <vector>

#include <opencv2/core.hpp>
#include <visp3/vlp_detection/vpLedRoiDetector.h>

BEGIN_VISP_NAMESPACE

//! The convex hull of a region, by the ends of its chords.
namespace vpChordHull
{

using Points = std::vector<cv::Point2f>;

/*!
  Convex hull of points that come line by line, each line's leftmost first (Andrew 1979): down its left side
  and up its right one.
*/
Points of(const Points &points);

//! The points, line by line, no farther than \e nearly from their convex hull.
Points nearIt(const Points &points, const Points &hull, float nearly);

//! Left and right end of a polygon on each line of the box.
struct Extent {
  std::vector<float> first;
  std::vector<float> last;

  Extent(const Points &polygon, const cv::Rect &box);
};

//! Lit length over the length of the convex hull, summed over the lit lines: 1 for a convex region.
double solidity(const std::vector<vpLedChord> &chords, const Extent &hull, int firstLine);

//! How far each chord ends inside the hull, on its worse side, in units of \e tolerance.
std::vector<float> shortfalls(const std::vector<vpLedChord> &chords, const Extent &hull, int firstLine,
                              double tolerance);

} // namespace vpChordHull

END_VISP_NAMESPACE

#endif
