/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpOutlineFitter_h
#define vpOutlineFitter_h

#include <algorithm>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpLampObservation.h>
#include <visp3/vlp_detection/vpLedRoiDetector.h>

BEGIN_VISP_NAMESPACE

//! Outline of a lamp and how blurred its edge is. Coordinates are samples (x, u) and lines (y, v) of a
//! vpLinePicture.
struct VISP_EXPORT vpOutlineFit {
  vpLampOutline outline;
  double blur = 0;       // px, standard deviation of the edge's spread
  double background = 0; // grey value just outside the lamp, a median
  double noise = 0;      // grey levels, standard deviation of a pixel
  bool sound = false;    // sharp, and as bright along all of its edge as inside: that of an evenly lit lamp

  //! The blur, px, of a lamp that white clips: at least a lens's, which the clipped edge hides.
  double clippedBlur() const
  {
    constexpr double lens = 0.7; // px, of a sharp one
    return std::max(lens, blur);
  }
};

/*!
  Fits a lamp's outline to the pixels about its edge, to sub-pixel accuracy and without bias from the stripes.

  A rolling shutter multiplies each line of the lamp's blurred picture by what the lamp gave during that
  line's exposure: I(u, v) = b + a D(u, v) on line v, where D is 1 inside the outline, 0 outside and between
  them a Gaussian edge integrated over each pixel's square. Left and right end of each line have their own a
  and b, which depend on the lamp's waveform, an uneven emitter or a halo, and where a's of left ends
  differ from those of right ones, the lens darkens (shades) D along the lines. a and b are eliminated from
  the least squares in closed form (variable projection, Golub and Pereyra 1973, with Kaufman's approximation
  of the Jacobian). What is left is the outline and the blur, by Gauss-Newton with weights that exclude ends
  that do not fit (Tukey's biweight on each end's distance from the outline). Where the stripes do not
  determine the ellipse, a weak prior does (axes equal within `shapeSigma`), and the covariance includes it.

  Ellipse and quadrilateral compete by likelihood (Schwarz 1978); what the stripes do not tell apart adds to
  the covariance. Where the edges are not those of an evenly lit lamp, those of its brighter half are tried. A
  lamp with no edge to fit, since it glows about a bright core or a lens blurs it, is placed on the middle of
  its light, with a covariance that is a share of its size.
*/
class VISP_EXPORT vpOutlineFitter
{
public:
  double shapeSigma = 0.15; // prior standard deviation of log(a / b)
  int maxIterations = 40;

  /*!
    \param lines The picture as read out. \param linePositions, samplePositions True positions of its lines
    and samples (vpLineTiming), pixels. \param roi Where the lamp is. \param likelyBlur px, that of other
    lamps of the same lens, from which it is sooner found; 0: not known. \return The ellipse or quadrilateral
    that is likelier; a region where neither fits.
  */
  vpOutlineFit fit(const cv::Mat_<unsigned char> &lines, const std::vector<double> &linePositions,
                   const std::vector<double> &samplePositions, const vpLedRoi &roi,
                   double likelyBlur = 0) const;

  //! Whether a region has the shape of a whole lamp with nothing beside it: such an outline is soon found.
  static bool looksWhole(const vpLedRoi &roi);

  //! That of the lit pixels, a region, as uncertain as it is large.
  static vpOutlineFit boxOf(const cv::Mat_<unsigned char> &lines, const vpLedRoi &roi);

  //! Standard deviation of the pixels in a box, grey levels: what neighbours differ by, whatever pattern they
  //! show.
  static double noiseOf(const cv::Mat_<unsigned char> &lines, const cv::Rect &box);

  //! Median grey value of stretches to both sides of a box, \e gap samples beside it or at the border: of
  //! means, which noise that black clips has others of than single samples' median. Nothing where none is in
  //! the picture.
  static std::optional<double> backgroundOf(const cv::Mat_<unsigned char> &lines, const cv::Rect &box,
                                            int gap);
};

END_VISP_NAMESPACE

#endif
