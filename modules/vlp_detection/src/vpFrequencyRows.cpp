/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpFrequencyRows.h"

#include <algorithm>
#include <cmath>
#include <limits>

BEGIN_VISP_NAMESPACE

vpFrequencyRows::vpFrequencyRows(const vpLedIdPlanner &planner, double lines, double oscillatorPpm)
    : m_planner(planner), m_lines(lines), m_oscillatorPpm(oscillatorPpm), m_lowest(planner.lowest(lines)),
      m_highest(planner.highest())
{
  std::vector<double> duties = planner.duties;
  std::sort(duties.begin(), duties.end());
  std::stable_sort(duties.begin(), duties.end(),
                   [](double a, double b) { return std::abs(a - 0.5) < std::abs(b - 0.5); });
  for (const double duty : duties) {
    Row row{duty, {}};
    for (int cell = 0; cell < cells && m_lowest <= m_highest; ++cell) {
      row.dutyDoubt.push_back(largestDutyDoubt(duty, end(cell), end(cell + 1)));
    }
    m_rows.push_back(row);
  }
}

/*!
  Between two frequencies. Pulse and exposure of one length make a triangle in the stripes, whose sides do not say
  which of the two grows: a peak of doubt, narrow as a rule. Gap and exposure do the same.
*/
double vpFrequencyRows::largestDutyDoubt(double duty, double low, double high) const
{
  const double exposure = m_planner.prediction.exposure();
  double largest = 0;
  for (const double f : {low, high, duty / exposure, (1 - duty) / exposure}) {
    if (f >= low && f <= high) {
      largest =
          std::max(largest, m_planner.prediction.doubt(vpPwmLamp(f, duty), m_lines, m_oscillatorPpm).duty);
    }
  }
  return largest;
}

double vpFrequencyRows::doubt(const Row &row, double frequency) const
{
  return m_planner.prediction.frequencyDoubt(vpPwmLamp(frequency, row.duty), m_lines, m_oscillatorPpm);
}

double vpFrequencyRows::widest() const
{
  double least = std::numeric_limits<double>::infinity();
  for (const Row &row : m_rows) {
    least = std::min(least, doubt(row, m_lowest)); // it grows with frequency
  }
  return (m_highest - m_lowest) / least + 1;
}

//! The lowest frequency above that is at the distance; above all where none is.
double vpFrequencyRows::next(const Row &row, double frequency, double distance) const
{
  const double here = doubt(row, frequency);
  double to = frequency + distance * here;
  for (int i = 0; i < 100 && to <= m_highest; ++i) {
    const double before = to;
    to = frequency + 0.5 * distance * (here + doubt(row, to));
    if (std::abs(to - before) < 1e-9 * to) {
      break;
    }
  }
  return to;
}

//! Where lamps of each row may be, cell by cell.
std::vector<std::vector<bool>> vpFrequencyRows::open(unsigned int set, double acrossDuty) const
{
  std::vector<std::vector<bool>> open(m_rows.size(), std::vector<bool>(cells, false));
  for (size_t i = 0; i < m_rows.size(); ++i) {
    for (size_t cell = 0; cell < cells && (set >> i & 1) == 1; ++cell) {
      open[i][cell] = true;
      for (size_t j = 0; j < i; ++j) {
        const double mean = 0.5 * (m_rows[i].dutyDoubt[cell] + m_rows[j].dutyDoubt[cell]);
        const bool near = std::abs(m_rows[i].duty - m_rows[j].duty) < acrossDuty * mean;
        open[i][cell] = open[i][cell] && !(open[j][cell] && near);
      }
    }
  }
  return open;
}

std::vector<vpModulation> vpFrequencyRows::filled(unsigned int set, double alongFrequency,
                                                  double acrossDuty) const
{
  std::vector<vpModulation> lamps;
  if (m_lowest > m_highest) {
    return lamps;
  }
  const std::vector<std::vector<bool>> isOpen = open(set, acrossDuty);
  const double step = m_planner.frequencyStep, rounding = 1e-9;
  const auto rounded = [&](double f) { return std::ceil(f / step - rounding) * step; };
  for (size_t i = 0; i < m_rows.size(); ++i) {
    const double width = (m_highest - m_lowest) / cells;
    for (double f = rounded(m_lowest); f <= m_highest * (1 + rounding);) {
      const int cell = width > 0 ? std::min(cells - 1, static_cast<int>((f - m_lowest) / width)) : 0;
      if (isOpen[i][static_cast<size_t>(std::max(0, cell))]) {
        lamps.push_back(vpPwmLamp(f, m_rows[i].duty));
        f = std::max(rounded(next(m_rows[i], f, alongFrequency)), rounded(f + step));
      } else {
        f = std::max(rounded(end(cell + 1)), rounded(f + step));
      }
    }
  }
  return lamps;
}

END_VISP_NAMESPACE
