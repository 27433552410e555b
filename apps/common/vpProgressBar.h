/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpProgressBar_h
#define vpProgressBar_h

#include <chrono>
#include <cstddef>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  A line on stderr that says how far the work is; where stderr is no terminal it shows nothing. It appears
  after half a second, so that short work stays quiet, and is gone at the end.
*/
class vpProgressBar
{
public:
  //! \param total Steps in all, 0 where it is unknown. \param wanted False: shows nothing at all.
  explicit vpProgressBar(size_t total, bool wanted = true);
  ~vpProgressBar() { clear(); }
  vpProgressBar(const vpProgressBar &) = delete;
  vpProgressBar &operator=(const vpProgressBar &) = delete;

  //! \e done steps are over.
  void show(size_t done);

  //! Makes room for another line; the next show() brings the bar back.
  void clear();

private:
  using Clock = std::chrono::steady_clock;

  size_t m_total;
  bool m_wanted;
  bool m_shown = false;
  Clock::time_point m_start = Clock::now();
  Clock::time_point m_next;
};

END_VISP_NAMESPACE

#endif
