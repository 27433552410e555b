/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSteadyLight_h
#define vpSteadyLight_h

#include <opencv2/core.hpp>
#include <visp3/vlp_detection/vpLedRoiDetector.h>

BEGIN_VISP_NAMESPACE

/*!
  Depth of the deepest dip from line to line, 0 to 1, by the middles of a region's chords and by their lengths
  alone: what has none is a tube, a panel, a window, or a single stripe that says nothing of any frequency.
  1 for a dark gap between its lines, and where there are few lines.
*/
double vpDeepestDip(const cv::Mat_<unsigned char> &lines, const vpLedRoi &roi);

END_VISP_NAMESPACE

#endif
