/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpBinnedSearch_h
#define vpBinnedSearch_h

#include <vector>

#include <opencv2/core.hpp>
#include <visp3/vlp_detection/vpLedRoiDetector.h>

#include "vpBackground.h"

BEGIN_VISP_NAMESPACE

/*!
  Regions in pictures so noisy that single pixels do not show a lamp. Along the lines pixels are averaged in
  bins, which keeps the stripes; what several widths of bins find is put together.
*/
namespace vpBinnedSearch
{
//! Samples per bin that are worth a search of its own at this noise: 2, 4 and so on, none in most pictures.
std::vector<int> widths(const vpBackground &dark);

//! The picture with each sample the mean of its bin, and the background as it has it.
cv::Mat_<unsigned char> binned(const cv::Mat_<unsigned char> &lines, int width);
vpBackground binned(const vpBackground &dark, int width);

//! Regions found with narrower bins, but for those that are pieces of what wider ones show whole, and the
//! rest of these.
std::vector<vpLedRoi> merged(std::vector<vpLedRoi> narrower, const std::vector<vpLedRoi> &wider);
} // namespace vpBinnedSearch

END_VISP_NAMESPACE

#endif
