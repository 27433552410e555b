/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_simulation/vpLampLight.h>

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/vpExpectError.h"
#include "slowRollingShutter.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
using Kind = vpModulation::Kind;
using Darks = std::vector<std::pair<double, double>>; // s

vpModulation pwm(double frequency, double duty)
{
  vpModulation modulation;
  modulation.kind = Kind::pwm;
  modulation.frequency = frequency;
  modulation.duty = duty;
  return modulation;
}

vpModulation twoPulse(double frequency, double duty, double difference)
{
  vpModulation modulation = pwm(frequency, duty);
  modulation.kind = Kind::twoPulse;
  modulation.phaseDifference = difference;
  return modulation;
}

vpModulation word(const std::string &bits, double chipRate, vpModulation::Code code)
{
  vpModulation modulation;
  modulation.kind = Kind::word;
  modulation.bits = bits;
  modulation.chipRate = chipRate;
  modulation.code = code;
  return modulation;
}

std::vector<vpModulation> everyKind()
{
  using Code = vpModulation::Code;
  return {vpModulation(),
          pwm(2300, 0.4),
          pwm(7400, 0.93),
          twoPulse(1500, 0.3, 0.37),
          twoPulse(900, 0.6, 0.3),
          word("0111101011001", 8000, Code::manchester),
          word("10", 3000, Code::ook),
          word("1110100", 21000, Code::ook)};
}

/*!
  The same by counting: each of \e steps equal parts of the exposure is lit or dark as a whole. Times are
  taken from \e origin on, in which the lamp's phase is \e phase, so that hours lose no digits here.
*/
vpLampLight::Exposed counted(const vpModulation &modulation, double phase, const Darks &darks, double from,
                             double to, int steps)
{
  int lit = 0;
  double sum = 0;
  for (int k = 0; k < steps; ++k) {
    const double t = from + (k + 0.5) / steps * (to - from);
    const bool dark =
        std::any_of(darks.begin(), darks.end(), [t](const auto &d) { return t >= d.first && t < d.second; });
    if (!dark && SlowRollingShutter::lit(modulation, phase, t)) {
      ++lit;
      sum += t;
    }
  }
  return {double(lit) / steps, lit > 0 ? sum / lit : 0.5 * (from + to)};
}
} // namespace

TEST(LampLight, IsWhatCountingSmallStepsGives)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform;
  static const int steps = 20000;
  for (const vpModulation &modulation : everyKind()) {
    for (int trial = 0; trial < 20; ++trial) {
      const double phase = uniform(random), from = 0.02 * (uniform(random) - 0.5);
      const double exposure = trial % 4 == 0 ? 5e-3 * uniform(random) : 300e-6 * uniform(random);
      const vpLampLight light(modulation, 1, phase);
      const vpLampLight::Exposed exact = light.over(from, from + exposure);
      const vpLampLight::Exposed slow = counted(modulation, phase, {}, from, from + exposure, steps);
      // A step of uncertainty at each edge, of which there are two in a period, seven in a word's.
      const double edges = 2 + 14 * exposure * std::max(modulation.repetitionFrequency(), 1.0);
      EXPECT_NEAR(exact.share, slow.share, edges / steps);
      if (slow.share > 0.1) {
        EXPECT_NEAR(exact.middle, slow.middle, exposure * edges / steps / slow.share);
      }
      EXPECT_GE(exact.middle, from);
      EXPECT_LE(exact.middle, from + exposure);
    }
  }
}

TEST(LampLight, WholePeriodsGiveTheDuty)
{
  EXPECT_NEAR(vpLampLight(pwm(2000, 0.3), 1, 0.77).over(0.1234, 0.1234 + 3 / 2000.).share, 0.3, 1e-12);
  EXPECT_NEAR(vpLampLight(twoPulse(1000, 0.3, 0.37), 1, 0.2).over(0, 5e-3).share, 0.3, 1e-12);
  const auto bits = word("1110100", 7000, vpModulation::Code::ook);
  EXPECT_NEAR(vpLampLight(bits, 1, 0.4).over(0, 2e-3).share, 4 / 7., 1e-12);
  vpModulation unmeasured = pwm(1000, 0.2);
  unmeasured.duty.reset();
  EXPECT_NEAR(vpLampLight(unmeasured).over(0, 1e-3).share, 0.5, 1e-12);
}

