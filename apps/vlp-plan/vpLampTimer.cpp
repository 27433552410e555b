/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampTimer.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "vpPlanText.h"

BEGIN_VISP_NAMESPACE

namespace
{
const double mostCycles = 65536; // of a period: 16 bits

std::vector<unsigned int> oneTo(unsigned int most)
{
  std::vector<unsigned int> all(most);
  std::iota(all.begin(), all.end(), 1);
  return all;
}

std::string whole(double value)
{
  return std::to_string(std::lround(value));
}

//! By their data sheets, each at its usual clock.
const std::vector<vpLampTimer> &timers()
{
  static const std::vector<vpLampTimer> all = {
      {"avr", 16e6, "clock / ", "ICR1", "OCR1A", -1, {1, 8, 64, 256, 1024}}, // timer 1, fast PWM, mode 14
      {"stm32", 72e6, "PSC = -1 + ", "ARR", "CCR1", 0, oneTo(65536)},        // general purpose, PWM mode 1
      {"rp2040", 125e6, "DIV = ", "TOP", "CC", 0, oneTo(255)},               // PWM slice, whole dividers
      {"esp32", 160e6, "prescale = -1 + ", "period", "compare", 0, oneTo(256)}}; // MCPWM, counting up
  return all;
}
} // namespace

std::vector<std::string> vpLampTimer::names()
{
  std::vector<std::string> names;
  for (const vpLampTimer &timer : timers()) {
    names.push_back(timer.name);
  }
  return names;
}

vpLampTimer vpLampTimer::named(const std::string &name)
{
  const auto found = std::find_if(timers().begin(), timers().end(),
                                  [&name](const vpLampTimer &timer) { return timer.name == name; });
  if (found == timers().end()) {
    throw vpException(vpException::badValue, "timer: " + vpShown(name) + ", expected one that is known");
  }
  return *found;
}

unsigned int vpLampTimer::prescalerFor(double lowest) const
{
  const auto enough = std::find_if(prescalers.begin(), prescalers.end(), [&](unsigned int prescaler) {
    return clock / prescaler / lowest <= mostCycles;
  });
  if (enough == prescalers.end()) {
    throw vpException(vpException::badValue, "--timers: " + name + " does not reach " + vpFigureText(lowest) +
                                                 " Hz, expected a slower --clock or higher --frequencies");
  }
  return *enough;
}

vpReportTable vpLampTimer::registers(const vpLampMap &map, unsigned int prescaler) const
{
  vpReportTable table;
  table.heading = "Registers of " + name + ", " + vpFigureText(1e-6 * clock) + " MHz, " + prescalerRegister +
                  std::to_string(prescaler);
  table.columns = {"lamp", "Hz", periodRegister, compareRegister};
  for (const vpLamp &lamp : map.lamps) {
    const bool word = lamp.modulation.kind == vpModulation::Kind::word;
    const double rate = word ? lamp.modulation.chipRate : lamp.modulation.frequency,
                 cycles = std::round(clock / prescaler / rate);
    const double lit = std::round(lamp.modulation.duty.value_or(0) * cycles) + compareOffset;
    table.rows.push_back({lamp.id, vpNumberText(rate), whole(cycles - 1), word ? "each chip" : whole(lit)});
  }
  table.note = "A period is one cycle more than its register.";
  return table;
}

END_VISP_NAMESPACE
