/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Features of the stripes of painted lamps: frequency, duty and phase difference with honest sigmas, and what
// kind of signal it is.

#include <cmath>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <visp3/vlp_identification/vpStripeAnalyzer.h>

#include "common/vpLampPicture.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{

using Signal = vpStripeFeatures::Signal;

//! One lamp of random place and phase, seen by a camera of 40 us a line.
struct Scene {
  double radius = 28;     // px
  double amplitude = 150; // grey levels
  double exposure = 40e-6;
  bool columns = false;
  vpPaintedLamp lamp;
  unsigned int seed = 1;

  vpStripeFeatures features() const
  {
    vpLampPicture picture;
    picture.width = picture.height = static_cast<int>(2 * radius + 44);
    picture.rowTime = 40e-6;
    picture.exposure = exposure;
    picture.columns = columns;
    picture.blur = 0.7;
    picture.seed = seed;
    vpPaintedLamp painted = lamp;
    painted.a = painted.b = radius;
    painted.amplitude = amplitude;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shift(-0.5, 0.5);
    painted.centre = {0.5 * picture.width + shift(random), 0.5 * picture.height + shift(random)};
    painted.phase = shift(random) + 0.5;
    picture.lamps = {painted};
    const vpImage<unsigned char> I = picture.render();

    vpRollingShutter shutter;
    shutter.rowTime = 40e-6;
    shutter.exposure = exposure;
    shutter.readout = columns ? vpRollingShutter::Readout::columns : vpRollingShutter::Readout::rows;
    const vpLineTiming timing(shutter, {}, I.getWidth(), I.getHeight());
    const vpLinePicture lines(I, columns);
    const auto rois = vpLedRoiDetector().detect(lines.grey);
    if (rois.empty()) {
      ADD_FAILURE() << "no lamp found";
      return {};
    }
    const vpOutlineFit fit =
        vpOutlineFitter().fit(lines.grey, timing.linePositions(), timing.samplePositions(), rois[0]);
    return vpStripeAnalyzer().analyze(vpStripeProfile::along(lines.grey, timing, fit, rois[0]));
  }
};

struct Spread {
  double sum = 0, squares = 0, most = 0, within = 0;
  int count = 0;

  void add(double error, double sigma)
  {
    sum += error;
    squares += error * error;
    most = std::max(most, std::abs(error / sigma));
    within += std::abs(error) < 3 * sigma ? 1 : 0;
    ++count;
  }
  double bias() const { return sum / count; }
  double rms() const { return std::sqrt(squares / count); }
  void print(const std::string &what) const
  {
    std::cout << what << ": bias " << bias() << ", rms " << rms() << ", largest error " << most
              << " of its sigma, " << 100 * within / count << " % within 3\n";
  }
};

class Pwm : public testing::TestWithParam<std::tuple<double, bool>> // amplitude, columns
{
};

TEST_P(Pwm, FrequencyAndDutyWithTheirSigma)
{
  const auto [amplitude, columns] = GetParam();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> frequency(1600, 6000), duty(0.25, 0.75);
  Spread frequencies, duties;
  for (unsigned int trial = 0; trial < 100; ++trial) {
    Scene scene;
    scene.amplitude = amplitude;
    scene.columns = columns;
    scene.seed = trial + 1;
    scene.lamp.frequency = frequency(random);
    const double share = duty(random);
    scene.lamp.pwm(share);
    const vpStripeFeatures seen = scene.features();
    ASSERT_EQ(seen.signal, Signal::pwm)
        << "trial " << trial << ", " << scene.lamp.frequency << " Hz, duty " << share;
    EXPECT_LT(seen.frequencySigma, 0.01 * scene.lamp.frequency) << "trial " << trial;
    frequencies.add(seen.frequency - scene.lamp.frequency, seen.frequencySigma);
    duties.add(seen.duty - share, std::hypot(seen.dutySigma, 0.03)); // as recognition does
  }
  frequencies.print("frequency, Hz");
  duties.print("duty");
  EXPECT_LT(std::abs(frequencies.bias()), 1);
  EXPECT_LT(frequencies.rms(), amplitude > 100 ? 1.5 : 3);
  EXPECT_GE(frequencies.within, 99);
  EXPECT_LT(std::abs(duties.bias()), 0.01);
  EXPECT_GE(duties.within, 99);
}

