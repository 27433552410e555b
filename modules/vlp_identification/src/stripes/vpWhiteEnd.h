/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpWhiteEnd_h
#define vpWhiteEnd_h

#include <array>
#include <vector>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  The bright end of the grey scale: it clips a lamp's brightest samples, more of them on brighter lines. The
  mean C of a line's dimmest samples follows the modulation as that of all does: a quantile commutes with
  clipping, a mean does not. The ratio of C of more samples to C of few is the emission's, which changes
  smoothly along the lines: C(more) = C(few) r(v). The polynomial r is found by least squares over the lines
  that are spared more. Each line is told by the share that makes its light most certain.
*/
class vpWhiteEnd
{
public:
  //! The light of a line's dimmest samples, grey levels: as many as are spared on all lines, a tenth or more.
  struct Light {
    double mean, sigma;
  };

  //! \param background Grey levels, of the lamp's surroundings. \param noise Of a pixel, grey levels.
  vpWhiteEnd(double background, double noise) : m_background(background), m_noise(noise) {}
  //! A line. \param from, to Samples, from where to where the lamp is on it.
  void add(const unsigned char *row, double from, double to);
  //! Of all lines, in their order.
  std::vector<Light> light() const;

private:
  static constexpr int shares = 10; // that a line's samples are divided into, by their light
  struct Line {
    std::array<double, shares> mean; // light of the dimmest share, of the dimmest two, ..., grey levels
    int spared;                      // shares
    double samples;
  };
  class Ratio;

  std::vector<Line> m_lines;
  double m_background, m_noise;
};

END_VISP_NAMESPACE

#endif
