/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_identification/vpExposureEvidence.h>

#include <algorithm>
#include <cmath>

#include "waveform/vpStripeLimits.h"

BEGIN_VISP_NAMESPACE

namespace
{
const double sigmas = 5;      // standard deviations of the stated exposure that are looked at
const double step = 0.04;     // of the logarithm
const double softened = 0.15; // of the logarithm: tone curve and blur change what a lamp shows of it

double square(double x)
{
  return x * x;
}
} // namespace

vpExposureEvidence::vpExposureEvidence(double stated, double logSigma)
    : m_stated(stated), m_statedLogSigma(logSigma), m_exposure(stated), m_logSigma(logSigma)
{
  if (logSigma > step) {
    const int side = static_cast<int>(std::ceil(sigmas * logSigma / step));
    for (int i = -side; i <= side; ++i) {
      m_logPosterior.push_back(-0.5 * square(i * step / logSigma));
    }
  }
}

void vpExposureEvidence::add(const vpStripeFeatures &seen)
{
  if (m_logPosterior.empty() || seen.signal != vpStripeFeatures::Signal::pwm || !(seen.exposure > 0) ||
      !(seen.exposureSigma > 0) || !(seen.frequencySigma < seen.frequency)) {
    return;
  }
  static const double saysNothing = 0.05; // share of the lamps
  const double width = seen.exposure * seen.frequency,
               sigma = std::hypot(softened, seen.exposureSigma / seen.exposure);
  const double fitted = std::log(seen.exposure / m_stated),
               other = std::log(seen.duty / seen.frequency / m_stated);
  const double first = std::exp(-0.5 * vpStripeLimits::unlikely(seen.duty)),
               second = std::exp(-0.5 * vpStripeLimits::unlikely(width));
  const double uniform = 1 / (step * static_cast<double>(m_logPosterior.size()));
  const int side = static_cast<int>(m_logPosterior.size() / 2);
  for (int i = -side; i <= side; ++i) {
    auto bell = [&](double mean) {
      return std::exp(-0.5 * square((i * step - mean) / sigma)) / (std::sqrt(2 * M_PI) * sigma);
    };
    const double both = (first * bell(fitted) + second * bell(other)) / std::max(first + second, 1e-12);
    m_logPosterior[static_cast<size_t>(i + side)] +=
        std::log((1 - saysNothing) * both + saysNothing * uniform);
  }
  summarise();
}

void vpExposureEvidence::summarise()
{
  const double most = *std::max_element(m_logPosterior.begin(), m_logPosterior.end());
  const int side = static_cast<int>(m_logPosterior.size() / 2);
  double sum = 0, first = 0, second = 0;
  for (int i = -side; i <= side; ++i) {
    double &log = m_logPosterior[static_cast<size_t>(i + side)];
    log -= most;
    const double weight = std::exp(log), at = i * step;
    sum += weight;
    first += weight * at;
    second += weight * at * at;
  }
  first /= sum;
  m_exposure = m_stated * std::exp(first);
  // What changes what lamps show of it is common to all of them.
  m_logSigma = std::sqrt(std::max(0.0, second / sum - first * first) + square(softened));
}

bool vpExposureEvidence::contradicts() const
{
  static const double clearly = 3, notable = 0.25; // standard deviations; of the logarithm
  const double off = std::abs(std::log(m_exposure / m_stated));
  return !m_logPosterior.empty() && off > clearly * m_logSigma && off > std::max(m_statedLogSigma, notable);
}

END_VISP_NAMESPACE
