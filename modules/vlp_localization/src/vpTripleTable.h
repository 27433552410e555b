/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpTripleTable_h
#define vpTripleTable_h

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! Three lamps, by their indices.
using vpLampTriple = std::array<uint32_t, 3>;

/*!
  Sets of three lamps by their identifiers, to find those that look alike. Private to the module.
*/
class vpTripleTable
{
public:
  //! How three lamps look: identifiers ascending, and the triangle with its corners in their order.
  struct Look {
    uint64_t key = 0;             // of the identifiers
    bool distinct = false;        // all three; else the rest is not set
    std::array<float, 3> sides{}; // m: first to second, second to third, third to first
    float area = 0;               // m^2, twice the signed area
  };

  vpTripleTable(const std::vector<Eigen::Vector2d> &places, double tolerance)
      : m_places(places), m_tolerance(static_cast<float>(tolerance))
  {
  }

  Look look(const vpLampTriple &triple, const std::array<uint32_t, 3> &identifiers) const;
  //! Sets in the table that look the same.
  size_t count(const Look &look) const;
  void add(const Look &look);
  void remove(const Look &look);

private:
  bool same(const Look &a, const Look &b) const;

  const std::vector<Eigen::Vector2d> &m_places;
  float m_tolerance; // m
  std::unordered_map<uint64_t, std::vector<Look>> m_looks;
};

END_VISP_NAMESPACE

#endif
