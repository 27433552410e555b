/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPixelEdge_h
#define vpPixelEdge_h

#include <Eigen/Core>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! What a pixel sees of a bright region with a straight, blurred edge: its share of the region's light.
struct VISP_EXPORT vpPixelEdge {
  double share;   // 0 to 1
  double byShift; // 1/px, derivative by an outward shift of the edge
  double byBlur;  // 1/px, derivative by the blur

  /*!
    A pixel whose middle lies \e d (px) outside an edge of outward unit normal \e normal, spread by a Gaussian
    of standard deviation \e blur (px, more than 0). Integrating over the pixel's square adds a box of width
    |n_x| and one of width |n_y| to the Gaussian: the share is the second difference of the Gaussian taken as
    integral three times. Above a blur of \e exactUpTo a Gaussian of the same variance takes their place; from
    half a pixel on it is right to 0.002.
  */
  static vpPixelEdge at(double d, const Eigen::Vector2d &normal, double blur, double exactUpTo = 0.5);
};

END_VISP_NAMESPACE

#endif
