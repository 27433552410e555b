/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPathFollower_h
#define vpPathFollower_h

#include <visp3/vlp_servo/vpPathReference.h>
#include <visp3/vlp_servo/vpPointServo.h>

BEGIN_VISP_NAMESPACE

struct VISP_EXPORT vpPathFollowerSettings {
  vpReferenceSettings reference;
  vpPointServoSettings servo;
  double errorFree = 0.05;    // m off the reference, up to which it keeps its speed
  double errorSlowest = 0.25; // m, from which on it goes no faster than the share slowestShare
  double slowestShare = 0.2;
  double turnFirst = 1;        // rad off the path's heading, from which on the base first turns on the spot
  double turnTolerance = 0.01; // rad, to which it turns before it drives on
  double endTolerance = 0.003; // m along the path, to which it drives to the end, or back to it

  //! \throw vpException (badValue) with one line: the field, what came and what was expected.
  void check() const;
};

/*!
  Takes a base along a path: the reference ahead (vpPathReference), the base after it (vpPointServo).

  It joins the path at the place closest to the base: of its first leg, and if it is closed of its first half.
  At corners it turns on the spot, where only the heading is controlled. A base that lags or is off slows the
  reference.
*/
class VISP_EXPORT vpPathFollower
{
public:
  //! \throw vpException (badValue) where the settings are out of range.
  vpPathFollower(const vpPath &path, const vpBaseLimits &limits, const vpPathFollowerSettings &settings);

  /*!
    The velocity for a base at \e wMb, one period of \e dt (s) after the call before. \param share Of the
    speed that it may have, 0 to 1. With 0 the reference waits, and the velocity is 0; the next time it goes
    on from the place of the path that is then closest.
  */
  vpBaseVelocity follow(const vpHomogeneousMatrix &wMb, double share, double dt);

  //! The last command was limited: its errors are not disturbances of the wheels.
  void commandWasCut() { m_cut = true; }

  const vpReference &reference() const { return m_reference.now(); }
  const vpPointServo &servo() const { return m_servo; }
  bool arrived() const { return m_arrived; }
  //! The reference is at the end of the path, whether the base is or not.
  bool atEnd() const { return m_reference.arrived(); }
  double end() const { return m_reference.end(); } // m, s of the end

private:
  void join(const vpHomogeneousMatrix &wMb);
  void joinAgain(const vpHomogeneousMatrix &wMb);
  double shareByError() const;

  vpPathFollowerSettings m_settings;
  vpPath m_path;
  vpPathReference m_reference;
  vpPointServo m_servo;
  bool m_joined = false;
  bool m_waiting = false;
  bool m_cut = false;
  bool m_arrived = false;
};

END_VISP_NAMESPACE

#endif
