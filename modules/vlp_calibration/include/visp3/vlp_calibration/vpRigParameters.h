/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpRigParameters_h
#define vpRigParameters_h

#include <array>
#include <string>

#include <Eigen/Core>
#include <visp3/vlp_core/vpVlpRig.h>

BEGIN_VISP_NAMESPACE

/*!
  \file vpRigParameters.h
  The rig parameters that lamps can calibrate, as a step from the values in the rig's files: translation of
  the camera in b (x, y, z, m); its rotation by a rotation vector in b, on top of the rig's (roll, pitch, yaw,
  rad about x, y, z of b); its principal point (u0, v0, pixels of the picture as delivered); its focal length
  (focal, a share of px and py, whose ratio stays).
*/

enum class vpRigParameter { x, y, z, roll, pitch, yaw, u0, v0, focal };

constexpr int vpRigParameterCount = 9;

using vpRigVector = Eigen::Matrix<double, vpRigParameterCount, 1>;
using vpRigMatrix = Eigen::Matrix<double, vpRigParameterCount, vpRigParameterCount>;

//! What a parameter is called, and how it is shown to people.
struct VISP_EXPORT vpRigParameterInfo {
  std::string name; // as in --fix
  std::string unit; // as shown
  double shown;     // shown value of 1 m, rad, pixel or share
  double coarse;    // m, rad, px or share: less certain than this, it is as good as unknown

  static const std::array<vpRigParameterInfo, vpRigParameterCount> &all();

  //! Its index. \throw vpException (badValue) with one line that lists the names.
  static int index(const std::string &name);
};

//! The rig one step further.
VISP_EXPORT vpVlpRig vpMovedRig(const vpVlpRig &rig, const vpRigVector &step);

//! The step that vpMovedRig() takes \e from one \e to the other; both of one camera model.
VISP_EXPORT vpRigVector vpRigStep(const vpVlpRig &from, const vpVlpRig &to);

/*!
  The standard deviations that the rig's file states, as those of a step: 0 where it states none.
*/
VISP_EXPORT vpRigVector vpStatedSigma(const vpVlpRig &rig);

END_VISP_NAMESPACE

#endif
