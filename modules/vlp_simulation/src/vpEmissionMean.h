/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEmissionMean_h
#define vpEmissionMean_h

#include <vector>

#include <Eigen/Core>

#include "vpEmitter.h"

BEGIN_VISP_NAMESPACE

/*!
  Mean brightness of what a blurred pixel sees of an emission pattern, inside the emitter's outline. Times the
  share of the pixel that the outline covers (vpEmitterShare), it is the pattern's light.

  The mean is one over points that a Fibonacci lattice spreads over blur and square, each of equal weight. On
  a jump of brightness it is off by 3 % of the jump at most, on what is smooth by far less (tests bound both).
  A lamp of few pixels has its own points instead, weighted by blur and square.
*/
class vpEmissionMean
{
public:
  //! \e blur: px, above 0.
  explicit vpEmissionMean(double blur);

  //! \e inPlane: m, what the pixel sees of the plane; \e gradient: m per pixel there, by u and v.
  double at(const vpEmitter &emitter, const Eigen::Vector2d &inPlane, const Eigen::Matrix2d &gradient) const;

private:
  double overPixel(const vpEmitter &emitter, const Eigen::Vector2d &inPlane,
                   const Eigen::Matrix2d &gradient) const;
  double overEmitter(const vpEmitter &emitter, const Eigen::Vector2d &inPlane,
                     const Eigen::Matrix2d &gradient) const;

  std::vector<Eigen::Vector2d> m_offsets; // px
  double m_variance;                      // px^2, of blur and square in any direction
};

END_VISP_NAMESPACE

#endif
