/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpEmitterFalloff.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <Eigen/LU>
#include <visp3/vlp_core/vpSimdClones.h>

#include <visp3/vlp_core/vpLanes.h>

#pragma GCC diagnostic ignored "-Wpsabi" // vectors are passed within this file only

BEGIN_VISP_NAMESPACE

namespace
{
using vpLanes::Floats;

//! Sums over samples of a line of weight, weight x log, times powers of the squared radius.
struct Moments {
  std::array<float, 5> weights{};
  std::array<float, 3> logs{};
};

VP_SIMD_CLONES void momentsOf(const float *weight, const float *log, size_t count, float first, float step,
                              const vpEmitterFalloff::SquaredRadius &radius, Moments &moments)
{
  std::array<Floats, 5> weights{};
  std::array<Floats, 3> logs{};
  static const Floats ramp = {0, 1, 2, 3, 4, 5, 6, 7};
  for (size_t i = 0; i < count; i += vpLanes::count) {
    const Floats from = first + step * (ramp + static_cast<float>(i)) - radius.nearest;
    const Floats r2 = radius.scale * from * from + radius.least;
    Floats w, l;
    std::memcpy(&w, weight + i, sizeof(w));
    std::memcpy(&l, log + i, sizeof(l));
    l *= w;
    for (size_t k = 0; k < weights.size(); ++k) {
      weights[k] += w;
      w *= r2;
    }
    for (size_t k = 0; k < logs.size(); ++k) {
      logs[k] += l;
      l *= r2;
    }
  }
  for (size_t k = 0; k < weights.size(); ++k) {
    moments.weights[k] = vpLanes::sum(weights[k]);
  }
  for (size_t k = 0; k < logs.size(); ++k) {
    moments.logs[k] = vpLanes::sum(logs[k]);
  }
}
} // namespace

vpEmitterFalloff::vpEmitterFalloff(const cv::Mat_<unsigned char> &lines, const std::vector<Chord> &chords,
                                   const vpOutlineFit &fit)
{
  const vpLampOutline &outline = fit.outline;
  const double c = std::cos(outline.angle), s = std::sin(outline.angle);
  m_toDisc << c / outline.a, s / outline.a, -s / outline.b, c / outline.b;
  m_middle = m_toDisc * outline.centre;
  static const double roughness = 0.02; // share of the light by which an emitter is not smooth, sigma
  static const double usual = 1;        // of a and b, standard deviation
  constexpr int enough = 32;            // samples of a line: fewer than twice as many are taken
  const double noise = std::max(fit.noise, 0.3), least = std::max(8 * noise, 6.0);
  std::array<float, 256> weights{}, logs{}; // of each grey value
  for (size_t grey = 0; grey < static_cast<size_t>(white); ++grey) {
    const double light = static_cast<double>(grey) - fit.background;
    if (light >= least) {
      weights[grey] = static_cast<float>(1 / (noise * noise / (light * light) + roughness * roughness));
      logs[grey] = static_cast<float>(std::log(light));
    }
  }
  Eigen::Matrix2d H = Eigen::Matrix2d::Identity() / (usual * usual);
  Eigen::Vector2d g = Eigen::Vector2d::Zero();
  std::array<float, 2 * enough + vpLanes::count> weight, log;
  Moments sum;
  for (const Chord &chord : chords) {
    const int step = std::max(1, (chord.last - chord.first) / enough);
    const auto count = static_cast<size_t>((chord.last - chord.first) / step + 1);
    const unsigned char *row = lines[chord.line] + chord.first;
    for (size_t i = 0; i < count; ++i) {
      const unsigned char grey = row[i * static_cast<size_t>(step)];
      weight[i] = weights[grey];
      log[i] = logs[grey];
    }
    std::fill_n(weight.data() + count, vpLanes::count, 0.f);
    std::fill_n(log.data() + count, vpLanes::count, 0.f);
    momentsOf(weight.data(), log.data(), count, static_cast<float>(chord.first), static_cast<float>(step),
              along(chord.line), sum);
    const double all = sum.weights[0];
    if (all > 0) {
      const Eigen::Vector2d mean(sum.weights[1] / all, sum.weights[2] / all);
      Eigen::Matrix2d squares;
      squares << sum.weights[2], sum.weights[3], sum.weights[3], sum.weights[4];
      H += squares - all * mean * mean.transpose();
      g += Eigen::Vector2d(sum.logs[1], sum.logs[2]) - sum.logs[0] * mean;
    }
  }
  const Eigen::Vector2d solution = H.inverse() * g;
  static const double most = 4; // of the logarithm at the rim: what goes farther is no lamp's falloff
  // The envelope of the stripes makes up for so little.
  static const double little = 0.003;
  if (solution.allFinite() && std::abs(solution.sum()) < most && solution.norm() < 3 * most &&
      solution.cwiseAbs().sum() >= little) {
    m_log = {static_cast<float>(solution.x()), static_cast<float>(solution.y())};
  }
}

END_VISP_NAMESPACE
