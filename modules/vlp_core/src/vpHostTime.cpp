/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpHostTime.h>

#include <chrono>

BEGIN_VISP_NAMESPACE

double vpHostTime()
{
  using Steady = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  static const Steady::time_point begin = Steady::now();
  static const Seconds offset = std::chrono::system_clock::now().time_since_epoch();
  return (offset + Seconds(Steady::now() - begin)).count();
}

END_VISP_NAMESPACE
