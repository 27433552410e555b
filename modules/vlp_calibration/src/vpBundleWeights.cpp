/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vpBundleProblem: how images and odometry are weighed by what their residuals show.

#include "vpBundleProblem.h"

#include <algorithm>
#include <cmath>
#include <utility>

BEGIN_VISP_NAMESPACE

namespace
{
const double nearly = 0.03; // share by which a weight changes that is right

/*!
  How far a logarithm has yet to go, whose last two steps were these, where they shrink slowly: the sum of
  what follows, if each keeps as much of the one before (Aitken 1926). So goes the weight of errors that are
  all but none.
*/
double ahead(double before, double step)
{
  static const double slow = 0.5, farthest = 1.4;
  const double kept = before == 0 ? 0 : step / before;
  if (kept <= slow || std::abs(step) < nearly) {
    return 0;
  }
  return std::copysign(kept < 1 ? std::min(farthest, std::abs(step) * kept / (1 - kept)) : farthest, step);
}
} // namespace

std::vector<size_t> vpBundleProblem::rowsOf(Row kind) const
{
  std::vector<size_t> rows;
  for (size_t i = 0; i < m_rows.size(); ++i) {
    if (m_rows[i] == kind) {
      rows.push_back(i);
    }
  }
  return rows;
}

//! Estimates variance components (Foerstner 1979); of the one that is slowest, all that is ahead of it at
//! once.
bool vpBundleProblem::weigh()
{
  static const double lowest = 1e-3, highest = 1e3; // of a stated sigma: observations without any noise
  const vpNormalEquations equations = this->equations();
  bool settled = true;
  double *slowest = nullptr;
  double farthest = 0, bound = highest, *lastStep = nullptr;
  const auto weighOne = [&](Row kind, double &weight, double most) {
    const std::vector<size_t> rows = rowsOf(kind);
    if (rows.empty()) {
      return;
    }
    const double redundancy = equations.redundancy(rows);
    static const double least = 5; // fewer say little of their own errors
    if (redundancy < least) {
      return;
    }
    double squares = 0;
    for (const size_t row : rows) {
      squares += equations.residuals()[row] * equations.residuals()[row];
    }
    m_imageRedundancy = kind == Row::image ? redundancy : m_imageRedundancy;
    const double before = weight;
    weight = std::clamp(weight * std::sqrt(redundancy / std::max(squares, 1e-12)), lowest, most);
    double &last = m_lastSteps[static_cast<size_t>(kind)];
    const double step = std::log(weight / before);
    settled = settled && std::abs(step) < nearly;
    const double further = ahead(std::exchange(last, step), step);
    if (kind != Row::image && std::abs(further) > std::abs(farthest)) {
      slowest = &weight, lastStep = &last, farthest = further, bound = most;
    }
  };
  weighOne(Row::image, m_imageWeight, highest);
  weighOne(Row::along, m_stepWeight(0), highest);
  if (m_rolls) {
    weighOne(Row::sideways, m_stepWeight(1), 1);
  } else {
    m_stepWeight(1) = 1;
    m_rolls = true;
    settled = false;
  }
  weighOne(Row::turn, m_stepWeight(2), highest);
  weighOne(Row::slip, m_slipWeight, highest);
  weighOne(Row::rates, m_ratesWeight, highest);
  if (slowest != nullptr) {
    *slowest = std::clamp(*slowest * std::exp(farthest), lowest, bound);
    *lastStep = 0;
  }
  return settled;
}

END_VISP_NAMESPACE
