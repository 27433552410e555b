/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_servo/vpServoClock.h>

#include <cmath>
#include <thread>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpHostTime.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

namespace
{
double seconds(std::chrono::steady_clock::duration duration)
{
  return std::chrono::duration<double>(duration).count();
}
} // namespace

vpSteadyClock::vpSteadyClock(double period) : m_period(period)
{
  if (!(period > 0 && std::isfinite(period))) {
    throw vpException(vpException::badValue,
                      "clock: period: " + vpNumberText(period) + ", expected a number of seconds above 0");
  }
}

double vpSteadyClock::now()
{
  return vpHostTime();
}

double vpSteadyClock::next()
{
  const auto step = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(m_period));
  const Clock::time_point begin = Clock::now();
  m_due = m_begun ? m_due + step : begin;
  m_begun = true;
  constexpr double tolerated = 0.1; // of a period
  if (seconds(begin - m_due) > tolerated * m_period) {
    ++m_missed;
    m_due = begin; // what was missed is not caught up with
  }
  std::this_thread::sleep_until(m_due);
  return now();
}

END_VISP_NAMESPACE
