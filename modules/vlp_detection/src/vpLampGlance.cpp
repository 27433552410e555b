/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampGlance.h"

#include <algorithm>
#include <cmath>

#include "vpBrighter.h"

BEGIN_VISP_NAMESPACE

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

bool vpLampGlance::suits(const vpLampObservation &before)
{
  static const double smallest = 12; // px: the smaller, the more is decided by a few pixels
  static const double certain = 0.005, explained = 0.01;
  const vpStripeFeatures &features = before.features;
  return before.outline.shape == vpLampOutline::Shape::ellipse && !before.cut && before.blur > 0 &&
         before.blur < 0.1 * before.outline.b && 2 * before.outline.b > smallest &&
         features.signal == vpStripeFeatures::Signal::pwm &&
         features.frequencySigma < certain * features.frequency && features.misfit < explained;
}

bool vpLampGlance::find(const vpLinePicture &picture, const vpLineTiming &timing,
                        const vpLampObservation &before, double shapeSigma)
{
  return whole(before.outline, before.blur, picture) && findOutline(picture, timing, before, shapeSigma) &&
         whole(fit.outline, fit.blur, picture) && sameStripes(picture, timing, before.features);
}

bool vpLampGlance::findOutline(const vpLinePicture &picture, const vpLineTiming &timing,
                               const vpLampObservation &before, double shapeSigma)
{
  // The step after one as short would be a fiftieth of it.
  static const vpEdgeFit<vpEllipseModel>::Steps steps{6, 3, 0.02, true, true};
  static const double nearlyAll = 0.97, evenEdge = 0.45, rare = 6; // as vpOutlineFitter's
  static const double growth = 0.03;                               // share of an axis, from frame to frame
  static const double sharper = 0.7, softer = 1.4, tenth = 0.1;    // of the blur; px
  const vpLampOutline &outline = before.outline;
  const Eigen::Vector4d box = outline.box();
  const cv::Rect around(static_cast<int>(box(0)), static_cast<int>(box(1)),
                        static_cast<int>(std::ceil(box(2) - box(0))),
                        static_cast<int>(std::ceil(box(3) - box(1))));
  vpEdgeFit<vpEllipseModel> ellipse(
      {picture.grey, timing.linePositions(), timing.samplePositions(), timing.samplesAligned()},
      vpEllipseModel(outline.centre, outline.a, outline.b, outline.angle), m_edges);
  if (!ellipse.run(around, shapeSigma, steps, before.blur) || ellipse.kept() < nearlyAll ||
      ellipse.shining() < nearlyAll || ellipse.prior() > rare || ellipse.evenness() < evenEdge) {
    return false;
  }
  fit = ellipse.result();
  auto alike = [](double now, double then) { return std::abs(now - then) < growth * then + 1; };
  return alike(fit.outline.a, outline.a) && alike(fit.outline.b, outline.b) &&
         fit.blur > sharper * before.blur - tenth && fit.blur < softer * before.blur + tenth;
}

//! Of the middle of each line, of which the envelope makes up for what is not even.
void vpLampGlance::readProfile(const vpLinePicture &picture, const vpLineTiming &timing)
{
  static const double inside = 0.7; // of a chord
  const vpLampOutline &outline = fit.outline;
  const vpEllipseModel model(outline.centre, outline.a, outline.b, outline.angle);
  const Eigen::Vector4d box = outline.box();
  const double margin = 2 * fit.blur;
  m_profile.time.clear();
  m_profile.light.clear();
  m_profile.sigma.clear();
  m_profile.exposure = std::hypot(timing.exposure(), timing.averaging());
  double brightest = 0;
  m_lengths.clear();
  for (int line = static_cast<int>(std::ceil(box(1) + margin)); line <= box(3) - margin; ++line) {
    double first, last;
    if (!model.stretch(line, 0, first, last)) {
      continue;
    }
    const double cut = 0.5 * (1 - inside) * (last - first);
    const int left = std::max(0, static_cast<int>(std::ceil(first + cut))),
              right = std::min(picture.grey.cols - 1, static_cast<int>(std::floor(last - cut)));
    const int pixels = right - left + 1;
    if (pixels < 3) {
      continue;
    }
    const double light =
        static_cast<double>(vpBrighter::sum(picture.grey[line] + left, pixels)) / pixels - fit.background;
    m_profile.time.push_back(timing.middle(static_cast<unsigned int>(line)));
    m_profile.light.push_back(light);
    m_profile.sigma.push_back(std::max(fit.noise, 0.3) / std::sqrt(pixels));
    m_lengths.push_back(last - first);
    brightest = std::max(brightest, light);
  }
  static const double dark = 0.1; // share of the brightest line
  m_area = 0;
  for (size_t i = 0; i < m_lengths.size(); ++i) {
    m_area += m_profile.light[i] > dark * brightest ? m_lengths[i] : 0;
  }
}

bool vpLampGlance::sameStripes(const vpLinePicture &picture, const vpLineTiming &timing,
                               const vpStripeFeatures &before)
{
  static const double gate = 4;               // standard deviations
  static const double much = 0.015, more = 2; // misfit; times that of before
  readProfile(picture, timing);
  return m_check.compare(m_profile, before) && m_check.amplitude > 0 &&
         m_check.misfit < std::max(much, more * before.misfit) &&
         std::abs(m_check.change) < gate * std::hypot(m_check.changeSigma, before.frequencySigma);
}

END_VISP_NAMESPACE
