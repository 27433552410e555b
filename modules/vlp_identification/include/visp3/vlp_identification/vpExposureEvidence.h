/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpExposureEvidence_h
#define vpExposureEvidence_h

#include <array>
#include <vector>

#include <visp3/vlp_core/vpLampObservation.h>

BEGIN_VISP_NAMESPACE

/*!
  The exposure of the camera's lines, which all lamps of a frame and all frames of a run share.

  Its prior is what the rig states: the logarithm is normal about the stated one. A lamp's stripes are the
  pulse averaged over the exposure, two boxes that the stripes do not tell apart
  (vpStripeFeatures::duty and exposure may be exchanged). So one lamp leaves two exposures possible; lamps of
  several frequencies have only the true one in common. The posterior is a product over lamps of these
  mixtures, each with a share of lamps without information, on a grid.
*/
class VISP_EXPORT vpExposureEvidence
{
public:
  //! \param stated s. \param logSigma Standard deviation of its logarithm; 0: it is known.
  explicit vpExposureEvidence(double stated = 0, double logSigma = 0);

  //! Adds one lamp of one frame. Only stripes of one pulse a period count. \param before What was known of
  //! the exposure when they were read.
  void add(const vpStripeFeatures &seen, const vpExposureEvidence &before);

  double stated() const { return m_stated; }     // s
  double exposure() const { return m_exposure; } // s, by all that is known
  double logSigma() const { return m_logSigma; } // standard deviation of its logarithm
  //! Whether the stripes contradict what the rig states.
  bool contradicts() const;

private:
  void summarise();

  double m_stated, m_statedLogSigma;
  double m_exposure, m_logSigma;
  // At logarithms from -reach to +reach about the stated one's, with each softening.
  std::array<std::vector<double>, 2> m_logPosterior;
};

END_VISP_NAMESPACE

#endif
