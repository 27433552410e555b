/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpModulation_h
#define vpModulation_h

#include <complex>
#include <optional>
#include <string>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  How a lamp blinks: its light power over time, 1 while lit and 0 while dark.

  - pwm: one pulse per period 1/frequency, lit for the share `duty` of it (the paper's PWM-OOK).
  - twoPulse: two equal pulses per period, the second starting `phaseDifference` periods after the first;
  `duty` is the lit share of the whole period. The paper names a "phase difference coefficient" and defines
  none; lamp and camera share no clock, so only a phase relative to the lamp itself can carry information.
  This definition is ours. 0 < phaseDifference < 0.5: two equal pulses make k and 1 - k the same signal, and k
  = 0.5 is a plain lamp of twice the frequency.
  - word: the chips of `bits` over and over at `chipRate`, each bit one chip (ook) or two (manchester: 1 is
    lit-dark, 0 is dark-lit).
  - unmodulated: always lit.
*/
struct VISP_EXPORT vpModulation {
  enum class Kind { unmodulated, pwm, twoPulse, word };
  enum class Code { ook, manchester };

  Kind kind = Kind::unmodulated;
  double frequency = 0;         // Hz, repetition rate of pwm and twoPulse
  std::optional<double> duty;   // in (0, 1); unset: not measured, and not used in recognition
  double phaseDifference = 0;   // periods, twoPulse only
  std::string bits;             // '0' and '1', word only
  double chipRate = 0;          // Hz, word only
  Code code = Code::manchester; // word only

  //! Chips of one repetition of a word, '1' lit; empty for the other kinds.
  std::string chips() const;

  //! Rate at which the signal repeats, Hz; 0 for an unmodulated lamp.
  double repetitionFrequency() const;

  //! Whether both lamps emit the same light but for a shift in time: words that are rotations of each other
  //! do.
  bool sameSignal(const vpModulation &other) const;

  //! Whether chips are those of one word, wherever it begins.
  static bool sameWord(const std::string &chips, const std::string &others);

  /*!
    Fourier coefficient c_k of the light power p(t) = sum over all k of c_k exp(2 i pi k f t), with f the
    repetition frequency and t = 0 at the start of the first pulse (of the first chip of a word). An unset
    duty counts as 0.5. c_0 is the mean power.
  */
  std::complex<double> harmonic(int k) const;
};

END_VISP_NAMESPACE

#endif
