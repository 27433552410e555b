/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCameraOf_h
#define vpCameraOf_h

#include <visp3/vlp_calibration/vpCameraCalibration.h>

BEGIN_VISP_NAMESPACE

//! ViSP's camera of a model's parameters (of OpenCV's: its linear part), for pictures of \e width x \e height
//! px.
vpCameraParameters vpCameraOf(vpCameraCalibration::Model model, const Eigen::VectorXd &p, unsigned int width,
                              unsigned int height);

END_VISP_NAMESPACE

#endif
