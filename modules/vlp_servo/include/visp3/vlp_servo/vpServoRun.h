/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpServoRun_h
#define vpServoRun_h

#include <functional>
#include <string>
#include <vector>

#include <visp3/vlp_localization/vpVlpFix.h>
#include <visp3/vlp_robot/vpOdometry.h>
#include <visp3/vlp_servo/vpPathReference.h>

BEGIN_VISP_NAMESPACE

//! One period of a control loop.
struct VISP_EXPORT vpServoStep {
  double time = 0;         // s, when it began
  bool located = false;    // there was a pose
  vpHomogeneousMatrix wMb; // the pose that the command rests on: that at time + actuation delay
  double sigma = 0;        // m, of the worse of its x and y
  vpReference reference;   // where the base should be then
  vpBaseVelocity wanted;   // out of the control law
  vpBaseVelocity told;     // what the base was told
  double share = 0;        // of the speed that it was allowed
  std::string waiting;     // why it was allowed none, or empty
};

//! From a picture to the first command that rests on it.
struct VISP_EXPORT vpPictureDelay {
  double timestamp = 0; // s, of the picture
  double known = 0;     // s, when its pose was there
  double command = 0;   // s, when the command was given
  double compute = 0;   // s, that the localizer took
  bool fix = false;     // it has a pose; else there is no such command
};

//! What a control loop did.
struct VISP_EXPORT vpServoRun {
  enum class End {
    arrived, //!< the path was driven to its end
    stopped, //!< somebody wanted it to end
    failed   //!< an error or a safety limit ended it
  };

  std::vector<vpServoStep> steps;
  std::vector<vpPictureDelay> pictures;
  std::vector<vpOdometry> odometry; // each sample once
  size_t missed = 0;                // periods that began late
  End end = End::failed;
  std::string reason; // of its end, in one line; empty where it arrived
};

//! How far a base is off its path.
struct VISP_EXPORT vpTrackError {
  double time = 0;      // s
  double s = 0;         // m, of the closest place of the path, over all laps
  double across = 0;    // m, to the left
  double heading = 0;   // rad, to the left of the path's
  bool turning = false; // on the spot: the heading means nothing
};

/*!
  The errors of \e run, one for each of its periods from the first in which the reference moved to that before
  the last. \param wMb Where the base is at a time (s): the truth, where it is known. It is compared with the
  closest place of the path within 0.3 m of the reference, so that a path may cross itself.
*/
VISP_EXPORT std::vector<vpTrackError> vpTrackErrorsOf(const vpPath &path, const vpServoRun &run,
                                                      const std::function<vpHomogeneousMatrix(double)> &wMb);

//! The same of the poses that the run itself estimated.
VISP_EXPORT std::vector<vpTrackError> vpTrackErrorsOf(const vpPath &path, const vpServoRun &run);

END_VISP_NAMESPACE

#endif
