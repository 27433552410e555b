/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_identification/vpLedDetector.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include <visp3/core/vpException.h>
#include <visp3/core/vpRect.h>
#include <visp3/vlp_identification/vpLedIdEvidence.h>

#include "stripes/vpLampReacquisition.h"
#include "stripes/vpSteadyLight.h"
#include "stripes/vpStripeStarts.h"
#include "vpSeenRegion.h"
#include "vpTransposed.h"
#include "words/vpWordFormats.h"
#include <visp3/vlp_core/vpBrighter.h>

BEGIN_VISP_NAMESPACE

namespace
{

//! A pixel at most one outside of a picture, which may be far from where the window ends.
int near(double x, int pixels)
{
  return static_cast<int>(std::clamp(x, -1.0, static_cast<double>(pixels)));
}

//! Windows as lines and samples of the picture, clipped to it.
std::vector<cv::Rect> linesOf(const std::vector<vpRect> &windows, const vpLinePicture &picture)
{
  std::vector<cv::Rect> rects;
  for (const vpRect &window : windows) {
    if (!std::isfinite(window.getRight()) || !std::isfinite(window.getBottom())) {
      std::ostringstream message;
      message << "windows: one from (" << window.getLeft() << ", " << window.getTop() << ") to ("
              << window.getRight() << ", " << window.getBottom() << "), expected finite numbers";
      throw vpException(vpException::badValue, message.str());
    }
    const int columns = picture.transposed ? picture.grey.rows : picture.grey.cols,
              rows = picture.transposed ? picture.grey.cols : picture.grey.rows;
    const int left = near(std::floor(window.getLeft()), columns),
              top = near(std::floor(window.getTop()), rows),
              right = near(std::ceil(window.getRight()), columns),
              bottom = near(std::ceil(window.getBottom()), rows);
    cv::Rect rect(left, top, right - left + 1, bottom - top + 1);
    if (picture.transposed) {
      std::swap(rect.x, rect.y);
      std::swap(rect.width, rect.height);
    }
    rect &= cv::Rect(0, 0, picture.grey.cols, picture.grey.rows);
    if (rect.area() > 0) {
      rects.push_back(rect);
    }
  }
  return rects;
}

//! Rectangles that overlap, as one.
std::vector<cv::Rect> joined(std::vector<cv::Rect> rects)
{
  for (size_t i = 0; i < rects.size(); ++i) {
    for (size_t k = i + 1; k < rects.size(); ++k) {
      if ((rects[i] & rects[k]).area() > 0) {
        rects[i] |= rects[k];
        rects.erase(rects.begin() + static_cast<long>(k));
        k = i; // the larger one may overlap others
      }
    }
  }
  return rects;
}

//! Lit pixels of a region.
void measureArea(const vpLinePicture &picture, const vpLedRoi &roi, vpLampObservation &lamp)
{
  const auto level = static_cast<unsigned char>(std::clamp(std::floor(roi.level), 0.0, 255.0));
  int pixels = 0;
  for (const vpLedChord &chord : roi.chords) {
    const unsigned char *row = picture.grey[chord.line] + chord.first;
    const int samples = chord.last - chord.first + 1;
    pixels += vpBrighter::count(row, samples, level);
  }
  lamp.features.area = pixels;
}

std::vector<vpImagePoint> cornersOf(const vpLampOutline &outline)
{
  std::vector<vpImagePoint> corners;
  if (outline.shape == vpLampOutline::Shape::quadrilateral) {
    for (const Eigen::Vector2d &corner : outline.corners) {
      corners.emplace_back(corner.y(), corner.x());
    }
  } else {
    const Eigen::Vector4d box = outline.box();
    corners = {{box(1), box(0)}, {box(1), box(2)}, {box(3), box(2)}, {box(3), box(0)}};
  }
  return corners;
}

} // namespace

