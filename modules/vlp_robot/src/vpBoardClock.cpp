/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_robot/vpBoardClock.h>

#include <algorithm>

BEGIN_VISP_NAMESPACE

namespace
{
constexpr double truncation = 1e-3; // s
}

std::int32_t vpBoardClock::sinceLast(std::uint32_t millis) const
{
  return m_started ? static_cast<std::int32_t>(millis - m_lastMillis) : 0; // modulo 2^32
}

double vpBoardClock::hostTime(std::uint32_t millis, double from, double until)
{
  const double elapsed = 1e-3 * sinceLast(millis);
  m_board += elapsed;
  m_lastMillis = millis;

  const double earliest = from - m_board - truncation, latest = until - m_board;
  const double drift = maxDrift * std::max(elapsed, 0.0);
  m_earliest = std::max(m_earliest - drift, earliest);
  m_latest = std::min(m_latest + drift, latest);
  if (!m_started || m_earliest > m_latest) {
    m_earliest = earliest;
    m_latest = latest;
    m_started = true;
  }
  const double begin = std::max(from, m_board + m_earliest);
  const double end = std::min(until, m_board + truncation + m_latest);
  m_uncertainty = std::max(end - begin, 0.0) / 2;
  return std::clamp((begin + end) / 2, from, until);
}

END_VISP_NAMESPACE
