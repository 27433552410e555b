/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpServoClock_h
#define vpServoClock_h

#include <chrono>
#include <cstddef>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  The time of a control loop, on the clock of the frames' time stamps and of the odometry: the host's with a
  real robot, the world's in simulation.
*/
class VISP_EXPORT vpServoClock
{
public:
  virtual ~vpServoClock() = default;

  //! s, from one period of the loop to the next.
  virtual double period() const = 0;

  //! Waits for the next period to begin. \return now(), s.
  virtual double next() = 0;

  //! s.
  virtual double now() = 0;

  //! Periods that began late, since the one before was not over in time: by more than a tenth of one.
  virtual size_t missed() const { return 0; }
};

//! Real time: vpHostTime(), its periods kept by the steady clock.
class VISP_EXPORT vpSteadyClock : public vpServoClock
{
public:
  //! \param period s. \throw vpException (badValue) where it is not above 0.
  explicit vpSteadyClock(double period);

  double period() const override { return m_period; }
  double next() override;
  double now() override;
  size_t missed() const override { return m_missed; }

private:
  using Clock = std::chrono::steady_clock;

  double m_period; // s
  Clock::time_point m_due;
  bool m_begun = false;
  size_t m_missed = 0;
};

END_VISP_NAMESPACE

#endif
