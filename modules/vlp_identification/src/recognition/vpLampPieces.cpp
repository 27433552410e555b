/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vpLedDetector::complete(): regions that are parts of one lamp become that lamp.

#include <visp3/vlp_identification/vpLedDetector.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <Eigen/LU>
#include <visp3/vlp_detection/vpBlinkingLight.h>
#include <visp3/vlp_identification/vpLedIdEvidence.h>
#include <visp3/vlp_identification/vpLitShare.h>

#include "vpSeenRegion.h"

BEGIN_VISP_NAMESPACE

namespace
{
//! Both regions as one: on each line from the first to the last lit sample.
vpLedRoi joined(const vpLedRoi &a, const vpLedRoi &b)
{
  std::map<int, vpLedChord> chords;
  for (const vpLedRoi *roi : {&a, &b}) {
    for (const vpLedChord &chord : roi->chords) {
      vpLedChord &whole = chords.emplace(chord.line, chord).first->second;
      whole.first = std::min(whole.first, chord.first);
      whole.last = std::max(whole.last, chord.last);
    }
  }
  vpLedRoi roi = a;
  roi.chords.clear();
  for (const auto &[line, chord] : chords) {
    roi.chords.push_back(chord);
  }
  roi.box |= b.box;
  roi.level = std::min(a.level, b.level);
  roi.lampness = std::max(a.lampness, b.lampness);
  roi.cutAcross = a.cutAcross || b.cutAcross;
  roi.cutAlong = a.cutAlong || b.cutAlong;
  return roi;
}

bool tells(const vpLampObservation &lamp)
{
  return vpLedIdEvidence::tells(lamp.features);
}

//! Whether pulses explain a region's stripes, which are too few to say how often they come.
bool blinksSomehow(const vpLampObservation &lamp)
{
  return !std::isnan(lamp.features.phase) && !tells(lamp);
}

//! Whether a region may be lamps that blink in different ways: two stripes that no pulses explain are shades.
bool mayBeSeveral(const vpLampObservation &lamp)
{
  const bool unexplained = lamp.features.signal == vpStripeFeatures::Signal::coded;
  return !tells(lamp) && lamp.features.stripes >= (unexplained ? vpPatchwork::fewestStripes : 2);
}

//! Whether an outline is that of a whole lamp: no part of a lamp is an evenly lit ellipse.
bool isWhole(const vpOutlineFit &fit)
{
  return fit.sound && fit.outline.shape == vpLampOutline::Shape::ellipse;
}

//! Lines between two boxes; negative where they share some.
int gapAlong(const cv::Rect &a, const cv::Rect &b)
{
  return std::max(a.y, b.y) - std::min(a.br().y, b.br().y);
}

//! px between two boxes, along lines or across, whichever is more; negative where they overlap.
int gapBetween(const cv::Rect &a, const cv::Rect &b)
{
  return std::max(std::max(a.x, b.x) - std::min(a.br().x, b.br().x), gapAlong(a, b));
}

int sizeOf(const cv::Rect &box)
{
  return std::max(box.width, box.height);
}

//! Whether two regions are so near to each other that they may be parts of one lamp.
bool neighbours(const vpLedRoi &a, const vpLedRoi &b)
{
  return gapBetween(a.box, b.box) <= std::max(sizeOf(a.box), sizeOf(b.box)) / 2;
}

//! Whether two regions may show stripes together that neither shows: what dips from line to line in no strip
//! of its samples does so only with what lies on other lines of the same samples.
bool mayAlternate(const vpLedRoi &a, const vpLedRoi &b)
{
  return !a.even || !b.even || std::max(a.box.x, b.box.x) < std::min(a.box.br().x, b.box.br().x);
}

/*!
  Whether two regions may have one modulation: of one frequency, and of one phase at a time between them, as
  far as they tell.
*/
bool mayBlinkAlike(const vpLampObservation &a, const vpLampObservation &b)
{
  static const double sigmas = 5, most = 0.1; // standard deviations; periods
  if (!tells(a) || !tells(b)) {
    return a.features.signal != vpStripeFeatures::Signal::unmodulated ||
           b.features.signal != vpStripeFeatures::Signal::unmodulated;
  }
  const vpStripeFeatures &one = a.features, &other = b.features;
  if (one.signal != other.signal || one.chips != other.chips ||
      std::abs(one.frequency - other.frequency) >
          sigmas * std::hypot(one.frequencySigma, other.frequencySigma)) {
    return false;
  }
  const double between = 0.5 * (a.time + b.time),
               apart = (one.frequency - other.frequency) * between + one.phase - other.phase,
               unknown =
                   0.5 * std::abs(a.time - b.time) * std::hypot(one.frequencySigma, other.frequencySigma);
  // The middle of a pulse is better known than its start.
  const double middles = apart - 0.5 * (one.duty - other.duty);
  return std::isnan(middles) || std::abs(std::remainder(middles, 1)) < most + sigmas * unknown;
}

//! Whether a region shows what another one shows better: both blink alike, and no two lamps overlap. Of a
//! lamp's scraps and mirror images the stripes tell less; of those that tell as much the middle decides.
bool isDoubleOf(const vpLampObservation &one, const vpLampObservation &other)
{
  static const double clearly = 2; // times the standard deviation of the frequency
  const Eigen::Vector4d a = one.outline.box(), b = other.outline.box();
  const bool overlap =
      std::max(a(0), b(0)) < std::min(a(2), b(2)) && std::max(a(1), b(1)) < std::min(a(3), b(3));
  if (!overlap || !tells(one) || !tells(other) || !mayBlinkAlike(one, other)) {
    return false;
  }
  const double less = one.features.frequencySigma / other.features.frequencySigma;
  return less > clearly || (less > 1 / clearly && one.covariance.trace() > other.covariance.trace());
}
} // namespace

