/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpWordFit_h
#define vpWordFit_h

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_identification/vpStripeAnalyzer.h>

#include "vpChipTrellis.h"

BEGIN_VISP_NAMESPACE

/*!
  A word of n chips, sent over and over, fitted to a profile:
    light of line i = offset + E(y) (r + b r (1 - r)),  r = min(1, g s),  s = sum over k of c_k w_ik,
  w_ik the share of the line's exposure that falls into the chips k, k + n, k + 2n ..., c_k 0 or 1, E the
  given envelope times a polynomial in y, the line scaled to [-1, 1] over the profile. The gain g >= 1 stands
  for saturation; the bend b for what else makes lines that see an edge lighter or darker than their share: a
  tone curve, an emitter that goes out more slowly than it comes on.

  All words are compared at once (vpChipTrellis) on a grid of phases and durations of a chip; the light's
  parameters are linear, and phase, duration, exposure and gain follow by Gauss and Newton's method, in turns
  with the chips until these stay.
*/
class vpWordFit
{
public:
  struct Settings {
    int envelopeOrder = 0; // up to 4
    double modelError = 0.03;
    double exposureTolerance = 0.5;
  };

  //! One word and how it is sent.
  struct Word {
    std::vector<char> chips;       // of one repetition, 1 lit
    double chip = 0;               // s, duration of one
    double phase = 0;              // chips: place in the word of the profile's middle
    double exposure = 0;           // s
    double gain = 1;               // of the light before saturation cuts it off
    std::array<double, 7> light{}; // offset, polynomial, bend; the latter two in envelopes
    double chiSquare = 0;          // of the profile and the exposure's prior
    double misfit = 1;             // share of the stripes' power left unexplained, beyond noise
  };

  //! \param envelope How bright the lamp is at each line while it is lit, about, grey levels.
  vpWordFit(const vpStripeProfile &profile, const Settings &settings, const std::vector<double> &envelope);

  //! The likeliest words of so many chips, the best first by cost(), of different chips each. \param chip s.
  //! \param tolerance Share of it, to either side. \param count Words to fit.
  std::vector<Word> words(size_t chips, double chip, double tolerance, size_t count) const;

  //! The likeliest words of fewest to most chips, sent as \e start is.
  std::vector<Word> repeating(const Word &start, size_t fewest, size_t most, size_t count) const;

  /*!
    The likeliest durations of a chip from \e shortest to \e longest s, whatever the chips: as words that the
    profile is too short to see repeat.
  */
  std::vector<Word> durations(double shortest, double longest, size_t count) const;

  /*!
    -2 log of likelihood and prior, but for a constant: N log(1 + chi^2/N) over N lines, which is chi-square
    where the noise explains it, and counts for little where all words leave more; and half a bit for each
    chip, as much as Manchester's code has.
  */
  double cost(const Word &word) const;

  //! Brings phase, duration, exposure, gain, light and chips of a word to the nearest minimum of chi-square.
  void refine(Word &word) const;

  //! Probability that all chips are right, given that the number of chips and their duration are.
  //! \param others Other words, refined; \param inflation of chi-square by what the model leaves out.
  double confidence(const Word &word, const std::vector<Word> &others, double inflation) const;

  //! Standard deviation of a chip's duration as a share of it.
  double durationSigma(const Word &word, double inflation) const;

  //! Chi-square per degree of freedom, at least 1.
  double inflation(const Word &word) const;

  double span() const { return 2 * m_half + m_exposure; } //!< s, of the exposures

  //! The greatest rotation of a word's chips as '0' and '1'.
  static std::string canonical(const std::vector<char> &chips);

private:
  static constexpr int nonlinear = 4; // phase, duration, exposure, gain
  using Place = Eigen::Matrix<double, nonlinear, 1>;
  using Curvature = Eigen::Matrix<double, nonlinear, nonlinear>;
  using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, nonlinear>;

  //! Light at each line by its coefficients, grey levels.
  struct Light {
    double offset;
    std::vector<double> envelope, bend;
  };
  Light lightOf(const Word &word) const;
  bool fill(vpChipTrellis &trellis, const Word &word, const Light &light, int window) const;
  static int window(const Word &word);
  double least(const Word &word, const Light &light, std::vector<char> *chips) const;
  double fitLight(Word &word, Eigen::VectorXd *residuals = nullptr) const;
  Eigen::Vector2d prior(const Word &word) const;
  Word moved(const Word &word, const Place &step) const;
  bool jacobian(const Word &word, double step, Eigen::VectorXd &residuals, Jacobian &J) const;
  void descend(Word &word) const;
  Word plain(size_t chips, double chip) const;
  void grid(const Word &about, std::vector<Word> &found) const;
  std::vector<Word> refined(std::vector<Word> &grid, size_t count) const;
  void measureMisfit(Word &word) const;

  const vpStripeProfile *m_profile;
  Settings m_settings;
  std::vector<double> m_weight; // 1 / variance of each line
  std::vector<double> m_given;  // envelope, grey levels
  std::vector<double> m_time;   // s, from the middle of the profile
  double m_dark = 0;            // light while dark, about
  int m_linear = 3;             // parameters of the light
  double m_middle = 0;          // s
  double m_half = 1;            // s
  double m_exposure = 0;        // s
};

END_VISP_NAMESPACE

#endif
