/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLineEnds.h"

#include <visp3/vlp_core/vpSimdClones.h>

#pragma GCC diagnostic ignored "-Wpsabi" // vectors are passed within this file only

BEGIN_VISP_NAMESPACE

namespace
{
using vpLanes::all;
using vpLanes::Floats;
using vpLanes::Integers;
using vpLanes::select;

template <int N>
VP_LANES_INLINE void judgeOf(std::vector<vpEightLines<N>> &lines)
{
  for (vpEightLines<N> &eight : lines) {
    for (vpLineEnds<N> &end : eight.sides) {
      end.offset = end.shift / vpLanes::most(end.shiftShift, all(1e-12f));
      // What the end's own best shift leaves: from a start a pixel off, all ends misfit, and none is dark for
      // it.
      const Floats left = end.squares - end.offset * end.shift;
      end.variance = vpLanes::most(left, all(0)) / vpLanes::most(end.pixels - 3, all(1));
    }
  }
}

template <int N>
VP_LANES_INLINE void weighOf(std::vector<vpEightLines<N>> &lines, float noise, float scale,
                             vpEndSums::Sums<N> &sums)
{
  // The lower half of H, row by row; the blur is the last parameter.
  std::array<Floats, N *(N + 1) / 2> H{};
  std::array<Floats, N> g{};
  Floats shift{}, shiftShift{}, squares{}, pixels{}, members{}, shining{}, kept{};
  for (vpEightLines<N> &eight : lines) {
    for (vpLineEnds<N> &end : eight.sides) {
      const Floats lit = select(end.shines, all(1), all(0));
      shining += lit;
      squares += lit * end.squares;
      pixels += lit * end.pixels;
      const Floats variance = vpLanes::most(end.squares / vpLanes::most(end.pixels - 2, all(1)), all(noise));
      const Floats own = vpLanes::root(variance / vpLanes::most(end.shiftShift, all(1e-12f)));
      const Floats z = end.offset / (4.685f * vpLanes::most(all(scale), own));
      const Integers near = end.shines & Integers(vpLanes::magnitude(z) < 1);
      const Floats tukey = select(near, (1 - z * z) * (1 - z * z), all(0)), weight = tukey / variance;
      end.weight = weight;
      members += tukey;
      kept += select(near, all(1), all(0));
      shift += weight * end.shift * end.offset;
      shiftShift += weight * end.shiftShift;

      const Floats crossing = select(end.along < 0, weight, all(0)), byShift = crossing * end.shiftShift,
                   byBoth = crossing * end.shiftBlur, ofShift = crossing * end.shift;
      size_t at = 0;
      for (size_t k = 0; k + 1 < N; ++k) {
        const Floats outward = byShift * end.outward[k];
        for (size_t l = 0; l <= k; ++l) {
          H[at++] += outward * end.outward[l];
        }
        g[k] += ofShift * end.outward[k];
      }
      for (size_t l = 0; l + 1 < N; ++l) {
        H[at++] += byBoth * end.outward[l];
      }
      H[at] += crossing * end.blurBlur;
      g[N - 1] += crossing * end.blur;
    }
  }
  size_t at = 0;
  for (int k = 0; k < N; ++k) {
    for (int l = 0; l <= k; ++l) {
      sums.equations.H(k, l) = sums.equations.H(l, k) = vpLanes::sum(H[at++]);
    }
    sums.equations.g(k) = vpLanes::sum(g[static_cast<size_t>(k)]);
  }
  sums.shift = vpLanes::sum(shift);
  sums.shiftShift = vpLanes::sum(shiftShift);
  sums.squares = vpLanes::sum(squares);
  sums.pixels = vpLanes::sum(pixels);
  sums.members = vpLanes::sum(members);
  sums.shining = vpLanes::sum(shining);
  sums.kept = vpLanes::sum(kept);
}

template <int N>
VP_LANES_INLINE double shadingOf(const std::vector<vpEightLines<N>> &lines)
{
  static constexpr float scatter = 0.3f; // of an amplitude about the other: more, and something hides an end
  Floats slope{}, weight{};
  for (const vpEightLines<N> &eight : lines) {
    const vpLineEnds<N> &first = eight.sides[0], &last = eight.sides[1];
    const Floats light = 0.5f * (first.amplitude + last.amplitude), more = last.amplitude - first.amplitude,
                 length = last.crossing - first.crossing;
    const Integers both = first.valid & last.valid & Integers(first.along < 0) & Integers(last.along < 0) &
                          Integers(first.amplitude > 0) & Integers(last.amplitude > 0) &
                          Integers(vpLanes::magnitude(more) < scatter * light);
    slope += select(both, more * light * length, all(0));
    weight += select(both, light * light * length * length, all(0));
  }
  const double total = vpLanes::sum(weight);
  return total > 0 ? vpLanes::sum(slope) / total : 0;
}
} // namespace

VP_SIMD_CLONES void vpEndSums::judge(std::vector<vpEightLines<6>> &lines)
{
  judgeOf(lines);
}

VP_SIMD_CLONES void vpEndSums::judge(std::vector<vpEightLines<9>> &lines)
{
  judgeOf(lines);
}

VP_SIMD_CLONES void vpEndSums::weigh(std::vector<vpEightLines<6>> &lines, double noise, double scale,
                                     Sums<6> &sums)
{
  weighOf(lines, static_cast<float>(noise), static_cast<float>(scale), sums);
}

VP_SIMD_CLONES void vpEndSums::weigh(std::vector<vpEightLines<9>> &lines, double noise, double scale,
                                     Sums<9> &sums)
{
  weighOf(lines, static_cast<float>(noise), static_cast<float>(scale), sums);
}

VP_SIMD_CLONES double vpEndSums::shading(const std::vector<vpEightLines<6>> &lines)
{
  return shadingOf(lines);
}

VP_SIMD_CLONES double vpEndSums::shading(const std::vector<vpEightLines<9>> &lines)
{
  return shadingOf(lines);
}

END_VISP_NAMESPACE
