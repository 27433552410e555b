/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpWordSearch_h
#define vpWordSearch_h

#include <optional>
#include <vector>

#include "vpWordFit.h"

BEGIN_VISP_NAMESPACE

//! Which word a profile shows: of a format that is known, or of any.
class vpWordSearch
{
public:
  struct Found {
    vpWordFit::Word word;
    double confidence = 0;    // probability that all chips are right
    double durationSigma = 0; // of a chip, as a share of it
    double inflation = 1;     // chi-square per degree of freedom
  };

  //! \param envelope As vpWordFit's.
  vpWordSearch(const vpStripeProfile &profile, const vpWordFit::Settings &settings,
               const std::vector<double> &envelope)
      : m_profile(&profile), m_settings(settings), m_envelope(envelope)
  {
  }

  /*!
    The best word of any of the formats that the profile shows once or more. \param misfit Share of the
    stripes' power that a word may leave unexplained.
  */
  std::optional<Found> known(const std::vector<vpWordFormat> &formats, double misfit) const;

  /*!
    A word of unknown length and rate. First the chips as if they never repeated, which gives their duration;
    then each number of chips that the profile shows clearly more than once. A repetition counts where it is
    a thousand times likelier than chips that agree by chance; of several, the shortest that explains.
  */
  std::optional<Found> blind(double misfit) const;

  //! Whether chips are one pulse over and over, as pwm is.
  static bool singlePulse(const std::vector<char> &chips);

private:
  double shortRun() const;
  vpStripeProfile middle(double span, std::vector<double> &envelope) const;

  const vpStripeProfile *m_profile;
  vpWordFit::Settings m_settings;
  std::vector<double> m_envelope;
};

END_VISP_NAMESPACE

#endif
