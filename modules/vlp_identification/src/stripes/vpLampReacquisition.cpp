/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampReacquisition.h"

#include <algorithm>
#include <cmath>

#include <visp3/vlp_core/vpBrighter.h>

BEGIN_VISP_NAMESPACE

bool vpLampReacquisition::suits(const vpLampObservation &before)
{
  static const double certain = 0.005, explained = 0.01;
  const vpStripeFeatures &features = before.features;
  return !before.cut && vpOutlineTracker::suits(before.outline, before.blur) &&
         features.signal == vpStripeFeatures::Signal::pwm &&
         features.frequencySigma < certain * features.frequency && features.misfit < explained;
}

bool vpLampReacquisition::find(const vpLinePicture &picture, const vpLineTiming &timing,
                               const vpLampObservation &before, double shapeSigma)
{
  return m_outline.find(picture, timing, before.outline, before.blur, shapeSigma) &&
         sameStripes(picture, timing, before.features);
}

//! Of the middle of each line, of which the envelope makes up for what is not even.
void vpLampReacquisition::readProfile(const vpLinePicture &picture, const vpLineTiming &timing)
{
  static const double inside = 0.7; // of a chord
  const vpOutlineFit &fit = m_outline.fit();
  const vpLampOutline &outline = fit.outline;
  const Eigen::Vector4d box = outline.box();
  const double margin = 2 * fit.blur;
  m_profile.time.clear();
  m_profile.light.clear();
  m_profile.sigma.clear();
  m_profile.exposure = std::hypot(timing.exposure(), timing.averaging());
  m_profile.logExposureSigma = timing.logExposureSigma();
  double brightest = 0;
  m_lengths.clear();
  const vpOutlineLines across(outline);
  for (int line = static_cast<int>(std::ceil(box(1) + margin)); line <= box(3) - margin; ++line) {
    double first, last;
    if (!across.stretch(line, first, last)) {
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

bool vpLampReacquisition::sameStripes(const vpLinePicture &picture, const vpLineTiming &timing,
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
