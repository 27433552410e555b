/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpStripePrediction_h
#define vpStripePrediction_h

#include <utility>
#include <vector>

#include <visp3/vlp_core/vpModulation.h>
#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_identification/vpLedIdRecognizer.h>
#include <visp3/vlp_identification/vpStripeAnalyzer.h>

BEGIN_VISP_NAMESPACE

//! Standard deviations with which the recogniser compares a lamp's stripes with those that the map predicts.
struct VISP_EXPORT vpStripeUncertainty {
  double frequency = 0;       // Hz: estimate, row time and oscillator together
  double duty = 0;            // estimate and vpLedIdRecognizer::dutyError together
  double phaseDifference = 0; // periods, of two pulses; estimate and vpLedIdRecognizer::phaseError together
};

/*!
  How precisely a rig will measure the stripes of a lamp, predicted before the lamp is installed.

  A lamp of N lines, T_r apart on average, whose stripes have the amplitude A (half their swing) against the
  noise sigma of one line. The standard deviation of a sinusoid's frequency is at least

      sigma_f = (1 / (2 pi T_r)) sqrt(12 / (eta N (N^2 - 1))),   eta = A^2 / (2 sigma^2)

  (Cramer-Rao bound; Rife and Boorstyn 1974). A pulse of duty d has the fundamental (4 / pi) sin(pi d) A, and
  an exposure T_e weakens it by |sinc(f T_e)|. What vpStripeAnalyzer reaches lies below `margin` times that
  bound (tests/bench/stripes.md).
*/
class VISP_EXPORT vpStripePrediction
{
public:
  /*!
    dB, 20 log10(A / sigma): the stripes' amplitude without any blur against the noise of one line's mean. 20
    is careful: a lamp of 150 grey levels, 140 pixels wide, under a noise of 2 levels a pixel has 50.
  */
  double snrDb = 20;
  double margin = 1.3; // standard deviations of frequency and duty over their bounds
  //! Error of a line's light beyond noise, as a share of that light: as in the analyser's own sigmas.
  double modelError = vpStripeAnalyzer().modelError;
  //! Share of the exposure by which the rig's may be off. More than vpStripeAnalyzer assumes: a plan has to
  //! hold for cameras whose exposure is a line longer or shorter than stated.
  double exposureTolerance = 0.1;
  double dutyError = 0.03;  // as vpLedIdRecognizer::dutyError
  double phaseError = 0.01; // periods, as vpLedIdRecognizer::phaseError

  //! \throw vpException (badValue) where the rig has no row time, no focal length or no lines.
  explicit vpStripePrediction(const vpVlpRig &rig);

  //! Delivered lines across a lamp of that diameter or side (m), flat and upright, so far (m) above the
  //! camera along the optical axis; no more than the picture has.
  double lines(double size, double height) const;
  //! The way back: the height (m) at which such a lamp has so many lines.
  double height(double size, double lines) const;

  //! Mean time (s) between lines of the delivered picture.
  double lineTime() const { return m_lineTime; }
  //! Time (s) over which a line averages, that of an area resize included.
  double exposure() const { return m_exposure; }
  //! Lines of the delivered picture.
  double pictureLines() const { return static_cast<double>(m_middle.size()); }

  //! Share of a sinusoid's amplitude that the exposure leaves, |sinc(f T_e)|.
  double contrast(double frequency) const;
  //! Hz at which contrast() has fallen to that share, below its first zero; infinite without exposure.
  double frequencyOfContrast(double share) const;
  //! Half the rate of lines, Hz: from there on a frequency looks like a lower one.
  double fold() const { return 0.5 / m_lineTime; }

  //! The bound above, Hz, for a sinusoid of \e amplitude times A; no model error, no margin.
  double sinusoidBound(double lines, double amplitude = 1) const;

  //! Hz, standard deviation of a pwm's or twoPulse's frequency by the stripes alone, margin included.
  double frequencySigma(const vpModulation &modulation, double lines) const;

  /*!
    Error by edges that fall into gaps between the exposures of lines, as after a nearest-neighbour resize or
    with a short exposure. An edge in a gap may lie anywhere there. If the frequency is nearly a simple
    fraction of the rate of lines, all edges fall into gaps alike. Two edges of one kind, l periods apart,
    allow the period to change by as much as both have room, divided by l. The narrowest of these ranges is
    what the frequency may be off by; all of it is taken for a standard deviation, since the analyser's own
    ones reach that, and of all phases against the lines the worst. In Hz and periods.
  */
  vpStripeUncertainty hiddenEdges(const vpModulation &modulation, double lines) const;

  /*!
    Standard deviations of duty and phase difference by the stripes, no edge in a gap: from the Fisher
    information of frequency, phase, duty, exposure (known to `exposureTolerance` only), phase difference,
    offset and amplitude together, averaged over the phase. A pulse about as long as the exposure cannot be
    told from it by the stripes.
  */
  vpStripeUncertainty shapeSigma(const vpModulation &modulation, double lines) const;

  //! All of it together, with row time, oscillator (standard deviation in 1e-6 of the frequency) and the
  //! recogniser's own errors.
  vpStripeUncertainty uncertainty(const vpModulation &modulation, double lines, double oscillatorPpm) const;
  //! The same where \e shape is known, which changes slowly with frequency and takes longest.
  vpStripeUncertainty together(const vpModulation &modulation, double lines, double oscillatorPpm,
                               const vpStripeUncertainty &shape) const;

  //! Root mean square error of a line of the lamp, as a share of A: noise and model error.
  double lineNoise(double duty) const;

  //! Standard deviations of measurements at each of some phases of the lamp against the lines: hidden edges
  //! with a uniform distribution over their range there. Mostly far less than uncertainty(), which has
  //! the worst.
  std::vector<vpStripeUncertainty> scatter(const vpModulation &modulation, double lines,
                                           double oscillatorPpm) const;

private:
  vpStripeUncertainty hiddenEdgesAt(const vpModulation &modulation, double lines, int trial,
                                    double negligible) const;
  vpStripeUncertainty sum(const vpModulation &modulation, double lines, double oscillatorPpm,
                          const vpStripeUncertainty &shape, const vpStripeUncertainty &hidden) const;
  double takenForExposure(const vpModulation &modulation) const;
  std::pair<size_t, size_t> linesUnder(double lines, int trial) const;

  std::vector<double> m_middle; // s, of each delivered line's exposure, ascending
  double m_lineTime = 0;
  double m_logExposureSigma = 0;
  double m_exposure = 0;
  double m_relativeRowTime = 0; // standard deviation of the row time as a share of it
  double m_pixels = 0;          // px or py of the delivered picture, across the lines
};

END_VISP_NAMESPACE

#endif
