/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpFrequencyRows.h"

#include <algorithm>
#include <cmath>
#include <limits>

BEGIN_VISP_NAMESPACE

vpFrequencyRows::vpFrequencyRows(const vpLedIdPlanner &planner, double lines)
    : m_lowest(planner.lowest(lines)), m_highest(planner.highest())
{
  for (const double duty : planner.duties) {
    m_rows.push_back(rowOf(planner, duty, lines));
  }
}

vpFrequencyRows::Row vpFrequencyRows::rowOf(const vpLedIdPlanner &planner, double duty, double lines) const
{
  Row row{duty, {}};
  const double highest = std::min(m_highest, std::min(duty, 1 - duty) / planner.prediction.exposure());
  const double step = planner.frequencyStep;
  static const double rounding = 1e-9, cell = 5; // Hz, within which the shape's doubt changes little
  vpStripeDoubt below = planner.prediction.shapeSigma(vpPwmLamp(m_lowest, duty), lines), above = below;
  double end = m_lowest; // of the cell, at which above is
  for (double n = std::ceil(m_lowest / step - rounding); n * step <= highest * (1 + rounding); ++n) {
    while (end < n * step) {
      end = std::max(end + cell, n * step);
      below = above;
      above = planner.prediction.shapeSigma(vpPwmLamp(end, duty), lines);
    }
    const vpStripeDoubt doubt = planner.prediction.together(vpPwmLamp(n * step, duty), lines, 0,
                                                            below.duty > above.duty ? below : above);
    row.candidates.push_back({n * step, doubt.frequency, doubt.duty});
  }
  return row;
}

double vpFrequencyRows::doubtOf(const Candidate &candidate) const
{
  return std::hypot(candidate.frequencyDoubt, 1e-6 * m_oscillatorPpm * candidate.frequency);
}

double vpFrequencyRows::widest() const
{
  double least = std::numeric_limits<double>::infinity();
  for (const Row &row : m_rows) {
    for (const Candidate &candidate : row.candidates) {
      least = std::min(least, doubtOf(candidate));
    }
  }
  return std::max(0.0, m_highest - m_lowest) / least + 1;
}

//! From a row's duty to the nearest other one of the set.
double vpFrequencyRows::roomAcross(unsigned int set, size_t row) const
{
  double room = std::numeric_limits<double>::infinity();
  for (size_t other = 0; other < m_rows.size(); ++other) {
    if (other != row && (set >> other & 1) == 1) {
      room = std::min(room, std::abs(m_rows[other].duty - m_rows[row].duty));
    }
  }
  return room;
}

std::vector<vpModulation> vpFrequencyRows::filled(unsigned int set, double alongFrequency,
                                                  double acrossDuty) const
{
  std::vector<vpModulation> lamps;
  for (size_t i = 0; i < m_rows.size(); ++i) {
    if ((set >> i & 1) == 0) {
      continue;
    }
    const double room = roomAcross(set, i);
    std::vector<std::pair<double, const Candidate *>> byEnd;
    for (const Candidate &candidate : m_rows[i].candidates) {
      if (candidate.dutyDoubt * acrossDuty <= room) {
        byEnd.emplace_back(candidate.frequency + 0.5 * alongFrequency * doubtOf(candidate), &candidate);
      }
    }
    std::sort(byEnd.begin(), byEnd.end());
    double taken = -std::numeric_limits<double>::infinity();
    for (const auto &[end, candidate] : byEnd) {
      if (candidate->frequency - 0.5 * alongFrequency * doubtOf(*candidate) >= taken) {
        lamps.push_back(vpPwmLamp(candidate->frequency, m_rows[i].duty));
        taken = end;
      }
    }
  }
  return lamps;
}

END_VISP_NAMESPACE
