/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_identification/vpLedIdRecognizer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>

#include <visp3/core/vpMath.h>

#include "vpMergedPulses.h"
#include "vpNormalTail.h"
#include "waveform/vpDutyRidge.h"

BEGIN_VISP_NAMESPACE

namespace
{

using Signal = vpStripeFeatures::Signal;

const double leastProbability = 1e-3; // of a candidate that is handed on
const double farthestRowTime = 4.5;   // standard deviations of the row time that are looked at

double normalDensity(double z, double sigma)
{
  return std::exp(-0.5 * z * z) / (std::sqrt(2 * M_PI) * sigma);
}

//! Student's t of four degrees of freedom: of several estimates, one that is far off decides nothing for the
//! others (Lange, Little and Taylor 1989).
double heavyTailedDensity(double z, double sigma)
{
  const double q = 1 + 0.25 * z * z;
  return 0.375 / (q * q * std::sqrt(q) * sigma);
}

bool sameKind(Signal signal, vpModulation::Kind kind)
{
  return (signal == Signal::pwm && kind == vpModulation::Kind::pwm) ||
         (signal == Signal::twoPulse && kind == vpModulation::Kind::twoPulse) ||
         (signal == Signal::coded && kind == vpModulation::Kind::word);
}

//! Density of a duty that may be any of some, but for its error.
double evenDensity(double duty, double sigma, const vpMergedPulses &pulses)
{
  const double width = std::max(pulses.mostDuty - pulses.leastDuty, 1e-6);
  return (vpNormalTail((pulses.leastDuty - duty) / sigma) - vpNormalTail((pulses.mostDuty - duty) / sigma)) /
         width;
}

//! Density of what was seen under a lamp that the map does not know: any frequency of two decades, any duty,
//! any phase difference, any word alike.
double unknownDensity(const vpStripeFeatures &seen)
{
  static const double logRange = std::log(100.0);
  double density = 1 / (seen.frequency * logRange);
  if (seen.signal == Signal::twoPulse) {
    density *= 2; // phase differences end at half a period
  } else if (seen.signal == Signal::coded) {
    density *= std::exp2(-static_cast<double>(seen.chips.size()));
  }
  return density;
}

/*!
  A lamp hangs in one place. What blinks as it does elsewhere, with a small part of its light, is its
  reflection in a pane or on a shiny thing, or a piece of it: it keeps its candidates and has no id.
*/
void dropReflections(std::vector<vpLampObservation> &lamps)
{
  static const double much = 3; // times the lit area
  std::vector<size_t> reflections;
  for (size_t i = 0; i < lamps.size(); ++i) {
    const bool reflected =
        !lamps[i].id.empty() && std::any_of(lamps.begin(), lamps.end(), [&](const vpLampObservation &other) {
          return other.id == lamps[i].id && other.features.area > much * lamps[i].features.area;
        });
    if (reflected) {
      reflections.push_back(i);
    }
  }
  for (size_t i : reflections) {
    lamps[i].remark = "blinks as lamp " + lamps[i].id + ", which is larger elsewhere: its reflection";
    lamps[i].id.clear();
    lamps[i].confidence = 1 - lamps[i].confidence;
  }
}

} // namespace

//! An identifier that may have been seen, the row time's error aside.
struct vpLedIdRecognizer::Candidate {
  size_t identifier;
  double frequency; // Hz
  double seen;      // Hz, as the stripes would have it with its duty
  double reach;     // Hz, that what was seen may be off
  double sigma;     // Hz, of the frequency seen about it, row time exact
  double clock;     // Hz, the share of it that is the lamp's own
  double weight;    // prior probability, times the density of all features but the frequency
  bool fits;        // within the gates: of all features but the frequency, and of that once judged
  double probability = 0;

  //! How far what was seen is off, in standard deviations.
  double off(double rowTimeError) const { return (seen - frequency * (1 + rowTimeError)) / sigma; }
};

//! One lamp as the recogniser works on it.
struct vpLedIdRecognizer::Sight {
  bool readable = false;
  double unknown = 0; // prior probability times density of a lamp that the map does not know
  std::vector<Candidate> candidates;
  bool misshapen = false; // not the shape of a lamp that might have blinked so

