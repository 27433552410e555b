/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_evaluation/vpErrorStatistics.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpRoundStep.h>

BEGIN_VISP_NAMESPACE

namespace
{
double percentileOfSorted(const std::vector<double> &sorted, double share)
{
  const double index = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<size_t>(index);
  const size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (index - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}
} // namespace

double vpPercentile(std::vector<double> values, double share)
{
  if (values.empty() || !(share >= 0 && share <= 1)) {
    throw vpException(vpException::badValue, "percentile: share " + vpNumberText(share) + " of " +
                                                 std::to_string(values.size()) +
                                                 " values, expected a share of 0 to 1 of one or more");
  }
  std::sort(values.begin(), values.end());
  return percentileOfSorted(values, share);
}

vpErrorStatistics vpErrorStatistics::of(const std::vector<double> &errors)
{
  vpErrorStatistics statistics;
  statistics.count = errors.size();
  if (errors.empty()) {
    return statistics;
  }
  const auto n = static_cast<double>(errors.size());
  for (const double error : errors) {
    statistics.mean += error / n;
  }
  double variance = 0;
  std::vector<double> magnitudes;
  for (const double error : errors) {
    variance += (error - statistics.mean) * (error - statistics.mean) / n;
    magnitudes.push_back(std::abs(error));
  }
  std::sort(magnitudes.begin(), magnitudes.end());
  statistics.deviation = std::sqrt(variance);
  statistics.rmse = std::hypot(statistics.mean, statistics.deviation);
  statistics.median = vpPercentile(errors, 0.5);
  statistics.percentile90 = percentileOfSorted(magnitudes, 0.90);
  statistics.percentile95 = percentileOfSorted(magnitudes, 0.95);
  statistics.largest = magnitudes.back();
  return statistics;
}

vpErrorDistribution::vpErrorDistribution(std::vector<double> errors)
    : m_errors(std::move(errors)), m_binWidth(0.001)
{
  if (m_errors.empty()) {
    return;
  }
  for (const double error : m_errors) {
    if (!(error >= 0 && std::isfinite(error))) {
      throw vpException(vpException::badValue,
                        "errors: " + vpNumberText(error) + " m, expected finite distances of 0 or more");
    }
  }
  std::sort(m_errors.begin(), m_errors.end());
  constexpr double bins = 20, least = 1e-9; // m; errors below it are rounding
  m_binWidth = vpRoundStep(std::max(m_errors.back(), least) / bins);
  const auto binOf = [this](double error) { return static_cast<size_t>(error / m_binWidth); };
  m_pmf.assign(binOf(m_errors.back()) + 1, 0);
  for (const double error : m_errors) {
    m_pmf[binOf(error)] += 1 / static_cast<double>(m_errors.size());
  }
}

double vpErrorDistribution::cdf(double error) const
{
  const auto above = std::upper_bound(m_errors.begin(), m_errors.end(), error);
  return m_errors.empty()
             ? 0
             : static_cast<double>(above - m_errors.begin()) / static_cast<double>(m_errors.size());
}

END_VISP_NAMESPACE
