/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPlaceSearch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/LU>
#include <visp3/core/vpMath.h>

#include "vpLampGeometry.h"

BEGIN_VISP_NAMESPACE

namespace
{
const double gate = 4; // standard deviations, beyond which a lamp is not where it is expected
const size_t noLamp = vpLampMatch::noLamp;

bool has(const std::vector<size_t> &all, size_t one)
{
  return std::find(all.begin(), all.end(), one) != all.end();
}
} // namespace

const vpSeenLamp::Option *vpSeenLamp::option(const vpLampIndex::Lamp &lamp) const
{
  const auto found = std::find_if(options.begin(), options.end(),
                                  [&](const Option &option) { return option.identifier == lamp.identifier; });
  return found == options.end() ? nullptr : &*found;
}

bool vpPlaceSearch::Bounds::near(const Place &place) const
{
  return std::abs(place.camera - around) <= reach &&
         std::abs(std::arg(place.heading * std::polar(1.0, -heading))) <= turn;
}

vpPlaceSearch::vpPlaceSearch(const vpLampMatcher &settings, const vpLampIndex &index,
                             const std::vector<vpSeenLamp> &seen, double pictureArea, const Bounds &bounds)
    : m_settings(settings), m_index(index), m_seen(seen), m_area(pictureArea), m_bounds(bounds)
{
  std::vector<size_t> order(seen.size()); // regions that few lamps of the map can be come first
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t i, size_t j) { return seen[i].lamps < seen[j].lamps; });
  // A place that all pairs of the first k regions miss has one of them at most.
  for (size_t k = 1; k < order.size() && m_complete && order.size() + 1 >= k + needed(); ++k) {
    for (size_t i = 0; i < k && m_complete; ++i) {
      tryPair(order[i], order[k]);
      m_complete = m_hypotheses < m_settings.maxHypotheses && 10 * m_places.size() < m_settings.maxHypotheses;
    }
  }
  std::stable_sort(m_places.begin(), m_places.end(),
                   [](const Place &a, const Place &b) { return a.logEvidence > b.logEvidence; });
}

//! Regions that a place has to explain: two fewer than another one does are never an answer.
size_t vpPlaceSearch::needed() const
{
  const double share = std::ceil(m_settings.minShare * static_cast<double>(m_seen.size()));
  return std::max({size_t(2), static_cast<size_t>(share), m_most - std::min<size_t>(m_most, 1)});
}

void vpPlaceSearch::within(const vpSeenLamp::Option &option, const Complex &place, double radius,
                           std::vector<size_t> &found) const
{
  m_index.within(option.identifier, place, radius, found);
  if (option.only != vpLampIndex::nowhere) {
    found.assign(has(found, option.only) ? 1 : 0, option.only);
  }
}

void vpPlaceSearch::tryPair(size_t i, size_t j)
{
  const Complex &q = m_seen[i].ray, &other = m_seen[j].ray;
  const double apart = std::abs(other - q);
  if (vpMath::sqr(apart) < vpMath::sqr(gate) / 4 * (m_seen[i].variance + m_seen[j].variance)) {
    return; // shows no heading
  }
  const double heightRange = gate * m_bounds.heightSigma;
  const double greatestDepth = m_index.highest() - m_bounds.height + heightRange;
  const double reach = m_bounds.anywhere
                           ? std::numeric_limits<double>::infinity()
                           : m_bounds.reach + greatestDepth * std::abs(q) +
                                 gate * std::sqrt(variance(i, m_index.greatestSigma(), greatestDepth));
  for (const vpSeenLamp::Option &option : m_seen[i].options) {
    within(option, m_bounds.around, reach, m_firsts);
    for (size_t first : m_firsts) {
      const vpLampIndex::Lamp &lamp = m_index.lamp(first);
      const double depth = lamp.height - m_bounds.height;
      if (!(depth + heightRange > 0)) {
        continue; // below the camera
      }
      // |P2 - P1| = |H (q2 - q1) + rise q2|
      const double rise = std::max(m_index.highest() - lamp.height, lamp.height - m_index.lowest());
      const double sigma =
          std::sqrt(variance(i, lamp.positionSigma, depth) + variance(j, m_index.greatestSigma(), depth));
      const double margin = rise * std::abs(other) + gate * sigma;
      const double inner = (depth - heightRange) * apart - margin;
      const double outer = (depth + heightRange) * apart + margin;
      for (const vpSeenLamp::Option &otherOption : m_seen[j].options) {
        within(otherOption, lamp.place, outer, m_seconds);
        for (size_t second : m_seconds) {
          if (second != first && std::abs(m_index.lamp(second).place - lamp.place) >= inner) {
            hypothesise(i, first, j, second);
          }
        }
      }
    }
  }
}