vpLedDetector::vpLedDetector(const vpVlpRig &rig, const vpLampMap &map)
    : recognizer(map, rig.shutter), m_rig(rig)
{
  if (rig.width == 0 || rig.height == 0) {
    throw vpException(vpException::badValue,
                      "rig: picture size is 0, expected the camera's width and height");
  }
  m_timing = rig.lineTiming();
  longestPeriod = vpLongestPeriod(map, rig);
  roiDetector.longestPeriod = vpLongestPeriodLines(map, rig);
  m_exposure =
      vpExposureEvidence(std::hypot(m_timing.exposure(), m_timing.averaging()), m_timing.logExposureSigma());
  stripeAnalyzer.searchTwoPulses = std::any_of(map.lamps.begin(), map.lamps.end(), [](const vpLamp &lamp) {
    return lamp.modulation.kind == vpModulation::Kind::twoPulse;
  });
  stripeAnalyzer.words = vpWordFormatsOf(map, rig.shutter);
}

void vpLedDetector::check(const vpImage<unsigned char> &I) const
{
  if (I.getWidth() != m_rig.width || I.getHeight() != m_rig.height) {
    std::ostringstream message;
    message << "picture is " << I.getWidth() << " x " << I.getHeight() << " pixels, expected " << m_rig.width
            << " x " << m_rig.height << " as the rig's camera says";
    throw vpException(vpException::dimensionError, message.str());
  }
}

bool vpLedDetector::detect(const vpImage<unsigned char> &I)
{
  check(I);
  m_blur = 0; // a whole picture is seen as if it were alone
  const vpLinePicture picture(I, m_rig.shutter.alongColumns());
  return observe(picture, roiDetector.detect(picture.grey));
}

bool vpLedDetector::detect(const vpImage<unsigned char> &I, const std::vector<vpRect> &windows,
                           const std::vector<vpRect> &known)
{
  check(I);
  const vpLinePicture picture(I, m_rig.shutter.alongColumns());
  const std::vector<cv::Rect> knownBoxes = linesOf(known, picture);
  std::vector<vpLedRoi> rois;
  for (const cv::Rect &window : joined(linesOf(windows, picture))) {
    for (vpLedRoi &roi : roiDetector.detect(picture.grey, window, knownBoxes)) {
      // Windows that grow may see one lamp twice.
      const bool twice = std::any_of(rois.begin(), rois.end(), [&roi](const vpLedRoi &other) {
        return 2 * (roi.box & other.box).area() > std::min(roi.box.area(), other.box.area());
      });
      if (!twice) {
        rois.push_back(std::move(roi));
      }
    }
  }
  return observe(picture, rois);
}

bool vpLedDetector::reacquire(const vpImage<unsigned char> &I, vpLampObservation &lamp)
{
  check(I);
  if (!vpLampReacquisition::suits(lamp) || m_rig.shutter.alongColumns()) {
    return false;
  }
  const vpLinePicture picture(I, false);
  static thread_local vpLampReacquisition found; // for its memory
  if (!found.find(picture, m_timing, lamp, outlineFitter.shapeSigma)) {
    return false;
  }
  place(lamp, found.fit(), false);
  lamp.features.area = found.area();
  m_blur = found.fit().blur;
  return true;
}

//! Where the lamp is, by its outline.
void vpLedDetector::place(vpLampObservation &lamp, const vpOutlineFit &fit, bool transposed) const
{
  lamp.outline = transposed ? vpTransposed(fit.outline) : fit.outline;
  lamp.point = lamp.outline.middle(m_rig.camera, m_rig.verticalInCamera());
  lamp.covariance = lamp.outline.centreCovariance;
  lamp.time = m_timing.middleAt(transposed ? lamp.point.x() : lamp.point.y());
  lamp.blur = fit.blur;
  lamp.noise = fit.noise;
}

