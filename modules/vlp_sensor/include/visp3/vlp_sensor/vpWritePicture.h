/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpWritePicture_h
#define vpWritePicture_h

#include <string>

#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  Writes a picture in the format of its name's ending, whole or not at all. \throw vpException (ioError) where
  it cannot be written.
*/
VISP_EXPORT void vpWritePicture(const std::string &name, const cv::Mat &picture);

END_VISP_NAMESPACE

#endif
