/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpFilterParts_h
#define vpVlpFilterParts_h

#include <vector>

#include <visp3/vlp_localization/vpVlpFilter.h>

#include "vpLampGeometry.h"

BEGIN_VISP_NAMESPACE

//! What never changes.
struct vpVlpFilter::Given {
  explicit Given(const vpVlpRig &rig) : rig(rig), mount(rig) {}

  vpVlpRig rig;
  vpMountFrame mount;
};

//! What startAgain() goes back to.
struct vpVlpFilter::Start {
  Vector x;
  Matrix P;
  std::vector<vpOdometry> odometry;
};

//! A lamp's ray and its derivative by the state.
struct vpVlpFilter::Predicted {
  bool inFront = false;
  double depth = 0;
  Eigen::Vector2d ray = Eigen::Vector2d::Zero();
  Eigen::Matrix2d byPlace; // of ray by x and y of the lamp
  Derivative<2> H;
  Eigen::Matrix2d ownCovariance = Eigen::Matrix2d::Zero(); // of a lamp whose error is no state yet
};

END_VISP_NAMESPACE

#endif
