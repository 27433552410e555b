/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpRimFit_h
#define vpRimFit_h

#include <optional>
#include <vector>

#include <opencv2/core.hpp>
#include <visp3/vlp_detection/vpOutlineFitter.h>

BEGIN_VISP_NAMESPACE

/*!
  The outline through the ends of the lit lines: for luminaires whose edges are too unlike each other, or too
  soft, to be fitted as one blurred step.

  Ends are those at a grey level, and levels rise by the same factor. Ends inside the convex hull of all are
  no rim: the emitter is dark there. An ellipse and a rectangle compete by their mean squared distance from
  the rest. The outline is that of the level from which it changes least to the next (maximally stable, Matas
  et al. 2002): there the lamp has its edge. By how much it changes while the light halves is what is not
  known of it. What neighbouring ends are off by has one cause, so that they count as few.
*/
namespace vpRimFit
{
using Ends = std::vector<cv::Point2f>; // line by line, the first one first

constexpr double levelRatio = 1.25;

//! \param levels Ends at each level, the lowest first. \param[out] chosen Which one it is. \return Nothing
//! where neither shape comes near to the ends of any.
std::optional<vpOutlineFit> mostStable(const std::vector<Ends> &levels, size_t &chosen);

/*!
  An edge that is no sharper than a lens makes it may be that of a glow, or of a housing that the lamp lights:
  then the lamp's middle is that of its light. Both are held together, by the probability of each. \param fit
  By mostStable(). \param light Middle of the light, px.
*/
void allowForGlow(vpOutlineFit &fit, const Eigen::Vector2d &light);

//! Middle of a region's light above its level, px; nothing where it has none.
std::optional<Eigen::Vector2d> middleOfLight(const cv::Mat_<unsigned char> &lines, const vpLedRoi &roi);

/*!
  A side of a quadrilateral of which more than half lies in the dark between two stripes may be anywhere
  there, and so may its opposite: the middle is as uncertain. \param gap Lines, the longest in the dark.
*/
void addHiddenSides(vpLampOutline &outline, double gap);

//! Of the region's level, and higher ones.
std::optional<vpOutlineFit> of(const cv::Mat_<unsigned char> &lines, const vpLedRoi &roi);
} // namespace vpRimFit

END_VISP_NAMESPACE

#endif
