/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpGreyOf.h"

#include <opencv2/imgproc.hpp>

BEGIN_VISP_NAMESPACE

void vpGreyOf(const cv::Mat &picture, vpImage<unsigned char> &I)
{
  cv::Mat grey = picture;
  if (picture.channels() == 2) {
    cv::extractChannel(picture, grey, 0);
  } else if (picture.channels() >= 3) {
    cv::cvtColor(picture, grey, picture.channels() == 3 ? cv::COLOR_BGR2GRAY : cv::COLOR_BGRA2GRAY);
  }
  I.resize(static_cast<unsigned int>(grey.rows), static_cast<unsigned int>(grey.cols));
  cv::Mat target(grey.rows, grey.cols, CV_8UC1, I.bitmap);
  if (grey.depth() == CV_16U) {
    grey.convertTo(target, CV_8U, 1.0 / 257); // 65535 is 257 * 255
  } else {
    grey.copyTo(target);
  }
}

END_VISP_NAMESPACE
