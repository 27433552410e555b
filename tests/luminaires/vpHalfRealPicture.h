/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpHalfRealPicture_h
#define vpHalfRealPicture_h

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <visp3/core/vpImage.h>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpVlpRig.h>

#include "luminaires/vpEmissionPattern.h"

/*!
  \file vpHalfRealPicture.h
  Pictures of lamps whose emission patterns are real or drawn, and whose modulation, place and size are known.
*/

BEGIN_VISP_NAMESPACE

//! One lamp as it truly is. Pixels of the picture, centres at integers, u to the right and v down.
struct vpHalfRealLamp {
  const vpEmissionPattern *pattern = nullptr;
  std::string id;
  Eigen::Vector2d middle = {0, 0}; // px, where the pattern's own middle comes to lie
  double diameter = 100;           // px, of the outline before the tilt
  double angle = 0;                // rad, turn of the pattern from u towards v
  double tilt = 0;                 // rad, from facing the camera: one axis is shortened by its cosine
  double tiltAxis = 0;             // rad, direction that the tilt shortens, from u towards v
  vpModulation modulation;
  double rate = 1;    // of its clock, 1 + error
  double phase = 0;   // periods, at time 0
  double level = 150; // grey levels above the background of the brightest pixel, where m is 1

  //! px of the picture, standard deviation of each coordinate of the middle: as good as the pattern's own.
  double middleSigma() const { return pattern->middleSigma * diameter / pattern->diameter; }
  //! Lines that show it: length along v of the ellipse that touches the four sides of what is lit.
  double lines() const;
  //! The matrix that takes pattern pixels about the pattern's middle to picture pixels about \e middle.
  Eigen::Matrix2d warp() const;
  //! Farthest that the pattern's picture reaches from the middle, px.
  double reach() const;
};

/*!
  A picture of the model: grey = background + sum over the lamps of S(u, v) m(v), m(v) the mean of the lamp's
  light over the exposure of line v, which starts at v * rowTime. The optical blur acts on S, before m.
  Then come the tone curve, noise, rounding to 8 bits, and JPEG.
*/
struct vpHalfRealPicture {
  int width = 1280, height = 960;           // px
  double rowTime = 20e-6, exposure = 50e-6; // s
  double background = 5;                    // grey levels, in the picture's middle
  Eigen::Vector2d gradient = {0, 0};        // grey levels per px, of the background
  double blur = 0.7;                        // px, standard deviation; 0: none
  double noise = 1;                         // grey levels, standard deviation, where it is dark
  double electrons = 0;                     // for one grey level, what shot noise follows from; 0: none
  double gamma = 1;                         // tone curve 255 (grey / 255)^(1 / gamma); phones: about 2.2
  int jpeg = 0;                             // quality, 1 to 100; 0: none
  uint64_t seed = 1;                        // of the noise
  std::vector<vpHalfRealLamp> lamps;

  /*!
    Light of a lamp without stripes, grey levels. Each pixel is the mean of S over its area; blurred.
    \param box The part of the picture that it is of, px; it may reach beyond the picture.
  */
  cv::Mat_<float> unstriped(const vpHalfRealLamp &lamp, cv::Rect &box) const;

  //! \throw vpException (badValue) as vpLampLight.
  vpImage<unsigned char> render() const;
};

END_VISP_NAMESPACE

#endif
