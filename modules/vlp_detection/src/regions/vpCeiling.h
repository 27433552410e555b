/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCeiling_h
#define vpCeiling_h

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "vpBackground.h"

BEGIN_VISP_NAMESPACE

/*!
  A ceiling that lamps and daylight make brighter in one part of a picture than in another: a quadratic
  surface through most of the picture's blocks, by weights that fall with what a block is off (Cauchy's;
  Holland and Welsch 1977). Lamps, panels and windows are far off.
*/
class vpCeiling
{
public:
  //! \param noise Of a pixel, grey levels. Nothing where half of the blocks are farther off than that: what
  //! has edges, or is mottled, is no such surface.
  static std::optional<vpCeiling> of(const std::vector<vpPictureBlock> &blocks, double noise);

  //! The picture as it would be if the ceiling were as dark all over as in its darkest place.
  cv::Mat_<unsigned char> takenOff(const cv::Mat_<unsigned char> &lines) const;
  //! Grey levels that this takes off at a point, px, of a picture of that size.
  double above(const cv::Point2d &point, const cv::Size &picture) const;

private:
  using Terms = Eigen::Matrix<double, 6, 1>; // of the surface

  static Terms termsAt(double x, double y);

  Terms m_surface = Terms::Zero();
  double m_darkest = 0; // grey levels
};

END_VISP_NAMESPACE

#endif
