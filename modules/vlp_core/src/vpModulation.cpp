/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpModulation.h>

#include <cmath>

BEGIN_VISP_NAMESPACE

namespace
{
//! Fourier coefficient k of one pulse per period, lit from 0 to `width` periods.
std::complex<double> pulseHarmonic(int k, double width)
{
  if (k == 0) {
    return width;
  }
  const double phase = M_PI * k * width;
  return std::sin(phase) / (M_PI * k) * std::polar(1.0, -phase); // polar takes no negative magnitude
}

//! exp(-2 i pi turns)
std::complex<double> delay(double turns)
{
  return std::polar(1.0, -2 * M_PI * turns);
}
} // namespace

std::string vpModulation::chips() const
{
  if (kind != Kind::word || code == Code::ook) {
    return kind == Kind::word ? bits : std::string();
  }
  std::string chips;
  chips.reserve(2 * bits.size());
  for (const char bit : bits) {
    chips += bit == '1' ? "10" : "01";
  }
  return chips;
}

double vpModulation::repetitionFrequency() const
{
  switch (kind) {
  case Kind::pwm:
  case Kind::twoPulse:
    return frequency;
  case Kind::word: {
    const size_t length = chips().size();
    return length == 0 ? 0 : chipRate / static_cast<double>(length);
  }
  case Kind::unmodulated:
    break;
  }
  return 0;
}

bool vpModulation::sameWord(const std::string &chips, const std::string &others)
{
  return chips.size() == others.size() && (chips + chips).find(others) != std::string::npos;
}

bool vpModulation::sameSignal(const vpModulation &other) const
{
  if (kind != other.kind) {
    return false;
  }
  switch (kind) {
  case Kind::pwm:
    return frequency == other.frequency && duty == other.duty;
  case Kind::twoPulse:
    return frequency == other.frequency && duty == other.duty && phaseDifference == other.phaseDifference;
  case Kind::word:
    return chipRate == other.chipRate && sameWord(chips(), other.chips());
  case Kind::unmodulated:
    break;
  }
  return true;
}

std::complex<double> vpModulation::harmonic(int k) const
{
  switch (kind) {
  case Kind::pwm:
    return pulseHarmonic(k, duty.value_or(0.5));
  case Kind::twoPulse:
    return pulseHarmonic(k, duty.value_or(0.5) / 2) * (1.0 + delay(k * phaseDifference));
  case Kind::word: {
    const std::string lit = chips();
    const long long length = static_cast<long long>(lit.size());
    std::complex<double> sum = 0;
    for (long long n = 0; n < length; ++n) {
      if (lit[static_cast<size_t>(n)] == '1') {
        sum +=
            delay(static_cast<double>(k * n % length) / static_cast<double>(length)); // whole turns dropped
      }
    }
    return length == 0 ? sum : sum * pulseHarmonic(k, 1 / static_cast<double>(length));
  }
  case Kind::unmodulated:
    break;
  }
  return k == 0 ? 1 : 0;
}

END_VISP_NAMESPACE
