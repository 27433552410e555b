/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpWaveformMoments_h
#define vpWaveformMoments_h

#include <limits>

#include "vpWaveformFit.h"

BEGIN_VISP_NAMESPACE

//! Mean and covariance of weighted samples.
class vpWaveformFit::Moments
{
public:
  //! \param about Some place near them.
  explicit Moments(const Vector &about) : m_about(about) {}

  void add(const Vector &x, double weight, double cost)
  {
    keepLikeliest(x, cost);
    const Vector apart = x - m_about;
    m_sum += weight;
    m_first += weight * apart;
    m_second += weight * apart * apart.transpose();
  }
  //! Samples about the same place.
  void add(const Moments &other)
  {
    keepLikeliest(other.m_likeliest, other.m_leastCost);
    m_sum += other.m_sum;
    m_first += other.m_first;
    m_second += other.m_second;
  }
  //! Whether no mean is farther from the other's than so many standard deviations of all samples.
  bool isNear(const Moments &other, double sigmas) const
  {
    Moments both = *this;
    both.add(other);
    const Vector variance = both.covariance().diagonal();
    return ((mean() - other.mean()).array().square() <= sigmas * sigmas * variance.array()).all();
  }
  Vector mean() const { return m_about + m_first / m_sum; }
  Matrix covariance() const
  {
    const Vector first = m_first / m_sum;
    return m_second / m_sum - first * first.transpose();
  }
  const Vector &likeliest() const { return m_likeliest; }
  double leastCost() const { return m_leastCost; }

private:
  void keepLikeliest(const Vector &x, double cost)
  {
    if (cost < m_leastCost) {
      m_leastCost = cost;
      m_likeliest = x;
    }
  }

  Vector m_about, m_first = Vector::Zero(), m_likeliest = Vector::Zero();
  Matrix m_second = Matrix::Zero();
  double m_sum = 0, m_leastCost = std::numeric_limits<double>::infinity();
};

END_VISP_NAMESPACE

#endif
