/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpServoLoop_h
#define vpServoLoop_h

#include <functional>

#include <visp3/vlp_robot/vpMobileBase.h>
#include <visp3/vlp_servo/vpPathFollower.h>
#include <visp3/vlp_servo/vpPoseSource.h>
#include <visp3/vlp_servo/vpServoClock.h>
#include <visp3/vlp_servo/vpServoRun.h>
#include <visp3/vlp_servo/vpServoSafety.h>

BEGIN_VISP_NAMESPACE

struct VISP_EXPORT vpServoLoopSettings {
  vpPathFollowerSettings follower;
  vpServoSafetySettings safety;
  double actuationDelay = 0.04; // s, from a command to the base's doing it: motors' lag, and half a period
};

/*!
  Drives a base along a path: run() is the whole of it. Pictures are located elsewhere (vpPictureFeed), so
  that the loop keeps its period; between them odometry carries the pose.

  \code
  vpVlpPose poses(pictures);
  vpSteadyClock clock(0.02);
  vpServoLoop loop(base, poses, clock, vpPath::load("square.yaml"), vpServoLoopSettings());
  const vpServoRun run = loop.run(); // the base stands once it returns, and where it throws
  \endcode
*/
class VISP_EXPORT vpServoLoop
{
public:
  //! V, of the base's battery, asked once a second or so; empty: unknown.
  std::function<double()> battery;
  //! Called in each period with what happened and the pictures that became known; false ends the run.
  std::function<bool(const vpServoStep &, const std::vector<vpLocatedPicture> &)> watch;

  //! base, poses and clock outlive this. \throw vpException (badValue) where the settings are out of range.
  vpServoLoop(vpMobileBase &base, vpPoseSource &poses, vpServoClock &clock, const vpPath &path,
              const vpServoLoopSettings &settings);

  /*!
    Drives to the end of the path, or until something ends it before. The base is told to stop on every way
    out. An error of the base ends the run, and is its reason. \throw vpException, or whatever \e watch
    throws, where anything else goes wrong.
  */
  vpServoRun run();

private:
  std::vector<vpLocatedPicture> sense(double now);
  vpServoStep step(double now);
  void noteDelays(const std::vector<vpLocatedPicture> &pictures);
  bool goesOn(const vpServoStep &step, const std::vector<vpLocatedPicture> &pictures);

  vpMobileBase &m_base;
  vpPoseSource &m_poses;
  vpServoClock &m_clock;
  vpServoLoopSettings m_settings;
  vpPathFollower m_follower;
  vpServoSafety m_safety;
  bool m_failed = false;          // for good, by the safety
  double m_batteryAsked = -1e300; // s
  vpServoRun m_run;
};

END_VISP_NAMESPACE

#endif
