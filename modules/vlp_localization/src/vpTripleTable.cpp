/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpTripleTable.h"

#include <algorithm>
#include <cmath>
#include <utility>

BEGIN_VISP_NAMESPACE

vpTripleTable::Look vpTripleTable::look(const vpLampTriple &triple,
                                        const std::array<uint32_t, 3> &identifiers) const
{
  std::array<std::pair<uint32_t, uint32_t>, 3> corners;
  for (size_t k = 0; k < 3; ++k) {
    corners[k] = {identifiers[k], triple[k]};
  }
  std::sort(corners.begin(), corners.end());
  Look look;
  look.distinct = corners[0].first != corners[1].first && corners[1].first != corners[2].first;
  if (!look.distinct) {
    return look;
  }
  static const unsigned int bits = 21; // two million identifiers
  for (const auto &corner : corners) {
    look.key = look.key << bits | corner.first;
  }
  const Eigen::Vector2d &a = m_places[corners[0].second], &b = m_places[corners[1].second],
                        &c = m_places[corners[2].second];
  const Eigen::Vector2d ab = b - a, ac = c - a;
  look.sides = {static_cast<float>(ab.norm()), static_cast<float>((c - b).norm()),
                static_cast<float>(ac.norm())};
  look.area = static_cast<float>(ab.x() * ac.y() - ab.y() * ac.x());
  return look;
}

//! Sides alike, and not the mirror image but where the three lie almost on one line.
bool vpTripleTable::same(const Look &a, const Look &b) const
{
  float longest = 0;
  for (size_t k = 0; k < 3; ++k) {
    if (std::abs(a.sides[k] - b.sides[k]) > m_tolerance) {
      return false;
    }
    longest = std::max(longest, a.sides[k]);
  }
  const float thin = m_tolerance * longest;
  return (a.area > 0) == (b.area > 0) || std::abs(a.area) < thin || std::abs(b.area) < thin;
}

size_t vpTripleTable::count(const Look &look) const
{
  const auto found = m_looks.find(look.key);
  if (!look.distinct || found == m_looks.end()) {
    return 0;
  }
  return static_cast<size_t>(std::count_if(found->second.begin(), found->second.end(),
                                           [&](const Look &other) { return same(look, other); }));
}

void vpTripleTable::add(const Look &look)
{
  if (look.distinct) {
    m_looks[look.key].push_back(look);
  }
}

void vpTripleTable::remove(const Look &look)
{
  if (!look.distinct) {
    return;
  }
  std::vector<Look> &looks = m_looks[look.key];
  const auto found = std::find_if(looks.begin(), looks.end(), [&](const Look &other) {
    return other.sides == look.sides && other.area == look.area;
  });
  if (found != looks.end()) {
    *found = looks.back();
    looks.pop_back();
  }
}

END_VISP_NAMESPACE
