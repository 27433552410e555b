/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpFixLog_h
#define vpFixLog_h

#include <limits>
#include <string>
#include <vector>

#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/vlp_core/vpTrajectory.h>

BEGIN_VISP_NAMESPACE

//! What became of one frame, as `vlp-locate --fixes` writes it.
struct VISP_EXPORT vpLoggedFix {
  enum class State {
    none,      //!< no position: no pose, no sigmas
    ambiguous, //!< a second pose explains the frame as well
    fix,       //!< of one frame alone
    tracking,  //!< carried from frame to frame and corrected
    coasting,  //!< the same, uncertain: lamps are too few or hidden
    relocated  //!< a place that no motion explains, not yet confirmed by a third lamp
  };

  //! Whether there is a position that is the only one.
  bool hasPosition() const { return state != State::none && state != State::ambiguous; }

  double timestamp = 0; // s
  State state = State::none;
  vpHomogeneousMatrix wMb;
  // NaN where the file has none
  double sigmaX = std::numeric_limits<double>::quiet_NaN();   // m
  double sigmaY = std::numeric_limits<double>::quiet_NaN();   // m
  double sigmaZ = std::numeric_limits<double>::quiet_NaN();   // m
  double sigmaYaw = std::numeric_limits<double>::quiet_NaN(); // rad
  double covXY = std::numeric_limits<double>::quiet_NaN();    // m^2
  double compute = 0;                                         // s, from frame to pose
};

/*!
  The fixes of a run: a CSV file `timestamp_s,x,y,z,roll,pitch,yaw,sigma_x,sigma_y,sigma_z,sigma_yaw,cov_xy,
  lamps,state,compute_s` with a row for each frame.
*/
struct VISP_EXPORT vpFixLog {
  std::vector<vpLoggedFix> fixes;

  /*!
    \throw vpException (ioError, badValue) with one line that names file, line, column, what came and what was
    expected. Frames may come late, so that times repeat or go back; a frame with a state other than none has
    a pose, one with none has not.
  */
  static vpFixLog load(const std::string &filename);

  //! Names of its columns.
  static const std::vector<std::string> &columns();

  //! Frames with a position that is the only one.
  size_t count() const;

  //! The poses of those, but for poses whose time is not after that of the one before.
  vpTrajectory trajectory() const;
};

END_VISP_NAMESPACE

#endif
