/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpBackground_h
#define vpBackground_h

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! A small block of a picture.
struct vpPictureBlock {
  double x, y;  // of its middle: -1 to 1 over the picture
  double mean;  // grey levels
  double noise; // grey levels, standard deviation along its lines, which know no stripes

  //! Several hundred, spread evenly over a picture.
  static std::vector<vpPictureBlock> of(const cv::Mat_<unsigned char> &lines);
};

//! The dark part of a picture, grey levels.
struct vpBackground {
  double level = 0;  // of its darkest places
  double median = 0; // of the whole picture
  double noise = 0;  // standard deviation, before clipping at black

  double gain = 0; // growth of the noise's variance with the light: that of photons

  double noiseAt(double grey) const { return std::sqrt(noise * noise + gain * std::max(0.0, grey - level)); }

  /*!
    Of the darker half of the blocks, by their mean. Noise is the median of theirs; lamps, edges and texture
    are few among them. The gain is that of the calmer of the brighter blocks, as texture can only add to it.
  */
  static vpBackground of(const std::vector<vpPictureBlock> &blocks);
};

END_VISP_NAMESPACE

#endif