//! The places that see two lamps in two regions.
void vpPlaceSearch::hypothesise(size_t i, size_t first, size_t j, size_t second)
{
  const vpLampIndex::Lamp &a = m_index.lamp(first), &b = m_index.lamp(second);
  const vpLampPair pair{b.place - a.place, b.height - a.height, {m_seen[i].ray, m_seen[j].ray}};
  bool disagree = false;
  for (double H : pair.heights(disagree)) {
    if (m_hypotheses >= m_settings.maxHypotheses) {
      return;
    }
    ++m_hypotheses;
    Place place;
    place.height = a.height - H;
    place.heading = std::polar(1.0, pair.heading(H));
    place.camera = a.place - H * place.heading * m_seen[i].ray;
    place.lamps.assign(m_seen.size(), noLamp);
    place.lamps[i] = first;
    place.lamps[j] = second;
    settle(place);
  }
}

//! Finds the other lamps of a place, fits it to all of them, and keeps it where it may matter.
void vpPlaceSearch::settle(Place &place)
{
  static const int rounds = 3; // the pair alone may expect lamps too far away, or too near
  fit(place);
  for (int round = 0; round < rounds; ++round) {
    if (!gather(place)) {
      return;
    }
    fit(place);
  }
  if (std::abs(place.height - m_bounds.height) <= gate * m_bounds.heightSigma &&
      (m_bounds.anywhere || m_bounds.near(place))) {
    m_most = std::max(m_most, place.count);
    place.logEvidence = logEvidence(place);
    keep(place);
  }
}

//! For each region the lamp that fits best, each lamp once. False, and nothing changed, where these are fewer
//! than needed.
bool vpPlaceSearch::gather(Place &place) const
{
  std::vector<double> distances(m_seen.size());
  std::vector<size_t> lamps(m_seen.size(), noLamp);
  size_t count = 0;
  for (size_t i = 0; i < m_seen.size() && count + m_seen.size() - i >= needed(); ++i) {
    double best = -std::numeric_limits<double>::infinity();
    visitLamps(place, i, place.lamps[i] != noLamp ? 0 : poseVariance(place, i),
               [&](size_t lamp, const vpSeenLamp::Option &option, double d) {
                 if (option.weight - 0.5 * d > best) {
                   best = option.weight - 0.5 * d;
                   lamps[i] = lamp;
                   distances[i] = d;
                 }
               });
    if (lamps[i] == noLamp) {
      continue;
    }
    // Of a lamp and its reflection the one that is nearer to where the lamp hangs.
    const size_t rival = static_cast<size_t>(std::find(lamps.begin(), lamps.end(), lamps[i]) - lamps.begin());
    if (rival < i) {
      lamps[distances[i] < distances[rival] ? rival : i] = noLamp;
    } else {
      ++count;
    }
  }
  if (count < needed()) {
    return false;
  }
  place.lamps = lamps;
  place.count = count;
  return true;
}

//! Two places that share two lamps and are near each other are one.
void vpPlaceSearch::keep(const Place &place)
{
  static const double near = 0.5; // m: two lamps that fit alike fix the pose far better
  double best = place.logEvidence;
  for (Place &known : m_places) {
    best = std::max(best, known.logEvidence);
    size_t shared = 0;
    for (size_t i = 0; i < m_seen.size(); ++i) {
      shared += place.lamps[i] != noLamp && place.lamps[i] == known.lamps[i];
    }
    if (shared >= 2 && std::abs(known.camera - place.camera) < near) {
      if (place.logEvidence > known.logEvidence) {
        known = place;
      }
      return;
    }
  }
  // All hypotheses as unlikely as this could not dispute the best.
  const double negligible =
      best - std::log(m_settings.minOdds * static_cast<double>(m_settings.maxHypotheses));
  m_places.push_back(place);
  m_places.erase(std::remove_if(m_places.begin(), m_places.end(),
                                [&](const Place &known) { return known.logEvidence < negligible; }),
                 m_places.end());
}

