/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpFrequencyRows_h
#define vpFrequencyRows_h

#include <vector>

#include <visp3/vlp_detection/vpLedIdPlanner.h>

BEGIN_VISP_NAMESPACE

/*!
  Lamps in rows of one duty each, along the frequencies. Where two duties are too near for the doubt at some
  frequency, as where an exposure is about as long as a pulse, the one farther from 0.5 has no lamps there.
*/
class vpFrequencyRows
{
public:
  vpFrequencyRows(const vpLedIdPlanner &planner, double lines, double oscillatorPpm);

  //! The rows that a set of duties may take: of duty i, counted from that nearest to 0.5, where bit i is set.
  unsigned int sets() const { return 1u << m_rows.size(); }
  static bool several(unsigned int set) { return (set & (set - 1)) != 0; }

  //! Each row from the lowest frequency upwards, neighbours so many standard deviations apart.
  std::vector<vpModulation> filled(unsigned int set, double alongFrequency, double acrossDuty) const;

  //! A distance at which no row holds more than one lamp.
  double widest() const;

private:
  struct Row {
    double duty;
    std::vector<double> dutyDoubt; // largest in each cell
  };
  double largestDutyDoubt(double duty, double low, double high) const;
  double next(const Row &row, double frequency, double distance) const;
  std::vector<std::vector<bool>> open(unsigned int set, double acrossDuty) const;
  double doubt(const Row &row, double frequency) const;
  double end(int cell) const { return m_lowest + (m_highest - m_lowest) * cell / cells; }

  static constexpr int cells = 60; // of frequency, within which doubt of the duty changes little

  const vpLedIdPlanner &m_planner;
  double m_lines, m_oscillatorPpm;
  double m_lowest, m_highest; // Hz
  std::vector<Row> m_rows;    // that nearest to 0.5 first
};

//! A pwm lamp.
inline vpModulation vpPwmLamp(double frequency, double duty)
{
  vpModulation modulation;
  modulation.kind = vpModulation::Kind::pwm;
  modulation.frequency = frequency;
  modulation.duty = duty;
  return modulation;
}

END_VISP_NAMESPACE

#endif