  //! Of what was seen, whichever lamp it is, for the lamps beside it.
  double evidence(double rowTimeError) const
  {
    double sum = unknown;
    for (const Candidate &candidate : candidates) {
      sum += candidate.weight * heavyTailedDensity(candidate.off(rowTimeError), candidate.sigma);
    }
    return sum;
  }
  //! Probabilities of the candidates, where row-time errors have these weights, which add up to 1.
  void judge(const std::vector<double> &errors, const std::vector<double> &weights, double gate);
};

void vpLedIdRecognizer::Sight::judge(const std::vector<double> &errors, const std::vector<double> &weights,
                                     double gate)
{
  const double most = *std::max_element(weights.begin(), weights.end());
  double sum = unknown;
  for (Candidate &candidate : candidates) {
    const double reach = std::hypot(candidate.reach, gate * candidate.clock);
    double least = std::numeric_limits<double>::infinity(); // gates^2, from the nearest likely row time
    for (size_t k = 0; k < errors.size(); ++k) {
      const double off = candidate.seen - candidate.frequency * (1 + errors[k]);
      least = std::min(least, vpMath::sqr(off / reach) - 2 * std::log(weights[k] / most) / vpMath::sqr(gate));
    }
    candidate.fits = candidate.fits && least < 1;
    candidate.probability = 0;
    for (size_t k = 0; k < errors.size(); ++k) {
      candidate.probability +=
          weights[k] * candidate.weight * normalDensity(candidate.off(errors[k]), candidate.sigma);
    }
    sum += candidate.probability; // of what does not fit, too: it may be less unlikely than the rest
  }
  for (Candidate &candidate : candidates) {
    candidate.probability /= sum;
  }
  candidates.erase(
      std::remove_if(candidates.begin(), candidates.end(),
                     [](const Candidate &c) { return !c.fits || !(c.probability > leastProbability); }),
      candidates.end());
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate &a, const Candidate &b) { return a.probability > b.probability; });
}

vpLedIdRecognizer::vpLedIdRecognizer(const vpLampMap &map, const vpRollingShutter &shutter)
    : m_map(map), m_exposure(shutter.exposure), m_identifiers(map.identifiers()),
      m_byFrequency(m_identifiers.size())
{
  if (shutter.rowTime > 0) {
    m_relativeRowTime = shutter.rowTimeSigma / shutter.rowTime;
  }
  std::iota(m_byFrequency.begin(), m_byFrequency.end(), size_t{0});
  std::sort(m_byFrequency.begin(), m_byFrequency.end(), [this](size_t a, size_t b) {
    return m_identifiers[a].modulation.repetitionFrequency() <
           m_identifiers[b].modulation.repetitionFrequency();
  });
}

//! Whether any of its lamps may have the outline seen.
bool vpLedIdRecognizer::mayLookLike(const vpIdentifier &identifier, const vpLampObservation &seen) const
{
  if (seen.cut || !(seen.outline.otherShape < leastShape)) {
    return true;
  }
  const vpLamp::Shape shape =
      seen.outline.shape == vpLampOutline::Shape::quadrilateral ? vpLamp::Shape::square : vpLamp::Shape::disk;
  return std::any_of(identifier.lamps.begin(), identifier.lamps.end(), [&](size_t index) {
    const vpLamp &lamp = m_map.lamps[index];
    return lamp.shape == shape || std::isnan(lamp.size);
  });
}

//! Why the features name no lamp of the map, whichever it is; empty where they may.
std::string vpLedIdRecognizer::unreadable(const vpStripeFeatures &seen) const
{
  if (seen.signal == Signal::unmodulated) {
    return "no stripes";
  }
  if (seen.signal == Signal::coded && seen.chips.empty()) {
    return "neither PWM nor a word that was seen whole";
  }
  if (!(seen.frequencySigma < maxFrequencySigma * seen.frequency)) {
    return "too few stripes for a frequency";
  }
  if (seen.alongDuty.empty() && seen.frequencySigma > maxSpread * boundOf(seen)) {
    return "its edges hide between the lines";
  }
  return "";
}

//! Hz, the bound of an estimate's error, or as much more as lets hardly any unknown lamp pass.
double vpLedIdRecognizer::boundOf(const vpStripeFeatures &seen) const
{
  if (std::isnan(seen.frequencyBound)) {
    return std::numeric_limits<double>::infinity();
  }
  const double identifiers = static_cast<double>(m_identifiers.size()),
               chance = 2 * boundGate * identifiers * unknownDensity(seen); // per Hz
  return std::max(seen.frequencyBound, maxChance / chance);
}