INSTANTIATE_TEST_SUITE_P(RowsAndColumns, Pwm,
                         testing::Combine(testing::Values(150.0, 30.0), testing::Values(false, true)));

// The lamp's first or last line may show the dim end of a stripe, which is no sign of a dim rim.
TEST(StripeAnalyzer, StripesCutByTheRimDoNotBiasTheFrequency)
{
  Spread frequencies;
  for (unsigned int trial = 0; trial < 200; ++trial) {
    Scene scene;
    scene.lamp.frequency = 1000 + 6 * trial;
    scene.seed = trial + 1;
    scene.lamp.pwm(0.35);
    const vpStripeFeatures seen = scene.features();
    ASSERT_EQ(seen.signal, Signal::pwm) << "trial " << trial;
    frequencies.add(seen.frequency - scene.lamp.frequency, seen.frequencySigma);
  }
  frequencies.print("frequency, Hz");
  EXPECT_EQ(frequencies.within, 200);
  EXPECT_LT(frequencies.rms(), 0.8);
}

TEST(StripeAnalyzer, LongExposureDoesNotBiasFrequencyOrDuty)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> frequency(1200, 2600), duty(0.3, 0.7);
  Spread frequencies, duties;
  for (unsigned int trial = 0; trial < 50; ++trial) {
    Scene scene;
    scene.exposure = 150e-6; // up to 0.4 periods
    scene.seed = trial + 1;
    scene.lamp.frequency = frequency(random);
    const double share = duty(random);
    scene.lamp.pwm(share);
    const vpStripeFeatures seen = scene.features();
    ASSERT_EQ(seen.signal, Signal::pwm) << "trial " << trial;
    frequencies.add(seen.frequency - scene.lamp.frequency, seen.frequencySigma);
    duties.add(seen.duty - share, std::hypot(seen.dutySigma, 0.03));
  }
  frequencies.print("frequency, Hz");
  duties.print("duty");
  EXPECT_LT(frequencies.rms(), 4);
  EXPECT_GE(frequencies.within, 49);
  EXPECT_GE(duties.within, 49);
}

// Pulse and exposure together longer than a period leave no line dark. The dark rest of the period under an
// exposure as long as the pulse lacks would look alike, of a lamp that never goes out.
TEST(StripeAnalyzer, LampThatNoLineShowsDarkIsNoShorterPulse)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> exposure(0.5, 0.8), together(1.03, 1.3);
  Spread frequencies, duties;
  for (unsigned int trial = 0; trial < 50; ++trial) {
    const double exposed = exposure(random), share = std::min(0.85, together(random) - exposed);
    Scene scene;
    scene.radius = 40;
    scene.exposure = 200e-6;
    scene.seed = trial + 1;
    scene.lamp.frequency = exposed / scene.exposure;
    scene.lamp.pwm(share);
    const vpStripeFeatures seen = scene.features();
    ASSERT_EQ(seen.signal, Signal::pwm) << "trial " << trial;
    frequencies.add(seen.frequency - scene.lamp.frequency, seen.frequencySigma);
    duties.add(seen.duty - share, std::hypot(seen.dutySigma, 0.03));
  }
  frequencies.print("frequency, Hz");
  duties.print("duty");
  EXPECT_GE(frequencies.within, 49);
  EXPECT_EQ(duties.within, 50);
}

// What an exposure of whole periods and a part shows is what the part would, but fainter and half a period
// later for each of the whole ones.
TEST(StripeAnalyzer, ExposureOfMoreThanAPeriodTellsTheDuty)
{
  std::mt19937 random(8);
  std::uniform_real_distribution<double> beyond(0.1, 0.4), duty(0.25, 0.75);
  for (const int whole : {1, 2}) {
    Spread frequencies, duties;
    for (unsigned int trial = 0; trial < 40; ++trial) {
      Scene scene;
      scene.radius = 60;
      scene.exposure = 400e-6;
      scene.seed = trial + 1;
      scene.lamp.frequency = (whole + beyond(random)) / scene.exposure;
      const double share = duty(random);
      scene.lamp.pwm(share);
      const vpStripeFeatures seen = scene.features();
      ASSERT_EQ(seen.signal, Signal::pwm) << whole << ", trial " << trial;
      frequencies.add(seen.frequency - scene.lamp.frequency, seen.frequencySigma);
      duties.add(seen.duty - share, std::hypot(seen.dutySigma, 0.01));
    }
    frequencies.print("frequency, Hz");
    duties.print("duty");
    EXPECT_GE(frequencies.within, 39) << whole;
    EXPECT_GE(duties.within, 39) << whole;
    EXPECT_LT(duties.rms(), 0.03) << whole;
  }
}

