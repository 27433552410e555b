/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLanes_h
#define vpLanes_h

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  Eight numbers on which all arithmetic works at once: vectors of the compiler (GCC and Clang), which uses
  what the processor has. For use inside functions under VP_SIMD_CLONES only: these functions are made part of
  them.
*/
namespace vpLanes
{
constexpr int count = 8;
//! Of structs of vectors that several functions see: those of one instruction set take another alignment for
//! granted than those of another.
constexpr size_t alignment = count * sizeof(float);
using Floats = float __attribute__((vector_size(count * sizeof(float))));
using Integers = std::int32_t __attribute__((vector_size(count * sizeof(std::int32_t))));
using Unsigned = std::uint32_t __attribute__((vector_size(count * sizeof(std::uint32_t))));

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi" // how functions would pass vectors: none of these is ever called
#define VP_LANES_INLINE [[gnu::always_inline]] inline

VP_LANES_INLINE Floats all(float x)
{
  return Floats{x, x, x, x, x, x, x, x};
}

//! -1 where the comparison that gave \e mask is true: \e yes; 0: \e no.
VP_LANES_INLINE Floats select(const Integers &mask, const Floats &yes, const Floats &no)
{
  return reinterpret_cast<Floats>((mask & reinterpret_cast<Integers>(yes)) |
                                  (~mask & reinterpret_cast<Integers>(no)));
}

VP_LANES_INLINE Floats least(const Floats &a, const Floats &b)
{
  return select(a < b, a, b);
}

VP_LANES_INLINE Floats most(const Floats &a, const Floats &b)
{
  return select(a > b, a, b);
}

VP_LANES_INLINE Floats magnitude(const Floats &x)
{
  return reinterpret_cast<Floats>(reinterpret_cast<Integers>(x) & 0x7fffffff);
}

VP_LANES_INLINE float sum(const Floats &x)
{
  return ((x[0] + x[4]) + (x[1] + x[5])) + ((x[2] + x[6]) + (x[3] + x[7]));
}

//! Eight grey values in a row.
VP_LANES_INLINE Floats grey(const unsigned char *pixel)
{
  std::uint32_t first, second;
  std::memcpy(&first, pixel, sizeof(first));
  std::memcpy(&second, pixel + sizeof(first), sizeof(second));
  const Unsigned words = {first, first, first, first, second, second, second, second},
                 shifts = {0, 8, 16, 24, 0, 8, 16, 24};
  return __builtin_convertvector(reinterpret_cast<Integers>(words >> shifts & 0xff), Floats);
}

VP_LANES_INLINE Floats root(const Floats &x)
{
  Floats y;
  for (int i = 0; i < count; ++i) {
    y[i] = __builtin_sqrtf(x[i]);
  }
  return y;
}

//! exp(x) for x from -80 to 0, to 1e-7 of itself: 2^k e^r with |r| < ln(2) / 2, of which Taylor's series.
VP_LANES_INLINE Floats exponential(const Floats &x)
{
  const Integers k = __builtin_convertvector(x * 1.44269504f - 0.5f, Integers);
  const Floats r = x - __builtin_convertvector(k, Floats) * 0.693147182f;
  const Floats series =
      1 + r * (1 + r * (0.5f + r * (1 / 6.f + r * (1 / 24.f + r * (1 / 120.f + r * (1 / 720.f))))));
  return series * reinterpret_cast<Floats>((k + 127) << 23);
}

struct Normal {
  Floats below; // probability of less
  Floats density;
};

//! The standard normal distribution, to 1e-7 (Abramowitz and Stegun 1964, 26.2.17).
VP_LANES_INLINE Normal normal(const Floats &x)
{
  const Floats far = least(magnitude(x), all(12));
  const Floats density = 0.398942280f * exponential(-0.5f * far * far);
  const Floats t = 1 / (1 + 0.2316419f * far);
  const Floats tail =
      density * t *
      (0.319381530f + t * (-0.356563782f + t * (1.781477937f + t * (-1.821255978f + t * 1.330274429f))));
  return {select(x > 0, 1 - tail, tail), density};
}
} // namespace vpLanes
#pragma GCC diagnostic pop

END_VISP_NAMESPACE

#endif
