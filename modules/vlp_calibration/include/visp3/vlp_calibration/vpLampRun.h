/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampRun_h
#define vpLampRun_h

#include <string>
#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpLampObservation.h>
#include <visp3/vlp_core/vpTrajectory.h>
#include <visp3/vlp_robot/vpOdometry.h>

BEGIN_VISP_NAMESPACE

//! A lamp's image point.
struct VISP_EXPORT vpLampImage {
  size_t lamp = 0;                                 // index into the map
  double time = 0;                                 // s, of its own line, on the clock of the frames
  Eigen::Vector2d point = Eigen::Vector2d::Zero(); // px, projection of the lamp's middle
  //! That point is the middle of, to the rig that the detector had; a region: nothing but the point is known.
  vpLampOutline outline;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero(); // px^2
};

//! What one frame shows of the map's lamps.
struct VISP_EXPORT vpLampView {
  double timestamp = 0; // s, of the frame
  std::string name;     // of the frame, for messages
  std::vector<vpLampImage> images;

  //! Of the observations those that are lamps of \e map, whole and with an image point of known covariance.
  static vpLampView of(double timestamp, const std::string &name,
                       const std::vector<vpLampObservation> &observations, const vpLampMap &map);

  //! s, mean of its images' times; of a frame that shows no lamp its time stamp.
  double middle() const;
};

//! A drive under lamps, as calibration sees it.
struct VISP_EXPORT vpLampRun {
  //! What is known of the robot's motion beside that it stands level on the floor z = 0.
  enum class Motion {
    wheels, //!< it rolls without slipping sideways, and by the odometry's distance where there is one
    spin,   //!< it turns on the spot, its base's origin staying in one place
    known,  //!< it was put at known places, those of `places`
    unknown //!< nothing
  };

  Motion motion = Motion::wheels;
  std::vector<vpLampView> views;    // in order of time
  std::vector<vpOdometry> odometry; // may be empty
  vpTrajectory places;              // of Motion::known; views at other times than theirs are left out
  double placeSigma = 0.0005;       // m, of the places' x and y
  double headingSigma = 0.0017;     // rad, of their yaw
};

END_VISP_NAMESPACE

#endif