//! Compares duty, phase difference or word of an identifier with what was seen.
void vpLedIdRecognizer::addCandidate(Sight &sight, const vpLampObservation &lamp, size_t index) const
{
  const vpStripeFeatures &seen = lamp.features;
  const vpIdentifier &identifier = m_identifiers[index];
  const vpModulation &sent = identifier.modulation;
  std::optional<vpMergedPulses> merged;
  if (seen.signal == Signal::pwm) {
    merged = vpMergedPulses::of(sent, std::fmax(m_exposure, seen.exposure));
  }
  if (!sameKind(seen.signal, sent.kind) && !merged) {
    return;
  }
  if (!mayLookLike(identifier, lamp)) {
    sight.misshapen = true;
    return;
  }
  Candidate candidate;
  candidate.identifier = index;
  candidate.frequency = sent.repetitionFrequency();
  candidate.clock = 1e-6 * identifier.oscillatorPpm * candidate.frequency;
  // What all frames share is no smaller where the stripes are those of several.
  const double error = std::hypot(dutyError, seen.dutyClipped);
  vpDutyRidge::Reading reading = vpDutyRidge::of(seen, merged ? std::nullopt : sent.duty, error);
  if (merged) {
    const double sigma = std::hypot(reading.dutySigma, error);
    reading.density = evenDensity(reading.duty, sigma, *merged);
    reading.distance = merged->distance({reading.duty, reading.duty}) / sigma;
  }
  candidate.seen = reading.frequency;
  const double bound = boundOf(seen), reach = std::min(gate * reading.frequencySigma, boundGate * bound);
  candidate.reach = std::hypot(reach, spreadGate * reading.spread);
  candidate.sigma = std::hypot(reading.frequencySigma, candidate.clock);
  candidate.weight = (1 - unknownPrior) * static_cast<double>(identifier.lamps.size()) /
                     static_cast<double>(m_map.lamps.size());
  candidate.weight *= reading.density;
  candidate.fits = reading.distance < shapeGate && !(reading.frequencySigma > maxSpread * bound);
  if (seen.signal == Signal::twoPulse) {
    const double sigma = std::hypot(seen.phaseDifferenceSigma, phaseError),
                 z = (seen.phaseDifference - sent.phaseDifference) / sigma;
    candidate.weight *= normalDensity(z, sigma);
    candidate.fits = candidate.fits && std::abs(z) < shapeGate;
  }
  if (sent.kind == vpModulation::Kind::word) {
    if (!vpModulation::sameWord(seen.chips, sent.chips())) {
      return;
    }
    candidate.weight *= seen.chipsConfidence;
  }
  sight.candidates.push_back(candidate);
}

vpLedIdRecognizer::Sight vpLedIdRecognizer::sightOf(const vpLampObservation &lamp) const
{
  const vpStripeFeatures &seen = lamp.features;
  Sight sight;
  if (!unreadable(seen).empty()) {
    return sight;
  }
  sight.readable = true;
  sight.unknown = unknownPrior * unknownDensity(seen);
  double spread = 2 * gate * seen.frequencySigma; // Hz
  for (const vpDutySlice &slice : seen.alongDuty) {
    spread = std::max(spread, std::abs(slice.frequency - seen.frequency) + 2 * gate * slice.frequencySigma);
  }
  // All that may compete; an oscillator of the map may be as wide as the range of frequencies.
  for (size_t index : m_byFrequency) {
    const vpIdentifier &identifier = m_identifiers[index];
    const double f = identifier.modulation.repetitionFrequency();
    const double reach = farthestRowTime * m_relativeRowTime * f +
                         std::hypot(spread, 2e-6 * gate * identifier.oscillatorPpm * f);
    if (std::abs(seen.frequency - f) < reach) {
      addCandidate(sight, lamp, index);
    }
  }
  return sight;
}

//! A grid of them, fine enough for the sharpest candidate.
std::vector<double> vpLedIdRecognizer::rowTimeErrors(const std::vector<Sight> &sights) const
{
  if (!(m_relativeRowTime > 0)) {
    return {0};
  }
  static const double ofSigma = 0.5;
  static const int most = 4000; // to each side
  const double reach = farthestRowTime * m_relativeRowTime;
  double step = ofSigma * m_relativeRowTime;
  for (const Sight &sight : sights) {
    for (const Candidate &candidate : sight.candidates) {
      step = std::min(step, ofSigma * candidate.sigma / candidate.frequency);
    }
  }
  const int side = std::clamp(static_cast<int>(std::ceil(reach / std::max(step, 1e-12))), 1, most);
  std::vector<double> errors;
  for (int k = -side; k <= side; ++k) {
    errors.push_back(reach * k / side);
  }
  return errors;
}

