/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpBoardClock_h
#define vpBoardClock_h

#include <cstdint>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  Puts readings of a board's millisecond counter on the host's clock.

  A reading m, truncated, that the board made between the host's times a and b bounds the offset
  o = host - board: a - m - 1 ms <= o <= b - m. The bounds of all readings are intersected, after those of the
  past were widened by what the two clocks may have drifted apart since. So one quick answer dates the later
  slow ones. Where they contradict each other (a clock was set) the newest alone counts. The counter may roll
  over (49.7 days).
*/
class VISP_EXPORT vpBoardClock
{
public:
  double maxDrift = 200e-6; // s per s: two crystals of 100 ppm

  /*!
    s on the host's clock when the board's counter was \e millis: within \e from to \e until, between which
    the reading was made. Readings come in the order of their making.
  */
  double hostTime(std::uint32_t millis, double from, double until);

  //! s by which the last hostTime() may be off, either way.
  double uncertainty() const { return m_uncertainty; }

  //! ms that the board counted from the last reading to \e millis, negative where it went backwards: the
  //! board restarted. 0 where there is no last reading.
  std::int32_t sinceLast(std::uint32_t millis) const;

  void reset() { *this = vpBoardClock{maxDrift}; }

  vpBoardClock() = default;
  explicit vpBoardClock(double drift) : maxDrift(drift) {}

private:
  bool m_started = false;
  std::uint32_t m_lastMillis = 0;
  double m_uncertainty = 0;            // s
  double m_board = 0;                  // s that the board counted since the first reading
  double m_earliest = 0, m_latest = 0; // s, bounds of host - m_board
};

END_VISP_NAMESPACE

#endif
