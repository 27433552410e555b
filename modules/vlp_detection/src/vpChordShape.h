/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpChordShape_h
#define vpChordShape_h

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

//! 0 to 1: how much the chords look like one whole lamp on a background of grey value \e dark.
double lampness(const vpLedRoi &roi, const cv::Mat_<unsigned char> &lines, double dark);

} // namespace vpChordShape

END_VISP_NAMESPACE

#endif
