/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpDips_h
#define vpDips_h

#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  Whether light in a box, higher than \e longestPeriod lines, may blink. A lamp goes dark once a period, so
  that each strip of samples that it crosses dips again and again from line to line. What has no dip, and
  where there is room for two no two within a period, is a panel, a tube, a window, a wall. A dip is a fall
  and a rise again by a depth (a - b) / (a + b) of 0.05, and by 4 standard deviations of the noise. Strips are
  4 samples wide: of every lamp of 8 samples one lies inside it.
  \param dark Grey value where there is no light. \param noise Grey levels, standard deviation of a pixel.
*/
bool vpMayBlink(const cv::Mat_<unsigned char> &lines, const cv::Rect &box, double dark, double noise,
                double longestPeriod);

END_VISP_NAMESPACE

#endif
