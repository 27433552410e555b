/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLedIdPlanner_h
#define vpLedIdPlanner_h

#include <limits>
#include <string>
#include <vector>

#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpModulation.h>
#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_identification/vpStripePrediction.h>

BEGIN_VISP_NAMESPACE

//! Identifiers of one frequency and duty each, and how well they stay apart.
struct VISP_EXPORT vpLedIdPlan {
  std::vector<vpModulation> identifiers; // pwm, ascending in frequency
  //! Least distance of two of them in standard deviations (vpLedIdPlanner); infinite with fewer than two.
  double separation = std::numeric_limits<double>::infinity();
  double error = 0;      // of the worst: probability that another one is nearer to what is measured
  double acceptance = 1; // of the worst: probability that the recogniser gives its id
};

//! How the words of a plan look: a header that marks where they begin, and bits of their own.
struct VISP_EXPORT vpWordScheme {
  std::string header = "011110"; // '0' and '1'; of Guan's group, JLT 2021
  unsigned int bits = 14;        // of the whole word
  double chipRate = 8000;        // Hz
  vpModulation::Code code = vpModulation::Code::manchester;
  unsigned int minDistance = 2; // chips in which any two words differ at least, however they are turned
};

//! Words that stay apart, and how well.
struct VISP_EXPORT vpWordPlan {
  std::vector<vpModulation> words;
  unsigned int distance = 0; // chips, the least Hamming distance of two words over all rotations; 0: one word
  double repetitions = 0;    // of a word that the lamp shows
  double linesPerChip = 0;   // of the delivered picture
  double error = 0;          // of the worst: probability that another one is nearer
  std::string refusal;       // why there are no words; empty where there are
};

//! How easily two identifiers of a map are taken for each other.
struct VISP_EXPORT vpLedIdPair {
  size_t first = 0, second = 0; // indices into vpLampMap::identifiers()
  double distance = 0;          // standard deviations, at the phase against the lines with most edges in gaps
  double error = 0; // probability that one is nearer to what is measured of the other, at any phase
  int chips = -1;   // of two words of equal length: least Hamming distance over rotations
};

//! Lamps that share an identifier.
struct VISP_EXPORT vpLedIdReuse {
  size_t identifier = 0;        // index into vpLampMap::identifiers()
  size_t first = 0, second = 0; // the two nearest of its lamps, indices into vpLampMap::lamps
  double apart = 0;             // m, between these two
};

/*!
  Which frequencies and duties lamps should have so that a rig tells them apart, how many it can hold, and
  which lamps of a map it will confuse.

  Distances. Measured features of a lamp scatter about those of the map with the standard deviations of
  vpStripePrediction. The recogniser compares a measurement with all lamps, by that measurement's own standard
  deviations. So the distance of two lamps is that of their features in units of the larger of their two
  standard deviations, all features together: d^2 = sum ((x1 - x2) / max(s1, s2))^2. A measurement is nearer
  to the wrong one of the two with probability Q(d / 2), Q the upper tail of the normal distribution; of a
  lamp with several neighbours the sum of these is a bound.

  Error. Of neighbours on both sides, 2 Q(d / 2) <= maxError: d >= 6.6 for 1 in 1000.

  Acceptance. vpLedIdRecognizer's gates refuse 2 Q(gate) + 2 Q(shapeGate) whatever the neighbours, and it
  gives an id where its probability reaches c = minConfidence. With a neighbour at d, a measurement that is e
  off towards it leaves odds of exp(d (d - 2 e) / 2), enough up to e = d / 2 - ln(c / (1 - c)) / d. So a share
  of 2 Q(e) is refused beside what the gates refuse, and to accept `minAcceptance` takes
  d >= t + sqrt(t^2 + 2 ln(c / (1 - c))), 2 Q(t) being what is left to refuse: 7.4 for 99.5 %. The gates of
  two neighbours may overlap: between them the odds decide, not the gates.

  Where several duties are used, neighbours in frequency get nine tenths of the error and neighbours in duty
  one tenth, or less where that is not enough: frequencies are the scarce resource. Of each duty the longest
  chain of frequencies is taken in which neighbours are far enough apart, which leaves out those at which
  edges fall between exposures (vpStripePrediction::hiddenEdges()).
*/
class VISP_EXPORT vpLedIdPlanner
{
public:
  vpStripePrediction prediction;
  double maxError = 1e-3;                       // probability of a wrong id, of each lamp
  double minAcceptance = 0.995;                 // probability of any id, of each lamp
  double minConfidence = 0.99;                  // as vpLedIdRecognizer::minConfidence
  double gate = 3;                              // standard deviations that vpLedIdRecognizer's two gates on
                                                // the frequency leave, about
  double shapeGate = 4;                         // standard deviations, as vpLedIdRecognizer's
  std::vector<double> duties = {0.2, 0.5, 0.8}; // that lamps may have, at most 8
  //! Hz; NaN: that of `leastStripes` on the lamp, yet at least `flicker`.
  double lowestFrequency = std::numeric_limits<double>::quiet_NaN();
  //! Hz, cut at the fold; NaN: the lower one of where the exposure leaves `leastContrast`, and `foldShare` of
  //! the fold.
  double highestFrequency = std::numeric_limits<double>::quiet_NaN();
  double leastStripes = 3;
  static constexpr double visibleFlicker = 500; // Hz, up to which people may see it, where eye or lamp moves
  double flicker = visibleFlicker;
  double leastContrast = 0.2;
  double foldShare = 0.9;
  double frequencyStep =
      1;            // Hz: frequencies are multiples of this, or the nearest to them that `clock` makes
  double clock = 0; // Hz, of the lamps' timers: a period, or a chip, is a whole number of cycles; 0: any is

