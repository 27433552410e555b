/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_detection/vpOutlineTracker.h>

#include <cmath>

#include "vpEdgeFit.h"

BEGIN_VISP_NAMESPACE

struct vpOutlineTracker::Memory {
  vpEdgeFit<vpEllipseModel>::Memory edges;
};

namespace
{
//! Whether all of it lies in the picture, and what is beside it.
bool whole(const vpLampOutline &outline, double blur, const vpLinePicture &picture)
{
  const Eigen::Vector4d box = outline.box();
  const double margin = 3 * blur + 4; // px
  return box(0) > margin && box(1) > margin && box(2) < picture.grey.cols - 1 - margin &&
         box(3) < picture.grey.rows - 1 - margin;
}
} // namespace

vpOutlineTracker::vpOutlineTracker() : m_memory(std::make_unique<Memory>()) {}

vpOutlineTracker::~vpOutlineTracker() = default;

bool vpOutlineTracker::suits(const vpLampOutline &outline, double blur)
{
  static const double smallest = 12; // px: the smaller, the more is decided by a few pixels
  return outline.shape == vpLampOutline::Shape::ellipse && blur > 0 && blur < 0.1 * outline.b &&
         2 * outline.b > smallest;
}

bool vpOutlineTracker::find(const vpLinePicture &picture, const vpLineTiming &timing,
                            const vpLampOutline &expected, double blur, double shapeSigma)
{
  // The step after one as short would be a fiftieth of it.
  static const vpEdgeFit<vpEllipseModel>::Steps steps{6, 3, 0.02, true, true};
  static const double nearlyAll = 0.97, evenEdge = 0.45, rare = 6; // as vpOutlineFitter's
  static const double growth = 0.03;                               // share of an axis, from frame to frame
  static const double sharper = 0.7, softer = 1.4, tenth = 0.1;    // of the blur; px
  if (!whole(expected, blur, picture)) {
    return false;
  }
  const Eigen::Vector4d box = expected.box();
  const cv::Rect around(static_cast<int>(box(0)), static_cast<int>(box(1)),
                        static_cast<int>(std::ceil(box(2) - box(0))),
                        static_cast<int>(std::ceil(box(3) - box(1))));
  vpEdgeFit<vpEllipseModel> ellipse(
      {picture.grey, timing.linePositions(), timing.samplePositions(), timing.samplesAligned()},
      vpEllipseModel(expected.centre, expected.a, expected.b, expected.angle), m_memory->edges);
  if (!ellipse.run(around, shapeSigma, steps, blur) || ellipse.kept() < nearlyAll ||
      ellipse.shining() < nearlyAll || ellipse.prior() > rare || ellipse.evenness().edges < evenEdge) {
    return false;
  }
  m_fit = ellipse.result();
  auto alike = [](double now, double then) { return std::abs(now - then) < growth * then + 1; };
  return alike(m_fit.outline.a, expected.a) && alike(m_fit.outline.b, expected.b) &&
         m_fit.blur > sharper * blur - tenth && m_fit.blur < softer * blur + tenth &&
         whole(m_fit.outline, m_fit.blur, picture);
}

END_VISP_NAMESPACE