vpRowTimeError vpLedIdRecognizer::recognize(std::vector<vpLampObservation> &lamps) const
{
  std::vector<Sight> sights;
  for (const vpLampObservation &lamp : lamps) {
    sights.push_back(sightOf(lamp));
  }
  const std::vector<double> errors = rowTimeErrors(sights);
  std::vector<std::vector<double>> logs; // of each lamp's evidence at each error
  std::vector<double> together;
  for (double error : errors) {
    together.push_back(m_relativeRowTime > 0 ? -0.5 * vpMath::sqr(error / m_relativeRowTime) : 0);
  }
  for (const Sight &sight : sights) {
    logs.emplace_back(errors.size(), 0.0);
    for (size_t k = 0; sight.readable && k < errors.size(); ++k) {
      logs.back()[k] = std::log(sight.evidence(errors[k]));
      together[k] += logs.back()[k];
    }
  }
  auto normalised = [](std::vector<double> log) {
    const double most = *std::max_element(log.begin(), log.end());
    double sum = 0;
    for (double &value : log) {
      value = std::exp(value - most);
      sum += value;
    }
    for (double &value : log) {
      value /= sum;
    }
    return log;
  };
  for (size_t i = 0; i < lamps.size(); ++i) {
    std::vector<double> others = together;
    std::transform(others.begin(), others.end(), logs[i].begin(), others.begin(), std::minus<double>());
    sights[i].judge(errors, normalised(std::move(others)), gate);
    decide(lamps[i], sights[i]);
  }
  dropReflections(lamps);
  vpRowTimeError error;
  const std::vector<double> weights = normalised(std::move(together));
  for (size_t k = 0; k < errors.size(); ++k) {
    error.mean -= weights[k] * errors[k]; // longer lines make slower stripes of the same lamp
    error.sigma += weights[k] * vpMath::sqr(errors[k]);
  }
  error.sigma = std::sqrt(std::max(0.0, error.sigma - vpMath::sqr(error.mean)));
  return error;
}

void vpLedIdRecognizer::recognize(vpLampObservation &lamp) const
{
  std::vector<vpLampObservation> alone{lamp};
  recognize(alone);
  lamp = alone.front();
}

void vpLedIdRecognizer::decide(vpLampObservation &lamp, const Sight &sight) const
{
  lamp.id.clear();
  lamp.candidates.clear();
  lamp.remark = unreadable(lamp.features);
  lamp.confidence = 1; // of being none of them
  if (!sight.readable) {
    return;
  }
  if (!sight.candidates.empty() && !(lamp.blinking > leastBlinking)) {
    lamp.remark = lamp.blinking > 0 ? "only a part of it blinks as a lamp of the map"
                                    : "blinks as a lamp of the map, but has no outline of one";
    return;
  }
  for (const Candidate &candidate : sight.candidates) {
    lamp.candidates.push_back({candidate.identifier, candidate.probability});
    lamp.confidence = std::max(0.0, lamp.confidence - candidate.probability);
  }
  if (lamp.candidates.empty()) {
    lamp.remark = lamp.features.signal == Signal::coded ? "coded, a word that the map does not have"
                  : sight.misshapen                     ? "fits no lamp of the map of its shape"
                                                        : "fits no lamp of the map";
    return;
  }
  const vpLedIdCandidate &best = lamp.candidates.front();
  const std::vector<size_t> &carriers = m_identifiers[best.identifier].lamps;
  const std::string first = m_map.lamps[carriers.front()].id;
  if (best.probability < minConfidence) {
    lamp.remark = lamp.candidates.size() == 1
                      ? "hardly fits lamp " + first
                      : "fits " + std::to_string(lamp.candidates.size()) + " identifiers of the map";
  } else if (carriers.size() > 1) {
    lamp.remark = "may be any of " + std::to_string(carriers.size()) + " lamps that blink alike, as " + first;
  } else {
    lamp.id = first;
    lamp.confidence = best.probability;
  }
}

END_VISP_NAMESPACE
