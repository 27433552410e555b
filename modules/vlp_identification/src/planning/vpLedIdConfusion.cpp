/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What vpLedIdPlanner says of a map that there is.

#include <visp3/vlp_identification/vpLedIdPlanner.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "recognition/vpMergedPulses.h"
#include "recognition/vpNormalTail.h"
#include "words/vpWordCode.h"

BEGIN_VISP_NAMESPACE

namespace
{
//! An identifier as the rig sees the smallest of its lamps.
struct Seen {
  const vpModulation *sent;
  double apparent; // Hz, of the stripes
  vpStripeUncertainty sigma;
  std::vector<vpStripeUncertainty> scatter; // at some phases; empty of a word
  std::optional<vpMergedPulses> onePulse;   // the duties that it may have where one pulse is seen
  double chipDistance = 0;                  // of two words that differ in one chip
  std::string chips;
};

//! \param exposure Of a line, s.
std::optional<vpMergedPulses> onePulseOf(const vpModulation &sent, double exposure)
{
  if (sent.kind == vpModulation::Kind::pwm) {
    return sent.duty ? vpMergedPulses{*sent.duty, *sent.duty} : vpMergedPulses();
  }
  return vpMergedPulses::of(sent, exposure);
}

//! The frequency, Hz, that stripes show to lines of a rate (Hz): above half of it another one (aliasing).
double apparentOf(const vpModulation &sent, double lineRate)
{
  return std::abs(std::remainder(sent.repetitionFrequency(), lineRate));
}

double squaredDistance(double difference, double sigma, double otherSigma)
{
  const double distance = difference / std::max(sigma, otherSigma);
  return distance * distance;
}

bool comparable(const Seen &a, const Seen &b)
{
  return (a.sent->kind == b.sent->kind && a.chips.size() == b.chips.size()) || (a.onePulse && b.onePulse);
}

//! Squared distance in units of a pair of standard deviations, words' chips left out.
double squaredDistance(const Seen &one, const Seen &other, const vpStripeUncertainty &ofA,
                       const vpStripeUncertainty &ofB)
{
  const vpModulation &a = *one.sent, &b = *other.sent;
  const bool pulses = a.kind == vpModulation::Kind::twoPulse;
  double shape = std::numeric_limits<double>::infinity();
  if (a.kind == b.kind) {
    shape = a.duty && b.duty ? squaredDistance(*a.duty - *b.duty, ofA.duty, ofB.duty) : 0;
    shape += pulses ? squaredDistance(a.phaseDifference - b.phaseDifference, ofA.phaseDifference,
                                      ofB.phaseDifference)
                    : 0;
  }
  if (one.onePulse && other.onePulse && (pulses || a.kind != b.kind)) {
    shape = std::min(shape, squaredDistance(one.onePulse->distance(*other.onePulse), ofA.duty, ofB.duty));
  }
  return squaredDistance(one.apparent - other.apparent, ofA.frequency, ofB.frequency) + shape;
}

//! Probability that \e sent is taken for \e other, over the phases.
double errorOf(const Seen &sent, const Seen &other)
{
  double sum = 0;
  for (const vpStripeUncertainty &here : sent.scatter) {
    sum += vpNormalTail(0.5 * std::sqrt(squaredDistance(sent, other, here, here)));
  }
  return sum / static_cast<double>(sent.scatter.size());
}

vpLedIdPair pairOf(const Seen &a, const Seen &b)
{
  vpLedIdPair pair;
  double squared = squaredDistance(a, b, a.sigma, b.sigma);
  if (a.sent->kind == vpModulation::Kind::word) {
    pair.chips = static_cast<int>(vpWordCode(a.chips).distance(vpWordCode(b.chips)));
    squared += std::pow(std::min(a.chipDistance, b.chipDistance), 2) * pair.chips;
  }
  pair.distance = std::sqrt(squared);
  if (!std::isfinite(pair.distance)) { // stripes so long that they tell no frequency
    pair.distance = 0;
    pair.error = vpNormalTail(0);
    return pair;
  }
  pair.error = a.scatter.empty() ? vpNormalTail(0.5 * pair.distance) : std::max(errorOf(a, b), errorOf(b, a));
  return pair;
}

Seen seenWord(const vpStripePrediction &prediction, const vpLamp &lamp, double lines)
{
  const vpModulation &sent = lamp.modulation;
  Seen seen{&sent, apparentOf(sent, 2 * prediction.fold()), {}, {}, {}, 0, sent.chips()};
  if (seen.chips.size() > vpWordCode::mostChips) {
    throw vpException(vpException::badValue,
                      "lamp " + vpShown(lamp.id) + ": a word of " + std::to_string(seen.chips.size()) +
                          " chips, expected at most " + std::to_string(vpWordCode::mostChips));
  }
  // Its chips tell the rate at which it repeats as a pulse of the rate of two chips tells its own.
  vpModulation chips;
  chips.kind = vpModulation::Kind::pwm;
  chips.frequency = 0.5 * sent.chipRate;
  const auto length = static_cast<double>(seen.chips.size());
  seen.sigma.frequency = prediction.uncertainty(chips, lines, lamp.oscillatorPpm).frequency * 2 / length;
  seen.chipDistance = 2 * prediction.contrast(chips.frequency) * std::sqrt(lines / length) /
                      (prediction.lineNoise(0.5) * prediction.margin);
  return seen;
}
} // namespace

