/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPathReference_h
#define vpPathReference_h

#include <visp3/vlp_robot/vpMobileBase.h>
#include <visp3/vlp_servo/vpPath.h>

BEGIN_VISP_NAMESPACE

//! How the reference moves.
struct VISP_EXPORT vpReferenceSettings {
  double speed = 0.1;          // m/s along the path
  double acceleration = 0.3;   // m/s^2
  double braking = 1.5;        // m/s^2, where it is told to wait
  double turnRate = 1;         // rad/s, on the spot
  double turnAcceleration = 3; // rad/s^2
  double share = 0.85;         // of the base's limits; the rest is left to the feedback
  unsigned int laps = 1;       // of a closed path

  //! \throw vpException (badValue) with one line: the field, what came and what was expected.
  void check() const;
};

//! Where the base should be, and how it should move there.
struct VISP_EXPORT vpReference {
  double s = 0;                                    // m along the path, over all laps
  Eigen::Vector2d place = Eigen::Vector2d::Zero(); // m, in w
  double heading = 0;                              // rad
  double v = 0;                                    // m/s along the heading
  double w = 0;                                    // rad/s
  bool turning = false;                            // on the spot, at a corner
};

/*!
  The reference that moves along a path: as fast as asked for where the wheels allow it in that bend, speeding
  up and slowing down in time. It stops at corners and at the end. At a corner its heading turns, and it goes
  on after leaveCorner(), once the base has turned, too.
*/
class VISP_EXPORT vpPathReference
{
public:
  //! \throw vpException (badValue) where the settings are out of range.
  vpPathReference(const vpPath &path, const vpBaseLimits &limits, const vpReferenceSettings &settings);

  //! Stands at \e s. Where \e heading (rad) is given it first turns from there to the path's own.
  void place(double s);
  void place(double s, double heading);

  //! So much later, s. \e share: of the speed that it may have, 0 to 1; 0: it comes to a stand.
  const vpReference &advance(double dt, double share);

  //! At a corner: the base has turned. Only where turned().
  void leaveCorner();

  const vpReference &now() const { return m_now; }
  bool turned() const { return m_now.turning && m_toTurn == 0; }
  bool arrived() const { return !m_now.turning && m_now.s >= end(); }
  //! s of the end of the last lap, m.
  double end() const;
  //! s of the next place where it stands, m: a corner or the end.
  double nextStop() const;

private:
  double fastest(double s) const;
  double braked(double s, double speed) const;
  void turn(double dt, double share);
  void beginTurn(double heading);

  vpPath m_path;
  vpBaseLimits m_limits;
  vpReferenceSettings m_settings;
  vpReference m_now;
  double m_toTurn = 0; // rad, left of a turn on the spot
  double m_left = -1;  // m, s of the corner that it stands at and has turned at
};

END_VISP_NAMESPACE

#endif
