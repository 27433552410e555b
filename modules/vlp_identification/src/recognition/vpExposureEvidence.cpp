/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_identification/vpExposureEvidence.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <visp3/core/vpMath.h>

#include "waveform/vpStripeLimits.h"

BEGIN_VISP_NAMESPACE

namespace
{
const double sigmas = 5;  // standard deviations of the stated exposure that are looked at
const double step = 0.04; // of the logarithm
// Of the logarithm, by which tone curve and blur change what a lamp shows of it: hardly or notably.
const std::array<double, 2> softened{0.03, 0.15};

} // namespace

vpExposureEvidence::vpExposureEvidence(double stated, double logSigma)
    : m_stated(stated), m_statedLogSigma(logSigma), m_exposure(stated), m_logSigma(logSigma)
{
  if (logSigma > step) {
    const int side = static_cast<int>(std::ceil(sigmas * logSigma / step));
    for (std::vector<double> &log : m_logPosterior) {
      for (int i = -side; i <= side; ++i) {
        log.push_back(-0.5 * vpMath::sqr(i * step / logSigma));
      }
    }
  }
}

void vpExposureEvidence::add(const vpStripeFeatures &seen, const vpExposureEvidence &before)
{
  if (m_logPosterior.front().empty() || seen.signal != vpStripeFeatures::Signal::pwm ||
      !(seen.exposure > 0) || !(seen.exposureSigma > 0) || !(seen.frequencySigma < seen.frequency)) {
    return;
  }
  static const double saysNothing = 0.05, mostKnown = 0.95; // shares of the lamps; of what was read
  const double width = seen.exposure * seen.frequency;
  // What was known before is in what was read, and is to count once.
  const double variance = vpMath::sqr(seen.exposureSigma / seen.exposure),
               share =
                   std::min(variance / vpMath::sqr(before.m_logSigma), mostKnown), // that was known before
      alone = variance / (1 - share), known = std::log(before.m_exposure / m_stated);
  auto byStripes = [&](double exposure) {
    return (std::log(exposure / m_stated) - share * known) / (1 - share);
  };
  const double fitted = byStripes(seen.exposure), other = byStripes(seen.duty / seen.frequency);
  const double first = std::exp(-0.5 * vpStripeLimits::unlikely(seen.duty)),
               second = std::exp(-0.5 * vpStripeLimits::unlikely(width));
  const double uniform = 1 / (step * static_cast<double>(m_logPosterior.front().size()));
  const int side = static_cast<int>(m_logPosterior.front().size() / 2);
  for (size_t k = 0; k < softened.size(); ++k) {
    const double sigma = std::sqrt(vpMath::sqr(softened[k]) + alone);
    for (int i = -side; i <= side; ++i) {
      auto bell = [&](double mean) {
        return std::exp(-0.5 * vpMath::sqr((i * step - mean) / sigma)) / (std::sqrt(2 * M_PI) * sigma);
      };
      const double both = (first * bell(fitted) + second * bell(other)) / std::max(first + second, 1e-12);
      m_logPosterior[k][static_cast<size_t>(i + side)] +=
          std::log((1 - saysNothing) * both + saysNothing * uniform);
    }
  }
  summarise();
}

void vpExposureEvidence::summarise()
{
  double most = -std::numeric_limits<double>::infinity();
  for (const std::vector<double> &log : m_logPosterior) {
    most = std::max(most, *std::max_element(log.begin(), log.end()));
  }
  const int side = static_cast<int>(m_logPosterior.front().size() / 2);
  double sum = 0, first = 0, second = 0;
  for (size_t k = 0; k < softened.size(); ++k) {
    for (int i = -side; i <= side; ++i) {
      double &log = m_logPosterior[k][static_cast<size_t>(i + side)];
      log -= most;
      const double weight = std::exp(log), at = i * step;
      sum += weight;
      first += weight * at;
      // What changes what lamps show of it is common to all of them.
      second += weight * (at * at + vpMath::sqr(softened[k]));
    }
  }
  first /= sum;
  m_exposure = m_stated * std::exp(first);
  m_logSigma = std::sqrt(std::max(0.0, second / sum - first * first));
}

bool vpExposureEvidence::contradicts() const
{
  static const double clearly = 3, notable = 0.25; // standard deviations; of the logarithm
  const double off = std::abs(std::log(m_exposure / m_stated));
  return !m_logPosterior.front().empty() && off > clearly * m_logSigma &&
         off > std::max(m_statedLogSigma, notable);
}

END_VISP_NAMESPACE