double vpLedIdPlanner::linesOf(const vpLamp &lamp, double height, double size) const
{
  const double own = std::isnan(lamp.size) ? size : lamp.size;
  const double above = std::isnan(height) ? lamp.position.z() - m_cameraHeight : height;
  if (std::isnan(own)) {
    throw vpException(vpException::badValue,
                      "lamp " + vpShown(lamp.id) + ": no size, expected one in the map");
  }
  if (!(above > 0)) {
    throw vpException(vpException::badValue, "lamp " + vpShown(lamp.id) + ": " + vpNumberText(above) +
                                                 " m above the camera, expected more than 0");
  }
  return prediction.lines(own, above);
}

std::vector<vpLedIdPair> vpLedIdPlanner::confusion(const vpLampMap &map, double height, double size) const
{
  std::vector<Seen> all;
  for (const vpIdentifier &identifier : map.identifiers()) {
    double lines = prediction.pictureLines();
    for (const size_t lamp : identifier.lamps) {
      lines = std::min(lines, linesOf(map.lamps[lamp], height, size));
    }
    const vpLamp &lamp = map.lamps[identifier.lamps.front()];
    all.push_back(lamp.modulation.kind == vpModulation::Kind::word
                      ? seenWord(prediction, lamp, lines)
                      : Seen{&lamp.modulation,
                             apparentOf(lamp.modulation, 2 * prediction.fold()),
                             prediction.uncertainty(lamp.modulation, lines, lamp.oscillatorPpm),
                             prediction.scatter(lamp.modulation, lines, lamp.oscillatorPpm),
                             onePulseOf(lamp.modulation, prediction.exposure()),
                             0,
                             {}});
  }
  std::vector<vpLedIdPair> pairs;
  for (size_t i = 0; i < all.size(); ++i) {
    for (size_t j = i + 1; j < all.size(); ++j) {
      if (comparable(all[i], all[j])) {
        pairs.push_back(pairOf(all[i], all[j]));
        pairs.back().first = i;
        pairs.back().second = j;
      }
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const vpLedIdPair &a, const vpLedIdPair &b) {
    return std::make_pair(-a.error, a.distance) < std::make_pair(-b.error, b.distance);
  });
  return pairs;
}

std::vector<vpLedIdReuse> vpLedIdPlanner::reuse(const vpLampMap &map)
{
  std::vector<vpLedIdReuse> shared;
  const std::vector<vpIdentifier> identifiers = map.identifiers();
  for (size_t i = 0; i < identifiers.size(); ++i) {
    const std::vector<size_t> &lamps = identifiers[i].lamps;
    vpLedIdReuse nearest{i, 0, 0, std::numeric_limits<double>::infinity()};
    for (size_t j = 0; j < lamps.size(); ++j) {
      for (size_t k = j + 1; k < lamps.size(); ++k) {
        const double apart = (map.lamps[lamps[j]].position - map.lamps[lamps[k]].position).norm();
        if (apart < nearest.apart) {
          nearest = {i, lamps[j], lamps[k], apart};
        }
      }
    }
    if (lamps.size() > 1) {
      shared.push_back(nearest);
    }
  }
  std::stable_sort(shared.begin(), shared.end(),
                   [](const vpLedIdReuse &a, const vpLedIdReuse &b) { return a.apart < b.apart; });
  return shared;
}

END_VISP_NAMESPACE
