/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSteadyLight_h
#define vpSteadyLight_h

#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_detection/vpLedRoiDetector.h>
#include <visp3/vlp_identification/vpStripeAnalyzer.h>

BEGIN_VISP_NAMESPACE

/*!
  Depth of the deepest dip from line to line, 0 to 1, by the middles of a region's chords and by their lengths
  alone: what has none is a tube, a panel, a window, or a single stripe that says nothing of any frequency.
  1 for a dark gap between its lines, and where there are few lines.
*/
double vpDeepestDip(const cv::Mat_<unsigned char> &lines, const vpLedRoi &roi);

//! The same of a profile, and none where it is empty: a single stripe says nothing of any frequency.
double vpDeepestDip(const vpStripeProfile &profile);

//! s, the longest stretch of a profile's lines that are nearer to its brightest than to its darkest one.
double vpLongestLit(const vpStripeProfile &profile);

//! The most lines on end that are nearer to a profile's darkest than to its brightest one, between two that
//! are not.
size_t vpLongestDark(const vpStripeProfile &profile);

//! Lines of the picture that the longest period of the map's lamps takes; infinite without lamps or row time.
double vpLongestPeriodLines(const vpLampMap &map, const vpVlpRig &rig);

/*!
  s, the longest period of the map's lamps, as far as the row time is known: what shines on end for longer is
  none of them. Infinite without lamps, and where one may be dark for so short that every line sees some
  light.
*/
double vpLongestPeriod(const vpLampMap &map, const vpVlpRig &rig);

END_VISP_NAMESPACE

#endif