double vpPlaceSearch::odds(const Place &place) const
{
  double against = std::exp(chance() - place.logEvidence);
  for (const Place &other : m_places) {
    against += &other == &place ? 0 : std::exp(other.logEvidence - place.logEvidence);
  }
  return 1 / against;
}

bool vpPlaceSearch::decided() const
{
  return m_complete && !m_places.empty() && odds(m_places[0]) >= m_settings.minOdds &&
         !tooFewOnALine(m_places[0]);
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
  // Weighted moments of the points: the sums of squared deviations along and across the line are half the sum
  // and half the difference of |d|^2 and |d^2|.
  double weight = 0, norms = 0;
  Complex sum, squares;
  for (size_t i = 0; i < m_seen.size(); ++i) {
    if (place.lamps[i] != noLamp) {
      const vpLampIndex::Lamp &lamp = m_index.lamp(place.lamps[i]);
      const double w = 1 / variance(i, lamp.positionSigma, lamp.height - place.height);
      const Complex off = expected(place, i, lamp.height) - place.camera;
      weight += w;
      sum += w * off;
      norms += w * std::norm(off);
      squares += w * off * off;
    }
  }
  const double across = 0.5 * (norms - std::norm(sum) / weight - std::abs(squares - sum * sum / weight));
  return across < vpMath::sqr(gate) * static_cast<double>(place.count);
}

//! Whether another region may be the lamp of region \e i nearly as well, or that region another lamp.
bool vpPlaceSearch::mistakable(const Place &place, size_t i) const
{
  const double limit = distance(place, i, place.lamps[i], 0) + 2 * std::log(m_settings.minOdds);
  bool found = false;
  for (size_t j = 0; j < m_seen.size(); ++j) {
    if (j == i || place.lamps[j] == noLamp) {
      visitLamps(place, j, poseVariance(place, j), [&](size_t lamp, const vpSeenLamp::Option &, double d) {
        found |= d < limit && (j == i ? !has(place.lamps, lamp) : lamp == place.lamps[i]);
      });
    }
  }
  return found;
}

vpPlaceSearch::Place vpPlaceSearch::withoutUndecided(const Place &place) const
{
  Place decided = place;
  for (size_t i = 0; i < m_seen.size(); ++i) {
    if (place.lamps[i] != noLamp && mistakable(place, i)) {
      decided.lamps[i] = noLamp;
      --decided.count;
    }
  }
  return decided;
}

//! Calls visit(lamp, option, distance) with each lamp that region \e i may be and that hangs where its ray
//! leads. \param poseVariance Of the point that the ray leads to, m^2.
template <class Visit>
void vpPlaceSearch::visitLamps(const Place &place, size_t i, double poseVariance, const Visit &visit) const
{
  const double middle = 0.5 * (m_index.lowest() + m_index.highest());
  const double radius =
      gate *
          std::sqrt(variance(i, m_index.greatestSigma(), m_index.highest() - place.height) + poseVariance) +
      (m_index.highest() - middle) * std::abs(m_seen[i].ray);
  for (const vpSeenLamp::Option &option : m_seen[i].options) {
    within(option, expected(place, i, middle), radius, m_near);
    for (size_t lamp : m_near) {
      const double d = distance(place, i, lamp, poseVariance);
      if (d <= vpMath::sqr(gate)) {
        visit(lamp, option, d);
      }
    }
  }
}

//! Where the ray of region \e i meets the height of a lamp, m.
vpPlaceSearch::Complex vpPlaceSearch::expected(const Place &place, size_t i, double lampHeight) const
{
  return place.camera + (lampHeight - place.height) * place.heading * m_seen[i].ray;
}

//! Of the distance between a lamp and the point that the ray of region \e i leads to, in each direction, m^2.
double vpPlaceSearch::variance(size_t i, double positionSigma, double depth) const
{
  return vpMath::sqr(std::max(positionSigma, m_settings.mapTolerance)) +
         vpMath::sqr(depth) * m_seen[i].variance;
}

