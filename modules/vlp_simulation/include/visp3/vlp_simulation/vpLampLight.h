/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampLight_h
#define vpLampLight_h

#include <utility>
#include <vector>

#include <visp3/vlp_core/vpModulation.h>

BEGIN_VISP_NAMESPACE

/*!
  The light that a lamp gives over time, integrated over an exposure in closed form. The lamp runs on a clock
  of its own: phase and rate are independent of all others.
*/
class VISP_EXPORT vpLampLight
{
public:
  //! What one exposure gets of it.
  struct Exposed {
    double share = 0;  // of the exposure during which the lamp is lit, 0 to 1
    double middle = 0; // s, mean time of that light; the exposure's middle where there is none
  };

  //! Always lit.
  vpLampLight() = default;

  /*!
    \param modulation An unset duty counts as 0.5. \param rate How fast its clock runs, 1 + error. \param
    phase Periods (of the whole word) that have passed at time 0. \throw vpException (badValue) where it
    repeats at no rate that a lamp has, or where its two pulses overlap.
  */
  explicit vpLampLight(const vpModulation &modulation, double rate = 1, double phase = 0);

  //! No light from \e from until \e to, s: a lamp that fails, is switched off, or replaced.
  void addDark(double from, double to);

  //! Light from time \e from until \e to, s, \e to after \e from.
  Exposed over(double from, double to) const;

private:
  void addLight(double from, double to, double sign, double pivot, double &sum, double &moment) const;

  double m_frequency = 0;                        // Hz, of repetition; 0: always lit
  double m_phase = 0;                            // periods
  std::vector<std::pair<double, double>> m_lit;  // stretches of one period
  std::vector<std::pair<double, double>> m_dark; // s
};

END_VISP_NAMESPACE

#endif
