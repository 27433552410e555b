/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpMobileBase_h
#define vpMobileBase_h

#include <visp3/vlp_core/vpVlpNamespace.h>
#include <visp3/vlp_robot/vpOdometry.h>

BEGIN_VISP_NAMESPACE

//! Velocity of the base in its own frame b: x forward, y left, z up, origin between the wheels on the floor.
struct VISP_EXPORT vpBaseVelocity {
  double v = 0; // m/s along x
  double w = 0; // rad/s about z, to the left
};

/*!
  How fast the base may go. Both at once share the wheels: |v| / limits.v + |w| / limits.w <= 1, which for two
  driven wheels is the speed limit of the faster one. Both are above 0.
*/
struct VISP_EXPORT vpBaseLimits {
  double v = 0; // m/s, straight on
  double w = 0; // rad/s, on the spot

  //! Share of the limit that \e velocity takes: 1 where one wheel turns as fast as it may.
  double share(const vpBaseVelocity &velocity) const;

  /*!
    \e velocity where it is within the limits, else the fastest one of the same curvature w / v.
    \throw vpException (badValue) where it is not finite.
  */
  vpBaseVelocity saturated(const vpBaseVelocity &velocity) const;
};

/*!
  A robot on wheels that takes (v, w): TurtleBot3 over OpenCR, a ROS topic, the simulator.

  Time: odometry carries the clock of the frames' time stamps: the host's clock with a real robot, the
  scenario's time in simulation. Who drives waits or advances that clock; setVelocity() returns at once.

  Safety: a command stays in force until the next one. A base with a watchdog takes each setVelocity() as the
  sign that the control loop is alive, so call it once per control period even if nothing changed; the
  interface has no thread that would serve the watchdog in place of the loop. Every way out of a loop,
  exceptions included, calls stop(); drivers of real bases also do so when they are destroyed.

  Errors are vpException: badValue for what the caller gave, ioError where the base cannot be reached, did not
  confirm, or refused. After an ioError from setVelocity() the command may or may not be in force.

  \code
  while (driving) {
    const vpOdometry odometry = base.odometry();
    base.setVelocity(v, w);
    ... // the next control period
  }
  base.stop();
  \endcode
*/
class VISP_EXPORT vpMobileBase
{
public:
  virtual ~vpMobileBase() = default;
  vpMobileBase() = default;
  vpMobileBase(const vpMobileBase &) = delete;
  vpMobileBase &operator=(const vpMobileBase &) = delete;

  /*!
    Asks for \e v (m/s) and \e w (rad/s) in b. What is beyond the limits is saturated with the curvature kept.
    \return What the base was told, after saturation and rounding to its quantum.
    \throw vpException (badValue) where v or w is not finite: the command before stays in force; (ioError).
  */
  virtual vpBaseVelocity setVelocity(double v, double w) = 0;

  //! Tells the base to stand, and forgets what rounding carried over. \throw vpException (ioError).
  virtual void stop() = 0;

  /*!
    The newest sample, the same one again until there is a newer. \throw vpException (ioError) where there is
    none, or only one too old for the driver's stated deadline.
  */
  virtual vpOdometry odometry() = 0;

  //! The same during the base's whole life.
  virtual vpBaseLimits limits() const = 0;
};

END_VISP_NAMESPACE

#endif