//! All that follows from the regions.
bool vpLedDetector::observe(const vpLinePicture &picture, const std::vector<vpLedRoi> &rois)
{
  std::vector<Region> regions;
  for (const vpLedRoi &roi : rois) {
    regions.push_back(observe(picture, roi));
  }
  shareExposure(picture, regions);
  complete(picture, regions);
  for (Region &region : regions) {
    region.lamp.blinking = blinkingShare(picture, region);
  }
  recognise(regions);
  std::stable_sort(regions.begin(), regions.end(), [](const Region &a, const Region &b) {
    return a.lamp.features.area > b.lamp.features.area;
  });
  m_observations.clear();
  m_polygon.clear();
  m_message.clear();
  for (const Region &region : regions) {
    m_observations.push_back(region.lamp);
    m_polygon.push_back(cornersOf(region.lamp.outline));
    m_message.push_back(region.lamp.id);
  }
  m_nb_objects = m_observations.size();
  return m_nb_objects > 0;
}

void vpLedDetector::recognise(std::vector<Region> &regions)
{
  std::vector<vpLampObservation> lamps;
  for (const Region &region : regions) {
    lamps.push_back(region.lamp);
  }
  m_rowTimeError = recognizer.recognize(lamps);
  for (size_t i = 0; i < regions.size(); ++i) {
    regions[i].lamp = lamps[i];
  }
}

//! The analyser for lamps that are as fast as the detector looks for.
vpStripeAnalyzer vpLedDetector::analyzer() const
{
  vpStripeAnalyzer analyzer = stripeAnalyzer;
  analyzer.minFrequency = 1 / (roiDetector.longestPeriod * std::abs(m_timing.meanLineTime()));
  return analyzer;
}

//! What a profile says under the exposure as it is known. \param unknownWords Whether words of formats that
//! the map does not have are looked for.
vpStripeFeatures vpLedDetector::analyzed(vpStripeProfile profile, bool unknownWords) const
{
  profile.exposure = m_exposure.exposure();
  profile.logExposureSigma = m_exposure.logSigma();
  vpStripeAnalyzer by = analyzer();
  by.searchUnknownWords = by.searchUnknownWords && unknownWords;
  return by.analyze(profile);
}

//! Whether light shines on end for longer than any lamp does.
bool vpLedDetector::isSteady(const vpStripeProfile &profile) const
{
  return !profile.light.empty() && vpLongestLit(profile) > longestPeriod;
}

vpStripeFeatures vpLedDetector::stripesOf(const vpLinePicture &picture, const vpOutlineFit &fit,
                                          const vpLedRoi &roi) const
{
  const vpStripeProfile profile = vpStripeProfile::along(picture.grey, m_timing, fit, roi);
  if (isSteady(profile)) {
    return {};
  }
  vpStripeFeatures features = analyzed(profile, fit.sound); // parts of a lamp show no whole word
  static const double explained = 0.01;                     // misfit
  const bool tells = vpLedIdEvidence::tells(features);
  if ((tells && features.misfit < explained) ||
      features.modulation < (tells ? stripeAnalyzer.minModulation : vpPatchwork::least)) {
    return features;
  }
  const vpStripeFeatures other = agreedStripes(picture, fit, roi);
  // Of few lines that are hardly known, any wave explains all.
  const bool finer = !tells || other.frequencySigma < features.frequencySigma,
             better = features.signal == vpStripeFeatures::Signal::unmodulated ||
                      (finer && other.misfit < features.misfit);
  return vpLedIdEvidence::tells(other) && better ? other : features;
}

//! What the lines' means hide the columns may agree on.
vpStripeFeatures vpLedDetector::agreedStripes(const vpLinePicture &picture, const vpOutlineFit &fit,
                                              const vpLedRoi &roi) const
{
  const vpStripeProfile agreed = vpStripeProfile::agreedByColumns(picture.grey, m_timing, fit, roi);
  if (vpStripeStarts::peaks(agreed).size() < vpPatchwork::fewestStripes ||
      agreed.depth() < vpPatchwork::least || !analyzer().blinks(agreed)) {
    return {};
  }
  const vpStripeFeatures features = analyzed(agreed, false);
  const bool coded = features.signal == vpStripeFeatures::Signal::coded;
  return coded || vpPatchwork::isLamp(features) ? features : vpStripeFeatures();
}

