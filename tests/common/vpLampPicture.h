/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampPicture_h
#define vpLampPicture_h

/*!
  \file vpLampPicture.h
  Pictures of blinking lamps by brute force, without any formula of the library: areas by counting points,
  light by the overlap of pulses and exposure.
*/

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <visp3/core/vpImage.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! A lamp in the picture. Pixels, centres at integers, u to the right and v down.
struct vpPaintedLamp {
  struct Pulse {
    double start, length; // periods
  };

  Eigen::Vector2d centre = {0, 0};      // px, of the ellipse
  double a = 10, b = 10;                // px, semi-axes
  double angle = 0;                     // rad, from u to a, towards v
  std::vector<Eigen::Vector2d> corners; // px, four in order around it: a convex quadrilateral instead
  double amplitude = 150;               // grey levels above the background while lit
  Eigen::Vector2d shading = {0, 0};     // 1/px, share by which that grows with u and v from the centre
  double frequency = 0;                 // Hz, of repetition
  double phase = 0;                     // periods, at time 0
  std::vector<Pulse> pulses = {{0, 1}}; // lit stretches of each period; default: always lit

  void pwm(double duty) { pulses = {{0, duty}}; }
  void twoPulse(double duty, double difference) { pulses = {{0, 0.5 * duty}, {difference, 0.5 * duty}}; }
  //! '1' lit, '0' dark, all of them one period.
  void chips(const std::string &word)
  {
    pulses.clear();
    for (size_t k = 0; k < word.size(); ++k)
      if (word[k] == '1')
        pulses.push_back({static_cast<double>(k) / word.size(), 1.0 / word.size()});
  }
  //! About the centre and turned by the angle.
  void rectangle(double width, double height)
  {
    const Eigen::Vector2d x(std::cos(angle), std::sin(angle)), y(-x.y(), x.x());
    const Eigen::Vector2d w = 0.5 * width * x, h = 0.5 * height * y;
    corners = {centre - w - h, centre + w - h, centre + w + h, centre - w + h};
  }

  bool inside(const Eigen::Vector2d &point) const;

  bool hasTipNear(const Eigen::Vector2d &point) const
  {
    return std::any_of(corners.begin(), corners.end(), [&](auto &tip) { return (tip - point).norm() < 1; });
  }

  //! Share of a square that it covers: points of it counted. They form a Fibonacci lattice, of which no two
  //! share a u or a v, so that upright edges are met as finely as others.
  double covers(const Eigen::Vector2d &upperLeft, double side) const;

  //! Farthest that it reaches from its centre, px.
  double reach() const
  {
    double farthest = corners.empty() ? std::max(a, b) : 0;
    for (const Eigen::Vector2d &corner : corners)
      farthest = std::max(farthest, (corner - centre).norm());
    return farthest;
  }

  //! Share of the time from \e t on, \e exposure long (s), during which it is lit.
  double light(double t, double exposure) const
  {
    if (frequency <= 0)
      return 1;
    // Lit periods since a pulse's start: whole ones and the begun one.
    auto lit = [](double x, double length) {
      return std::floor(x) * length + std::min(x - std::floor(x), length);
    };
    const double from = t * frequency + phase, to = from + exposure * frequency;
    double sum = 0;
    for (const Pulse &pulse : pulses)
      sum += lit(to - pulse.start, pulse.length) - lit(from - pulse.start, pulse.length);
    return sum / (to - from);
  }
};

//! A camera looking at lamps; the line read first starts its exposure at time 0.
struct vpLampPicture {
  int width = 640, height = 480; // px
  std::vector<vpPaintedLamp> lamps;
  double rowTime = 43.1e-6, exposure = 43.1e-6; // s
  bool columns = false;                         // the readout runs along columns
  bool reversed = false;                        // the last line first
  double blur = 0;                              // px, standard deviation of the optical blur
  double background = 10;                       // grey value
  double noise = 2;                             // grey levels, standard deviation
  unsigned int seed = 1;                        // of the noise

  //! Start of the exposure of a line, s.
  double start(int line) const { return rowTime * (reversed ? (columns ? width : height) - 1 - line : line); }

  //! Share of each pixel that the lamp covers, blur included; no blinking.
  cv::Mat_<float> coverage(const vpPaintedLamp &lamp) const;

  //! Grey values before noise, rounding and clipping.
  cv::Mat_<float> exact() const;

  vpImage<unsigned char> render() const;
};

END_VISP_NAMESPACE

#endif
