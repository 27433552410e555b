/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpGreyOf_h
#define vpGreyOf_h

#include <opencv2/core.hpp>

#include <visp3/core/vpImage.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! 8-bit grey of a picture of 8 or 16 bits with 1 to 4 channels in OpenCV's order (grey, grey + alpha, BGR,
//! BGRA).
void vpGreyOf(const cv::Mat &picture, vpImage<unsigned char> &I);

END_VISP_NAMESPACE

#endif
