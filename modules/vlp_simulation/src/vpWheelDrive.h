/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpWheelDrive_h
#define vpWheelDrive_h

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  Motor of one wheel: its reference runs to the goal at no more than the acceleration allowed, its speed
  follows the reference with a first-order lag. Exact for any duration, since the response to a ramp, speed(t)
  = reference(0) + a (t - lag) + (speed(0) - reference(0) + a lag) exp(-t / lag), and its integral are used
  instead of small steps.
*/
class vpWheelDrive
{
public:
  //! \e lag: s, 0 for none. \e acceleration: rad/s^2, infinite for none.
  vpWheelDrive(double lag, double acceleration) : m_lag(lag), m_acceleration(acceleration) {}

  //! Drives towards \e goal (rad/s) for \e duration (s). \return The angle rolled, rad.
  double roll(double goal, double duration);

  double speed() const { return m_speed; } // rad/s

private:
  double ramp(double slope, double duration);

  double m_lag;
  double m_acceleration;
  double m_reference = 0; // rad/s
  double m_speed = 0;     // rad/s
};

END_VISP_NAMESPACE

#endif
