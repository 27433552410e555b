/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPhonePicture_h
#define vpPhonePicture_h

#include <cstdint>

#include <opencv2/core.hpp>
#include <visp3/vlp_simulation/vpRollingShutterRenderer.h>

BEGIN_VISP_NAMESPACE

//! What a phone makes of the values that its sensor measured.
class vpPhonePicture
{
public:
  //! \throw vpException (badValue) with one line that names what is out of its range.
  explicit vpPhonePicture(const vpSimulatedCamera &camera);

  //! Whether there is nothing to be done.
  bool plain() const { return m_plain; }

  //! \e grey: linear, with the noise of photons and readout, as the picture lies.
  cv::Mat_<unsigned char> of(const cv::Mat_<float> &grey, std::uint64_t seed) const;

private:
  float toned(float grey) const;

  double m_chromaNoise; // grey levels
  double m_clipped;     // share
  double m_gamma;
  double m_sharpening;
  int m_jpegQuality;
  bool m_plain;
};

END_VISP_NAMESPACE

#endif
