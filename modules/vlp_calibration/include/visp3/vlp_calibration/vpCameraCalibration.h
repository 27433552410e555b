/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCameraCalibration_h
#define vpCameraCalibration_h

#include <string>
#include <vector>

#include <Eigen/Core>
#include <visp3/core/vpCameraParameters.h>
#include <visp3/vlp_calibration/vpBoard.h>
#include <visp3/vlp_core/vpCameraXml.h>

BEGIN_VISP_NAMESPACE

//! One picture of the board compared with the result.
struct VISP_EXPORT vpCalibratedView {
  std::string picture;
  double rms = 0;                                 // px, reprojection error along each axis
  bool used = true;                               // false: an outlier
  double tilt = 0;                                // rad, of the board against the picture plane
  std::vector<Eigen::Vector2d> points, residuals; // px; measured minus predicted
};

//! A camera as pictures of a board show it, or why they do not.
struct VISP_EXPORT vpCameraEstimate {
  bool valid = false;
  std::string refusal;            // one line that says what to do, where not valid
  vpCameraParameters camera;      // of a ViSP model; of OpenCV's: its linear part
  std::vector<std::string> names; // of the parameters: px, py, u0, v0, and the distortion's
  Eigen::VectorXd values;         // of each
  Eigen::MatrixXd covariance;     // of each
  double rms = 0;                 // px, along each axis
  double coverage = 0;            // share of an 8 x 6 grid over the picture that shows a point
  std::vector<vpCalibratedView> views;
};

/*!
  Intrinsic parameters from pictures of a flat board (Zhang 2000). OpenCV gives the start; then all parameters
  of the chosen model and the board's poses are fitted to the points (Ceres), whose scatter gives the standard
  deviations.

  visp: u = u0 + px x (1 + kud r^2), ViSP's perspective projection with distortion; kdu, its way back, is
  fitted to kud over the picture, since the two are no exact inverses of each other. kannalaBrandt: as of
  vpCameraParameters. opencv: k1, k2, p1, p2, k3, for which ViSP has no camera.

  Pictures whose error is far beyond that of the others are named and left out.
*/
class VISP_EXPORT vpCameraCalibration
{
public:
  enum class Model { perspective, visp, kannalaBrandt, opencv };

  Model model = Model::visp;
  size_t fewestViews = 5;
  double outlier = 3;                // times the median error of all pictures
  double worstFocal = 0.01;          // share: a less certain focal length is refused
  double worstPrincipalPoint = 0.01; // likewise, of the picture's width

  /*!
    \param width, height Of the pictures, px. Refuses, with one line that says what to do: too few pictures,
    all from one place, boards that are hardly tilted, focal lengths or principal points that cannot be.
  */
  vpCameraEstimate solve(const std::vector<vpBoardSight> &sights, unsigned int width,
                         unsigned int height) const;

private:
  bool fit(const std::vector<vpBoardSight> &sights, unsigned int width, unsigned int height,
           vpCameraEstimate &estimate) const;
  std::string degenerate(const vpCameraEstimate &estimate, unsigned int width, unsigned int height) const;
};

//! A ROS camera_info YAML: plumb_bob of perspective, visp and opencv, equidistant of Kannala-Brandt.
VISP_EXPORT std::string vpCameraInfoYaml(const vpCameraEstimate &estimate, vpCameraCalibration::Model model,
                                         const std::string &name, unsigned int width, unsigned int height);

/*!
  The camera of such a file. plumb_bob whose only coefficient is k1 becomes ViSP's perspective projection with
  distortion, k1 its kud; equidistant becomes Kannala-Brandt. \throw vpException with file, line, field, what
  came and what was expected. ViSP has no camera for more coefficients of plumb_bob: these are refused.
*/
VISP_EXPORT vpCameraXml vpCameraFromInfo(const std::string &filename);

END_VISP_NAMESPACE

#endif
