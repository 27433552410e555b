/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_robot/vpBoardClock.h>

#include <algorithm>

BEGIN_VISP_NAMESPACE

std::int32_t vpBoardClock::sinceLast(std::uint32_t millis) const
{
  return m_started ? static_cast<std::int32_t>(millis - m_lastMillis) : 0; // modulo 2^32
}

double vpBoardClock::hostTime(std::uint32_t millis, double arrival)
{
  const double elapsed = 1e-3 * sinceLast(millis);
  m_board += elapsed;
  m_lastMillis = millis;
  const double bound = arrival - m_board;
  m_offset = std::min(m_offset + maxDrift * std::max(elapsed, 0.0), bound);
  if (!m_started || bound - m_offset > oldest) {
    m_offset = bound;
    m_started = true;
  }
  return m_board + m_offset;
}

void vpBoardClock::reset()
{
  m_started = false;
  m_board = 0;
}

END_VISP_NAMESPACE
