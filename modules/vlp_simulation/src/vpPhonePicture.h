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

  //! \e picture: linear grey values, with the noise of photons and readout; it is changed.
  cv::Mat_<unsigned char> of(cv::Mat_<float> picture, std::uint64_t seed) const;

private:
  float toned(float grey) const;

  double m_chromaNoise; // grey levels
  double m_clipped;     // share
  double m_gamma;
  double m_sharpening;
  int m_jpegQuality;
};

END_VISP_NAMESPACE

#endif
