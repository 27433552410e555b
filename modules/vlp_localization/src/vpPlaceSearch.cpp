/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPlaceSearch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vpLampGeometry.h"

BEGIN_VISP_NAMESPACE

namespace
{
const double gate = vpPlaceModel::gate;
const double leastDepth = vpPlaceModel::leastDepth;
const double negligible = 20;   // a place e to this power less likely than the best is forgotten
const double slackOfPair = 0.3; // m and rad, by which a pair may miss the bounds that all its lamps keep
const size_t maxPlaces = 2000;  // of a picture that as many explain nobody asks which
const size_t noLamp = vpLampMatch::noLamp;

double square(double x)
{
  return x * x;
}
} // namespace

vpPlaceSearch::vpPlaceSearch(const vpLampMatcher &settings, const vpLampIndex &index,
                             const std::vector<vpSeenLamp> &seen, double pictureArea, const Bounds &bounds)
    : m_model(settings, index, seen, pictureArea, bounds), m_settings(settings), m_index(index), m_seen(seen),
      m_bounds(bounds)
{
}

bool vpPlaceSearch::run()
{
  const std::vector<size_t> order = ordered();
  // A pose that all pairs of the first k + 1 regions miss has one of them at most.
  for (size_t k = 1; k < order.size() && m_allowed && !complete(k); ++k) {
    for (size_t i = 0; i < k && m_allowed; ++i) {
      tryPair(order[i], order[k]);
      m_allowed = m_hypotheses < m_settings.maxHypotheses && m_places.size() < maxPlaces;
    }
  }
  std::stable_sort(m_places.begin(), m_places.end(),
                   [](const Place &a, const Place &b) { return a.logEvidence > b.logEvidence; });
  return m_allowed;
}

/*!
  Regions that few lamps of the map can be come first, and of these such as lie far apart: their pairs are few
  and fix the pose best.
*/
std::vector<size_t> vpPlaceSearch::ordered() const
{
  std::vector<size_t> order;
  std::vector<double> apart(m_seen.size()); // from those that are in order already
  for (size_t i = 0; i < m_seen.size(); ++i) {
    apart[i] = 1 + std::abs(m_seen[i].ray);
  }
  const auto merit = [&](size_t i) { return apart[i] / std::sqrt(m_seen[i].lamps); };
  while (order.size() < m_seen.size()) {
    size_t next = noLamp;
    for (size_t i = 0; i < m_seen.size(); ++i) {
      const bool used = std::find(order.begin(), order.end(), i) != order.end();
      if (!used && (next == noLamp || merit(i) > merit(next))) {
        next = i;
      }
    }
    order.push_back(next);
    for (size_t i = 0; i < m_seen.size(); ++i) {
      apart[i] = std::min(apart[i], std::abs(m_seen[i].ray - m_seen[next].ray));
    }
  }
  return order;
}

//! Whether a pose that leaves out all but one of the first \e tried regions is no rival of the best any more.
bool vpPlaceSearch::complete(size_t tried) const
{
  if (m_seen.size() - tried + 1 < m_model.fewest()) {
    return true;
  }
  const auto best = std::max_element(m_places.begin(), m_places.end(), [](const Place &a, const Place &b) {
    return a.logEvidence < b.logEvidence;
  });
  if (best == m_places.end() || tried - 1 + best->count <= m_seen.size()) {
    return false;
  }
  double leastGain = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < m_seen.size(); ++i) {
    const double depth = 0.5 * (m_index.lowest() + m_index.highest()) - best->height;
    leastGain = std::min(
        leastGain,
        m_model.gain(i, square(m_settings.mapTolerance) + square(depth) * m_seen[i].variance, depth));
  }
  static const double volume = 10; // what the prior of the pose and the volume of poses that fit can make up
  const double more = static_cast<double>(tried - 1 + best->count - m_seen.size());
  return more * leastGain > std::log(m_settings.minOdds) + volume;
}

