/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_simulation/vpLampLight.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

namespace
{
using Stretches = std::vector<std::pair<double, double>>;

Stretches litStretches(const vpModulation &modulation)
{
  const double duty = modulation.duty.value_or(0.5);
  switch (modulation.kind) {
  case vpModulation::Kind::pwm:
    return {{0, duty}};
  case vpModulation::Kind::twoPulse:
    return {{0, 0.5 * duty}, {modulation.phaseDifference, modulation.phaseDifference + 0.5 * duty}};
  case vpModulation::Kind::word: {
    Stretches lit;
    const std::string chips = modulation.chips();
    const auto length = static_cast<double>(chips.size());
    for (size_t k = 0; k < chips.size(); ++k) {
      if (chips[k] == '1') {
        lit.emplace_back(k / length, (k + 1) / length);
      }
    }
    return lit;
  }
  case vpModulation::Kind::unmodulated:
    break;
  }
  return {};
}

/*!
  Integrals over the periods from 0 to \e x of the light, and of the light times the period: those of the
  whole periods in closed form, that of the begun one stretch by stretch.
*/
void integrate(const Stretches &lit, double x, double &sum, double &moment)
{
  const double whole = std::floor(x);
  const double begun = x - whole;
  double period = 0, periodMoment = 0, part = 0, partMoment = 0;
  for (const auto &[from, to] : lit) {
    period += to - from;
    periodMoment += 0.5 * (to * to - from * from);
    const double end = std::clamp(begun, from, to);
    part += end - from;
    partMoment += 0.5 * (end * end - from * from);
  }
  sum = whole * period + part;
  moment = 0.5 * whole * (whole - 1) * period + whole * periodMoment + whole * part + partMoment;
}
} // namespace

vpLampLight::vpLampLight(const vpModulation &modulation, double rate, double phase)
    : m_frequency(modulation.repetitionFrequency() * rate), m_phase(phase - std::floor(phase)),
      m_lit(litStretches(modulation))
{
  static const double fastest = 1e9; // Hz; the square of the periods in an exposure still has digits to spare
  if (modulation.kind != vpModulation::Kind::unmodulated && !(m_frequency > 0 && m_frequency <= fastest)) {
    throw vpException(vpException::badValue, "lamp light: it repeats at " + vpNumberText(m_frequency) +
                                                 " Hz, expected more than 0 and at most " +
                                                 vpNumberText(fastest));
  }
  for (size_t k = 1; k < m_lit.size(); ++k) {
    if (m_lit[k].first < m_lit[k - 1].second) {
      throw vpException(vpException::badValue,
                        "lamp light: phase difference " + vpNumberText(modulation.phaseDifference) +
                            " with duty " + vpNumberText(modulation.duty.value_or(0.5)) +
                            ", expected at least half the duty, or the two pulses overlap");
    }
  }
}

//! Adds sign times the light from \e from until \e to (s), and its moment about \e pivot (s^2), which is
//! near: about time 0, the squares of hours would take the digits of microseconds.
void vpLampLight::addLight(double from, double to, double sign, double pivot, double &sum,
                           double &moment) const
{
  if (m_frequency <= 0) {
    sum += sign * (to - from);
    moment += sign * (to - from) * (0.5 * (from + to) - pivot);
    return;
  }
  // Counted from the period that the stretch begins in: after hours, digits would be lost.
  const double turns = from * m_frequency + m_phase;
  const double origin = std::floor(turns);
  const double start = turns - origin;
  double sumFrom, sumTo, momentFrom, momentTo;
  integrate(m_lit, start, sumFrom, momentFrom);
  integrate(m_lit, start + (to - from) * m_frequency, sumTo, momentTo);
  const double light = (sumTo - sumFrom) / m_frequency;
  const double zero = from - pivot - start / m_frequency; // s, where that period begins
  sum += sign * light;
  moment += sign * (zero * light + (momentTo - momentFrom) / (m_frequency * m_frequency));
}

void vpLampLight::addDark(double from, double to)
{
  // Kept apart from each other: what two of them share would be taken away twice.
  for (auto dark = m_dark.begin(); dark != m_dark.end();) {
    if (dark->first <= to && from <= dark->second) {
      from = std::min(from, dark->first);
      to = std::max(to, dark->second);
      dark = m_dark.erase(dark);
    } else {
      ++dark;
    }
  }
  m_dark.emplace_back(from, to);
}

vpLampLight::Exposed vpLampLight::over(double from, double to) const
{
  double sum = 0, moment = 0; // moment about from
  const double middle = 0.5 * (from + to);
  addLight(from, to, 1, from, sum, moment);
  for (const auto &[begin, end] : m_dark) {
    const double first = std::max(from, begin), last = std::min(to, end);
    if (first < last) {
      addLight(first, last, -1, from, sum, moment);
    }
  }
  const double exposure = to - from;
  if (!(sum > 1e-9 * exposure)) {
    return {0, middle};
  }
  return {std::min(sum / exposure, 1.0), std::clamp(from + moment / sum, from, to)};
}

END_VISP_NAMESPACE
