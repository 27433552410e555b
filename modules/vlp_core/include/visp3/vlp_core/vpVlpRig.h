/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpRig_h
#define vpVlpRig_h

#include <optional>
#include <string>

#include <Eigen/Core>
#include <visp3/core/vpCameraParameters.h>
#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/vlp_core/vpRollingShutter.h>

BEGIN_VISP_NAMESPACE

/*!
  The camera as mounted on the robot: the content of a rig.yaml.
*/
struct VISP_EXPORT vpVlpRig {
  std::string cameraFile;    // ViSP XML that the parameters came from, path as written in the rig file
  std::string cameraName;    // name of the camera in that XML
  vpCameraParameters camera; // of the picture as delivered
  unsigned int width = 0;    // pixels of the picture as delivered
  unsigned int height = 0;
  vpRollingShutter shutter;
  vpPictureResize resize;
  vpHomogeneousMatrix bMc;                                    // camera in the robot base frame
  Eigen::Vector3d translationSigma = Eigen::Vector3d::Zero(); // m
  //! rad, standard deviations about the axes x, y and z of b, of a camera that is turned about its own
  //! centre.
  Eigen::Vector3d rotationSigma = Eigen::Vector3d::Zero();
  std::optional<double> principalPointSigma; // px of the picture as delivered, of u0 and of v0
  std::optional<double> focalLengthSigma;    // share

  //! The vertical of a robot that stands level, in the camera's frame.
  Eigen::Vector3d verticalInCamera() const { return {bMc[2][0], bMc[2][1], bMc[2][2]}; }

  vpLineTiming lineTiming() const { return vpLineTiming(shutter, resize, width, height); }

  //! Where row_time_sigma_s is left out: an uncalibrated row time, this share of it.
  static constexpr double uncalibratedRowTime = 0.01;
  //! The same of exposure_sigma_s: an exposure that may be off by a factor of two.
  static constexpr double uncalibratedExposure = 1;

  /*!
    Reads a rig.yaml and the camera XML that it names (relative to the rig file).
    \throw vpException with one line that names file, line, field, what came and what was expected.
  */
  static vpVlpRig load(const std::string &filename);

  /*!
    Writes a rig.yaml that load() reads back, and beside it the camera XML of `cameraFile`. Both to temporary
    names first, then renamed.
  */
  void save(const std::string &filename) const;
};

END_VISP_NAMESPACE

#endif
