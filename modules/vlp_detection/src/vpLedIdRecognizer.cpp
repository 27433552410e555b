/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_detection/vpLedIdRecognizer.h>

#include <algorithm>
#include <cmath>
#include <string>

BEGIN_VISP_NAMESPACE

namespace
{

using Signal = vpStripeFeatures::Signal;

//! One feature against what a lamp predicts: squared distance and density.
struct Distance {
  double squared = 0;
  double density = 1;

  void add(double difference, double sigma)
  {
    const double z = difference / sigma;
    squared = std::max(squared, z * z); // each feature has to fit by itself
    density *= std::exp(-0.5 * z * z) / (std::sqrt(2 * M_PI) * sigma);
  }
};

bool sameKind(Signal signal, vpModulation::Kind kind)
{
  return (signal == Signal::pwm && kind == vpModulation::Kind::pwm) ||
         (signal == Signal::twoPulse && kind == vpModulation::Kind::twoPulse);
}

double square(double x)
{
  return x * x;
}

} // namespace

vpLedIdRecognizer::vpLedIdRecognizer(const vpLampMap &map, const vpRollingShutter &shutter) : m_map(map)
{
  if (shutter.rowTime > 0) {
    m_relativeRowTime = shutter.rowTimeSigma / shutter.rowTime;
  }
}

std::vector<vpLedIdRecognizer::Match>
vpLedIdRecognizer::candidates(const vpLampObservation &observation) const
{
  const vpStripeFeatures &seen = observation.features;
  std::vector<Match> matches;
  for (const vpLamp &lamp : m_map.lamps) {
    const vpModulation &sent = lamp.modulation;
    if (!sameKind(seen.signal, sent.kind)) {
      continue;
    }
    Distance distance;
    distance.add(seen.frequency - sent.frequency,
                 std::sqrt(square(seen.frequencySigma) + square(m_relativeRowTime * sent.frequency) +
                           square(1e-6 * lamp.oscillatorPpm * sent.frequency)));
    if (sent.duty) {
      // Saturation widens the lit stripes.
      static const double bySaturation = 0.15;
      distance.add(seen.duty - *sent.duty, std::sqrt(square(seen.dutySigma) + square(dutyError) +
                                                     square(bySaturation * observation.saturated)));
    }
    if (sent.kind == vpModulation::Kind::twoPulse) {
      distance.add(seen.phaseDifference - sent.phaseDifference,
                   std::hypot(seen.phaseDifferenceSigma, phaseError));
    }
    if (distance.squared < gate * gate) {
      matches.push_back({&lamp, distance.density});
    }
  }
  return matches;
}

void vpLedIdRecognizer::recognize(vpLampObservation &observation) const
{
  const vpStripeFeatures &seen = observation.features;
  observation.id.clear();
  observation.confidence = 1;
  if (seen.signal == Signal::unmodulated) {
    observation.remark = "no stripes";
    return;
  }
  if (seen.signal == Signal::coded) {
    observation.remark = "coded, neither one nor two pulses a period";
    return;
  }
  if (!(seen.frequencySigma < maxFrequencyDoubt * seen.frequency)) {
    observation.remark = "too few stripes for a frequency";
    return;
  }
  const std::vector<Match> matches = candidates(observation);
  if (matches.empty()) {
    observation.remark = "fits no lamp of the map";
    return;
  }
  // A lamp that the map does not know: any frequency of two decades, any duty, any phase difference.
  static const double logRange = std::log(100.0);
  double unknown = 1 / (seen.frequency * logRange);
  if (seen.signal == Signal::twoPulse) {
    unknown *= 2;
  }
  double sum = unknownPrior * unknown;
  const double prior = (1 - unknownPrior) / static_cast<double>(m_map.lamps.size());
  for (const Match &match : matches) {
    sum += prior * match.likelihood;
  }
  const Match &best = *std::max_element(matches.begin(), matches.end(), [](const Match &a, const Match &b) {
    return a.likelihood < b.likelihood;
  });
  const double probability = prior * best.likelihood / sum;
  if (probability >= minConfidence) {
    observation.id = best.lamp->id;
    observation.confidence = probability;
    return;
  }
  observation.confidence = unknownPrior * unknown / sum;
  observation.remark = matches.size() == 1 ? "hardly fits lamp " + best.lamp->id
                                           : "fits " + std::to_string(matches.size()) + " lamps of the map";
}

END_VISP_NAMESPACE
