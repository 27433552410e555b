/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpProgressBar.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <unistd.h>

BEGIN_VISP_NAMESPACE

namespace
{
constexpr std::chrono::milliseconds quiet{500}, refresh{100};

std::string leftText(double seconds)
{
  const long left = std::lround(seconds);
  return left < 100 ? std::to_string(left) + " s" : std::to_string((left + 30) / 60) + " min";
}

std::string barText(size_t done, size_t total, double seconds)
{
  constexpr size_t width = 30;
  if (total == 0 || done > total) { // a video's header may promise too few
    return std::to_string(done) + " frames";
  }
  const size_t full = width * done / total;
  return "[" + std::string(full, '#') + std::string(width - full, '.') + "] " + std::to_string(done) + "/" +
         std::to_string(total) + ", " + leftText(seconds * (total - done) / std::max<size_t>(done, 1)) +
         " left";
}
} // namespace

vpProgressBar::vpProgressBar(size_t total, bool wanted)
    : m_total(total), m_wanted(wanted && isatty(STDERR_FILENO) == 1), m_next(m_start + quiet)
{
}

void vpProgressBar::show(size_t done)
{
  const Clock::time_point now = Clock::now();
  if (!m_wanted || now < m_next) {
    return;
  }
  clear();
  std::fputs(barText(done, m_total, std::chrono::duration<double>(now - m_start).count()).c_str(), stderr);
  std::fflush(stderr);
  m_shown = true;
  m_next = now + refresh;
}

void vpProgressBar::clear()
{
  if (m_shown) {
    std::fputs("\r\x1b[K", stderr); // to the line's start, and wipes it
    std::fflush(stderr);
    m_shown = false;
  }
}

END_VISP_NAMESPACE