void vpPlaceSearch::lampsInReach(const vpSeenLamp &lamp, const vpSeenLamp::Option &option,
                                 std::vector<size_t> &found) const
{
  if (m_bounds.anywhere) {
    found = m_index.lampsOf(option.identifier);
  } else {
    const double depth = m_index.highest() - m_bounds.height + gate * m_bounds.heightSigma;
    m_index.within(option.identifier, m_bounds.around,
                   m_bounds.reach + slackOfPair + depth * std::abs(lamp.ray), found);
  }
  if (option.only != vpLampIndex::nowhere) {
    const bool inReach = std::find(found.begin(), found.end(), option.only) != found.end();
    found.assign(inReach ? 1 : 0, option.only);
  }
}

void vpPlaceSearch::tryPair(size_t i, size_t j)
{
  const Complex &q = m_seen[i].ray, &other = m_seen[j].ray;
  const double apart = std::abs(other - q);
  if (square(apart) < 4 * (m_seen[i].variance + m_seen[j].variance)) {
    return; // shows no heading
  }
  const double heightRange = gate * m_bounds.heightSigma;
  for (const vpSeenLamp::Option &option : m_seen[i].options) {
    lampsInReach(m_seen[i], option, m_firsts);
    for (size_t first : m_firsts) {
      const vpLampIndex::Lamp &lamp = m_index.lamp(first);
      const double depth = lamp.height - m_bounds.height;
      if (depth + heightRange < leastDepth) {
        continue; // below the camera
      }
      // |P2 - P1| = |H (q2 - q1) + rise q2|
      const double rise = std::max(m_index.highest() - lamp.height, lamp.height - m_index.lowest());
      const double doubt =
          gate * std::sqrt(m_model.variance(i, first, depth) + m_model.variance(j, first, depth));
      const double margin = rise * std::abs(other) + doubt;
      const double inner = (depth - heightRange) * apart - margin;
      const double outer = (depth + heightRange) * apart + margin;
      for (const vpSeenLamp::Option &otherOption : m_seen[j].options) {
        m_index.within(otherOption.identifier, lamp.place, outer, m_seconds);
        for (size_t second : m_seconds) {
          const bool possible = otherOption.only == vpLampIndex::nowhere || otherOption.only == second;
          if (possible && second != first && std::abs(m_index.lamp(second).place - lamp.place) >= inner) {
            hypothesise(i, first, j, second);
          }
        }
      }
    }
  }
}

//! The poses that see two lamps in two regions.
void vpPlaceSearch::hypothesise(size_t i, size_t first, size_t j, size_t second)
{
  if (m_hypotheses >= m_settings.maxHypotheses) {
    return;
  }
  const vpLampIndex::Lamp &a = m_index.lamp(first), &b = m_index.lamp(second);
  const vpLampPair pair(b.place - a.place, b.height - a.height, m_seen[i].ray, m_seen[j].ray);
  bool disagree = false;
  for (double H : pair.heights(disagree)) {
    ++m_hypotheses;
    Place place;
    place.height = a.height - H;
    place.heading = std::polar(1.0, pair.heading(H));
    place.camera = a.place - H * place.heading * m_seen[i].ray;
    if (!m_model.withinBounds(place, slackOfPair)) {
      continue;
    }
    place.lamps.assign(m_seen.size(), noLamp);
    place.lamps[i] = first;
    place.lamps[j] = second;
    place.count = 2;
    settle(place);
  }
}

//! Finds the other lamps of a place, fits it to all of them, and keeps it where it may matter.
void vpPlaceSearch::settle(Place &place)
{
  // Two lamps fewer than another place: e to minus two gains, and never an answer.
  const size_t needed = std::max(m_model.fewest(), m_most - std::min<size_t>(m_most, 1));
  if (!gather(place, needed)) {
    return;
  }
  static const int rounds = 2; // lamps that the pair alone expected too far away, or too near
  for (int round = 0; round < rounds; ++round) {
    if (!m_model.refine(place) || !gather(place, needed)) {
      return;
    }
  }
  if (m_model.refine(place) && m_model.withinBounds(place, 0)) {
    m_most = std::max(m_most, place.count);
    m_model.judge(place);
    keep(place);
  }
}

