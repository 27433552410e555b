/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_identification/vpIdentifierLayout.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <unordered_map>
#include <utility>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

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

//! Twice the signed area, m^2.
double areaOf(const Eigen::Vector2d &a, const Eigen::Vector2d &b, const Eigen::Vector2d &c)
{
  const Eigen::Vector2d ab = b - a, ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x();
}

//! Radius of the smallest circle that holds all three, m.
double enclosingRadius(const Eigen::Vector2d &a, const Eigen::Vector2d &b, const Eigen::Vector2d &c)
{
  std::array<double, 3> squared = {(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()};
  std::sort(squared.begin(), squared.end());
  if (squared[2] >= squared[0] + squared[1]) { // right or obtuse: the longest side is the diameter
    return std::sqrt(squared[2]) / 2;
  }
  return std::sqrt(squared[0] * squared[1] * squared[2]) / (2 * std::abs(areaOf(a, b, c)));
}

const uint32_t none = static_cast<uint32_t>(-1); // no identifier yet

//! How a set of three lamps looks: identifiers ascending, and the triangle with its corners in their order.
struct Look {
  uint64_t key = 0;             // of the identifiers; 0, and the rest not set: not three different ones
  uint32_t set = 0;             // index of the set
  std::array<float, 3> sides{}; // m: first to second, second to third, third to first
  float area = 0;               // m^2, twice the signed area

  //! Sides alike, and not the mirror image but where the three lie almost on one line.
  bool same(const Look &other, float tolerance) const
  {
    for (size_t k = 0; k < 3; ++k) {
      if (std::abs(sides[k] - other.sides[k]) > tolerance) {
        return false;
      }
    }
    const float thin = tolerance * *std::max_element(sides.begin(), sides.end());
    return (area > 0) == (other.area > 0) || std::abs(area) < thin || std::abs(other.area) < thin;
  }
};

//! The work of one lay().
class Layer
{
public:
  Layer(const vpIdentifierLayout &settings, const std::vector<Eigen::Vector3d> &positions, size_t identifiers)
      : m_settings(settings), m_identifiers(identifiers), m_order(positions.size()),
        m_inView(positions.size()), m_setsOf(positions.size()), m_given(positions.size(), none),
        m_random(settings.seed)
  {
    for (const Eigen::Vector3d &position : positions) {
      m_places.emplace_back(position.head<2>());
    }
    std::iota(m_order.begin(), m_order.end(), 0);
    std::stable_sort(m_order.begin(), m_order.end(),
                     [&](uint32_t a, uint32_t b) { return m_places[a].x() < m_places[b].x(); });
    findNeighbours();
    findSets();
  }

  vpIdentifierAssignment lay()
  {
    for (uint32_t lamp : m_order) {
      choose(lamp);
    }
    bool better = true;
    for (unsigned int pass = 0; pass < m_settings.passes && better; ++pass) {
      better = false;
      for (uint32_t lamp : m_order) {
        const bool repeated = repeatsInView(lamp)[m_given[lamp]] > 0 ||
                              std::any_of(m_setsOf[lamp].begin(), m_setsOf[lamp].end(),
                                          [&](uint32_t set) { return alike(look(set)) > 1; });
        better = (repeated && choose(lamp)) || better;
      }
    }
    return report();
  }

private:
  struct Near {
    uint32_t lamp;
    float distance; // m
  };

  //! Lamps that one view can hold together with each lamp: no farther than its diameter.
  void findNeighbours()
  {
    const double diameter = 2 * m_settings.viewRadius;
    for (auto lamp = m_order.begin(); lamp != m_order.end(); ++lamp) {
      for (auto other = lamp + 1;
           other != m_order.end() && m_places[*other].x() - m_places[*lamp].x() <= diameter; ++other) {
        const float distance = static_cast<float>((m_places[*other] - m_places[*lamp]).norm());
        if (distance <= diameter) {
          m_inView[*lamp].push_back({*other, distance});
          m_inView[*other].push_back({*lamp, distance});
        }
      }
    }
    for (std::vector<Near> &near : m_inView) {
      std::stable_sort(near.begin(), near.end(),
                       [](const Near &a, const Near &b) { return a.distance < b.distance; });
    }
  }

  void findSets()
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
            m_setsOf[lamp].push_back(static_cast<uint32_t>(m_sets.size()));
          }
          m_sets.push_back({a, *b, *c});
          static const float least = 0.02F;
          const float free = 1 - static_cast<float>(radius / m_settings.viewRadius);
          m_weights.push_back(least + free * free);
        }
      }
    }
  }

  //! How a set looks with these identifiers, and with \e identifier on \e lamp instead.
  Look look(uint32_t set, uint32_t lamp = none, uint32_t identifier = none) const
  {
    std::array<std::pair<uint32_t, uint32_t>, 3> corners; // identifier, lamp
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t other = m_sets[set][k];
      corners[k] = {other == lamp ? identifier : m_given[other], other};
    }
    std::sort(corners.begin(), corners.end());
    Look look;
    if (corners[0].first == corners[1].first || corners[1].first == corners[2].first ||
        corners[2].first == none) {
      return look;
    }
    static const unsigned int bits = 21; // two million identifiers
    look.key = (uint64_t(corners[0].first) << bits | corners[1].first) << bits | corners[2].first;
    look.set = set;
    const Eigen::Vector2d &a = m_places[corners[0].second], &b = m_places[corners[1].second],
                          &c = m_places[corners[2].second];
    look.sides = {static_cast<float>((b - a).norm()), static_cast<float>((c - b).norm()),
                  static_cast<float>((c - a).norm())};
    look.area = static_cast<float>(areaOf(a, b, c));
    return look;
  }

  //! Sets whose lamps have their identifiers and that look like that.
  size_t alike(const Look &look) const
  {
    const auto looks = m_looks.find(look.key);
    return look.key == 0 || looks == m_looks.end()
               ? 0
               : static_cast<size_t>(
                     std::count_if(looks->second.begin(), looks->second.end(),
                                   [tolerance = static_cast<float>(m_settings.tolerance),
                                    &look](const Look &other) { return look.same(other, tolerance); }));
  }

  //! Of each identifier, how many lamps in view of \e lamp have it; a near one counts twice, a far one once.
  std::vector<double> repeatsInView(uint32_t lamp) const
  {
    std::vector<double> repeats(m_identifiers, 0);
    for (const Near &near : m_inView[lamp]) {
      if (m_given[near.lamp] != none) {
        repeats[m_given[near.lamp]] += 2 - near.distance / (2 * m_settings.viewRadius);
      }
    }
    return repeats;
  }

  //! Gives \e lamp the best of some identifiers: those that fewest lamps in view have, in random order. True
  //! where that is another one than before.
  bool choose(uint32_t lamp)
  {
    const uint32_t before = m_given[lamp];
    for (uint32_t set : m_setsOf[lamp]) {
      if (const Look old = look(set); old.key != 0) {
        std::vector<Look> &looks = m_looks[old.key];
        std::swap(looks.back(), *std::find_if(looks.begin(), looks.end(),
                                              [&](const Look &other) { return other.set == set; }));
        looks.pop_back();
      }
    }
    const std::vector<double> inView = repeatsInView(lamp);
    std::vector<uint32_t> identifiers(m_identifiers);
    std::iota(identifiers.begin(), identifiers.end(), 0);
    for (size_t k = identifiers.size(); k > 1; --k) { // std::shuffle differs between libraries
      std::swap(identifiers[k - 1], identifiers[m_random() % k]);
    }
    std::stable_sort(identifiers.begin(), identifiers.end(),
                     [&](uint32_t a, uint32_t b) { return inView[a] < inView[b]; });
    identifiers.resize(std::min<size_t>(m_settings.choices, identifiers.size()));
    if (before != none) {
      identifiers.insert(identifiers.begin(), before);
    }

    static const double perLamp = 100; // sets that look alike: two lamps that no picture tells apart
    double least = std::numeric_limits<double>::infinity();
    for (uint32_t identifier : identifiers) {
      double cost = perLamp * inView[identifier];
      for (auto set = m_setsOf[lamp].begin(); set != m_setsOf[lamp].end() && cost < least; ++set) {
        cost += m_weights[*set] * static_cast<double>(alike(look(*set, lamp, identifier)));
      }
      if (cost < least) {
        least = cost;
        m_given[lamp] = identifier;
      }
    }
    for (uint32_t set : m_setsOf[lamp]) {
      if (const Look now = look(set); now.key != 0) {
        m_looks[now.key].push_back(now);
      }
    }
    return m_given[lamp] != before;
  }

  vpIdentifierAssignment report() const
  {
    vpIdentifierAssignment assignment;
    assignment.identifiers.assign(m_given.begin(), m_given.end());
    for (uint32_t lamp = 0; lamp < m_places.size(); ++lamp) {
      for (const Near &near : m_inView[lamp]) {
        assignment.pairsInView += near.lamp > lamp;
        assignment.repeatedPairs += near.lamp > lamp && m_given[near.lamp] == m_given[lamp];
      }
    }
    assignment.triples = m_sets.size();
    for (uint32_t set = 0; set < m_sets.size(); ++set) {
      assignment.repeatedTriples += alike(look(set)) != 1; // itself alone
    }
    return assignment;
  }

  const vpIdentifierLayout &m_settings;
  const size_t m_identifiers;
  std::vector<Eigen::Vector2d> m_places;
  std::vector<uint32_t> m_order;               // by x
  std::vector<std::vector<Near>> m_inView;     // of each lamp, the nearest first
  std::vector<std::array<uint32_t, 3>> m_sets; // of three lamps
  std::vector<float> m_weights; // of each: the closer the three, the more views hold them and no others
  std::vector<std::vector<uint32_t>> m_setsOf;             // each lamp, indices
  std::vector<uint32_t> m_given;                           // identifier of each lamp
  std::unordered_map<uint64_t, std::vector<Look>> m_looks; // of sets whose lamps have identifiers, by key
  std::mt19937 m_random;
};
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
