/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpBackground_h
#define vpBackground_h

#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! The dark part of a picture, grey levels.
struct vpBackground {
  double level = 0; // of its darkest places
  double noise = 0; // standard deviation, before clipping at black

  double gain = 0; // growth of the noise's variance with the light: that of photons

  double noiseAt(double grey) const { return std::sqrt(noise * noise + gain * std::max(0.0, grey - level)); }

  /*!
    From small blocks spread over the picture: the darker half of them, by their mean. Noise is the median of
    their deviations along the line, which knows no stripes; lamps, edges and texture are few among them.
    The gain is that of the calmer of the brighter blocks, as texture can only add to it.
  */
  static vpBackground of(const cv::Mat_<unsigned char> &lines);
};

END_VISP_NAMESPACE

#endif
