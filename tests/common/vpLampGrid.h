/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampGrid_h
#define vpLampGrid_h

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Core>

//! A square of \e count lamps every \e spacing (m), each off its knot by up to \e jitter (m); 3 m high, by 2
//! cm.
inline std::vector<Eigen::Vector3d> vpLampGrid(size_t count, double spacing, double jitter, unsigned int seed)
{
  std::mt19937 generator(seed);
  const auto off = [&] { return std::uniform_real_distribution<double>(-jitter, jitter)(generator); };
  const size_t side = static_cast<size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  std::vector<Eigen::Vector3d> positions;
  for (size_t k = 0; k < count; ++k) {
    const double z = 3 + 0.02 * std::normal_distribution<double>()(generator),
                 y = spacing * static_cast<double>(k / side) + off(),
                 x = spacing * static_cast<double>(k % side) + off();
    positions.emplace_back(x, y, z);
  }
  return positions;
}

#endif
