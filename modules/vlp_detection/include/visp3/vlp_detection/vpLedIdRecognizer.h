/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLedIdRecognizer_h
#define vpLedIdRecognizer_h

#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpLampObservation.h>
#include <visp3/vlp_core/vpRollingShutter.h>

BEGIN_VISP_NAMESPACE

/*!
  LED-ID recognition: which lamp of the map has these stripes.

  The paper compares features with a database; here the comparison is a statistical distance. Each lamp of the
  map predicts frequency, duty and phase difference; the squared distance d^2 to what was measured is a
  chi-square under every stated doubt: the estimate's own, the row time's (common to all frequencies), the
  lamp's oscillator, and what exposure and saturation do to a duty. A lamp within `gate` is a candidate; the
  likelihoods of all candidates, and that of a lamp that the map does not know (a uniform one over all
  frequencies and duties), give the probability of each. An id is given where one candidate has at least
  `minConfidence`.
*/
class VISP_EXPORT vpLedIdRecognizer
{
public:
  double gate = 4;                // standard deviations, on each feature and on all together
  double minConfidence = 0.95;    // probability below which no id is given
  double maxFrequencyDoubt = 0.1; // share of the frequency: less certain stripes are recognised as nothing
  double dutyError = 0.03;        // systematic error of a measured duty, standard deviation
  double phaseError = 0.01;       // of a measured phase difference, periods
  double unknownPrior = 0.01;     // prior probability that a blinking region is none of the map's lamps

  vpLedIdRecognizer(const vpLampMap &map, const vpRollingShutter &shutter);

  //! Sets id, confidence and remark of \e observation from its features.
  void recognize(vpLampObservation &observation) const;

private:
  struct Match {
    const vpLamp *lamp;
    double likelihood; // density over frequency (Hz), duty and phase difference (periods)
  };
  std::vector<Match> candidates(const vpLampObservation &observation) const;

  vpLampMap m_map;
  double m_relativeRowTime = 0; // standard deviation of the row time as a share of it
};

END_VISP_NAMESPACE

#endif
