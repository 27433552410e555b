/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpOwnStripes_h
#define vpOwnStripes_h

#include <opencv2/core.hpp>
#include <visp3/vlp_detection/vpLedRoiDetector.h>

BEGIN_VISP_NAMESPACE

/*!
  Whether a region changes from line to line by several times as much as what is lit beside it, on the same
  lines and within \e around, and unlike it: a lamp before a ceiling or a window that does not blink with it.
  All parts of one lamp are exposed at the same time and blink alike, so no fragment of a lamp has stripes of
  its own, however much brighter it is. \param dark Grey value of the picture's darkest places.
*/
bool vpOwnStripes(const vpLedRoi &roi, const vpLedRoi &around, const cv::Mat_<unsigned char> &lines,
                  double dark);

END_VISP_NAMESPACE

#endif
