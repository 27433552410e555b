/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpStripeAnalyzer_h
#define vpStripeAnalyzer_h

#include <limits>
#include <vector>

#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpLampObservation.h>
#include <visp3/vlp_core/vpRollingShutter.h>
#include <visp3/vlp_detection/vpOutlineFitter.h>

BEGIN_VISP_NAMESPACE

//! The light of one lamp, line by line.
struct VISP_EXPORT vpStripeProfile {
  std::vector<double> time;    // s, middle of each line's exposure, after the start of the frame
  std::vector<double> light;   // grey levels above the lamp's surroundings
  std::vector<double> sigma;   // grey levels, of light by pixel noise
  double exposure = 0;         // s, of each line, averaging by a resize included
  double logExposureSigma = 0; // standard deviation of its logarithm, as the rig states it
  double white = std::numeric_limits<double>::infinity(); // grey levels of light where the grey scale ends
  double agreement = 1; // correlation, over the lines, of their left and right halves

  //! Whether lit lines are as bright as the grey scale ends.
  bool isClipped() const;
  //! Standard deviation of the logarithm of the exposure that the edges of its stripes show: of a clipped
  //! lamp these are steeper.
  double logEdgeSigma() const;
  //! Of the stripes, 0 to 1, but for the darkest and the brightest twentieth of the lines; 0 of no lines.
  double depth() const;

  /*!
    Profile inside an outline (in samples and lines, as the fitter gives it): the mean of each line's samples.
    However an emitter's light is spread, it makes the stripes' envelope, which the waveform's fit finds.
    Samples count that lie wholly inside, of a quadrilateral in lines from the first to the last lit one of
    \e roi: its sides along the lines are hardly seen. Of a lamp with a soft edge only the middle strip
    counts, where its glow is even; where there is no outline, most of the hull of the region's chords.
    Where the grey scale's bright end clips samples, a line's dimmest ones tell its light: a quantile commutes
    with clipping, a mean does not. Where it clips all of a line, means are taken. Cut off at white, stripes
    are those of a lamp as bright as white under a shorter exposure. The surroundings are no brighter than the
    lamp's darkest lines.
  */
  static vpStripeProfile along(const cv::Mat_<unsigned char> &lines, const vpLineTiming &timing,
                               const vpOutlineFit &fit, const vpLedRoi &roi);

  /*!
    The same of a luminaire of any emission pattern: a pixel is S(u, v) m(v), S any positive pattern, m the
    modulation. Strips of a few columns inside the outline, or in the region's box where that has none, tell
    both by turns: S of each strip as a random walk along the lines, m of each line from the S that all
    other lines predict there. Patches, glare and clipped columns are outliers of a few strips. Where all
    strips change alike while the lamp is lit, S and m cannot be separated, and all is taken for m. Less
    certain than along() where the emitter is even. \return As if a lit line had 100 grey levels; lines that
    tell nothing are left out.
  */
  static vpStripeProfile agreedByColumns(const cv::Mat_<unsigned char> &lines, const vpLineTiming &timing,
                                         const vpOutlineFit &fit, const vpLedRoi &roi);
};

//! How the words of a map's lamps are sent: what is known of a word before its chips are.
struct VISP_EXPORT vpWordFormat {
  size_t chips = 0;     // of one repetition
  double chipRate = 0;  // Hz
  double tolerance = 0; // of the chip rate as the camera sees it, standard deviation as a share of it
};

/*!
  Features of the stripes: maximum likelihood over the line profile, and the posterior about it.

  A lamp's light on the line exposed about t is o + E(y) S(t): the waveform averaged over the exposure, which
  weighs harmonic k by sinc(k f T_e), times the emitter's envelope along the lines. Starts come from the edges
  of the stripes where they show, and from a periodogram. Least squares then fits frequency, phase, duty,
  exposure, offset and envelope together; mean and standard deviation are those of the posterior, which is no
  bell where lines leave gaps between their exposures. The exposure has the rig's value as prior, since blur
  and a phone's tone curve soften the edges as well. The variance of a line is that of its pixels plus shares
  of its light and of its neighbours', for all that the model leaves out.

  Where one or two pulses a period leave too much unexplained, the lamp may send a word: chips of equal
  duration, lit or dark, over and over. A line's light is then its share of lit chips, and the likeliest of
  all words comes from dynamic programming over the chips that neighbouring lines share (Viterbi 1967), for
  each phase and duration of a chip on a grid, both refined by least squares. A word of the map's formats
  (`words`) has to be seen once from end to end; any other so long that its repetition is no chance (1.3
  times, and 16 chips twice, 21 of a Manchester code). Its probability weighs it against all words that differ
  in a chip, each fitted anew.
*/
class VISP_EXPORT vpStripeAnalyzer
{
public:
  double modelError = 0.03; // share of a line's light that the model may be off by, standard deviation
  //! How far one lamp's exposure is off the camera's, beyond what the profile states of that: standard
  //! deviation of its logarithm.
  double exposureTolerance = 0.02;
  //! Share of the stripes' power that a pwm or twoPulse lamp may leave unexplained. Known values: pwm lamps
  //! of phones leave up to 0.09, coded lamps seen for less than a word from 0.165 on.
  double maxMisfit = 0.13;
  double minAgreement = 0.85;     // of the halves of lines: the shutter's stripes do not vary along a line
  double minModulation = 0.05;    // depth of stripes below which a lamp counts as unmodulated
  bool searchUnknownWords = true; // of formats that are not in `words`: a search of tenths of a second
  bool searchTwoPulses = true;    // off where no lamp of the map is one: a search of tens of milliseconds
  double minFrequency = 0;        // Hz: light that changes slower is no lamp's
  double minSignificance = 30;    // gain in chi-square by which a sinusoid has to beat a plain lamp

  double minWordConfidence = 0.99; // probability that all chips of a word are right below which none is given
  std::vector<vpWordFormat> words; // that the map's lamps send; other formats need more repetitions

  //! Whether there are stripes, before anything is fitted to them: one alone has the light's own shape.
  bool blinks(const vpStripeProfile &profile) const;

  //! Signal, frequency, duty, phase difference, chips, stripes, modulation, misfit; area is left to the
  //! caller.
  vpStripeFeatures analyze(const vpStripeProfile &profile) const;
};

END_VISP_NAMESPACE

#endif
