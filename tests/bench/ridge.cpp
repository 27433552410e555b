/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Lamps whose stripes are a simple fraction of the rate of lines, where every period falls on the lines
// alike: how well the frequency is known whatever the duty, at the lamp's duty, and at best. bench_ridge
// [TRIALS]

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <mutex>

#include "vpSimulatedStripes.h"

namespace
{
//! Errors of one way to estimate a frequency.
struct Errors {
  double squares = 0, inSigmas = 0;
  int count = 0;

  void add(double error, double sigma)
  {
    if (std::isfinite(error)) {
      squares += error * error;
      inSigmas += error * error / (sigma * sigma);
      ++count;
    }
  }
  double rms() const { return std::sqrt(squares / count); }
  double rmsInSigmas() const { return std::sqrt(inSigmas / count); }
};

struct Estimate {
  double frequency, sigma; // Hz
};

//! What alongDuty says at that duty; the plain estimate where the stripes leave nothing open.
Estimate atDuty(const vpStripeFeatures &seen, double duty)
{
  for (size_t i = 1; i < seen.alongDuty.size(); ++i) {
    const vpDutySlice &from = seen.alongDuty[i - 1], &to = seen.alongDuty[i];
    if (from.duty <= duty && duty < to.duty) {
      const double share = (duty - from.duty) / (to.duty - from.duty);
      return {from.frequency + share * (to.frequency - from.frequency),
              from.frequencySigma + share * (to.frequencySigma - from.frequencySigma)};
    }
  }
  return {seen.frequency, seen.frequencySigma};
}

//! Squares that the best background and amplitude leave of the lines, over their variance.
double chiSquare(const vpStripeProfile &profile, const vpLampLight &light)
{
  double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  const auto n = static_cast<double>(profile.light.size());
  for (size_t i = 0; i < profile.light.size(); ++i) {
    const double half = 0.5 * profile.exposure,
                 share = light.over(profile.time[i] - half, profile.time[i] + half).share;
    x += share;
    y += profile.light[i];
    xx += share * share;
    xy += share * profile.light[i];
    yy += profile.light[i] * profile.light[i];
  }
  const double sxx = xx - x * x / n, sxy = xy - x * y / n, syy = yy - y * y / n;
  return (syy - (sxx > 0 ? sxy * sxy / sxx : 0)) / (profile.sigma.front() * profile.sigma.front());
}

//! Mean and standard deviation of the posterior over frequency and phase on a grid about the truth, duty and
//! exposure known exactly: no estimator does better on average.
Estimate best(const vpStripeProfile &profile, vpModulation modulation)
{
  static const double reach = 24, step = 0.5; // Hz
  static const int phases = 240;
  const double truth = modulation.frequency, middle = 0.5 * (profile.time.front() + profile.time.back());
  std::vector<std::array<double, 2>> all; // frequency off the truth, chi-square
  double least = std::numeric_limits<double>::infinity();
  for (double off = -reach; off <= reach; off += step) {
    modulation.frequency = truth + off;
    for (int k = 0; k < phases; ++k) {
      const double phase = static_cast<double>(k) / phases - modulation.frequency * middle;
      all.push_back({off, chiSquare(profile, vpLampLight(modulation, 1, phase - std::floor(phase)))});
      least = std::min(least, all.back()[1]);
    }
  }
  double sum = 0, first = 0, second = 0;
  for (const auto &[off, chi] : all) {
    const double weight = std::exp(-0.5 * (chi - least));
    sum += weight;
    first += weight * off;
    second += weight * off * off;
  }
  const double mean = first / sum;
  return {truth + mean, std::sqrt(std::max(step * step / 12, second / sum - mean * mean))};
}

//! \param spread Of the frequencies about that one, as a share of it.
void run(double middle, double duty, int trials, double spread = 0)
{
  vpSimulatedStripes stripes;
  stripes.oscillator = 0;
  vpModulation lamp;
  lamp.kind = vpModulation::Kind::pwm;
  lamp.duty = duty;
  std::mutex guard;
  Errors any, known, ideal;
  double bound = 0;
  vpRunTrials(trials, [&](int, std::mt19937_64 &generator) {
    std::uniform_real_distribution<double> uniform(-0.5, 0.5);
    vpModulation modulation = lamp;
    modulation.frequency = spread > 0 ? middle * (1 + spread * uniform(generator)) : middle;
    const double frequency = modulation.frequency;
    const vpStripeProfile profile = stripes.profile(modulation, generator);
    vpStripeAnalyzer analyzer;
    analyzer.searchTwoPulses = false;
    const vpStripeFeatures seen = analyzer.analyze(profile);
    const Estimate stated = atDuty(seen, duty), posterior = best(profile, modulation);
    const std::lock_guard<std::mutex> lock(guard);
    any.add(seen.frequency - frequency, seen.frequencySigma);
    known.add(stated.frequency - frequency, stated.sigma);
    ideal.add(posterior.frequency - frequency, posterior.sigma);
    bound += seen.frequencyBound / trials;
  });
  std::printf("| %.0f%s | %.1f | %.2f | %.2f (%.2f) | %.2f (%.2f) | %.2f (%.2f) |\n", middle,
              spread > 0 ? " +- 0.5 %" : "", duty, bound, any.rms(), any.rmsInSigmas(), known.rms(),
              known.rmsInSigmas(), ideal.rms(), ideal.rmsInSigmas());
  std::fflush(stdout);
}
} // namespace

int main(int argc, char **argv)
{
  const int trials = argc > 1 ? std::max(1, std::atoi(argv[1])) : 200;
  std::printf("| frequency, Hz | duty | bound, Hz | whatever the duty | at the lamp's duty | at best |\n"
              "|---|---|---|---|---|---|\n");
  for (double duty : {0.2, 0.5}) {
    for (double frequency : {5807., 5850., 4700., 4646.}) {
      run(frequency, duty, trials);
    }
  }
  const double quarter = 36.5 / (146 * 43.1e-6); // Hz: 36.5 stripes over 146 lines
  for (double duty : {0.2, 0.3, 0.4}) {
    run(quarter, duty, trials, 0.01);
  }
  return 0;
}
