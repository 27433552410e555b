/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpErrorStatistics_h
#define vpErrorStatistics_h

#include <vector>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  The value below which a share of the values lies: of n sorted values x_0 to x_(n-1) the one at index
  (n - 1) share, linear between its neighbours (NumPy's default, type 7 of Hyndman and Fan 1996). Share 0 is
  the least value, 0.5 the median, 1 the largest.
  \throw vpException (badValue) without values, or where \e share is not of [0, 1].
*/
VISP_EXPORT double vpPercentile(std::vector<double> values, double share);

/*!
  What a set of errors amounts to, in the unit of the errors. Mean and median are of the errors with their
  signs, so that they show a bias; the percentiles and the largest are of their magnitudes. The standard
  deviation is that of the population: rmse^2 = mean^2 + deviation^2.
*/
struct VISP_EXPORT vpErrorStatistics {
  size_t count = 0; // 0: all below are 0 and meaningless
  double mean = 0;
  double median = 0;
  double rmse = 0;
  double deviation = 0;
  double percentile90 = 0;
  double percentile95 = 0;
  double largest = 0;

  static vpErrorStatistics of(const std::vector<double> &errors);
};

/*!
  How errors without sign (m) spread: the probability mass function over bins of one width, and the cumulative
  distribution function.
*/
class VISP_EXPORT vpErrorDistribution
{
public:
  //! Bins of a round width (1, 2 or 5 times a power of ten), about 20 of them up to the largest error.
  //! \throw vpException (badValue) where an error is negative or not finite.
  explicit vpErrorDistribution(std::vector<double> errors);

  //! Sorted.
  const std::vector<double> &errors() const { return m_errors; }

  double binWidth() const { return m_binWidth; }

  //! Share of the errors in each bin [i width, (i + 1) width), from 0 on; their sum is 1. Empty without
  //! errors.
  const std::vector<double> &pmf() const { return m_pmf; }

  //! Share of the errors that are \e error or less; 0 without errors.
  double cdf(double error) const;

private:
  std::vector<double> m_errors;
  double m_binWidth;
  std::vector<double> m_pmf;
};

END_VISP_NAMESPACE

#endif