/*!
  What the lamps say of the exposure together: those whose stripes said otherwise, or left the duty open, are
  read again with it.
*/
void vpLedDetector::shareExposure(const vpLinePicture &picture, std::vector<Region> &regions)
{
  const vpExposureEvidence before = m_exposure;
  for (const Region &region : regions) {
    m_exposure.add(region.lamp.features, before);
  }
  static const double better = 0.7, clearly = 1, open = 0.05; // share; standard deviations; duty
  if (!(m_exposure.logSigma() < better * before.logSigma())) {
    return;
  }
  for (Region &region : regions) {
    const vpStripeFeatures &seen = region.lamp.features;
    if (seen.signal == vpStripeFeatures::Signal::unmodulated) {
      continue;
    }
    const double off = std::abs(std::log(seen.exposure / m_exposure.exposure()));
    if (!(off < clearly * m_exposure.logSigma()) || !(seen.dutySigma < open) ||
        !(seen.frequencySigma < seen.frequency)) {
      read(picture, region);
    }
  }
}

//! A region as the picture shows it; of what does not blink, by its middle, the outline is no matter.
vpLedDetector::Region vpLedDetector::observe(const vpLinePicture &picture, vpLedRoi roi)
{
  static const int soft = 2; // lines at either end, by blur and by exposure
  const bool dark = roi.chords.size() < static_cast<size_t>(roi.box.height); // some of its lines
  if (roi.even || (dark && vpOutlineFitter::looksWhole(roi))) {
    return observe(picture, roi, !roi.even);
  }
  vpLedRoi inner = roi;
  inner.box = cv::Rect(roi.box.x, roi.box.y + soft, roi.box.width, std::max(0, roi.box.height - 2 * soft));
  const vpStripeProfile profile =
      vpStripeProfile::along(picture.grey, m_timing, vpOutlineFitter::boxOf(picture.grey, inner), inner);
  roi.steady = roi.steady || isSteady(profile);
  return observe(picture, roi, !roi.steady && analyzer().blinks(profile));
}

vpLedDetector::Region vpLedDetector::observe(const vpLinePicture &picture, const vpLedRoi &roi, bool blinks)
{
  Region region;
  region.roi = roi;
  region.fit = blinks ? outlineFitter.fit(picture.grey, m_timing.linePositions(), m_timing.samplePositions(),
                                          roi, m_blur)
                      : vpOutlineFitter::boxOf(picture.grey, roi);
  if (region.fit.outline.shape == vpLampOutline::Shape::ellipse) {
    m_blur = region.fit.blur;
  }
  if (blinks) {
    read(picture, region);
  }
  locate(picture, region);
  return region;
}

//! What a region's stripes say.
void vpLedDetector::read(const vpLinePicture &picture, Region &region) const
{
  region.lamp.features = stripesOf(picture, region.fit, region.roi);
  measureArea(picture, region.roi, region.lamp);
}

//! Where a region's lamp is.
void vpLedDetector::locate(const vpLinePicture &picture, Region &region) const
{
  vpLampObservation &lamp = region.lamp;
  measureArea(picture, region.roi, lamp);
  place(lamp, region.fit, picture.transposed);
  lamp.cut = region.roi.cutAcross || region.roi.cutAlong;
  // Of a lamp of which less than half is seen longer and shorter ellipses fit about as well, the less of it
  // the more.
  const Eigen::Vector2d &centre = region.fit.outline.centre;
  const Eigen::Vector2d last(picture.grey.cols - 1, picture.grey.rows - 1);
  const double outside = (centre - centre.cwiseMin(last).cwiseMax(Eigen::Vector2d::Zero())).norm();
  lamp.covariance += outside * outside * Eigen::Matrix2d::Identity();
}

END_VISP_NAMESPACE
