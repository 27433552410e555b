/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpChordShape_h
#define vpChordShape_h

#include <algorithm>
#include <vector>

#include <opencv2/core.hpp>
#include <visp3/vlp_detection/vpLedRoiDetector.h>

BEGIN_VISP_NAMESPACE

//! Shape of a region from the ends of its chords.
namespace vpChordShape
{

//! Outer ends of the chords, half a pixel outside the last lit sample; those at the picture's border left
//! out.
std::vector<cv::Point2f> ends(const vpLedRoi &roi, int samples);

//! Those of them that lie on the region's convex hull, or nearly: half-lit lines fall short of a soft
//! outline.
std::vector<cv::Point2f> outerEnds(const vpLedRoi &roi, int samples);

/*!
  Root mean square distance of the points to their best ellipse, to first order, and to the smallest rectangle
  around them, pixels; a large number where there is none.
*/
double ellipseMisfit(const std::vector<cv::Point2f> &points, const cv::Rect &box);
double rectangleMisfit(const std::vector<cv::Point2f> &points);

//! How the light falls off at the ends of the chords, grey levels.
struct Edge {
  double step = 0;   // mean fall, from just inside to just outside
  double inside = 0; // mean light just inside, above the background
  double light = 0;  // mean light of the chords, above the background
  double noise = 0;  // standard deviation inside
  int ends = 0;      // of chords, that there are

  double sharpness() const { return inside > 0 ? std::clamp(step / inside, 0.0, 1.0) : 0; }
};

//! How much the chords look like one whole lamp.
struct Score {
  Edge edge;
  double lampness = 0;          // 0 to 1
  std::vector<float> shortfall; // of each chord: how far it ends inside the convex hull, in tolerances
};

//! Of a region with that many chord ends near its hull, however good a lamp it is.
double mostLampness(int ends);

Score score(const vpLedRoi &roi, const cv::Mat_<unsigned char> &lines, double dark);

/*!
  The longest dark gap between the chords, lines. None in a single stripe, of a lamp that shines all the time,
  or, where it is flat, of one whose dark gap may be as long as itself.
*/
int longestGap(const vpLedRoi &roi);

/*!
  Sets cutAcross and cutAlong: whether the picture's border cuts the region's lamp. The region touches it, or
  its lamp may go on beyond the first or last line though the region ends before that, by a dark gap no longer
  than the lamp shows elsewhere, and the chords there do not close.
*/
void markCuts(vpLedRoi &roi, const cv::Size &picture);

} // namespace vpChordShape

END_VISP_NAMESPACE

#endif