TEST(StripeAnalyzer, TwoPulsesAndTheirPhaseDifference)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> frequency(1000, 2000), difference(0.25, 0.42);
  Spread frequencies, differences;
  int missed = 0;
  for (unsigned int trial = 0; trial < 40; ++trial) {
    Scene scene;
    scene.radius = 60;
    scene.seed = trial + 1;
    scene.lamp.frequency = frequency(random);
    const double k = difference(random);
    scene.lamp.twoPulse(0.3, k);
    const vpStripeFeatures seen = scene.features();
    if (seen.signal != Signal::twoPulse) {
      ++missed;
      continue;
    }
    frequencies.add(seen.frequency - scene.lamp.frequency, seen.frequencySigma);
    differences.add(seen.phaseDifference - k, std::hypot(seen.phaseDifferenceSigma, 0.01));
  }
  frequencies.print("frequency, Hz");
  differences.print("phase difference, periods");
  EXPECT_LE(missed, 1);
  EXPECT_LT(frequencies.rms(), 2);
  EXPECT_LT(differences.rms(), 0.01);
}

TEST(StripeAnalyzer, WordsAreCodedNotPwm)
{
  int pwm = 0;
  const std::vector<std::string> words = {"01010110010111001101", "0101100110100101100110010110",
                                          "01010111100001101011"};
  for (unsigned int trial = 0; trial < 30; ++trial) {
    Scene scene;
    scene.seed = trial + 1;
    scene.lamp.chips(words[trial % words.size()]);
    scene.lamp.frequency = 8000.0 / words[trial % words.size()].size(); // 3.1 lines a chip
    const vpStripeFeatures seen = scene.features();
    pwm += seen.signal == Signal::pwm ? 1 : 0;
    if (seen.signal == Signal::coded) {
      EXPECT_TRUE(std::isnan(seen.frequency));
    }
  }
  EXPECT_EQ(pwm, 0);
}

TEST(StripeAnalyzer, SteadyLightHasNoStripes)
{
  for (unsigned int trial = 0; trial < 20; ++trial) {
    Scene scene;
    scene.seed = trial + 1;
    scene.amplitude = 20 + 10 * trial;
    EXPECT_EQ(scene.features().signal, Signal::unmodulated) << "amplitude " << scene.amplitude;
  }
}

// A cosine slower than any lamp fits both better than one that is as fast as a lamp.
TEST(StripeAnalyzer, GapBetweenTwoStripesMayBeALampsAndOneStripeIsNot)
{
  std::mt19937 random(5);
  std::normal_distribution<double> noise;
  vpStripeAnalyzer analyzer;
  analyzer.minFrequency = 500;
  // 70 lines of 40 us, some in their middle unlike those before and after: a period of 50 is 500 Hz.
  auto seen = [&](int lines, double middle, double ends, double sigma) {
    vpStripeProfile profile;
    profile.exposure = 40e-6;
    for (int i = 0; i < 70; ++i) {
      profile.time.push_back(40e-6 * i);
      profile.light.push_back((2 * std::abs(i - 35) < lines ? middle : ends) + sigma * noise(random));
      profile.sigma.push_back(sigma);
    }
    return profile;
  };
  for (double sigma : {0.1, 1., 5.}) {
    EXPECT_TRUE(analyzer.blinks(seen(40, 0, 150, sigma))) << sigma << " grey levels of noise";
    for (int lines : {12, 20, 40, 60}) {
      EXPECT_FALSE(analyzer.blinks(seen(lines, 150, 0, sigma)))
          << lines << " lit lines, " << sigma << " grey levels of noise";
    }
  }
}

TEST(StripeAnalyzer, ShallowStripesBetweenSoftEdgesBlink)
{
  for (double ripple : {0., 0.02, 0.12, 0.2}) { // of the mean light
    vpStripeProfile profile;
    profile.exposure = 120e-6;
    for (int i = 0; i < 100; ++i) {
      const double edge = std::min({1., 0.25 * (i + 1), 0.25 * (100 - i)});
      profile.time.push_back(40e-6 * i);
      profile.light.push_back(edge * 150 * (1 + ripple * std::sin(2 * M_PI * i / 3.7)));
      profile.sigma.push_back(1);
    }
    EXPECT_EQ(vpStripeAnalyzer().blinks(profile), ripple > 0.1) << ripple;
  }
}

