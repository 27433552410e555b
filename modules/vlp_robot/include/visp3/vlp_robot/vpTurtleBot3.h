/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpTurtleBot3_h
#define vpTurtleBot3_h

#include <visp3/vlp_robot/vpMobileBase.h>

BEGIN_VISP_NAMESPACE

//! One quantity of both driven wheels, positive where the base rolls forward.
struct VISP_EXPORT vpWheels {
  double left = 0;
  double right = 0;
};

/*!
  Kinematics and limits of the TurtleBot3 as ROBOTIS states them (firmware OpenCR, e-manual).

  With wheel radius r, separation s and wheel speeds L, R in rad/s: v = r (R + L) / 2, w = r (R - L) / s.

  The limit of the wheels is the lowest that anything on the way sets, so that nothing further down clips a
  command and bends its curvature. Burger: its motors' velocity limit, 265 units of 0.229 rpm, 0.2097 m/s at
  the rim (below the firmware's 0.2108 m/s and the 0.22 m/s of the data sheet). Waffle: the 0.26 m/s of the
  data sheet (below its motors' 330 units, 0.2611 m/s).
*/
struct VISP_EXPORT vpTurtleBot3 {
  enum class Model { burger, waffle };

  static constexpr double tick = 6.283185307179586476925 / 4096;               // rad, of the encoder
  static constexpr double velocityUnit = 0.229 * 6.283185307179586476925 / 60; // rad/s, of the motors
  static constexpr double commandCounts = 100; // integers of a command per m/s and per rad/s

  explicit vpTurtleBot3(Model model = Model::burger);

  //! Wheel speeds, rad/s.
  vpWheels wheelSpeeds(const vpBaseVelocity &velocity) const;
  //! And back: velocity of the base from wheel speeds in rad/s.
  vpBaseVelocity velocity(const vpWheels &speeds) const;
  vpBaseLimits limits() const;

  double wheelRadius = 0;     // m
  double wheelSeparation = 0; // m between the wheels' middles
  double wheelSpeedLimit = 0; // rad/s
};

/*!
  Velocities as the TurtleBot3 takes them: whole hundredths of m/s and rad/s, within its limits. The firmware
  truncates, so it is the host that rounds, to the nearest (a tie goes towards zero). A quantum is coarse: the
  paper's 0.004 m/s is less than one. With dithering each axis carries what rounding left out over to the next
  command, so that the mean over commands of equal duration is the velocity asked for, and at no time are the
  two sums more than half a quantum apart. Zero always gives zero. Where rounding up would pass the limits the
  next lower step is taken; only there the mean falls short, by less than a quantum.
*/
class VISP_EXPORT vpVelocityRounding
{
public:
  vpVelocityRounding(const vpBaseLimits &limits, bool dither) : m_limits(limits), m_dither(dither) {}

  /*!
    The command for \e velocity, saturated first (vpBaseLimits::saturated()). The integers on the wire are
    std::lround(v * commandCounts) and std::lround(w * commandCounts).
    \throw vpException (badValue) where \e velocity is not finite.
  */
  vpBaseVelocity next(const vpBaseVelocity &velocity);

  //! Forgets what was carried over, as after a stop.
  void reset() { m_carry = vpBaseVelocity(); }

private:
  vpBaseLimits m_limits;
  bool m_dither;
  vpBaseVelocity m_carry; // asked for and not yet commanded, counts
};

END_VISP_NAMESPACE

#endif