/*!
  Parts of a lamp that tell nothing alone may do so together; what a lamp is that tells how it blinks shows by
  all the light that blinks like it.
*/
void vpLedDetector::complete(const vpLinePicture &picture, std::vector<Region> &regions)
{
  joinPieces(picture, regions);
  takeApart(picture, regions);
  std::stable_sort(regions.begin(), regions.end(), [](const Region &a, const Region &b) {
    return tells(a.lamp) != tells(b.lamp) ? tells(a.lamp) : a.lamp.features.area > b.lamp.features.area;
  });
  for (size_t i = 0; i < regions.size(); ++i) {
    completeOne(picture, regions, i);
    if (blinksSomehow(regions[i].lamp) && !isWhole(regions[i].fit) && readAround(picture, regions[i])) {
      completeOne(picture, regions, i);
    }
  }
  for (size_t i = regions.size(); i-- > 0;) {
    const vpLampObservation lamp = regions[i].lamp;
    if (std::any_of(regions.begin(), regions.end(),
                    [&lamp](const Region &other) { return isDoubleOf(lamp, other.lamp); })) {
      regions.erase(regions.begin() + static_cast<long>(i));
    }
  }
}

//! Lamps whose glow joins them blink in two ways, on which columns may not even agree: brighter parts of such
//! a region may tell alone.
void vpLedDetector::takeApart(const vpLinePicture &picture, std::vector<Region> &regions)
{
  for (size_t i = regions.size(); i-- > 0;) {
    const vpLedRoi roi = regions[i].roi;
    for (const double times : {2.0, 4.0}) {
      if (!mayBeSeveral(regions[i].lamp) || isWhole(regions[i].fit)) {
        break; // steady, one lamp, or taken apart already
      }
      double darkest = 0;
      cv::minMaxLoc(picture.grey(roi.box), &darkest);
      vpLedRoiDetector bright = roiDetector;
      bright.minContrast = times * (roi.level - darkest);
      std::vector<Region> parts;
      for (const vpLedRoi &part : bright.detect(picture.grey, roi.box)) {
        if ((part.box & roi.box) == part.box) {
          parts.push_back(observe(picture, part));
        }
      }
      if (std::any_of(parts.begin(), parts.end(), [](const Region &part) { return tells(part.lamp); })) {
        regions[i] = parts.front();
        regions.insert(regions.end(), parts.begin() + 1, parts.end());
      }
    }
  }
}

//! One region with the others that are parts of the same lamp. \param i Of the region; changes as these go.
void vpLedDetector::completeOne(const vpLinePicture &picture, std::vector<Region> &regions, size_t &i) const
{
  static const double alike = 0.6; // share of a part's light
  const Region region = regions[i];
  if (std::isnan(region.lamp.features.phase)) {
    return;
  }
  const bool whole = tells(region.lamp) && isWhole(region.fit);
  auto mayBePart = [&](size_t k) {
    const Region &other = regions[k];
    return k != i && !isWhole(other.fit) && mayBlinkAlike(region.lamp, other.lamp) &&
           (!whole || neighbours(region.roi, other.roi));
  };
  std::vector<size_t> near;
  for (size_t k = 0; k < regions.size(); ++k) {
    if (mayBePart(k)) {
      near.push_back(k);
    }
  }
  if (whole && near.empty()) {
    return;
  }
  const std::vector<float> lit = vpLitShareOf(region.lamp.features, m_timing);
  std::vector<char> part(regions.size(), 0);
  for (size_t k : near) {
    part[k] = vpBlinkingLight::share(picture.grey, lit, regions[k].roi.box) > alike;
  }
  if (whole && std::none_of(part.begin(), part.end(), [](char is) { return is != 0; })) {
    return;
  }
  std::vector<cv::Rect> others;
  for (size_t k = 0; k < regions.size(); ++k) {
    if (k != i && part[k] == 0) {
      others.push_back(regions[k].roi.box);
    }
  }
  complete(picture, lit, others, regions[i]);
  const cv::Rect box = regions[i].roi.box;
  for (size_t k = regions.size(); k-- > 0;) {
    const cv::Rect &other = regions[k].roi.box;
    if (part[k] != 0 && 2 * (box & other).area() > other.area()) {
      regions.erase(regions.begin() + static_cast<long>(k));
      i -= k < i ? 1 : 0;
    }
  }
}

