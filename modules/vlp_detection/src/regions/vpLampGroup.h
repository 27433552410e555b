/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampGroup_h
#define vpLampGroup_h

#include <algorithm>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>
#include <visp3/vlp_detection/vpLedRoiDetector.h>

#include "vpChordShape.h"
#include "vpLevelStripes.h"

BEGIN_VISP_NAMESPACE

//! Stripes that may be one lamp, at one level; a node of the tree of levels.
struct vpLampGroup {
  vpLedRoi roi;
  vpLevelStripes::Set set;      // of its level
  std::vector<float> shortfall; // of each chord of the region
  vpChordShape::Edge edge;
  int parent = -1;
  std::vector<int> children;

  double size() const { return std::max(roi.box.width, roi.box.height); } // px

  /*!
    The stripes of a set as lamps: split at waists, one cut after the other. A cut that was the best one while
    other lamps were in the set may part a lamp; so parts that are no worse as one are joined again. \e
    workLeft bounds the work on clutter.
  */
  static std::vector<vpLampGroup> lampsOf(const vpLevelStripes &level, vpLevelStripes::Set set,
                                          const cv::Mat_<unsigned char> &lines, double dark, long &workLeft);
};

END_VISP_NAMESPACE

#endif
