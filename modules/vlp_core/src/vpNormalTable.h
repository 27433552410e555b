/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpNormalTable_h
#define vpNormalTable_h

#include <algorithm>
#include <array>
#include <cmath>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! The standard normal distribution and its density from a table and Taylor's series: to 2e-9, ten times
//! faster than erfc() and exp().
class vpNormalTable
{
public:
  struct Value {
    double below; // probability of less
    double density;
  };

  static Value at(double z)
  {
    static const vpNormalTable table;
    const double place = std::clamp(z, -limit, limit), nearest = (place + limit) * perUnit + 0.5;
    const auto i = static_cast<size_t>(nearest);
    const Value &node = table.m_nodes[i];
    const double at = static_cast<double>(i) / perUnit - limit, h = place - at;
    // Derivatives of the density f: -z f, (z^2 - 1) f, (3 z - z^3) f.
    const double first = -at * node.density, second = -at * first - node.density,
                 third = -at * second - 2 * first;
    return {node.below + h * (node.density + h * (first / 2 + h * second / 6)),
            node.density + h * (first + h * (second / 2 + h * third / 6))};
  }

private:
  static constexpr double limit = 8; // beyond it all is 0 or 1
  static constexpr int perUnit = 32;

  vpNormalTable()
  {
    for (size_t i = 0; i < m_nodes.size(); ++i) {
      const double z = static_cast<double>(i) / perUnit - limit;
      m_nodes[i] = {0.5 * std::erfc(-z * M_SQRT1_2), std::exp(-0.5 * z * z) / std::sqrt(2 * M_PI)};
    }
  }

  std::array<Value, static_cast<size_t>(2 * limit) * perUnit + 1> m_nodes{};
};

END_VISP_NAMESPACE

#endif