//! Squared, in standard deviations.
double vpPlaceSearch::distance(const Place &place, size_t i, size_t lamp, double poseVariance) const
{
  const vpLampIndex::Lamp &known = m_index.lamp(lamp);
  return std::norm(known.place - expected(place, i, known.height)) /
         (variance(i, known.positionSigma, known.height - place.height) + poseVariance);
}

//! Derivative of expected() by x, y, z and yaw.
Eigen::Matrix<double, 2, 4> vpPlaceSearch::byPose(const Place &place, size_t i, double lampHeight) const
{
  const Complex ray = place.heading * m_seen[i].ray, arm = (lampHeight - place.height) * ray;
  Eigen::Matrix<double, 2, 4> J;
  J << 1, 0, -ray.real(), -arm.imag(), 0, 1, -ray.imag(), arm.real();
  return J;
}

//! A step of Gauss-Newton in x, y and z of the camera and its yaw.
void vpPlaceSearch::fit(Place &place) const
{
  const double prior = 1 / vpMath::sqr(m_bounds.heightSigma);
  Eigen::Matrix4d information = Eigen::Vector4d(0, 0, prior, 0).asDiagonal();
  Eigen::Vector4d gradient(0, 0, prior * (m_bounds.height - place.height), 0);
  for (size_t i = 0; i < m_seen.size(); ++i) {
    if (place.lamps[i] != noLamp) {
      const vpLampIndex::Lamp &lamp = m_index.lamp(place.lamps[i]);
      const Complex off = lamp.place - expected(place, i, lamp.height);
      const Eigen::Matrix<double, 2, 4> J = byPose(place, i, lamp.height);
      const Eigen::Matrix<double, 2, 4> weighted =
          J / variance(i, lamp.positionSigma, lamp.height - place.height);
      information += weighted.transpose() * J;
      gradient += weighted.transpose() * Eigen::Vector2d(off.real(), off.imag());
    }
  }
  place.covariance = information.inverse();
  const Eigen::Vector4d step = place.covariance * gradient;
  place.camera += Complex(step.x(), step.y());
  place.height += step.z();
  place.heading *= std::polar(1.0, step.w());
}

//! Of the point that the ray of region \e i leads to, in each direction, m^2.
double vpPlaceSearch::poseVariance(const Place &place, size_t i) const
{
  const Eigen::Matrix<double, 2, 4> J = byPose(place, i, 0.5 * (m_index.lowest() + m_index.highest()));
  return 0.5 * (J * place.covariance * J.transpose()).trace();
}

double vpPlaceSearch::logEvidence(const Place &place) const
{
  double sum = 0;
  for (size_t i = 0; i < m_seen.size(); ++i) {
    if (place.lamps[i] != noLamp) {
      const vpLampIndex::Lamp &lamp = m_index.lamp(place.lamps[i]);
      const double depth = lamp.height - place.height;
      sum += m_seen[i].option(lamp)->weight + std::log(m_area / m_settings.strangers) -
             0.5 * distance(place, i, place.lamps[i], 0) +
             std::log(vpMath::sqr(depth) / (2 * M_PI * variance(i, lamp.positionSigma, depth)));
    }
  }
  const double sigma = m_bounds.heightSigma;
  const double room =
      m_bounds.anywhere ? m_index.area(m_index.highest() - place.height) : M_PI * vpMath::sqr(m_bounds.reach);
  const double prior = -std::log(room * 2 * m_bounds.turn * std::sqrt(2 * M_PI) * sigma) -
                       0.5 * vpMath::sqr((place.height - m_bounds.height) / sigma);
  const double volume = 2 * std::log(2 * M_PI) + 0.5 * std::log(place.covariance.determinant());
  return sum + prior + volume;
}

//! Log of the evidence that one region shows a lamp of the map, seen from anywhere, and all others strangers:
//! what a place that rests on chance has to be held against.
double vpPlaceSearch::chance() const
{
  const double depth = std::max(0.0, 0.5 * (m_index.lowest() + m_index.highest()) - m_bounds.height);
  const double inView =
      static_cast<double>(m_index.size()) * vpMath::sqr(depth) * m_area / m_index.area(depth);
  return std::log(1 + static_cast<double>(m_seen.size()) * inView / m_settings.strangers);
}

END_VISP_NAMESPACE
