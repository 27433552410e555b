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

  The board notes its counter when it measures, every 20 ms with ROBOTIS' firmware, and the host reads the
  note some time later: between the reading m and the arrival t of the answer lie the note's age and the way
  of the answer. So host - board <= t - m, and the smallest t - m of late is nearly equal to it: one that was
  noted just before it was read, and answered quickly. What is older is dated by it, late answers too. The
  bound rises by what the two clocks may drift apart. Dates are late by the quickest answer's way, a
  millisecond or so.

  The counter may roll over (49.7 days).
*/
class VISP_EXPORT vpBoardClock
{
public:
  double maxDrift = 100e-6; // s per s: two crystals of 50 ppm
  double oldest = 0.3;      // s that a reading may be old; one that seems older shows that a clock was set

  /*!
    s on the host's clock when the board's counter was \e millis, a reading that arrived at \e arrival, s.
    Readings come in the order of their making.
  */
  double hostTime(std::uint32_t millis, double arrival);

  //! ms that the board counted from the last reading to \e millis, negative where it went backwards: the
  //! board restarted. 0 where there is no last reading.
  std::int32_t sinceLast(std::uint32_t millis) const;

  //! Forgets all readings.
  void reset();

private:
  bool m_started = false;
  std::uint32_t m_lastMillis = 0;
  double m_board = 0;  // s that the board counted since the first reading
  double m_offset = 0; // s, bound of host - m_board
};

END_VISP_NAMESPACE

#endif
