/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_evaluation/vpConsistency.h>

#include <cmath>
#include <limits>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

namespace
{
constexpr double rounding = std::numeric_limits<double>::epsilon();
constexpr int mostTerms = 100000; // some multiple of sqrt(a): enough for degrees of freedom of many millions

//! Logarithm of x^a e^-x / Gamma(a).
double logFactor(double a, double x)
{
  return a * std::log(x) - x - std::lgamma(a);
}

//! P(a, x) by its power series, which converges fast for x below a + 1.
double lowerGammaSeries(double a, double x)
{
  double term = 1 / a, sum = term;
  for (int n = 1; n < mostTerms && term > sum * rounding; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return sum * std::exp(logFactor(a, x));
}

//! 1 - P(a, x) by Legendre's continued fraction, evaluated by Lentz's method; for x above a + 1.
double upperGammaFraction(double a, double x)
{
  constexpr double tiny = 1e-300;
  double b = x + 1 - a, d = 1 / b, c = 1 / tiny, fraction = d;
  for (int n = 1; n < mostTerms; ++n) {
    const double numerator = -n * (n - a);
    b += 2;
    d = numerator * d + b;
    d = 1 / (std::abs(d) < tiny ? tiny : d);
    c = b + numerator / c;
    c = std::abs(c) < tiny ? tiny : c;
    fraction *= c * d;
    if (std::abs(c * d - 1) < 4 * rounding) {
      break;
    }
  }
  return fraction * std::exp(logFactor(a, x));
}
} // namespace

double vpChiSquareCdf(double value, double degrees)
{
  if (!(degrees > 0) || std::isnan(value)) {
    throw vpException(vpException::badValue, "chi-square: value " + vpNumberText(value) + " with " +
                                                 vpNumberText(degrees) +
                                                 " degrees of freedom, expected a number and more than 0");
  }
  const double a = 0.5 * degrees, x = 0.5 * value;
  if (x <= 0 || std::isinf(x)) {
    return x <= 0 ? 0 : 1;
  }
  return x < a + 1 ? lowerGammaSeries(a, x) : 1 - upperGammaFraction(a, x);
}

double vpChiSquareQuantile(double share, double degrees)
{
  if (!(share > 0 && share < 1) || !(degrees > 0)) {
    throw vpException(vpException::badValue,
                      "chi-square: quantile " + vpNumberText(share) + " with " + vpNumberText(degrees) +
                          " degrees of freedom, expected one between 0 and 1 and more than 0");
  }
  double low = 0, high = degrees + 1;
  while (vpChiSquareCdf(high, degrees) < share) {
    high *= 2;
  }
  for (double middle = 0.5 * high; middle > low && middle < high; middle = 0.5 * (low + high)) {
    (vpChiSquareCdf(middle, degrees) < share ? low : high) = middle;
  }
  return high;
}

vpConsistency::vpConsistency(unsigned int dimension)
    : m_dimension(dimension), m_bound(vpChiSquareQuantile(0.95, dimension))
{
}

void vpConsistency::add(double nees)
{
  ++m_count;
  m_sum += nees;
  m_within += nees <= m_bound ? 1 : 0;
}

double vpConsistency::shareWithin95() const
{
  return m_count == 0 ? 0 : static_cast<double>(m_within) / static_cast<double>(m_count);
}

double vpConsistency::meanQuantile(double share) const
{
  const auto n = static_cast<double>(m_count);
  return m_count == 0 ? 0 : vpChiSquareQuantile(share, n * m_dimension) / n;
}

END_VISP_NAMESPACE
