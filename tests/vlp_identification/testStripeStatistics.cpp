/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Frequency of stripes against the Cramer-Rao bound of a sinusoid, and against its own standard deviation.

#include <visp3/vlp_identification/vpStripeAnalyzer.h>

#include <cmath>
#include <iostream>
#include <random>

#include <gtest/gtest.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
const double amplitude = 75;         // grey levels, half the swing of the stripes
const double noise = amplitude / 10; // of one line: 20 dB
const double rowTime = 43.1e-6;      // s
const double exposure = rowTime;     // s
const unsigned int trials = 100;     // of each number of stripes

//! Share of an exposure from \e start on that falls into pulses of a wave, by counting.
double lit(double frequency, double duty, double phase, double start)
{
  static const int steps = 2000;
  int count = 0;
  for (int k = 0; k < steps; ++k) {
    const double x = (start + (k + 0.5) / steps * exposure) * frequency + phase;
    count += x - std::floor(x) < duty;
  }
  return static_cast<double>(count) / steps;
}

struct Figures {
  double deviation = 0; // Hz
  double bound = 0;     // Hz
  double told = 0;      // Hz, the mean of the bounds that the analyzer tells
  double rms = 0;       // of errors in their own standard deviations
  double worst = 0;
  unsigned int lost = 0; // without a frequency
};

//! \param step Sensor lines from one line of the picture to the next. \param spread Of the frequencies, as a
//! share of them.
Figures figuresOf(int lines, double step, double stripes, double duty, double spread = 0.05)
{
  std::mt19937_64 generator(17);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  const double span = lines * step * rowTime;
  double squares = 0, own = 0;
  Figures figures;
  unsigned int counted = 0;
  for (unsigned int trial = 0; trial < trials; ++trial) {
    const double frequency = stripes / span * (1 + spread * (uniform(generator) - 0.5)),
                 phase = uniform(generator);
    vpStripeProfile profile;
    profile.exposure = exposure;
    for (int i = 0; i < lines; ++i) {
      const double start = std::floor(i * step) * rowTime;
      profile.time.push_back(start + exposure / 2);
      profile.light.push_back(2 * amplitude * lit(frequency, duty, phase, start) + noise * normal(generator));
      profile.sigma.push_back(noise);
    }
    vpStripeAnalyzer analyzer;
    analyzer.searchTwoPulses = false;
    const vpStripeFeatures features = analyzer.analyze(profile);
    if (!(features.frequencySigma < 0.1 * frequency)) {
      ++figures.lost;
      continue;
    }
    const double error = features.frequency - frequency;
    squares += error * error;
    figures.told += features.frequencyBound;
    own += std::pow(error / features.frequencySigma, 2);
    figures.worst = std::max(figures.worst, std::abs(error) / features.frequencySigma);
    ++counted;
  }
  figures.deviation = std::sqrt(squares / counted);
  figures.rms = std::sqrt(own / counted);
  figures.told /= counted;
  // A sinusoid of that amplitude: Rife and Boorstyn 1974.
  const double eta = amplitude * amplitude / (2 * noise * noise), n = lines;
  figures.bound = std::sqrt(12 / (eta * n * (n * n - 1))) / (2 * M_PI * step * rowTime);
  std::cout << stripes << " stripes on " << lines << " lines, duty " << duty << ": deviation "
            << figures.deviation << " Hz, bound " << figures.bound << " Hz, in own sigmas rms " << figures.rms
            << ", worst " << figures.worst << ", without a frequency " << figures.lost << "\n";
  return figures;
}

//! How far off the figures may be: deviation in bounds, errors in their own standard deviations.
void expectWithin(const Figures &figures, double deviation, double rms, double worst)
{
  EXPECT_EQ(figures.lost, 0u);
  EXPECT_LT(figures.deviation, deviation * figures.bound);
  EXPECT_LT(figures.rms, rms);
  EXPECT_LT(figures.worst, worst);
}
} // namespace

// A deviation of 100 trials is good to 7 % (one sigma).
TEST(StripeStatistics, FullSizeReachesTheBound)
{
  for (double duty : {0.5, 0.3})
    for (double stripes : {3., 8., 20., 44.}) {
      const Figures figures = figuresOf(146, 1, stripes, duty);
      expectWithin(figures, 1.3, 1.2, 4);
      EXPECT_NEAR(figures.told, figures.bound,
                  0.25 * figures.bound); // from its own fit, the model's error included
    }
}

// Lines of the nearest-neighbour picture leave gaps in which edges hide.
TEST(StripeStatistics, GapsBetweenExposuresAreHonest)
{
  for (double duty : {0.5, 0.2})
    for (double stripes : {3., 5., 12., 20.})
      expectWithin(figuresOf(57, 2.56, stripes, duty), 1.5, 1.2, 4);
}

TEST(StripeStatistics, FewStripesAreWideAndHonest)
{
  for (double stripes : {1.5, 2.}) {
    const Figures figures = figuresOf(146, 1, stripes, 0.5);
    EXPECT_LT(figures.lost, trials / 2);
    EXPECT_LT(figures.rms, 1.2);
    EXPECT_LT(figures.worst, 6);
  }
}

// A quarter of the rate of lines: each pulse falls into one line or two over the whole lamp, and a short one
// of a bright lamp looks like a longer one of a dim lamp.
TEST(StripeStatistics, PulsesThatHideBetweenLinesAreHonest)
{
  for (double duty : {0.2, 0.3, 0.4}) {
    const Figures figures = figuresOf(146, 1, 36.5, duty, 0.01);
    EXPECT_EQ(figures.lost, 0u);
    EXPECT_LT(figures.rms, 1.2);
    EXPECT_LT(figures.worst, 4);
  }
}

// A fifth of the rate of lines: a short pulse, lit or dark, lies between two lines wherever it comes back to
// the same phase, and looks dim or of twice the frequency.
TEST(StripeStatistics, PulsesOfAFifthOfTheLinesAreHonest)
{
  for (double duty : {0.2, 0.8}) {
    const Figures figures = figuresOf(57, 2.56, 11.41, duty, 0.002);
    EXPECT_EQ(figures.lost, 0u);
    EXPECT_LT(figures.rms, 1.2);
    EXPECT_LT(figures.worst, 4);
  }
}
