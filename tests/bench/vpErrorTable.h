/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpErrorTable_h
#define vpErrorTable_h

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <string>
#include <vector>

//! Tables of tests/bench/calibration.md that compare errors with the standard deviations stated with them.
namespace vpErrorTable
{
inline double median(std::vector<double> values)
{
  if (values.empty()) {
    return NAN;
  }
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

//! Errors of one kind over all seeds, and their standard deviations.
struct Errors {
  std::string name;
  std::vector<double> errors, normalised; // of the unit shown; squared, over the variance stated
  int degrees = 1;                        // of freedom of each
  //! The latter, where a seed has several, which are not independent.
  std::map<size_t, std::vector<double>> ofSeed;

  void add(double error, double sigma)
  {
    errors.push_back(std::abs(error));
    normalised.push_back(error * error / (sigma * sigma));
  }
  void add(double error, double sigma, size_t seed)
  {
    add(error, sigma);
    ofSeed[seed].push_back(normalised.back());
  }

  /*!
    Degrees of freedom of the mean over all: of one value a seed, what they are; of several, those of a
    chi-square over its degrees that scatters as the seeds' means do.
  */
  double allDegrees() const
  {
    if (ofSeed.empty()) {
      return degrees * static_cast<double>(normalised.size());
    }
    const auto seeds = static_cast<double>(ofSeed.size());
    double sum = 0, squares = 0;
    for (const auto &[seed, values] : ofSeed) {
      const double mean =
          std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
      sum += mean;
      squares += mean * mean;
    }
    const double mean = sum / seeds, variance = (squares - sum * mean) / (seeds - 1);
    return seeds * 2 * mean * mean / variance;
  }

  //! Mean squared normalised error beside the interval that holds it 95 times in 100 (Wilson and Hilferty
  //! 1931).
  void print() const
  {
    const auto n = static_cast<double>(normalised.size());
    double mean = 0;
    for (const double value : normalised) {
      mean += value / n;
    }
    const double all = allDegrees();
    const auto quantile = [all](double z) {
      return std::pow(1 - 2 / (9 * all) + z * std::sqrt(2 / (9 * all)), 3);
    };
    std::vector<double> sorted = errors;
    std::sort(sorted.begin(), sorted.end());
    std::printf("| %s | %.4f | %.4f | %.2f | %.2f to %.2f |\n", name.c_str(), median(errors),
                sorted[static_cast<size_t>(0.9 * n)], mean, quantile(-1.96), quantile(1.96));
  }
};

inline void header(const std::string &what, int seeds)
{
  std::printf(
      "\n| %s, %d seeds | median error | 90 %% | mean squared normalised error | 95 %% interval of it |\n"
      "|---|---|---|---|---|\n",
      what.c_str(), seeds);
}
} // namespace vpErrorTable

#endif
