/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpFrequencyRows_h
#define vpFrequencyRows_h

#include <vector>

#include <visp3/vlp_identification/vpLedIdPlanner.h>

BEGIN_VISP_NAMESPACE

/*!
  Lamps in rows of one duty each, along the frequencies, as many as there is room for: frequencies of a
  large sigma, where edges hide, are passed over.
*/
class vpFrequencyRows
{
public:
  //! For lamps of perfect clocks until setOscillator() says otherwise.
  vpFrequencyRows(const vpLedIdPlanner &planner, double lines);
  void setOscillator(double ppm) { m_oscillatorPpm = ppm; }

  //! The rows that a set of duties may take: of duty i where bit i is set.
  unsigned int sets() const { return 1u << m_rows.size(); }
  static bool several(unsigned int set) { return (set & (set - 1)) != 0; }

  /*!
    As many lamps as there is room for, neighbours of a row so many standard deviations of frequency apart,
    and those of different rows so many of duty: a lamp whose duty is less certain than that is left out.
  */
  std::vector<vpModulation> filled(unsigned int set, double alongFrequency, double acrossDuty) const;

  //! A distance at which no row holds more than one lamp.
  double widest() const;

private:
  struct Candidate {
    double frequency, frequencySigma, dutySigma; // clocks perfect
  };
  struct Row {
    double duty;
    std::vector<Candidate> candidates; // ascending in frequency
  };
  Row rowOf(const vpLedIdPlanner &planner, double duty, double lines) const;
  double sigmaOf(const Candidate &candidate) const;
  std::vector<double> longestChain(const std::vector<Candidate> &candidates, double distance) const;
  double roomAcross(unsigned int set, size_t row) const;

  double m_lowest, m_highest; // Hz
  double m_oscillatorPpm = 0;
  std::vector<Row> m_rows;
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
