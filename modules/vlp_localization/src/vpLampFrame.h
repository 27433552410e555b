/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampFrame_h
#define vpLampFrame_h

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpLampObservation.h>
#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_localization/vpVlpFix.h>

BEGIN_VISP_NAMESPACE

const size_t poseLamps = 2; // that a pose needs

//! Log density of a ray that is \e off.
inline double logNormal(const Eigen::Vector2d &off, const Eigen::Matrix2d &covariance)
{
  return -0.5 * (off.dot(covariance.inverse() * off) + std::log(covariance.determinant())) -
         std::log(2 * M_PI);
}

//! Logarithm of the sum of what these are the logarithms of.
inline double logSum(double a, double b)
{
  return std::max(a, b) + std::log1p(std::exp(-std::abs(a - b)));
}

//! A lamp of the map in a frame.
struct vpFrameLamp {
  size_t observation; // index of it
  const vpLamp *lamp;
  const vpLampObservation *seen;
  double time; // s, of the line that saw its middle
  vpLampSight sight;
  double logPeak; // log density of its ray where it is expected for sure
};

//! The lamps of the map that a frame shows, in the order of their lines.
struct vpLampFrame {
  const vpVlpRig *rig = nullptr;
  double lineTime = 0;   // s, from line to line
  double timestamp = 0;  // s
  double logUniform = 0; // log density of a ray that may be anywhere in the picture
  std::vector<vpFrameLamp> lamps;
};

END_VISP_NAMESPACE

#endif
