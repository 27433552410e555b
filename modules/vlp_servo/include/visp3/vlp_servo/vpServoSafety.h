/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpServoSafety_h
#define vpServoSafety_h

#include <deque>
#include <optional>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp3/vlp_robot/vpMobileBase.h>

BEGIN_VISP_NAMESPACE

struct VISP_EXPORT vpServoSafetySettings {
  double acceleration = 0.6;    // m/s^2, most of any command
  double braking = 1.5;         // m/s^2, likewise towards a stand
  double turnAcceleration = 10; // rad/s^2, likewise
  double sigmaSlow = 0.02;      // m, of x or of y, from which on the base goes slower
  double sigmaStop = 0.05;      // m, beyond which it stands
  double yawSlow = 0.1;         // rad, likewise of the yaw
  double yawStop = 0.2;         // rad
  int confirmations = 3;        // pictures in a row with a tracked pose, before it moves, and after each wait
  double pictureTimeout = 0.5;  // s without a picture, after which it stands; an older one counts for none
  double compareTime = 2;       // s, over which the pose's way has to be that of the wheels
  double wayDeviations = 5;     // standard deviations of both ends, that it may be off
  double giveUp = 20;           // s of waiting, after which the run ends
  double farthest = 0.5;        // m off the reference, beyond which the run ends: the base does not follow
  double batteryLow = 11;       // V, of the TurtleBot3's three cells, below which the run ends
  double reaction = 0.1;        // s, from a command to the base's doing it, by which the fence is kept from
  std::optional<Eigen::AlignedBox2d> fence; // m, in w: where the base's origin has to stay

  //! \throw vpException (badValue) with one line: the field, what came and what was expected.
  void check() const;
};

//! Whether the base may move.
struct VISP_EXPORT vpServoPermit {
  double share = 0;   // of the speed that it may have, 0 to 1
  std::string reason; // in one line, why it may not; empty where share is above 0
  bool final = false; // it may not any more: the run has to end
};

/*!
  Limits and stops the follower's commands before they reach the base.

  Before the first confirmed fix nothing moves. Where the pose becomes uncertain, by its covariance, or
  pictures stay away for long or are of another time than now, the base brakes to a stand and waits; once as
  many pictures as at the start have a tracked pose whose covariance is below the lower limits, it goes on.
  Between pictures, and through pictures without lamps, it may drive on odometry as long as the covariance
  allows. Leaving the fence, a low battery, a camera that is gone, a base that does not follow, a pose that
  moves otherwise than the wheels, a clock that is set back, a command that is no number, and a wait that is
  too long end the run.

  Pose and wheels: the way of the pose within the last compareTime less that of the odometry is the error of
  both poses and of the wheels. More than wayDeviations standard deviations of both poses is no chance, unless
  it is less than sigmaStop or yawStop, which the wheels may slip.
*/
class VISP_EXPORT vpServoSafety
{
public:
  //! \param needsPictures False: the pose does not come of a camera. \throw vpException (badValue).
  vpServoSafety(const vpServoSafetySettings &settings, const vpBaseLimits &limits, bool needsPictures);

  //! A picture whose pose became known at \e known, s, on the clock of its time stamp.
  void addPicture(double known, const vpVlpLocation &location);

  //! Of the wheels, each sample once.
  void addOdometry(const vpOdometry &sample);

  //! The pose \e fix is that of \e now (s) or a little later.
  vpServoPermit permit(double now, const vpVlpFix &fix);

  //! How far (m) the base is off its reference, and whether that waits for it at the end of the path. A base
  //! that is too far off, or keeps it waiting for too long, does not follow: that ends the run.
  void setOffset(double now, double offset, bool atEnd);

  //! V, as the base reports it.
  void setBattery(double voltage) { m_battery = voltage; }

  //! What happened outside, and ends the run.
  void fail(const std::string &reason);

  /*!
    The command that is closest to \e wanted within limits of speed and acceleration, \e dt (s) after the one
    before. Where the latest permit was none it is a stand, at once: the motors' lag is its ramp. So is one
    that is not finite, which ends the run.
  */
  vpBaseVelocity limited(const vpBaseVelocity &wanted, double dt);

private:
  //! Where pose and odometry had the base.
  struct Place {
    double time = 0; // s
    vpVlpFix fix;
    vpHomogeneousMatrix oMb; // from an origin o of its own
  };

  std::string unsafe(double now, const vpVlpFix &fix) const;
  std::string leavesWheels(double now, const vpVlpFix &fix);
  bool leavesFence(const vpVlpFix &fix) const;
  double share(const vpVlpFix &fix) const;

  vpServoSafetySettings m_settings;
  vpBaseLimits m_limits;
  bool m_needsPictures;
  vpBaseVelocity m_command;                         // the last one
  std::string m_undecided;                          // why the latest picture's place is not sure, or empty
  int m_confirmed = 0;                              // pictures in a row
  bool m_moving = false;                            // permitted to
  std::string m_misdated;                           // why the latest picture is not one of now, or empty
  std::optional<double> m_now;                      // s, of the last permit
  std::optional<vpOdometry> m_odometry;             // the last sample
  vpHomogeneousMatrix m_oMb;                        // of then
  std::deque<Place> m_places;                       // since it has moved, for as long as compareTime
  std::optional<double> m_lastPicture, m_waitBegan; // s
  std::optional<double> m_endBegan;                 // s, when the reference was at the end
  std::optional<double> m_battery;                  // V
  std::string m_failure;                            // for good
};

END_VISP_NAMESPACE

#endif
