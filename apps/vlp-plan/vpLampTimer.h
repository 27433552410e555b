/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampTimer_h
#define vpLampTimer_h

#include <string>
#include <vector>

#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_evaluation/vpReportTable.h>

BEGIN_VISP_NAMESPACE

/*!
  A timer that drives a lamp: it counts the cycles of a clock, divided by a prescaler, up to a period of 65536
  at most, and has the pin lit up to a compare value.
*/
struct vpLampTimer {
  std::string name;
  double clock = 0; // Hz, before the prescaler
  std::string prescalerRegister, periodRegister, compareRegister;
  int compareOffset = 0; // -1 where the compare register has the last lit cycle, 0 where the first dark one
  std::vector<unsigned int> prescalers; // that it has, ascending

  //! The names of those there are.
  static std::vector<std::string> names();
  static vpLampTimer named(const std::string &name);

  //! The smallest prescaler with which it reaches so low a rate (Hz), for all lamps of a plan. \throw
  //! vpException (badValue) where none does.
  unsigned int prescalerFor(double lowest) const;

  //! What to write into its registers for each lamp. All lamps at that prescaler.
  vpReportTable registers(const vpLampMap &map, unsigned int prescaler) const;
};

END_VISP_NAMESPACE

#endif