TEST(StripeAnalyzer, TubeAtAnyAngleIsAsBrightOnAllItsLines)
{
  const double pi = std::acos(-1.);
  for (double angle : {0., 3., 10., 30., 60., 80.}) {
    const Eigen::Vector2d along(std::cos(angle * pi / 180), std::sin(angle * pi / 180));
    vpImage<unsigned char> I(440, 440, 5);
    for (unsigned int v = 0; v < I.getHeight(); ++v) {
      for (unsigned int u = 0; u < I.getWidth(); ++u) {
        const Eigen::Vector2d from(u - 220., v - 220.);
        const double outside = std::max(std::abs(from.dot(along)) - 200,
                                        std::abs(from.x() * along.y() - from.y() * along.x()) - 12);
        I[v][u] = static_cast<unsigned char>(5 + 180 * std::clamp(0.5 - 0.5 * outside, 0., 1.));
      }
    }
    const vpLinePicture lines(I, false);
    const auto rois = vpLedRoiDetector().detect(lines.grey);
    ASSERT_EQ(rois.size(), 1u) << angle << " degrees";
    vpRollingShutter shutter;
    shutter.rowTime = 40e-6;
    const vpLineTiming timing(shutter, {}, I.getWidth(), I.getHeight());
    const vpStripeProfile profile =
        vpStripeProfile::along(lines.grey, timing, vpOutlineFitter::boxOf(lines.grey, rois[0]), rois[0]);
    const size_t ends = 6; // lines that the tube's own edges are on
    ASSERT_GT(profile.light.size(), 2 * ends) << angle << " degrees";
    for (size_t i = ends; i + ends < profile.light.size(); ++i) {
      EXPECT_NEAR(profile.light[i], 180, 10) << "line " << i << " of a tube at " << angle << " degrees";
    }
  }
}

TEST(StripeAnalyzer, LightThatChangesSlowerThanAnyLampDoesNotBlink)
{
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  // 200 lines of 40 us: light that swells at 200 Hz, by a depth, times a lamp's pulses.
  auto seen = [&](double depth, bool lamp) {
    vpStripeProfile profile;
    profile.exposure = 40e-6;
    for (int i = 0; i < 200; ++i) {
      const double t = 40e-6 * i, pulses = std::fmod(1500 * t, 1) < 0.5 ? 1 : 0;
      profile.time.push_back(t);
      profile.light.push_back(100 * (1 + depth * std::sin(2 * M_PI * 200 * t)) * (lamp ? pulses : 1) +
                              noise(random));
      profile.sigma.push_back(1);
    }
    return profile;
  };
  vpStripeAnalyzer any, notSlower;
  notSlower.minFrequency = 500;
  const vpStripeProfile swell = seen(0.8, false), lamp = seen(0.3, true);
  EXPECT_TRUE(any.blinks(swell));
  EXPECT_FALSE(notSlower.blinks(swell));
  EXPECT_EQ(notSlower.analyze(swell).signal, Signal::unmodulated);
  EXPECT_TRUE(notSlower.blinks(lamp));
  EXPECT_NEAR(notSlower.analyze(lamp).frequency, 1500, 5);
}

//! An emitter that is brighter in its middle: its bow is no slow light, and does not hide shallow stripes.
TEST(StripeAnalyzer, ABowHidesNoStripes)
{
  vpStripeAnalyzer analyzer;
  analyzer.minFrequency = 500;
  for (const double frequency : {1500., 2500., 6000., 9500.}) {
    for (int k = 0; k < 10; ++k) {
      vpStripeProfile profile; // 145 lines of 40 us
      profile.exposure = 40e-6;
      for (int i = 0; i < 145; ++i) {
        const double y = (i - 72) / 73., t = 40e-6 * i;
        profile.time.push_back(t);
        profile.light.push_back(200 * (1 - 0.4 * y * y) *
                                (1 + 0.06 * std::cos(2 * M_PI * (frequency * t + 0.1 * k))));
        profile.sigma.push_back(0.3);
      }
      EXPECT_TRUE(analyzer.blinks(profile)) << frequency << " Hz, phase " << 0.1 * k;
    }
  }
}

