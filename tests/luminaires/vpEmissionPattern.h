/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEmissionPattern_h
#define vpEmissionPattern_h

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpVlpNamespace.h>

/*!
  \file vpEmissionPattern.h
  Emission patterns of luminaires: S of the model I(u, v) = b + S(u, v) m(v), in which the rolling shutter
  gives each line v of a lamp's picture the share m(v) of the light. Taken off real pictures, or drawn.
*/

BEGIN_VISP_NAMESPACE

//! How the light of a luminaire is spread over its picture, without any stripes.
struct vpEmissionPattern {
  std::string name;
  cv::Mat_<float> light; // share of the brightest pixel's, 0 to 1
  //! px of `light`, the centre of the lamp's outline. Of a real lamp: the hand-measured one.
  Eigen::Vector2d middle = {0, 0};
  double middleSigma = 0;       // px of `light`, standard deviation of each coordinate of the middle
  double diameter = 0;          // px of `light`, of a disc of the outline's area
  Eigen::Vector2d lit = {0, 0}; // px of `light`, width and height of what shines of the outline
  bool square = false;          // the outline is a square, a disc otherwise
};

//! Patterns of one kind, among which the half-real pictures of a family choose.
struct vpLuminaireFamily {
  std::string name;
  std::vector<vpEmissionPattern> patterns;
};

//! A lamp in a real picture whose lines are rows.
struct vpStripedLamp {
  cv::Mat_<float> grey;            // grey levels of the picture
  Eigen::Vector2d middle = {0, 0}; // px, measured by hand
  double period = 0;               // lines of the nominal blinking
  int reach = 0;                   // px from the middle to the sides of a square that holds the lamp
};

/*!
  Takes the emission pattern off a picture. The light m of a line is a function of its phase alone, and S is
  smooth along the columns. Alternating least squares finds both:
  - m(phase) = sum(I S) / sum(S^2) over the pixels of the lines near that phase;
  - each column of S minimises sum(w (I / m - S)^2) + tension sum(S'^2) + stiffness sum(S''^2) over its
    lines, w = m^2 on lit lines and 0 on dark ones, which thus are filled from the lit lines about them.

  The period is the one within 1.5 % of the nominal period that explains most of the lines' light. What lies
  outside the lamp is faded out.
  \throw vpException (badValue) where the square shows no light.
*/
vpEmissionPattern vpTakePattern(const vpStripedLamp &lamp);

/*!
  Families of VLP_INPUT_IMAGE_PATH: ub300, lumia-room, lumia-floor (both of its sets), chandelier. A family
  without its folder is left out. Truth of a middle is as good as the hand-measured centres: 1 px in the
  picture, 3 px in pictures of 33 megapixels; `middleSigma` says so.
  \param folder Where the sets are. \throw vpException (ioError) where there is no set at all.
*/
std::vector<vpLuminaireFamily> vpRealFamilies(const std::string &folder);

//! Families drawn by formula, \e count patterns each: discs, dies, panels, tubes. Their middles are exact.
std::vector<vpLuminaireFamily> vpDrawnFamilies(int count, uint64_t seed);

//! The pattern for the eye: grey levels are 255 (S / brightest)^0.5, the middle and the diameter are marked.
cv::Mat vpPatternPicture(const vpEmissionPattern &pattern);

END_VISP_NAMESPACE

#endif
