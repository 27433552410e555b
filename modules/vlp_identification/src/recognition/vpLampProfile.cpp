/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What was read of a lamp beside the light inside its outline: as a share, and for a person to look at.

#include <visp3/vlp_identification/vpLedDetector.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <visp3/vlp_detection/vpBlinkingLight.h>
#include <visp3/vlp_identification/vpLitShare.h>

#include "vpSeenRegion.h"
#include "vpTransposed.h"

BEGIN_VISP_NAMESPACE

namespace
{
//! The lines and samples that an outline holds, clipped to the picture.
cv::Rect boxOf(const vpLampOutline &outline, cv::Size picture)
{
  const Eigen::Array4d box = outline.box();
  if (!box.isFinite().all()) {
    return {};
  }
  const auto near = [](double x, int pixels) {
    return static_cast<int>(std::clamp(x, -1.0, static_cast<double>(pixels)));
  };
  const cv::Point first(near(std::floor(box(0)), picture.width), near(std::floor(box(1)), picture.height)),
      last(near(std::ceil(box(2)), picture.width), near(std::ceil(box(3)), picture.height));
  return cv::Rect(first, last + cv::Point(1, 1)) & cv::Rect(cv::Point(), picture);
}

//! Share of the light's variance over the lines that goes with the lamp's waveform.
double explained(const vpStripeProfile &profile, const vpStripeFeatures &features)
{
  const std::vector<double> share = vpLitShareOf(features, profile.time);
  if (share.empty()) {
    return 0;
  }
  const auto lines = static_cast<Eigen::Index>(share.size());
  Eigen::ArrayXd wave = Eigen::Map<const Eigen::ArrayXd>(share.data(), lines),
                 light = Eigen::Map<const Eigen::ArrayXd>(profile.light.data(), lines);
  wave -= wave.mean();
  light -= light.mean();
  const double common = (wave * light).sum(), variances = wave.square().sum() * light.square().sum();
  return common > 0 && variances > 0 ? common * common / variances : 0;
}
} // namespace

/*!
  Of the light inside a region's outline, the share that blinks as was read of it, as far as its duty is
  known: a wrong wave explains less.
*/
double vpLedDetector::blinkingShare(const vpLinePicture &picture, const Region &region) const
{
  static const double deep = 0.5; // of stripes: where no line is dark, none tells whose light is on it
  const vpStripeFeatures &read = region.lamp.features;
  if (region.fit.outline.shape == vpLampOutline::Shape::region) {
    return 0;
  }
  const cv::Rect box = boxOf(region.fit.outline, picture.grey.size());
  if (std::isnan(read.phase) || box.empty() || read.modulation < deep) {
    return 1;
  }
  double share = 0;
  vpStripeFeatures wave = read;
  for (const double sigmas : {0, -1, 1}) {
    if (share > recognizer.leastBlinking) {
      break;
    }
    wave.duty = std::clamp(read.duty + sigmas * read.dutySigma, 0.0, 1.0);
    wave.phase = read.phase + 0.5 * (wave.duty - read.duty); // the pulse's middle stays
    share = std::max(share, vpBlinkingLight::share(picture.grey, vpLitShareOf(wave, m_timing), box));
  }
  return share;
}

vpStripeProfile vpLedDetector::profile(const vpImage<unsigned char> &I, const vpLampObservation &lamp) const
{
  check(I);
  const vpLinePicture picture(I, m_rig.shutter.alongColumns());
  vpOutlineFit fit;
  fit.outline = picture.transposed ? vpTransposed(lamp.outline) : lamp.outline;
  fit.blur = lamp.blur;
  fit.noise = lamp.noise;
  vpLedRoi roi;
  roi.box = boxOf(fit.outline, picture.grey.size());
  if (roi.box.empty()) {
    return {};
  }
  for (const int line : {roi.box.y, roi.box.br().y - 1}) {
    roi.chords.push_back({line, roi.box.x, roi.box.br().x - 1});
  }
  static const double sigmas = 3; // of the blur, beyond which an edge shows no more of its lamp
  const int gap = static_cast<int>(std::ceil(sigmas * lamp.blur));
  fit.background = vpOutlineFitter::backgroundOf(picture.grey, roi.box, gap).value_or(0);
  vpStripeProfile profile = vpStripeProfile::along(picture.grey, m_timing, fit, roi);
  if (!std::isnan(lamp.features.phase)) {
    vpStripeProfile agreed = vpStripeProfile::agreedByColumns(picture.grey, m_timing, fit, roi);
    if (explained(agreed, lamp.features) > explained(profile, lamp.features)) {
      profile = std::move(agreed);
    }
  }
  profile.exposure = m_exposure.exposure();
  profile.logExposureSigma = m_exposure.logSigma();
  return profile;
}

END_VISP_NAMESPACE
