/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// As ViSP has its modules' tests: a bright disc is one region.

#include <cstdlib>

#include <opencv2/imgproc.hpp>
#include <visp3/vlp_detection/vpLedRoiDetector.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main()
{
  vpLinePicture picture;
  picture.grey = cv::Mat_<unsigned char>(240, 320, static_cast<unsigned char>(5));
  cv::circle(picture.grey, {150, 110}, 40, cv::Scalar(200), cv::FILLED, cv::LINE_AA);
  const std::vector<vpLedRoi> regions = vpLedRoiDetector().detect(picture.grey);
  return regions.size() == 1 && regions[0].box.contains({150, 110}) ? EXIT_SUCCESS : EXIT_FAILURE;
}
