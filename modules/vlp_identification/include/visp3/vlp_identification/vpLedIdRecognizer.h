/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLedIdRecognizer_h
#define vpLedIdRecognizer_h

#include <string>
#include <vector>

#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpLampObservation.h>
#include <visp3/vlp_core/vpRollingShutter.h>

BEGIN_VISP_NAMESPACE

//! Error of the row time, estimated from the lamps of one frame.
struct VISP_EXPORT vpRowTimeError {
  double mean = 0;  // true row time over the stated one, minus 1
  double sigma = 0; // its standard deviation; the stated one's where no lamp improves it
};

/*!
  LED-ID recognition: which lamp of the map has these stripes.

  The paper compares features with a database; here every identifier of the map predicts frequency, duty and
  phase difference, or a word and its rate, and Bayes' rule compares the map's identifiers with each other and
  with a lamp that the map does not know (of any frequency, duty, phase difference or word alike).

  Frequencies are measured in row times, whose relative error is common to all lamps in view. With it as d,
  lamp a of frequency f_a is seen at f_a (1 + d) + e, e being the estimate's own error and the oscillator's.
  The frame's evidence about d is p(d) times the product over its lamps of sum_a p(a) t(f - f_a (1 + d); e);
  each lamp is judged by the posterior of d given all others, integrated on a grid. So two lamps of a rig
  whose row time is known to 1 % calibrate it for each other. t is Student's distribution of four degrees of
  freedom (Lange, Little and Taylor 1989): one estimate that is farther off than it says decides nothing.

  An identifier that lies within `gate` standard deviations in frequency, and `shapeGate` in duty and phase
  difference, is a candidate. Near simple fractions of the rate of lines all edges may fall between exposures:
  the frequency is then less certain, and lamps that the map does not know may pass the gate. So the
  estimate's error is limited to `boundGate` times a bound: vpStripeFeatures::frequencyBound, or a wider one
  within which an unknown lamp lies with probability `maxChance`, as in maps of few lamps. A frequency whose
  sigma is more than `maxSpread` times the bound has no candidate.
  Where duty and frequency are known together only (vpStripeFeatures::alongDuty), each identifier is compared
  with the frequency that belongs to its own duty, and one that states none within `spreadGate` of all of
  them. Two pulses with a gap shorter than the exposure may be seen as one, of any duty from about theirs to
  about theirs and two gaps: such lamps compete for stripes that look like plain PWM.

  Where the map states a lamp's size, the outline must have the lamp's shape: a window that crossbars divide
  evenly shows stripes as a lamp does, but is no disc.

  A lamp has an outline, and its stripes explain most of the light inside. Where two lamps overlap, or
  the stripes are a neighbour's, they do not (`leastBlinking`).

  One that has at least `minConfidence` and a single lamp gives the id. Between several lamps of one
  identifier, or several candidates, geometry decides: `candidates` lists them.
*/
class VISP_EXPORT vpLedIdRecognizer
{
public:
  double gate = 3.5;               // standard deviations, on the frequency
  double boundGate = 2.1;          // times the bound, on the estimate's error
  double spreadGate = 1.2;         // standard deviations, on the frequency's range under an unstated duty
  double shapeGate = 4;            // standard deviations, on duty and phase difference
  double leastShape = 1e-3;        // probability of its shape below which a whole outline is another lamp's
  double leastBlinking = 0.6;      // of the light in an outline, that its lamp's stripes have to explain
  double minConfidence = 0.99;     // probability below which no id is given
  double maxFrequencySigma = 0.03; // share of the frequency: less certain stripes are recognised as nothing
  double maxSpread = 4;            // frequencySigma over that bound, above which there is no id
  double maxChance = 0.005;        // probability of an unknown lamp within the bounds of any of the map's
  double dutyError = 0.03;         // systematic error of a measured duty, standard deviation
  double phaseError = 0.01;        // of a measured phase difference, periods
  double unknownPrior = 0.001;     // prior probability that a blinking region is none of the map's lamps

  vpLedIdRecognizer(const vpLampMap &map, const vpRollingShutter &shutter);

  //! Sets candidates, id, confidence and remark of all lamps seen in one frame from their features.
  vpRowTimeError recognize(std::vector<vpLampObservation> &lamps) const;

  //! The same of one lamp alone.
  void recognize(vpLampObservation &lamp) const;

  //! The identifiers of the map that candidates name.
  const std::vector<vpIdentifier> &identifiers() const { return m_identifiers; }

private:
  struct Candidate;
  struct Sight;

  void addCandidate(Sight &sight, const vpLampObservation &lamp, size_t identifier) const;
  Sight sightOf(const vpLampObservation &lamp) const;
  bool mayLookLike(const vpIdentifier &identifier, const vpLampObservation &lamp) const;
  std::string unreadable(const vpStripeFeatures &seen) const;
  double boundOf(const vpStripeFeatures &seen) const;
  std::vector<double> rowTimeErrors(const std::vector<Sight> &sights) const;
  void decide(vpLampObservation &lamp, const Sight &sight) const;

  vpLampMap m_map;
  double m_exposure; // s, of a line
  std::vector<vpIdentifier> m_identifiers;
  std::vector<size_t> m_byFrequency; // identifiers, the slowest first
  double m_relativeRowTime = 0;      // standard deviation of the row time as a share of it
};

END_VISP_NAMESPACE

#endif
