/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef paintedLamps_h
#define paintedLamps_h

/*!
  \file paintedLamps.h
  Pictures of discs, and whether detection finds just these.
*/

#include <algorithm>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <visp3/vlp_detection/vpLedRoiDetector.h>
#include <visp3/vlp_detection/vpOutlineFitter.h>

#include "common/vpLampPicture.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace paintedLamps
{
//! A disc with stripes, \e period in lines.
inline vpPaintedLamp disc(double u, double v, double radius, double amplitude, double period, double duty,
                          double phase)
{
  vpPaintedLamp lamp;
  lamp.centre = {u, v};
  lamp.a = lamp.b = radius;
  lamp.amplitude = amplitude;
  lamp.frequency = 1 / (period * vpLampPicture().rowTime);
  lamp.phase = phase;
  lamp.pwm(duty);
  return lamp;
}

inline vpLampPicture pictureOf(const std::vector<vpPaintedLamp> &lamps, int width, int height)
{
  vpLampPicture picture;
  picture.lamps = lamps;
  picture.width = width;
  picture.height = height;
  picture.blur = 0.7;
  return picture;
}

//! Of all regions that are found in a square picture.
inline std::vector<vpLampOutline> outlinesIn(const vpLampPicture &picture)
{
  const vpImage<unsigned char> I = picture.render();
  const vpLinePicture lines(I, picture.columns);
  std::vector<double> positions(picture.width); // of lines and samples alike
  std::iota(positions.begin(), positions.end(), 0.0);
  std::vector<vpLampOutline> outlines;
  for (const vpLedRoi &roi : vpLedRoiDetector().detect(lines.grey))
    outlines.push_back(vpOutlineFitter().fit(lines.grey, positions, positions, roi).outline);
  return outlines;
}

//! One lamp in the middle of a picture that leaves its own radius and 20 px free around it.
inline vpLampPicture alone(vpPaintedLamp lamp)
{
  const int size = static_cast<int>(4 * lamp.reach()) + 40;
  lamp.centre = {0.5 * size + 0.3, 0.5 * size - 0.2};
  return pictureOf({lamp}, size, size);
}

inline std::vector<vpLedRoi> detect(const vpLampPicture &picture)
{
  const vpImage<unsigned char> I = picture.render();
  return vpLedRoiDetector().detect(vpLinePicture(I, picture.columns).grey);
}

//! Bounding boxes in samples and lines.
struct Lit {
  cv::Rect least; // of what no noise hides
  cv::Rect most;  // of all that the lamp lights
};

inline Lit litBy(vpLampPicture picture, const vpPaintedLamp &lamp)
{
  picture.lamps = {lamp};
  picture.background = 0;
  cv::Mat_<float> grey = picture.exact();
  if (picture.columns)
    grey = grey.t();
  return {cv::boundingRect(grey > std::max(0.6 * lamp.amplitude, 9 * picture.noise)),
          cv::boundingRect(grey > 2)};
}

//! The region's box is the lit part of the lamp, to 2 px.
inline bool matches(const vpLedRoi &roi, const Lit &lit)
{
  auto grown = [](const cv::Rect &box) {
    return cv::Rect(box.x - 2, box.y - 2, box.width + 4, box.height + 4);
  };
  return (grown(roi.box) & lit.least) == lit.least && (grown(lit.most) & roi.box) == roi.box;
}

inline std::string boxes(const std::vector<vpLedRoi> &rois)
{
  std::ostringstream text;
  text << rois.size() << " regions";
  for (size_t k = 0; k < std::min<size_t>(rois.size(), 6); ++k)
    text << " " << rois[k].box;
  return text.str();
}

inline testing::AssertionResult holds(const std::vector<vpLedRoi> &rois, const vpLampPicture &picture,
                                      const vpPaintedLamp &lamp)
{
  const Lit lit = litBy(picture, lamp);
  if (std::any_of(rois.begin(), rois.end(), [&](const vpLedRoi &roi) { return matches(roi, lit); }))
    return testing::AssertionSuccess();
  return testing::AssertionFailure() << "lamp lit in " << lit.least << " is not among " << boxes(rois);
}

//! One region for each lamp, and no other.
inline testing::AssertionResult findsExactlyTheLamps(const vpLampPicture &picture)
{
  const std::vector<vpLedRoi> rois = detect(picture);
  for (const vpPaintedLamp &lamp : picture.lamps)
    if (const auto held = holds(rois, picture, lamp); !held)
      return held;
  if (rois.size() != picture.lamps.size())
    return testing::AssertionFailure() << "found " << boxes(rois);
  return testing::AssertionSuccess();
}
} // namespace paintedLamps

#endif
