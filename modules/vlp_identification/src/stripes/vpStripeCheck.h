/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpStripeCheck_h
#define vpStripeCheck_h

#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_core/vpLampObservation.h>
#include <visp3/vlp_identification/vpStripeAnalyzer.h>

#include "waveform/vpPulseWave.h"

BEGIN_VISP_NAMESPACE

/*!
  Whether a profile shows the stripes that a lamp of known frequency, duty and exposure would: least squares
  of its phase, of the frequency's change, and of offset and envelope, a parabola. So much less is open than
  to vpStripeAnalyzer that a few steps do, in a fiftieth of the time. What it finds is a check, no estimate:
  an edge that lies between two exposures holds it where it began.
*/
class vpStripeCheck
{
public:
  double misfit = 1;      // share of the stripes' power left unexplained, beyond what noise explains
  double change = 0;      // Hz, of the frequency
  double changeSigma = 0; // Hz
  double amplitude = 0;   // grey levels, in the middle of the profile

  //! \return False where there is nothing to compare: few lines, no stripes.
  bool compare(const vpStripeProfile &profile, const vpStripeFeatures &known);

private:
  static constexpr int linear = 4, all = 6; // offset, envelope; phase, frequency
  using Vector = Eigen::Matrix<double, all, 1>;
  using Matrix = Eigen::Matrix<double, all, all>;

  void solve(double frequency, double phase, double width, double duty, int unknowns);

  //! One value a line each; the columns of the equations from there on.
  enum Part {
    time,
    light,
    weight,
    envelope,
    weighted,
    value,
    byTurn,
    byWidth,
    byDuty,
    columns,
    parts = columns + all
  };
  using Array = Eigen::Map<Eigen::ArrayXd>;
  Array part(int which) { return {m_memory.data() + which * m_lines, m_lines}; }

  std::vector<double> m_memory; // of all parts, kept from profile to profile
  Eigen::Index m_lines = 0;
  double m_half = 1; // s
  Vector m_solution;
  Matrix m_normal;
};

END_VISP_NAMESPACE

#endif
