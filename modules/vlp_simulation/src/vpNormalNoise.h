/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpNormalNoise_h
#define vpNormalNoise_h

#include <cmath>
#include <cstdint>
#include <random>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  Normal random numbers that are the same with every standard library: std::normal_distribution is free to
  draw as it likes, std::mt19937_64 and std::seed_seq are not. Box and Muller's transform (1958).
*/
class vpNormalNoise
{
public:
  //! Streams of the same \e seed and different \e stream are independent.
  vpNormalNoise(std::uint64_t seed, std::uint32_t stream)
  {
    std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32), stream};
    m_engine.seed(sequence);
  }

  //! Even in [0, 1).
  double uniform() { return std::ldexp(static_cast<double>(m_engine() >> 11), -53); }

  //! Mean 0, standard deviation 1.
  double operator()()
  {
    if (m_kept) {
      m_kept = false;
      return m_second;
    }
    const double radius = std::sqrt(-2 * std::log(1 - uniform())); // of (0, 1]
    const double angle = 2 * M_PI * uniform();
    m_second = radius * std::sin(angle);
    m_kept = true;
    return radius * std::cos(angle);
  }

private:
  std::mt19937_64 m_engine;
  double m_second = 0; // Box and Muller's come in pairs
  bool m_kept = false;
};

END_VISP_NAMESPACE

#endif