//! For each region the lamp that fits best, each lamp once. False, and nothing changed, where these are fewer
//! than \e needed.
bool vpPlaceSearch::gather(Place &place, size_t needed) const
{
  const Fit fit = m_model.fitOf(place);
  std::vector<double> distances(m_seen.size());
  std::vector<size_t> lamps(m_seen.size(), noLamp);
  size_t count = 0;
  for (size_t i = 0; i < m_seen.size() && count + (m_seen.size() - i) >= needed; ++i) {
    const double doubt = place.lamps[i] != noLamp ? 0 : m_model.poseVariance(fit, i);
    double best = -std::numeric_limits<double>::infinity();
    for (const vpSeenLamp::Option &option : m_seen[i].options) {
      m_model.lampsNear(place, i, option, doubt, m_near);
      for (size_t lamp : m_near) {
        const double d = m_model.distance(place, i, lamp, doubt);
        if (option.weight - 0.5 * d > best) {
          best = option.weight - 0.5 * d;
          lamps[i] = lamp;
          distances[i] = d;
        }
      }
    }
    // Of a lamp and its reflection the one that is nearer to where the lamp hangs.
    const auto rival = std::find(lamps.begin(), lamps.begin() + static_cast<long>(i), lamps[i]);
    const size_t other = static_cast<size_t>(rival - lamps.begin());
    if (lamps[i] != noLamp && other < i) {
      lamps[distances[i] < distances[other] ? other : i] = noLamp;
    } else if (lamps[i] != noLamp) {
      ++count;
    }
  }
  if (count < needed) {
    return false;
  }
  place.lamps = lamps;
  place.count = count;
  return true;
}

void vpPlaceSearch::keep(const Place &place)
{
  double best = place.logEvidence;
  for (Place &known : m_places) {
    best = std::max(best, known.logEvidence);
    size_t shared = 0;
    for (size_t i = 0; i < m_seen.size(); ++i) {
      shared += place.lamps[i] != noLamp && place.lamps[i] == known.lamps[i];
    }
    static const double near = 0.5; // m: two lamps that fit alike fix the pose far better
    if (shared >= 2 && std::abs(known.camera - place.camera) < near) {
      if (place.logEvidence > known.logEvidence) {
        known = place;
      }
      return;
    }
  }
  if (place.logEvidence < best - negligible) {
    return;
  }
  m_places.erase(std::remove_if(m_places.begin(), m_places.end(),
                                [&](const Place &known) { return known.logEvidence < best - negligible; }),
                 m_places.end());
  m_places.push_back(place);
}

//! Whether another region may be the lamp of region \e i nearly as well, or that region another lamp.
bool vpPlaceSearch::mistakable(const Place &place, const Fit &fit, size_t i) const
{
  const double limit = m_model.distance(place, i, place.lamps[i], 0) + 2 * std::log(m_settings.minOdds);
  for (size_t j = 0; j < m_seen.size(); ++j) {
    if (j != i && place.lamps[j] != noLamp) {
      continue;
    }
    const double doubt = m_model.poseVariance(fit, j);
    for (const vpSeenLamp::Option &option : m_seen[j].options) {
      m_model.lampsNear(place, j, option, doubt, m_near);
      for (size_t lamp : m_near) {
        const bool used = std::find(place.lamps.begin(), place.lamps.end(), lamp) != place.lamps.end();
        if ((j == i ? !used : lamp == place.lamps[i]) && m_model.distance(place, j, lamp, doubt) < limit) {
          return true;
        }
      }
    }
  }
  return false;
}

double vpPlaceSearch::odds(const Place &place) const
{
  double against = std::exp(m_model.chance() - place.logEvidence);
  for (const Place &other : m_places) {
    against += &other == &place ? 0 : std::exp(other.logEvidence - place.logEvidence);
  }
  return 1 / against;
}

bool vpPlaceSearch::decided() const
{
  return m_allowed && !m_places.empty() && odds(m_places[0]) >= m_settings.minOdds &&
         !m_model.tooFewOnALine(m_places[0]);
}

vpPlaceSearch::Place vpPlaceSearch::withoutUndecided(const Place &place) const
{
  const Fit fit = m_model.fitOf(place);
  Place decided = place;
  for (size_t i = 0; i < m_seen.size(); ++i) {
    if (place.lamps[i] != noLamp && mistakable(place, fit, i)) {
      decided.lamps[i] = noLamp;
      --decided.count;
    }
  }
  return decided;
}

END_VISP_NAMESPACE
