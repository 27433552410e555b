/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>
#include <functional>

#include <gtest/gtest.h>
#include <visp3/vlp_core/vpModulation.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
//! Fourier coefficient k of a signal over one period, by a plain sum; p takes the time in periods.
std::complex<double> sum(const std::function<bool(double)> &p, int k)
{
  constexpr int samples = 100000;
  std::complex<double> total = 0;
  for (int i = 0; i < samples; ++i) {
    const double t = (i + 0.5) / samples;
    if (p(t)) {
      total += std::polar(1.0 / samples, -2 * M_PI * k * t);
    }
  }
  return total;
}

void expectHarmonics(const vpModulation &modulation, const std::function<bool(double)> &p)
{
  for (int k = -12; k <= 12; ++k) {
    EXPECT_NEAR(std::abs(modulation.harmonic(k) - sum(p, k)), 0, 5e-5) << "harmonic " << k;
  }
}

vpModulation word(const std::string &bits, vpModulation::Code code)
{
  vpModulation modulation;
  modulation.kind = vpModulation::Kind::word;
  modulation.bits = bits;
  modulation.chipRate = 8000;
  modulation.code = code;
  return modulation;
}
} // namespace

TEST(Modulation, UnmodulatedHasItsMeanAlone)
{
  const vpModulation modulation;
  EXPECT_EQ(modulation.harmonic(0), 1.0);
  EXPECT_EQ(modulation.harmonic(1), 0.0);
  EXPECT_EQ(modulation.repetitionFrequency(), 0);
  EXPECT_EQ(modulation.chips(), "");
}

TEST(Modulation, PwmHarmonicsAreThoseOfTheSignal)
{
  for (const double duty : {0.05, 0.3, 0.5, 0.77}) {
    vpModulation modulation;
    modulation.kind = vpModulation::Kind::pwm;
    modulation.frequency = 2000;
    modulation.duty = duty;
    EXPECT_EQ(modulation.repetitionFrequency(), 2000);
    expectHarmonics(modulation, [duty](double t) { return t < duty; });
  }
}

TEST(Modulation, UnsetDutyCountsAsHalf)
{
  vpModulation modulation;
  modulation.kind = vpModulation::Kind::pwm;
  modulation.frequency = 2000;
  expectHarmonics(modulation, [](double t) { return t < 0.5; });
  modulation.kind = vpModulation::Kind::twoPulse;
  modulation.phaseDifference = 0.3;
  expectHarmonics(modulation, [](double t) { return t < 0.25 || (t >= 0.3 && t < 0.55); });
}

TEST(Modulation, TwoPulseHarmonicsAreThoseOfTheSignal)
{
  for (const double k : {0.2, 0.35, 0.49}) {
    vpModulation modulation;
    modulation.kind = vpModulation::Kind::twoPulse;
    modulation.frequency = 3000;
    modulation.duty = 0.3;
    modulation.phaseDifference = k;
    expectHarmonics(modulation, [k](double t) { return t < 0.15 || (t >= k && t < k + 0.15); });
  }
}

//! Why the map asks for 0 < k < 0.5: k and 1 - k are one signal, and k = 0.5 is a plain lamp of twice the
//! frequency.
TEST(Modulation, TwoPulseIsTheSameForKAndOneMinusK)
{
  vpModulation one, other;
  one.kind = other.kind = vpModulation::Kind::twoPulse;
  one.duty = other.duty = 0.25;
  one.phaseDifference = 0.35;
  other.phaseDifference = 0.65;
  for (int k = 0; k < 20; ++k) {
    EXPECT_NEAR(std::abs(one.harmonic(k)), std::abs(other.harmonic(k)), 1e-12) << k;
    // the same but for its start: later by 0.65 periods
    EXPECT_NEAR(std::abs(one.harmonic(k) - other.harmonic(k) * std::polar(1.0, 2 * M_PI * 0.65 * k)), 0,
                1e-12)
        << k;
  }
  one.phaseDifference = 0.5;
  vpModulation twice;
  twice.kind = vpModulation::Kind::pwm;
  twice.duty = 0.25;
  for (int k = 0; k < 20; ++k) {
    const std::complex<double> expected = k % 2 == 0 ? twice.harmonic(k / 2) : 0;
    EXPECT_NEAR(std::abs(one.harmonic(k) - expected), 0, 1e-12) << k;
  }
}

TEST(Modulation, ManchesterMakesTwoChipsOfABit)
{
  const vpModulation modulation = word("0110", vpModulation::Code::manchester);
  EXPECT_EQ(modulation.chips(), "01101001");
  EXPECT_DOUBLE_EQ(modulation.repetitionFrequency(), 1000);
  EXPECT_DOUBLE_EQ(modulation.harmonic(0).real(), 0.5);
  EXPECT_EQ(word("0110", vpModulation::Code::ook).chips(), "0110");
  EXPECT_DOUBLE_EQ(word("0110", vpModulation::Code::ook).repetitionFrequency(), 2000);
}

TEST(Modulation, WordHarmonicsAreThoseOfTheSignal)
{
  for (const vpModulation::Code code : {vpModulation::Code::manchester, vpModulation::Code::ook}) {
    const vpModulation modulation = word("01111010110010", code);
    const std::string chips = modulation.chips();
    expectHarmonics(modulation,
                    [&chips](double t) { return chips[static_cast<size_t>(t * chips.size())] == '1'; });
  }
}

TEST(Modulation, ThePowerOfAllHarmonicsIsTheMeanPower) // Parseval: p is 0 or 1, so its square is p
{
  for (vpModulation modulation : {word("110100", vpModulation::Code::ook), vpModulation{}}) {
    double power = 0;
    for (int k = -20000; k <= 20000; ++k) {
      power += std::norm(modulation.harmonic(k));
    }
    EXPECT_NEAR(power, modulation.harmonic(0).real(), 1e-4);
  }
}
