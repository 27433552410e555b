/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpBlackEnd.h"

#include <algorithm>
#include <cmath>

BEGIN_VISP_NAMESPACE

namespace
{
const double below = -1, // deviations: means that are farther below black hardly show
    above = 5;           // and those farther above are as they seem

double probability(double z)
{
  return 0.5 * std::erfc(-z * M_SQRT1_2);
}

double density(double z)
{
  return std::exp(-0.5 * z * z) / std::sqrt(2 * M_PI);
}

//! g(z)
double shown(double z)
{
  return z * probability(z) + density(z);
}

//! The z of which g(z) is that: Newton's steps from above, where a convex function lets none go too far.
double lightOf(double mean)
{
  static const double close = 1e-4;
  double z = mean;
  for (double step = 1; z > below && step > close; z -= step) {
    step = (shown(z) - mean) / probability(z);
  }
  return std::max(z, below);
}
} // namespace

vpBlackEnd::vpBlackEnd(const std::vector<Line> &lines, double noise) : m_noise(noise)
{
  static const int steps = 10;
  static const double rounding = 0.5, close = 1e-3, farthest = 2; // grey levels; share and factor of a step
  for (int step = 0; step < steps; ++step) {
    double more = 0, slope = 0; // black pixels than are, by their logarithm's noise
    for (const Line &line : lines) {
      const double z = line.mean < above * m_noise ? lightOf(line.mean / m_noise) : above;
      if (z > below && z < above) {
        const double at = rounding / m_noise;
        more += line.samples * probability(at - z) - line.black;
        slope += line.samples * density(at - z) * (shown(z) / probability(z) - at);
      }
    }
    if (!(slope > 0)) {
      break; // no line tells
    }
    const double factor = std::clamp(std::exp(-more / slope), 1 / farthest, farthest);
    m_noise *= factor;
    if (std::abs(factor - 1) < close) {
      break;
    }
  }
}

vpBlackEnd::Light vpBlackEnd::before(double mean) const
{
  if (mean > above * m_noise) {
    return {mean, m_noise};
  }
  const double z = lightOf(mean / m_noise), lit = probability(z), g = shown(z),
               variance = (z * z + 1) * lit + z * density(z) - g * g;
  return {z * m_noise, m_noise * std::sqrt(variance) / lit};
}

END_VISP_NAMESPACE