TEST(LampLight, ClockThatIsFastRepeatsSooner)
{
  const double rate = 1 + 1e-2, period = 1 / (1000 * rate);
  const vpLampLight light(pwm(1000, 0.5), rate, 0.25);
  for (const double t : {0.0, 0.1237, 17.0}) {
    const double share = light.over(t, t + 200e-6).share;
    EXPECT_NEAR(light.over(t + 70 * period, t + 70 * period + 200e-6).share, share, 1e-9);
  }
  EXPECT_NEAR(light.over(0, 1e-5).share, 1, 1e-12); // a quarter of the period has passed, lit
  EXPECT_NEAR(light.over(0.25 * period, 0.25 * period + 1e-5).share, 0, 1e-12);
}

TEST(LampLight, HoursLoseNoDigits)
{
  // Whole seconds are whole periods of these, so the light is that of the first second.
  const double exposure = 43e-6;
  for (const vpModulation &modulation : {vpModulation(), pwm(2300, 0.4), twoPulse(1500, 0.3, 0.37),
                                         word("0111101", 7000 * 2, vpModulation::Code::manchester)}) {
    const vpLampLight light(modulation, 1, 0.3);
    for (const double hours : {1.0, 6.0, 24.0}) {
      for (int k = 0; k < 50; ++k) {
        const double from = k / 64.0, late = 3600 * hours + from; // both exact
        const vpLampLight::Exposed now = light.over(from, from + exposure),
                                   then = light.over(late, late + exposure);
        EXPECT_NEAR(then.share, now.share, 1e-5);
        EXPECT_NEAR(then.middle - late, now.middle - from, 1e-9) << hours << " h";
      }
    }
  }
}

TEST(LampLight, DarkIntervalsTakeTheirLightAway)
{
  const Darks darks = {{0.001, 0.00123}, {0.0015, 0.0019}, {0.0018, 0.0022}, {0.0015, 0.0019}, {0.01, 0.02}};
  static const int steps = 20000;
  for (const vpModulation &modulation : everyKind()) {
    vpLampLight light(modulation, 1, 0.6);
    for (const auto &[from, to] : darks) {
      light.addDark(from, to);
    }
    for (double from = 0; from < 0.003; from += 0.00017) {
      for (const double exposure : {43e-6, 900e-6, 4e-3}) {
        const auto slow = counted(modulation, 0.6, darks, from, from + exposure, steps);
        const auto exact = light.over(from, from + exposure);
        const double edges = 6 + 14 * exposure * std::max(modulation.repetitionFrequency(), 1.0);
        EXPECT_NEAR(exact.share, slow.share, edges / steps) << from << " " << exposure;
        if (slow.share > 0.1) {
          EXPECT_NEAR(exact.middle, slow.middle, exposure * edges / steps / slow.share);
        }
      }
    }
    EXPECT_EQ(light.over(0.012, 0.013).share, 0);
    EXPECT_EQ(light.over(0.012, 0.013).middle, 0.0125); // where there is no light, the exposure's own
  }
}

TEST(LampLight, OverlappingDarkIntervalsCountOnce)
{
  // The exposure reaches over the edge of two that are the same, and of two that share a part.
  vpLampLight twice, shared;
  for (int k = 0; k < 2; ++k) {
    twice.addDark(1, 2);
  }
  shared.addDark(1.5, 2);
  shared.addDark(1, 1.7);
  shared.addDark(1.2, 1.3);
  for (const vpLampLight &light : {twice, shared}) {
    EXPECT_NEAR(light.over(0.9, 1.1).share, 0.5, 1e-12);
    EXPECT_NEAR(light.over(0.9, 1.1).middle, 0.95, 1e-12);
    EXPECT_NEAR(light.over(0, 4).share, 0.75, 1e-12);
    EXPECT_EQ(light.over(1.1, 1.9).share, 0);
  }
}

TEST(LampLight, LampThatIsNoneIsRefused)
{
  vpExpectError([] { vpLampLight(pwm(0, 0.5)); }, {"lamp light", "0 Hz"});
  vpExpectError([] { vpLampLight(pwm(1000, 0.5), -1); }, {"lamp light", "-1000 Hz"});
  vpExpectError([] { vpLampLight(pwm(1e300, 0.5)); }, {"lamp light", "1e+300 Hz"});
  vpExpectError([] { vpLampLight(word("", 1000, vpModulation::Code::ook)); }, {"lamp light", "0 Hz"});
  vpModulation overlap = twoPulse(1000, 0.5, 0.1);
  vpExpectError([&] { vpLampLight{overlap}; }, {"phase difference 0.1", "overlap"});
  overlap.duty.reset(); // then it counts as 0.5
  vpExpectError([&] { vpLampLight{overlap}; }, {"phase difference 0.1", "overlap"});
}
