/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_localization/vpIdentifierLayout.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "vpTripleTable.h"

BEGIN_VISP_NAMESPACE

namespace
{
void expect(bool right, const std::string &name, double came, const std::string &expected)
{
  if (!right) {
    throw vpException(vpException::badValue, "vpIdentifierLayout: %s is %s, expected %s", name.c_str(),
                      vpNumberText(came).c_str(), expected.c_str());
  }
}

float square(float x)
{
  return x * x;
}

//! Radius of the smallest circle that holds all three, m.
double enclosingRadius(const Eigen::Vector2d &a, const Eigen::Vector2d &b, const Eigen::Vector2d &c)
{
  std::array<double, 3> squared = {(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()};
  std::sort(squared.begin(), squared.end());
  if (squared[2] >= squared[0] + squared[1]) { // right or obtuse: the longest side is the diameter
    return std::sqrt(squared[2]) / 2;
  }
  const Eigen::Vector2d ab = b - a, ac = c - a;
  const double area = std::abs(ab.x() * ac.y() - ab.y() * ac.x()); // twice the triangle's
  return std::sqrt(squared[0] * squared[1] * squared[2]) / (2 * area);
}

//! The work of one lay().
class Layer
{
public:
  Layer(const vpIdentifierLayout &settings, const std::vector<Eigen::Vector3d> &positions,
        size_t identifiers);

  vpIdentifierAssignment lay();

private:
  struct Near {
    uint32_t lamp;
    float distance; // m
  };
  static constexpr uint32_t none = static_cast<uint32_t>(-1);

  void findNeighbours();
  void findTriples();
  std::vector<uint32_t> choicesFor(uint32_t lamp);
  double cost(uint32_t lamp, uint32_t identifier, double limit) const;
  double costInView(uint32_t lamp, uint32_t identifier) const;
  bool choose(uint32_t lamp);
  vpTripleTable::Look lookOf(const vpLampTriple &triple, uint32_t lamp, uint32_t identifier) const;
  bool laid(const vpLampTriple &triple) const;
  vpIdentifierAssignment report() const;

  const vpIdentifierLayout &m_settings;
  const uint32_t m_identifiers;
  std::vector<Eigen::Vector2d> m_places;
  std::vector<uint32_t> m_order;           // by x
  std::vector<std::vector<Near>> m_inView; // of each lamp, the nearest first
  std::vector<vpLampTriple> m_triples;
  std::vector<float> m_weights; // of each: the closer the three, the more views hold them and no others
  std::vector<std::vector<uint32_t>> m_triplesOf; // each lamp, indices
  std::vector<uint32_t> m_given;                  // identifier of each lamp
  vpTripleTable m_table;
  std::mt19937 m_random;
};

Layer::Layer(const vpIdentifierLayout &settings, const std::vector<Eigen::Vector3d> &positions,
             size_t identifiers)
    : m_settings(settings), m_identifiers(static_cast<uint32_t>(identifiers)), m_order(positions.size()),
      m_inView(positions.size()), m_triplesOf(positions.size()), m_given(positions.size(), none),
      m_table(m_places, settings.tolerance), m_random(settings.seed)
{
  for (const Eigen::Vector3d &position : positions) {
    m_places.push_back(position.head<2>());
  }
  std::iota(m_order.begin(), m_order.end(), 0);
  std::stable_sort(m_order.begin(), m_order.end(),
                   [&](uint32_t a, uint32_t b) { return m_places[a].x() < m_places[b].x(); });
  findNeighbours();
  findTriples();
}

//! Lamps that one view can hold together with each lamp: no farther than its diameter.
void Layer::findNeighbours()
{
  const double diameter = 2 * m_settings.viewRadius;
  for (size_t i = 0; i < m_order.size(); ++i) {
    const uint32_t lamp = m_order[i];
    for (size_t j = i + 1; j < m_order.size(); ++j) {
      const uint32_t other = m_order[j];
      if (m_places[other].x() - m_places[lamp].x() > diameter) {
        break;
      }
      const float distance = static_cast<float>((m_places[other] - m_places[lamp]).norm());
      if (distance <= diameter) {
        m_inView[lamp].push_back({other, distance});
        m_inView[other].push_back({lamp, distance});
      }
    }
  }
  for (std::vector<Near> &near : m_inView) {
    std::stable_sort(near.begin(), near.end(),
                     [](const Near &a, const Near &b) { return a.distance < b.distance; });
  }
}

void Layer::findTriples()
{
  std::vector<std::vector<uint32_t>> close(m_places.size()); // of which each has the other next to it
  for (uint32_t lamp = 0; lamp < m_places.size(); ++lamp) {
    const size_t count = std::min<size_t>(m_settings.neighbours, m_inView[lamp].size());
    for (size_t k = 0; k < count; ++k) {
      close[lamp].push_back(m_inView[lamp][k].lamp);
      close[m_inView[lamp][k].lamp].push_back(lamp);
    }
  }
  for (std::vector<uint32_t> &lamps : close) {
    std::sort(lamps.begin(), lamps.end());
    lamps.erase(std::unique(lamps.begin(), lamps.end()), lamps.end());
  }
  for (uint32_t a = 0; a < m_places.size(); ++a) {
    for (auto b = std::upper_bound(close[a].begin(), close[a].end(), a); b != close[a].end(); ++b) {
      for (auto c = b + 1; c != close[a].end(); ++c) {
        const double radius = enclosingRadius(m_places[a], m_places[*b], m_places[*c]);
        if (radius > m_settings.viewRadius || !std::binary_search(close[*b].begin(), close[*b].end(), *c)) {
          continue;
        }
        for (uint32_t lamp : {a, *b, *c}) {
          m_triplesOf[lamp].push_back(static_cast<uint32_t>(m_triples.size()));
        }
        m_triples.push_back({a, *b, *c});
        static const float least = 0.02F;
        m_weights.push_back(least + square(1 - static_cast<float>(radius / m_settings.viewRadius)));
      }
    }
  }
}

//! Lamps in view that have the identifier already; the nearer, the worse.
double Layer::costInView(uint32_t lamp, uint32_t identifier) const
{
  static const double perLamp = 100; // sets of three that look alike: two lamps that no picture tells apart
  double cost = 0;
  for (const Near &near : m_inView[lamp]) {
    if (m_given[near.lamp] == identifier) {
      cost += perLamp * (2 - near.distance / (2 * m_settings.viewRadius));
    }
  }
  return cost;
}

//! Whether all three have an identifier.
bool Layer::laid(const vpLampTriple &triple) const
{
  return std::all_of(triple.begin(), triple.end(), [&](uint32_t lamp) { return m_given[lamp] != none; });
}

//! How \e triple looks with that identifier on \e lamp.
vpTripleTable::Look Layer::lookOf(const vpLampTriple &triple, uint32_t lamp, uint32_t identifier) const
{
  std::array<uint32_t, 3> given;
  for (size_t k = 0; k < 3; ++k) {
    given[k] = triple[k] == lamp ? identifier : m_given[triple[k]];
  }
  return m_table.look(triple, given);
}

//! Of giving \e lamp the identifier; none of its own sets are in the table. More than \e limit need not be
//! exact.
double Layer::cost(uint32_t lamp, uint32_t identifier, double limit) const
{
  double cost = costInView(lamp, identifier);
  for (uint32_t t : m_triplesOf[lamp]) {
    const vpLampTriple &triple = m_triples[t];
    const bool complete = std::all_of(triple.begin(), triple.end(), [&](uint32_t other) {
      return other == lamp || m_given[other] != none;
    });
    if (complete) {
      cost += m_weights[t] * static_cast<double>(m_table.count(lookOf(triple, lamp, identifier)));
    }
    if (cost > limit) {
      break;
    }
  }
  return cost;
}

//! Identifiers to compare: those that fewest lamps in view have, in random order.
std::vector<uint32_t> Layer::choicesFor(uint32_t lamp)
{
  std::vector<double> inView(m_identifiers, 0);
  for (const Near &near : m_inView[lamp]) {
    if (m_given[near.lamp] != none) {
      inView[m_given[near.lamp]] += 2 - near.distance / (2 * m_settings.viewRadius);
    }
  }
  std::vector<uint32_t> identifiers(m_identifiers);
  std::iota(identifiers.begin(), identifiers.end(), 0);
  for (size_t k = identifiers.size(); k > 1; --k) { // std::shuffle differs between libraries
    std::swap(identifiers[k - 1], identifiers[m_random() % k]);
  }
  std::stable_sort(identifiers.begin(), identifiers.end(),
                   [&](uint32_t a, uint32_t b) { return inView[a] < inView[b]; });
  identifiers.resize(std::min<size_t>(m_settings.choices, identifiers.size()));
  return identifiers;
}

//! Gives \e lamp the best identifier. True where that is another one than before.
bool Layer::choose(uint32_t lamp)
{
  const uint32_t before = m_given[lamp];
  for (uint32_t t : m_triplesOf[lamp]) {
    if (laid(m_triples[t])) {
      m_table.remove(lookOf(m_triples[t], lamp, before));
    }
  }
  uint32_t best = before;
  double least = std::numeric_limits<double>::infinity();
  if (before != none) {
    least = cost(lamp, before, least);
  }
  for (uint32_t identifier : choicesFor(lamp)) {
    const double found = least > 0 ? cost(lamp, identifier, least) : least;
    if (found < least) {
      least = found;
      best = identifier;
    }
  }
  m_given[lamp] = best;
  for (uint32_t t : m_triplesOf[lamp]) {
    if (laid(m_triples[t])) {
      m_table.add(lookOf(m_triples[t], lamp, best));
    }
  }
  return best != before;
}

vpIdentifierAssignment Layer::report() const
{
  vpIdentifierAssignment assignment;
  assignment.identifiers.assign(m_given.begin(), m_given.end());
  for (uint32_t lamp = 0; lamp < m_places.size(); ++lamp) {
    for (const Near &near : m_inView[lamp]) {
      assignment.pairsInView += near.lamp > lamp;
      assignment.repeatedPairs += near.lamp > lamp && m_given[near.lamp] == m_given[lamp];
    }
  }
  assignment.triples = m_triples.size();
  for (const vpLampTriple &triple : m_triples) {
    const vpTripleTable::Look look = lookOf(triple, none, none);
    assignment.repeatedTriples += !look.distinct || m_table.count(look) > 1; // itself is in the table
  }
  return assignment;
}

vpIdentifierAssignment Layer::lay()
{
  for (uint32_t lamp : m_order) {
    choose(lamp);
  }
  bool better = true;
  for (unsigned int pass = 0; pass < m_settings.passes && better; ++pass) {
    better = false;
    for (uint32_t lamp : m_order) {
      const bool alike = costInView(lamp, m_given[lamp]) > 0 ||
                         std::any_of(m_triplesOf[lamp].begin(), m_triplesOf[lamp].end(), [&](uint32_t t) {
                           return m_table.count(lookOf(m_triples[t], none, none)) > 1;
                         });
      better = (alike && choose(lamp)) || better;
    }
  }
  return report();
}
} // namespace

vpIdentifierAssignment vpIdentifierLayout::lay(const std::vector<Eigen::Vector3d> &positions,
                                               size_t identifiers) const
{
  static const double most = 2e6; // that a hash of three takes
  expect(positions.size() >= 2, "the number of positions", static_cast<double>(positions.size()),
         "2 or more");
  expect(identifiers >= 2 && static_cast<double>(identifiers) <= most, "identifiers",
         static_cast<double>(identifiers), "a number between 2 and 2 million");
  for (const Eigen::Vector3d &position : positions) {
    expect(position.allFinite(), "a coordinate of positions", position.sum(), "a number of metres");
  }
  expect(viewRadius > 0 && std::isfinite(viewRadius), "viewRadius", viewRadius, "more than 0 m");
  expect(tolerance > 0 && std::isfinite(tolerance), "tolerance", tolerance, "more than 0 m");
  expect(choices > 0, "choices", choices, "1 or more");
  return Layer(*this, positions, identifiers).lay();
}

END_VISP_NAMESPACE
