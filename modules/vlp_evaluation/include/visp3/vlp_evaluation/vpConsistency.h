/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpConsistency_h
#define vpConsistency_h

#include <cstddef>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! Share of a chi-square distribution with that many degrees of freedom (> 0) that is \e value or less: the
//! regularised incomplete gamma function P(degrees / 2, value / 2).
VISP_EXPORT double vpChiSquareCdf(double value, double degrees);

/*!
  Its inverse, for a share of (0, 1). \throw vpException (badValue) where an argument is out of its range.
*/
VISP_EXPORT double vpChiSquareQuantile(double share, double degrees);

/*!
  Whether errors agree with their covariances: the normalised estimation error squared,
  NEES = e' P^-1 e, which for errors of covariance P is chi-square distributed (Bar-Shalom, Li, Kirubarajan:
  Estimation with Applications to Tracking and Navigation, 2001, section 5.4.2). A mean above the interval
  shows that the sigmas are too small, one below it that they are too large. The interval holds for errors
  that are independent of each other; those of a standing robot share the lamps' and camera's errors.
*/
class VISP_EXPORT vpConsistency
{
public:
  //! \param dimension Of the errors: 2 for (x, y), 1 for z or yaw.
  explicit vpConsistency(unsigned int dimension);

  void add(double nees);

  unsigned int dimension() const { return m_dimension; }
  size_t count() const { return m_count; }

  //! Mean of the NEES, whose expectation is dimension(); 0 without any.
  double mean() const { return m_count == 0 ? 0 : m_sum / static_cast<double>(m_count); }

  //! Share of the NEES within the 95 % bound of the chi-square distribution; 0 without any.
  double shareWithin95() const;

  //! Ends of the two-sided 95 % interval of mean() for count() independent errors of the covariance stated.
  //! Both 0 without any.
  double lower() const { return meanQuantile(0.025); }
  double upper() const { return meanQuantile(0.975); }

private:
  double meanQuantile(double share) const;

  unsigned int m_dimension;
  double m_bound; // of one NEES, at 95 %
  size_t m_count = 0;
  size_t m_within = 0;
  double m_sum = 0;
};

END_VISP_NAMESPACE

#endif