namespace
{
//! Share of an exposure that pulses of a length \e duty light, the first one from \e phase on, both in
//! periods.
double litShare(double frequency, double phase, double duty, double begin, double exposure)
{
  const auto litUntil = [duty](double periods) {
    return std::floor(periods) * duty + std::min(periods - std::floor(periods), duty);
  };
  return (litUntil(frequency * (begin + exposure) - phase) - litUntil(frequency * begin - phase)) /
         (frequency * exposure);
}

//! Of \e lines of an even lamp. \param lit Its share, of an exposure that begins at a time.
template <class Lit>
vpStripeProfile profileOf(int lines, double line, double exposure, std::mt19937 &random, const Lit &lit)
{
  std::normal_distribution<double> noise(0, 0.3);
  vpStripeProfile profile;
  profile.exposure = exposure;
  for (int i = 0; i < lines; ++i) {
    profile.time.push_back(line * i + 0.5 * exposure);
    profile.light.push_back(150 * lit(line * i) + noise(random));
    profile.sigma.push_back(0.3);
  }
  return profile;
}
} // namespace

//! Stripes of nearly five lines, which drift along the lines by a part of one: five lines that repeat, under
//! an envelope that bends, look alike.
TEST(StripeAnalyzer, StripesThatNearlyRepeatWithTheLines)
{
  const double line = 40e-6, exposure = 25e-6;
  const int lines = 66;
  std::mt19937 random(3);
  for (const double drift : {-0.6, -0.5, -0.4, 0.4, 0.5, 0.6}) { // lines, over all of them
    for (const double duty : {0.25, 0.35, 0.45}) {
      for (int k = 0; k < 20; ++k) {
        const double frequency = (1 + drift / lines) / (5 * line);
        vpStripeProfile profile = profileOf(lines, line, exposure, random, [&](double begin) {
          return litShare(frequency, 0.05 * k, duty, begin, exposure);
        });
        profile.exposure = 0.42 * exposure; // as the rig states it
        profile.logExposureSigma = 0.69;
        const vpStripeFeatures features = vpStripeAnalyzer().analyze(profile);
        EXPECT_NEAR(features.frequency, frequency, 5 * features.frequencySigma)
            << "drift " << drift << ", duty " << duty << ", phase " << 0.05 * k;
      }
    }
  }
}

//! Two pulses every 2.5 and every 2.4 lines: five and twelve lines that nearly repeat, and both pulses may be
//! longer or shorter along a ridge.
TEST(StripeStatistics, TwoPulsesThatNearlyRepeatWithTheLines)
{
  const double line = 40e-6;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const double lineRates : {0.4008, 0.4167}) {
    Spread frequencies, duties;
    for (int trial = 0; trial < 60; ++trial) {
      const double frequency = (lineRates + 0.0004 * (uniform(random) - 0.5)) / line, phase = uniform(random),
                   duty = 0.2 + 0.2 * uniform(random), k = 0.25 + 0.17 * uniform(random);
      const vpStripeProfile profile = profileOf(146, line, line, random, [&](double begin) {
        return litShare(frequency, phase, 0.5 * duty, begin, line) +
               litShare(frequency, phase + k, 0.5 * duty, begin, line);
      });
      vpStripeAnalyzer analyzer;
      analyzer.minFrequency = 5000; // or one period may be taken for two
      const vpStripeFeatures features = analyzer.analyze(profile);
      if (features.signal == Signal::twoPulse) {
        frequencies.add(features.frequency - frequency, features.frequencySigma);
        duties.add(features.duty - duty, features.dutySigma);
      }
    }
    std::cout << frequencies.count << " at " << lineRates << " of the line rate\n";
    frequencies.print("frequency, Hz");
    duties.print("duty");
    EXPECT_GE(frequencies.count, 50);
    EXPECT_LT(frequencies.most, 3);
    EXPECT_LT(duties.most, 3);
  }
}

TEST(StripeAnalyzer, EmptyAndShortProfilesSayNothing)
{
  vpStripeProfile profile;
  profile.exposure = 40e-6;
  EXPECT_EQ(vpStripeAnalyzer().analyze(profile).signal, Signal::unmodulated);
  for (int line = 0; line < 5; ++line) {
    profile.time.push_back(40e-6 * line);
    profile.light.push_back(line % 2 == 0 ? 100 : 0);
    profile.sigma.push_back(1);
  }
  EXPECT_EQ(vpStripeAnalyzer().analyze(profile).signal, Signal::unmodulated);
}

} // namespace
