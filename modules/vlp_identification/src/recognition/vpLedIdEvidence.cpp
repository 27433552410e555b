/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_identification/vpLedIdEvidence.h>

#include <cmath>

#include "waveform/vpDutyRidge.h"

BEGIN_VISP_NAMESPACE

namespace
{
using Signal = vpStripeFeatures::Signal;

//! Adds one estimate to the weighted mean of others.
void average(double &mean, double &sigma, double value, double valueSigma)
{
  const double weight = 1 / (sigma * sigma), more = 1 / (valueSigma * valueSigma);
  mean = (weight * mean + more * value) / (weight + more);
  sigma = 1 / std::sqrt(weight + more);
}

//! What is new in each frame averages out, what frames share does not.
void average(double &noise, double &sigma, double weight, double otherNoise, double otherSigma, double other)
{
  auto shared = [](double all, double own) { return std::sqrt(std::max(0.0, all * all - own * own)); };
  const double share = other / (weight + other),
               common = (1 - share) * shared(sigma, noise) + share * shared(otherSigma, otherNoise);
  noise = std::hypot((1 - share) * noise, share * otherNoise);
  sigma = std::hypot(noise, common);
}

double noiseOf(const vpStripeFeatures &seen)
{
  return std::isnan(seen.frequencyNoise) ? seen.frequencySigma
                                         : std::min(seen.frequencyNoise, seen.frequencySigma);
}
} // namespace

bool vpLedIdEvidence::tells(const vpStripeFeatures &seen)
{
  return seen.signal != Signal::unmodulated && std::isfinite(seen.frequency) &&
         seen.frequencySigma < seen.frequency && (seen.signal != Signal::coded || !seen.chips.empty());
}

bool vpLedIdEvidence::agrees(const vpStripeFeatures &seen) const
{
  auto near = [this](double a, double sigma, double b, double other) {
    return std::abs(a - b) < gate * std::hypot(sigma, other);
  };
  if (m_frames == 0 || !tells(seen)) {
    return true;
  }
  return seen.signal == m_features.signal && seen.chips == m_features.chips &&
         near(seen.frequency, seen.frequencySigma, m_features.frequency, m_features.frequencySigma) &&
         (seen.signal == Signal::coded ||
          near(seen.duty, seen.dutySigma, m_features.duty, m_features.dutySigma)) &&
         (seen.signal != Signal::twoPulse ||
          near(seen.phaseDifference, seen.phaseDifferenceSigma, m_features.phaseDifference,
               m_features.phaseDifferenceSigma));
}

bool vpLedIdEvidence::add(const vpStripeFeatures &seen)
{
  if (!tells(seen)) {
    if (m_frames == 0) {
      m_features = seen;
    }
    return true;
  }
  if (m_frames == 0 || !agrees(seen)) {
    const bool first = m_frames == 0;
    m_features = seen;
    m_frames = 1;
    m_weight = 1 / (seen.frequencySigma * seen.frequencySigma);
    return first;
  }
  const vpStripeFeatures before = m_features;
  m_features = seen; // stripes, area, modulation and misfit are those of the latest frame
  const double weight = 1 / (seen.frequencySigma * seen.frequencySigma),
               noise = noiseOf(before) / before.frequencySigma, more = noiseOf(seen) / seen.frequencySigma;
  m_features.frequency = (m_weight * before.frequency + weight * seen.frequency) / (m_weight + weight);
  m_features.frequencySigma = before.frequencySigma;
  m_features.frequencyNoise = noiseOf(before);
  average(m_features.frequencyNoise, m_features.frequencySigma, m_weight, noiseOf(seen), seen.frequencySigma,
          weight);
  m_features.frequencyBound = before.frequencyBound;
  double boundNoise = noise * before.frequencyBound;
  average(boundNoise, m_features.frequencyBound, m_weight, more * seen.frequencyBound, seen.frequencyBound,
          weight);
  m_weight += weight;
  m_features.alongDuty = vpDutyRidge::together(before, seen);
  if (!m_features.alongDuty.empty()) {
    vpDutyRidge::settle(m_features);
    m_features.alongDuty = vpDutyRidge::whereOpen(m_features.alongDuty);
  } else if (seen.signal == Signal::coded) {
    m_features.chipsConfidence = 1 - (1 - before.chipsConfidence) * (1 - seen.chipsConfidence);
  } else {
    m_features.duty = before.duty;
    m_features.dutySigma = before.dutySigma;
    average(m_features.duty, m_features.dutySigma, seen.duty, seen.dutySigma);
  }
  if (seen.signal == Signal::twoPulse) {
    m_features.phaseDifference = before.phaseDifference;
    m_features.phaseDifferenceSigma = before.phaseDifferenceSigma;
    average(m_features.phaseDifference, m_features.phaseDifferenceSigma, seen.phaseDifference,
            seen.phaseDifferenceSigma);
  }
  ++m_frames;
  return true;
}

void vpLedIdEvidence::clear()
{
  *this = vpLedIdEvidence();
}

END_VISP_NAMESPACE