//! The bright part of a lamp may show too few stripes, and the dim rest about it more.
bool vpLedDetector::readAround(const vpLinePicture &picture, Region &region) const
{
  vpLedRoi around = region.roi;
  const int by = sizeOf(around.box);
  around.box =
      cv::Rect(around.box.x - by, around.box.y - by, around.box.width + 2 * by, around.box.height + 2 * by) &
      cv::Rect(0, 0, picture.grey.cols, picture.grey.rows);
  const vpStripeFeatures features =
      agreedStripes(picture, vpOutlineFitter::boxOf(picture.grey, around), around);
  if (std::isnan(features.phase) || features.stripes <= region.lamp.features.stripes) {
    return false;
  }
  const double area = region.lamp.features.area;
  region.lamp.features = features;
  region.lamp.features.area = area;
  return true;
}

//! All the light that blinks as the region does.
void vpLedDetector::complete(const vpLinePicture &picture, const std::vector<float> &lit,
                             const std::vector<cv::Rect> &others, Region &region) const
{
  const std::optional<vpBlinkingLight::Extent> extent =
      vpBlinkingLight::about(picture.grey, lit, region.roi, others);
  if (!extent) {
    return;
  }
  Region whole{extent->roi, extent->fit, region.lamp};
  const vpOutlineFit fit = outlineFitter.fit(picture.grey, m_timing.linePositions(),
                                             m_timing.samplePositions(), extent->roi, m_blur);
  const Eigen::Vector2d apart = fit.outline.centre - extent->fit.outline.centre;
  static const double sigmas = 4;
  const Eigen::Matrix2d together = fit.outline.centreCovariance + extent->fit.outline.centreCovariance;
  if (fit.sound && apart.dot(together.inverse() * apart) < sigmas * sigmas) {
    whole.fit = fit;
  }
  read(picture, whole);
  const bool better = whole.lamp.features.misfit < region.lamp.features.misfit;
  if (!tells(whole.lamp) || !(better || mayBlinkAlike(whole.lamp, region.lamp))) {
    if (!tells(region.lamp)) {
      return;
    }
    whole.lamp.features = region.lamp.features;
  }
  locate(picture, whole);
  region = whole;
}

//! Regions that tell nothing alone, with their neighbours, where these together do.
void vpLedDetector::joinPieces(const vpLinePicture &picture, std::vector<Region> &regions)
{
  std::vector<char> done(regions.size(), 0);
  for (size_t i = 0; i < regions.size(); ++i) {
    if (done[i] != 0 || regions[i].roi.steady || tells(regions[i].lamp)) {
      continue;
    }
    std::vector<size_t> pieces{i};
    vpLedRoi whole = regions[i].roi;
    done[i] = 1;
    for (size_t n = 0; n < pieces.size(); ++n) {
      for (size_t k = 0; k < regions.size(); ++k) {
        if (done[k] == 0 && !regions[k].roi.steady && !tells(regions[k].lamp) &&
            gapAlong(regions[pieces[n]].roi.box, regions[k].roi.box) <= roiDetector.longestPeriod &&
            neighbours(regions[pieces[n]].roi, regions[k].roi) &&
            mayAlternate(regions[pieces[n]].roi, regions[k].roi)) {
          done[k] = 1;
          pieces.push_back(k);
          whole = joined(whole, regions[k].roi);
        }
      }
    }
    if (pieces.size() > 1 &&
        vpPatchwork::isLamp(stripesOf(picture, vpOutlineFitter::boxOf(picture.grey, whole), whole))) {
      Region together = observe(picture, whole, true);
      if (vpPatchwork::isLamp(together.lamp.features)) {
        regions[i] = together;
        for (size_t n = 1; n < pieces.size(); ++n) {
          regions[pieces[n]].roi.chords.clear(); // is no region any more
        }
      }
    }
  }
  regions.erase(std::remove_if(regions.begin(), regions.end(),
                               [](const Region &region) { return region.roi.chords.empty(); }),
                regions.end());
}

END_VISP_NAMESPACE
