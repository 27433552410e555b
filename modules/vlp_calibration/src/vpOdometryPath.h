/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpOdometryPath_h
#define vpOdometryPath_h

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_robot/vpOdometry.h>

BEGIN_VISP_NAMESPACE

//! From one pose on the floor to another: in the frame of the first one.
struct vpPlanarStep {
  double dt = 0;     // s
  double x = 0;      // m
  double y = 0;      // m
  double turn = 0;   // rad
  double along = 0;  // m rolled, backwards negative
  double length = 0; // m rolled, either way
  double turned = 0; // rad, either way
};

//! Pose on the floor: x, y (m) and yaw (rad) in w.
using vpPlanarPose = Eigen::Vector3d;

//! The pose that \e step leads to.
vpPlanarPose vpAfter(const vpPlanarPose &pose, const vpPlanarStep &step);

//! Where a base went by its odometry alone: along it and about it by cubics between the samples, these
//! without the steps of encoders.
class vpOdometryPath
{
public:
  explicit vpOdometryPath(const std::vector<vpOdometry> &samples);

  //! Nothing where a time (s) is before the first sample or more than a little after the last one, or where
  //! samples are missing in between.
  std::optional<vpPlanarStep> step(double from, double until) const;

  //! The same, but over missing samples as if the one behind them were their mean.
  std::optional<vpPlanarStep> roughStep(double from, double until) const;

private:
  struct Point {
    double time;
    vpPlanarPose pose;
    double along, length, turned; // since the start
    double v, w;                  // of the interval that ends here
  };
  Point at(double time) const;

  std::vector<Point> m_points;
};

END_VISP_NAMESPACE

#endif
