/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpDutyRidge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <visp3/core/vpMath.h>

BEGIN_VISP_NAMESPACE

namespace
{
double normalDensity(double z, double sigma)
{
  return std::exp(-0.5 * z * z) / (std::sqrt(2 * M_PI) * sigma);
}

vpDutySlice between(const vpDutySlice &from, const vpDutySlice &to, double share)
{
  auto at = [&](double vpDutySlice::*value) { return from.*value + share * (to.*value - from.*value); };
  return {at(&vpDutySlice::duty), at(&vpDutySlice::frequency), at(&vpDutySlice::frequencySigma),
          at(&vpDutySlice::chiSquare)};
}

//! Mean and variance of a weighted quantity.
struct Moments {
  double weight = 0, first = 0, second = 0;
  void add(double w, double value, double variance)
  {
    weight += w;
    first += w * value;
    second += w * (value * value + variance);
  }
  double mean() const { return first / weight; }
  double sigma() const { return std::sqrt(std::max(0.0, second / weight - vpMath::sqr(mean()))); }
};
} // namespace

vpDutyRidge::Reading vpDutyRidge::of(const vpStripeFeatures &seen, const std::optional<double> &stated,
                                     double dutyError)
{
  static const double anyDuty = 0.5, anyDutySigma = 0.3; // the spread of a uniform one
  Reading reading{seen.frequency, seen.frequencySigma, seen.duty, seen.dutySigma, 1, 0, 0};
  if (seen.alongDuty.size() < 2) {
    if (stated) {
      const double sigma = std::hypot(seen.dutySigma, dutyError), z = (seen.duty - *stated) / sigma;
      reading.density = normalDensity(z, sigma);
      reading.distance = std::abs(z);
    }
    return reading;
  }
  const double mean = stated.value_or(anyDuty), sigma = stated ? dutyError : anyDutySigma;
  static const int finer = 4; // than the slices
  double all = 0, least = std::numeric_limits<double>::infinity();
  Moments frequency, duty, middle; // middle: frequency, by the duty alone
  for (size_t i = 1; i < seen.alongDuty.size(); ++i) {
    for (int k = 0; k < finer; ++k) {
      const vpDutySlice slice = between(seen.alongDuty[i - 1], seen.alongDuty[i], (k + 0.5) / finer);
      const double width = (seen.alongDuty[i].duty - seen.alongDuty[i - 1].duty) / finer,
                   z = (slice.duty - mean) / sigma;
      const double likelihood = width * std::exp(-0.5 * slice.chiSquare),
                   weight = likelihood * normalDensity(z, sigma);
      all += likelihood;
      frequency.add(weight, slice.frequency - seen.frequency, vpMath::sqr(slice.frequencySigma));
      duty.add(weight, slice.duty, vpMath::sqr(width) / 12);
      middle.add(weight, slice.frequency - seen.frequency, 0);
      least = std::min(least, slice.chiSquare + vpMath::sqr(z));
    }
  }
  if (!(frequency.weight > 0)) {
    reading.density = 0;
    reading.distance = std::numeric_limits<double>::infinity();
    return reading;
  }
  reading.frequency = seen.frequency + frequency.mean();
  reading.frequencySigma = frequency.sigma();
  reading.duty = duty.mean();
  reading.dutySigma = duty.sigma();
  reading.spread = stated ? 0 : middle.sigma();
  if (stated) {
    reading.density = frequency.weight / all;
    reading.distance = std::sqrt(least);
  }
  return reading;
}

void vpDutyRidge::settle(vpStripeFeatures &features)
{
  const Reading reading = of(features, std::nullopt, 0);
  features.frequency = reading.frequency;
  features.frequencySigma = reading.frequencySigma;
  features.duty = reading.duty;
  features.dutySigma = reading.dutySigma;
}

//! Were the duty that; beyond the outermost slice nothing is explained.
vpDutySlice vpDutyRidge::at(const vpStripeFeatures &seen, double duty)
{
  const std::vector<vpDutySlice> &slices = seen.alongDuty;
  if (slices.size() < 2) {
    return {duty, seen.frequency, seen.frequencySigma, vpMath::sqr((duty - seen.duty) / seen.dutySigma)};
  }
  static const double sharply = 0.01; // duty, per standard deviation
  auto beyond = [duty](vpDutySlice slice) {
    slice.chiSquare += vpMath::sqr((duty - slice.duty) / sharply);
    slice.duty = duty;
    return slice;
  };
  if (duty <= slices.front().duty) {
    return beyond(slices.front());
  }
  const auto to = std::lower_bound(slices.begin(), slices.end(), duty,
                                   [](const vpDutySlice &slice, double value) { return slice.duty < value; });
  if (to == slices.end()) {
    return beyond(slices.back());
  }
  const vpDutySlice &from = *(to - 1);
  return between(from, *to, (duty - from.duty) / (to->duty - from.duty));
}

std::vector<vpDutySlice> vpDutyRidge::together(const vpStripeFeatures &one, const vpStripeFeatures &other)
{
  std::vector<vpDutySlice> slices = one.alongDuty.empty() ? other.alongDuty : one.alongDuty;
  double least = std::numeric_limits<double>::infinity();
  for (vpDutySlice &slice : slices) {
    const vpDutySlice a = at(one, slice.duty), b = at(other, slice.duty);
    const double weight = 1 / vpMath::sqr(a.frequencySigma), more = 1 / vpMath::sqr(b.frequencySigma);
    slice.frequency = (weight * a.frequency + more * b.frequency) / (weight + more);
    slice.frequencySigma = 1 / std::sqrt(weight + more);
    slice.chiSquare = a.chiSquare + b.chiSquare +
                      vpMath::sqr(a.frequency - b.frequency) /
                          (vpMath::sqr(a.frequencySigma) + vpMath::sqr(b.frequencySigma));
    least = std::min(least, slice.chiSquare);
  }
  for (vpDutySlice &slice : slices) {
    slice.chiSquare -= least;
  }
  return slices;
}

std::vector<vpDutySlice> vpDutyRidge::whereOpen(std::vector<vpDutySlice> slices)
{
  static const double explained = 9; // chi-square
  const auto open = std::count_if(slices.begin(), slices.end(),
                                  [](const vpDutySlice &slice) { return slice.chiSquare < explained; });
  if (open < 2) {
    slices.clear();
  }
  return slices;
}

END_VISP_NAMESPACE
