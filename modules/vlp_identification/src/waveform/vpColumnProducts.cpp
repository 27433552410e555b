/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpColumnProducts.h"

#include <cstring>

#include <visp3/vlp_core/vpSimdClones.h>

BEGIN_VISP_NAMESPACE

VP_SIMD_CLONES void vpColumnProducts(const double *columns, Eigen::Index rows, Eigen::Index count,
                                     const double *x, double *sums)
{
  constexpr Eigen::Index lanes = 4;
  using Doubles = double __attribute__((vector_size(lanes * sizeof(double))));
  const Eigen::Index whole = rows / lanes * lanes;
  for (Eigen::Index k = 0; k < count; ++k) {
    const double *column = columns + k * rows;
    Doubles sum{};
    for (Eigen::Index i = 0; i < whole; i += lanes) {
      Doubles a, b;
      std::memcpy(&a, column + i, sizeof(a));
      std::memcpy(&b, x + i, sizeof(b));
      sum += a * b;
    }
    sums[k] = (sum[0] + sum[2]) + (sum[1] + sum[3]);
    for (Eigen::Index i = whole; i < rows; ++i) {
      sums[k] += column[i] * x[i];
    }
  }
}

END_VISP_NAMESPACE
