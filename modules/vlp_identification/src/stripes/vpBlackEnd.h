/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpBlackEnd_h
#define vpBlackEnd_h

#include <vector>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  The dark end of the grey scale: a pixel of light L and noise s shows max(0, L + s e), e standard normal, a
  censored Gaussian (Tobin 1958). The mean of many is s g(L / s), g(z) = z Phi(z) + phi(z): 0.4 s where there
  is no light, L where there is much. Without it, half-lit lines seem darker than they are beside dark ones.
*/
class vpBlackEnd
{
public:
  //! What a line shows.
  struct Line {
    double mean;        // grey levels
    int samples, black; // black: of them, grey value 0
  };
  struct Light {
    double mean;  // grey levels, before clipping
    double sigma; // of one pixel's noise in it
  };

  //! The noise at which as many pixels are black as are, from about \e noise, grey levels.
  vpBlackEnd(const std::vector<Line> &lines, double noise);

  double noise() const { return m_noise; } // grey levels, before clipping
  //! \param mean Grey levels, of pixels of the same light.
  Light before(double mean) const;

private:
  double m_noise;
};

END_VISP_NAMESPACE

#endif
