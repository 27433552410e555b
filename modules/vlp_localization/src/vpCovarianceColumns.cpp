/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpCovarianceColumns.h"

#include <algorithm>

#include <visp3/vlp_core/vpSimdClones.h>

BEGIN_VISP_NAMESPACE

VP_SIMD_CLONES void vpCovarianceColumns::sum(const double *P, Eigen::Index size, const Eigen::Index *at,
                                             int count, const double *weights, int stride, int values,
                                             double *sums)
{
  double *__restrict first = sums, *__restrict second = sums + size, *__restrict third = sums + 2 * size;
  std::fill(sums, sums + values * size, 0.0);
  for (int k = 0; k < count; ++k) {
    const double *__restrict column = P + at[k] * size;
    const double a = weights[k], b = weights[k + stride];
    for (Eigen::Index i = 0; i < size; ++i) {
      first[i] += a * column[i];
      second[i] += b * column[i];
    }
    if (values > 2) {
      const double c = weights[k + 2 * stride];
      for (Eigen::Index i = 0; i < size; ++i) {
        third[i] += c * column[i];
      }
    }
  }
}

VP_SIMD_CLONES void vpCovarianceColumns::subtract(double *P, Eigen::Index size, Eigen::Index from,
                                                  Eigen::Index until, const double *K, const double *W,
                                                  int values)
{
  const double *__restrict k0 = K, *__restrict k1 = K + size, *__restrict k2 = K + 2 * size,
                           *__restrict w0 = W, *__restrict w1 = W + size, *__restrict w2 = W + 2 * size;
  for (Eigen::Index column = from; column < until; ++column) {
    double *__restrict p = P + column * size;
    const double a = w0[column], b = k0[column], c = w1[column], d = k1[column];
    for (Eigen::Index i = 0; i < size; ++i) {
      p[i] -= a * k0[i] + b * w0[i] + (c * k1[i] + d * w1[i]);
    }
    if (values > 2) {
      const double e = w2[column], f = k2[column];
      for (Eigen::Index i = 0; i < size; ++i) {
        p[i] -= e * k2[i] + f * w2[i];
      }
    }
  }
}

END_VISP_NAMESPACE
