/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCameraFit_h
#define vpCameraFit_h

#include <vector>

#include <visp3/vlp_calibration/vpCameraCalibration.h>

BEGIN_VISP_NAMESPACE

/*!
  Fits a model's parameters and a pose of each board to the points, from where OpenCV says that all is, and
  tells `values`, `covariance`, `rms` and `views`. The middle of a disc's picture is not the picture of its
  middle (Heikkila 2000): by how much is computed from the fit, and taken off.
  \return False where that comes to no end. \throw cv::Exception where OpenCV sees no way to begin.
*/
bool vpFitCamera(vpCameraCalibration::Model model, const std::vector<vpBoardSight> &sights,
                 unsigned int width, unsigned int height, vpCameraEstimate &estimate);

END_VISP_NAMESPACE

#endif