  //! \throw vpException (badValue) as vpStripePrediction.
  explicit vpLedIdPlanner(const vpVlpRig &rig) : prediction(rig), m_cameraHeight(rig.bMc[2][3]) {}

  //! Range of frequencies (Hz) for lamps of so many lines; it may be empty, lowest above highest.
  double lowest(double lines) const;
  double highest() const;

  //! The rate (Hz, of periods or chips) nearest to \e rate that the clock makes, to the millihertz.
  double made(double rate) const;

  //! Distance (standard deviations) that neighbours need who may cause so great a share of error and refusal.
  double neededDistance(double share = 1) const;

  //! Share of lamps that the recogniser's gates refuse, whatever their neighbours.
  double refusedByGates() const;

  /*!
    As many identifiers as the rig holds, for lamps of so many lines (the smallest that has to be told) whose
    clocks have this standard deviation. Empty where the range of frequencies is.
    \throw vpException (badValue) where a setting is out of its range.
  */
  vpLedIdPlan largest(double lines, double oscillatorPpm) const;

  //! How many these are, for clocks of several kinds.
  std::vector<size_t> capacities(double lines, const std::vector<double> &oscillatorsPpm) const;

  //! How many frequencies a count of stripes or the bins of an FFT tell apart in the same range: 1 / (N T_r)
  //! from one to the next. As in Xie, Guan et al. 2018, for comparison.
  size_t bins(double lines) const;

  /*!
    So many identifiers, as far apart as they can be: the least distance is as large as rows of the duties, or
    of some of them, allow. More than largest() has are nearer to each other than asked for, and fewer than
    asked for come back where even the steps of frequency do not hold them.
  */
  vpLedIdPlan spread(double lines, double oscillatorPpm, size_t count) const;

  //! Distances, error and acceptance of given identifiers, all pwm.
  vpLedIdPlan judged(std::vector<vpModulation> identifiers, double lines, double oscillatorPpm) const;

  /*!
    As many words as a greedy choice in ascending order finds, for lamps of so many lines. The header's chips
    stand at one rotation of a word alone, and the lamp shows a whole word. Two words that differ in D chips
    at their nearest rotations are at a distance of 2 (A / sigma) |sinc(r T_e / 2)| sqrt(n D), r the chip rate
    and n the lines that see each chip, in all repetitions; `error` sums Q of half of it over all words and
    rotations. \throw vpException (badValue) where the format is out of its range.
  */
  vpWordPlan words(double lines, const vpWordScheme &format) const;

  /*!
    All pairs of identifiers of a map that could be taken for each other, the likeliest first; pwm, twoPulse
    and word are told apart by their shape, and words of different length too, so no pair has one of each.
    Every identifier is judged on its lamp of the fewest lines. \param height m of all lamps above the camera;
    NaN: of each by its own z, the robot standing on z = 0. \param size m, of lamps whose map entry has none.
    \throw vpException (badValue) where a lamp has no size, or hangs below the camera.
  */
  std::vector<vpLedIdPair> confusion(const vpLampMap &map,
                                     double height = std::numeric_limits<double>::quiet_NaN(),
                                     double size = std::numeric_limits<double>::quiet_NaN()) const;

  //! Identifiers of two lamps or more, those whose lamps hang nearest to each other first.
  static std::vector<vpLedIdReuse> reuse(const vpLampMap &map);

private:
  double linesOf(const vpLamp &lamp, double height, double size) const;
  void checkSettings() const;

  double m_cameraHeight; // m above the floor
};

END_VISP_NAMESPACE

#endif
