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
const double gate = 4;          // standard deviations, beyond which a lamp is not where the pose expects it
const double leastDepth = 0.05; // m from the camera up to a lamp
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
    : m_settings(settings), m_index(index), m_seen(seen), m_area(pictureArea), m_bounds(bounds)
{
}

size_t vpPlaceSearch::fewest() const
{
  return std::max<size_t>(
      2, static_cast<size_t>(std::ceil(m_settings.minShare * static_cast<double>(m_seen.size()))));
}

bool vpPlaceSearch::run()
{
  const std::vector<size_t> order = ordered();
  bool allowed = true;
  // A pose that all pairs of the first k + 1 regions miss has one of them at most.
  for (size_t k = 1; k < order.size() && allowed && !complete(k); ++k) {
    for (size_t i = 0; i < k && allowed; ++i) {
      tryPair(order[i], order[k]);
      allowed = m_hypotheses < m_settings.maxHypotheses && m_places.size() < maxPlaces;
    }
  }
  std::stable_sort(m_places.begin(), m_places.end(),
                   [](const Place &a, const Place &b) { return a.logEvidence > b.logEvidence; });
  return allowed;
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
  if (m_seen.size() - tried + 1 < fewest()) {
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
        leastGain, gain(i, square(m_settings.mapTolerance) + square(depth) * m_seen[i].variance, depth));
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
      const double doubt = gate * std::sqrt(variance(i, first, depth) + variance(j, first, depth));
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
    if (!withinBounds(place, slackOfPair)) {
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
  const size_t needed = std::max(fewest(), m_most - std::min<size_t>(m_most, 1));
  if (!gather(place, needed)) {
    return;
  }
  static const int rounds = 2; // lamps that the pair alone expected too far away, or too near
  for (int round = 0; round < rounds; ++round) {
    if (!refine(place) || !gather(place, needed)) {
      return;
    }
  }
  if (refine(place) && withinBounds(place, 0)) {
    m_most = std::max(m_most, place.count);
    judge(place);
    keep(place);
  }
}

bool vpPlaceSearch::withinBounds(const Place &place, double slack) const
{
  if (std::abs(place.height - m_bounds.height) > gate * m_bounds.heightSigma + slack) {
    return false;
  }
  return m_bounds.anywhere ||
         (std::abs(place.camera - m_bounds.around) <= m_bounds.reach + slack &&
          std::abs(std::arg(place.heading * std::polar(1.0, -m_bounds.heading))) <= m_bounds.turn + slack);
}

//! Where the ray of region \e i meets the height of a lamp, m.
vpPlaceSearch::Complex vpPlaceSearch::expected(const Place &place, size_t i, double lampHeight) const
{
  return place.camera + (lampHeight - place.height) * place.heading * m_seen[i].ray;
}

//! Of the distance between a lamp and the point that the ray of region \e i leads to, in each direction, m^2.
double vpPlaceSearch::variance(size_t i, size_t lamp, double depth) const
{
  return square(std::max(m_index.lamp(lamp).positionSigma, m_settings.mapTolerance)) +
         square(depth) * m_seen[i].variance;
}

//! Squared, in standard deviations. \param poseVariance of the point that the ray leads to, m^2.
double vpPlaceSearch::distance(const Place &place, size_t i, size_t lamp, double poseVariance) const
{
  const double height = m_index.lamp(lamp).height;
  return std::norm(m_index.lamp(lamp).place - expected(place, i, height)) /
         (variance(i, lamp, height - place.height) + poseVariance);
}

vpPlaceSearch::Fit vpPlaceSearch::fitOf(const Place &place) const
{
  Fit fit;
  for (size_t i = 0; i < m_seen.size(); ++i) {
    if (place.lamps[i] != noLamp) {
      const double height = m_index.lamp(place.lamps[i]).height;
      const double w = 1 / variance(i, place.lamps[i], height - place.height);
      fit.weight += w;
      fit.middle += w * m_seen[i].ray;
      fit.spread += w * std::norm(m_seen[i].ray);
      fit.lampHeight += w * height;
    }
  }
  fit.middle /= fit.weight;
  fit.lampHeight /= fit.weight;
  fit.spread -= fit.weight * std::norm(fit.middle);
  return fit;
}

double vpPlaceSearch::poseVariance(const Fit &fit, size_t i) const
{
  return 1 / fit.weight + std::norm(m_seen[i].ray - fit.middle) / fit.spread;
}

//! Sets m_near to the lamps that region \e i may be and that hang where its ray leads.
void vpPlaceSearch::lampsNear(const Place &place, size_t i, const vpSeenLamp::Option &option,
                              double poseVariance) const
{
  const double middle = 0.5 * (m_index.lowest() + m_index.highest());
  const double halfRange = 0.5 * (m_index.highest() - m_index.lowest());
  const double sigma =
      std::sqrt(square(std::max(m_settings.mapTolerance, m_index.greatestSigma())) +
                square(m_index.highest() - place.height) * m_seen[i].variance + poseVariance);
  m_index.within(option.identifier, expected(place, i, middle),
                 gate * sigma + halfRange * std::abs(m_seen[i].ray), m_near);
  const auto outside = [&](size_t lamp) {
    return (option.only != vpLampIndex::nowhere && option.only != lamp) ||
           distance(place, i, lamp, poseVariance) > square(gate);
  };
  m_near.erase(std::remove_if(m_near.begin(), m_near.end(), outside), m_near.end());
}

//! For each region the lamp that fits best, each lamp once. False, and nothing changed, where these are fewer
//! than \e needed.
bool vpPlaceSearch::gather(Place &place, size_t needed) const
{
  const Fit fit = fitOf(place);
  std::vector<double> distances(m_seen.size());
  std::vector<size_t> lamps(m_seen.size(), noLamp);
  size_t count = 0;
  for (size_t i = 0; i < m_seen.size() && count + (m_seen.size() - i) >= needed; ++i) {
    const double doubt = place.lamps[i] != noLamp ? 0 : poseVariance(fit, i);
    double best = -std::numeric_limits<double>::infinity();
    for (const vpSeenLamp::Option &option : m_seen[i].options) {
      lampsNear(place, i, option, doubt);
      for (size_t lamp : m_near) {
        const double d = distance(place, i, lamp, doubt);
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

/*!
  Weighted least squares of the camera's place C and of w = heading * height over P_k = C + w q_k, lamps at
  other heights than the mean moved there along their rays; |w| weighed against the height that is expected.
*/
bool vpPlaceSearch::refine(Place &place) const
{
  if (place.count < 2) {
    return false;
  }
  const Fit fit = fitOf(place);
  if (!(fit.spread > 0)) {
    return false;
  }
  Complex mean, slope;
  for (size_t i = 0; i < m_seen.size(); ++i) {
    if (place.lamps[i] != noLamp) {
      const vpLampIndex::Lamp &lamp = m_index.lamp(place.lamps[i]);
      const double w = 1 / variance(i, place.lamps[i], lamp.height - place.height);
      const Complex level = lamp.place - place.heading * (lamp.height - fit.lampHeight) * m_seen[i].ray;
      mean += w * level;
      slope += w * level * std::conj(m_seen[i].ray - fit.middle);
    }
  }
  slope /= fit.spread;
  if (!(std::abs(slope) > leastDepth)) {
    return false;
  }
  const double prior = 1 / square(m_bounds.heightSigma);
  const double depth =
      (fit.spread * std::abs(slope) + prior * (fit.lampHeight - m_bounds.height)) / (fit.spread + prior);
  place.heading = slope / std::abs(slope);
  place.height = fit.lampHeight - depth;
  place.camera = mean / fit.weight - place.heading * depth * fit.middle;
  return depth > leastDepth;
}

/*!
  Lamps on one line look the same in a mirror: seen in a glass wall, they would put the robot behind it. So
  they are no place where more than a quarter of the regions stays unexplained.
*/
bool vpPlaceSearch::tooFewOnALine(const Place &place) const
{
  if (4 * place.count >= 3 * m_seen.size()) {
    return false;
  }
  const Fit fit = fitOf(place);
  Complex slant; // the spread is the sum of the squared deviations along and across the line, this their
                 // difference
  for (size_t i = 0; i < m_seen.size(); ++i) {
    if (place.lamps[i] != noLamp) {
      const double depth = m_index.lamp(place.lamps[i]).height - place.height;
      const Complex off = m_seen[i].ray - fit.middle;
      slant += off * off / variance(i, place.lamps[i], depth);
    }
  }
  const double across = 0.5 * (fit.spread - std::abs(slant)) * square(fit.lampHeight - place.height);
  return across < square(gate) * static_cast<double>(place.count);
}

//! What a lamp adds to the log evidence where its residual is 0.
double vpPlaceSearch::gain(size_t i, double variance, double depth) const
{
  double weight = -std::numeric_limits<double>::infinity();
  for (const vpSeenLamp::Option &option : m_seen[i].options) {
    weight = std::max(weight, option.weight);
  }
  return weight + std::log(m_area / m_settings.strangers) + std::log(square(depth) / (2 * M_PI * variance));
}

void vpPlaceSearch::judge(Place &place) const
{
  const Fit fit = fitOf(place);
  double sum = 0;
  for (size_t i = 0; i < m_seen.size(); ++i) {
    const size_t lamp = place.lamps[i];
    if (lamp != noLamp) {
      const double depth = m_index.lamp(lamp).height - place.height;
      double weight = -std::numeric_limits<double>::infinity();
      for (const vpSeenLamp::Option &option : m_seen[i].options) {
        if (option.identifier == m_index.lamp(lamp).identifier) {
          weight = std::max(weight, option.weight);
        }
      }
      sum += weight + std::log(m_area / m_settings.strangers) - 0.5 * distance(place, i, lamp, 0) +
             std::log(square(depth) / (2 * M_PI * variance(i, lamp, depth)));
    }
  }
  const double depth = fit.lampHeight - place.height;
  const double sigma = m_bounds.heightSigma;
  const double room = m_bounds.anywhere ? m_index.area(depth) : M_PI * square(m_bounds.reach);
  // Density over C and w: that of place, heading and height, and d^2w = |w| dheight dheading.
  const double prior = -std::log(room * 2 * m_bounds.turn * depth * std::sqrt(2 * M_PI) * sigma) -
                       0.5 * square((place.height - m_bounds.height) / sigma);
  const double volume = 2 * std::log(2 * M_PI) - std::log(fit.weight) -
                        0.5 * std::log(fit.spread * (fit.spread + 1 / square(sigma)));
  place.logEvidence = sum + prior + volume;
}

double vpPlaceSearch::chance() const
{
  const double depth = std::max(leastDepth, 0.5 * (m_index.lowest() + m_index.highest()) - m_bounds.height);
  const double inView = static_cast<double>(m_index.size()) * square(depth) * m_area / m_index.area(depth);
  return std::log(1 + static_cast<double>(m_seen.size()) * inView / m_settings.strangers);
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
  const double limit = distance(place, i, place.lamps[i], 0) + 2 * std::log(m_settings.minOdds);
  for (size_t j = 0; j < m_seen.size(); ++j) {
    if (j != i && place.lamps[j] != noLamp) {
      continue;
    }
    const double doubt = poseVariance(fit, j);
    for (const vpSeenLamp::Option &option : m_seen[j].options) {
      lampsNear(place, j, option, doubt);
      for (size_t lamp : m_near) {
        const bool used = std::find(place.lamps.begin(), place.lamps.end(), lamp) != place.lamps.end();
        if ((j == i ? !used : lamp == place.lamps[i]) && distance(place, j, lamp, doubt) < limit) {
          return true;
        }
      }
    }
  }
  return false;
}

void vpPlaceSearch::dropUndecided(Place &place) const
{
  const Fit fit = fitOf(place);
  std::vector<size_t> decided = place.lamps;
  for (size_t i = 0; i < m_seen.size(); ++i) {
    if (place.lamps[i] != noLamp && mistakable(place, fit, i)) {
      decided[i] = noLamp;
      --place.count;
    }
  }
  place.lamps = decided;
}

END_VISP_NAMESPACE
