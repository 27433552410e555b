/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpFix_h
#define vpVlpFix_h

#include <string>
#include <vector>

#include <Eigen/Core>
#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpLampObservation.h>
#include <visp3/vlp_core/vpVlpRig.h>

BEGIN_VISP_NAMESPACE

//! A lamp whose place is known, and the ray on which the camera sees its middle.
struct VISP_EXPORT vpLampSight {
  std::string id;
  Eigen::Vector3d position = Eigen::Vector3d::Zero(); // m, in w
  double positionSigma = 0;                           // m, of each coordinate
  Eigen::Vector2d ray = Eigen::Vector2d::Zero(); // normalised coordinates (x, y, 1) in c, without distortion
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero(); // of ray, squared normalised units

  //! From an observation of \e lamp, its point and covariance taken through the camera's inverse projection.
  static vpLampSight from(const vpLamp &lamp, const vpLampObservation &observation,
                          const vpCameraParameters &camera);
};

/*!
  A pose with its covariance, or the reason why there is none.
*/
struct VISP_EXPORT vpVlpFix {
  bool valid = false;
  std::string refusal;     // one line, where not valid
  vpHomogeneousMatrix wMb; // robot base in the map
  vpHomogeneousMatrix wMc; // camera in the map
  /*!
    Covariance of x, y, z (m) and roll, pitch, yaw (rad, small rotations about the fixed axes x, y, z of w)
    of wMb. In it: the lamps' image points, their positions in the map where the map states a sigma, and the
    mount where the rig states one: its translation, its yaw, and its roll and pitch (about x and y of b) as
    the variance of how far base and camera, rigid together, lean from the vertical. Roll and pitch that were
    taken from the rig have the rig's variance.
  */
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  std::vector<std::string> lamps;         // ids that the pose rests on
  std::vector<Eigen::Vector2d> residuals; // of each: ray measured minus ray predicted, normalised units
  double chiSquare = 0;                   // of the residuals under all errors that the covariance holds
  int degreesOfFreedom = 0;               // of chiSquare; 2 lamps with known attitude: 0
  bool ambiguous = false;                 // a second pose explains the picture as well: it is `other`
  vpHomogeneousMatrix other;              // wMb of the second pose
};

END_VISP_NAMESPACE

#endif
