/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Lamps before ceilings of uneven brightness: with a gradient, a spot of daylight, mottles, windows.

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#include <visp3/vlp_identification/vpLedDetector.h>

#include "common/paintedLamps.h"
#include "common/vpUpwardRig.h"

using namespace paintedLamps;

namespace
{
const int width = 480, height = 360;
const double frequencies[] = {2000, 2600, 3500, 4400};

//! Grey levels that a ceiling adds, by pixel.
using Ceiling = cv::Mat_<float>;

Ceiling ceilingOf(const std::function<double(double, double)> &light)
{
  Ceiling ceiling(height, width);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      ceiling(v, u) = static_cast<float>(light(u, v));
  return ceiling;
}

//! From 0 to \e span, in a direction.
Ceiling gradient(double span, double angle)
{
  const double c = std::cos(angle), s = std::sin(angle), length = std::abs(c) * width + std::abs(s) * height;
  return ceilingOf([=](double u, double v) {
    return span * (0.5 + (c * (u - 0.5 * width) + s * (v - 0.5 * height)) / length);
  });
}

//! Daylight on the ceiling's middle.
Ceiling spot(double peak, double radius)
{
  return ceilingOf([=](double u, double v) {
    return peak * std::exp(-0.5 * (std::pow(u - 260, 2) + std::pow(v - 190, 2)) / (radius * radius));
  });
}

//! Stains as large as \e scale px, of a standard deviation in grey levels.
Ceiling mottles(double scale, double deviation, unsigned int seed)
{
  Ceiling ceiling(height, width);
  cv::RNG random(seed);
  random.fill(ceiling, cv::RNG::NORMAL, 0, 1);
  cv::GaussianBlur(ceiling, ceiling, cv::Size(), 0.5 * scale);
  cv::Scalar mean, spread;
  cv::meanStdDev(ceiling, mean, spread);
  return (ceiling - mean[0]) * (deviation / spread[0]);
}

//! A sharp-edged part of a light of its own.
Ceiling panel(const cv::Rect &box, double light)
{
  Ceiling ceiling(height, width, 0.f);
  ceiling(box & cv::Rect(0, 0, width, height)) = static_cast<float>(light);
  return ceiling;
}

vpLampPicture lampsOf(double amplitude, double phase)
{
  vpLampPicture picture = pictureOf({}, width, height);
  const double places[][2] = {{90.3, 80.2}, {330.7, 95.6}, {260.1, 190.4}, {130.6, 270.3}};
  for (int k = 0; k < 4; ++k) {
    vpPaintedLamp lamp = disc(places[k][0], places[k][1], 18 + 4 * k, amplitude, 1, 0.5, phase + 0.3 * k);
    lamp.frequency = frequencies[k];
    picture.lamps.push_back(lamp);
  }
  return picture;
}

vpImage<unsigned char> rendered(const vpLampPicture &picture, const Ceiling &ceiling)
{
  cv::Mat_<float> noise(height, width);
  cv::RNG(picture.seed).fill(noise, cv::RNG::NORMAL, 0, picture.noise);
  const cv::Mat_<float> grey = picture.exact() + ceiling + noise;
  vpImage<unsigned char> I(height, width);
  cv::Mat_<unsigned char> view(height, width, I.bitmap);
  grey.convertTo(view, CV_8U);
  return I;
}

/*!
  Each lamp is a region of its own: all of it, and of the ceiling no more than a few pixels.
*/
testing::AssertionResult findsTheLamps(const vpLampPicture &picture, const Ceiling &ceiling)
{
  static const int few = 4; // px
  const vpImage<unsigned char> I = rendered(picture, ceiling);
  const std::vector<vpLedRoi> rois = vpLedRoiDetector().detect(vpLinePicture(I, picture.columns).grey);
  for (const vpPaintedLamp &lamp : picture.lamps) {
    Lit lit = litBy(picture, lamp);
    lit.most += cv::Size(2 * few, 2 * few);
    lit.most -= cv::Point(few, few);
    if (std::none_of(rois.begin(), rois.end(), [&](const vpLedRoi &roi) { return matches(roi, lit); }))
      return testing::AssertionFailure() << "lamp lit in " << lit.least << " is not among " << boxes(rois);
  }
  return testing::AssertionSuccess();
}

std::string nameOf(double frequency)
{
  return std::to_string(static_cast<int>(frequency));
}

vpLampMap mapOfLamps()
{
  vpLampMap map;
  for (const double frequency : frequencies) {
    vpLamp lamp;
    lamp.id = nameOf(frequency);
    lamp.modulation.kind = vpModulation::Kind::pwm;
    lamp.modulation.frequency = frequency;
    map.lamps.push_back(lamp);
  }
  return map;
}
} // namespace

TEST(UnevenCeiling, Gradient)
{
  for (const double amplitude : {40.0, 150.0})
    for (const double span : {10.0, 0.5 * amplitude, amplitude})
      for (const double angle : {0.0, 0.7, 1.6})
        for (const double phase : {0.1, 0.6})
          EXPECT_TRUE(findsTheLamps(lampsOf(amplitude, phase), gradient(span, angle)))
              << "amplitude " << amplitude << ", span " << span << ", angle " << angle << ", phase " << phase;
}

TEST(UnevenCeiling, DaylightSpot)
{
  for (const double amplitude : {40.0, 150.0})
    for (const double peak : {10.0, 0.3 * amplitude, 0.6 * amplitude})
      for (const double radius : {40.0, 80.0, 160.0})
        for (const bool columns : {false, true}) {
          vpLampPicture picture = lampsOf(amplitude, 0.1);
          picture.columns = columns;
          EXPECT_TRUE(findsTheLamps(picture, spot(peak, radius)))
              << "amplitude " << amplitude << ", peak " << peak << ", radius " << radius
              << (columns ? ", columns" : ", rows");
        }
}

TEST(UnevenCeiling, Mottles)
{
  for (const double ratio : {8.0, 12.0, 30.0}) // of the lamps' amplitude and the mottles' standard deviation
    for (const double amplitude : {40.0, 150.0})
      for (const double background : {15.0, 60.0})
        for (const double scale : {4.0, 12.0, 30.0, 80.0}) // lamps are 36 to 60 px wide
          for (const unsigned int seed : {1U, 2U}) {
            vpLampPicture picture = lampsOf(amplitude, 0.1 * seed);
            picture.background = background;
            EXPECT_TRUE(findsTheLamps(picture, mottles(scale, amplitude / ratio, seed)))
                << "amplitude " << amplitude << " on " << background << ", ratio " << ratio << ", scale "
                << scale << ", seed " << seed;
          }
}

TEST(UnevenCeiling, SharpEdgedPart)
{
  for (const double amplitude : {60.0, 150.0})
    for (const double light : {0.2 * amplitude, 0.5 * amplitude})
      for (const cv::Rect &part :
           {cv::Rect(0, 0, 210, height), cv::Rect(0, 0, width, 150), cv::Rect(40, 30, 250, 300)})
        EXPECT_TRUE(findsTheLamps(lampsOf(amplitude, 0.2), panel(part, light)))
            << "amplitude " << amplitude << ", light " << light << ", part " << part;
}

TEST(UnevenCeiling, WindowBeside)
{
  for (const double daylight : {100.0, 235.0})
    for (const cv::Rect &window : {cv::Rect(400, 60, 80, 250), cv::Rect(310, 270, 150, 80)})
      for (const Ceiling &ceiling : {gradient(60, 0.7), spot(60, 80), mottles(30, 8, 3)})
        EXPECT_TRUE(findsTheLamps(lampsOf(120, 0.4), ceiling + panel(window, daylight)))
            << "daylight " << daylight << ", window " << window;
}

// From the picture to names and places.
TEST(UnevenCeiling, LampsHaveTheirNames)
{
  for (const Ceiling &ceiling : {gradient(75, 1.6), spot(60, 80), mottles(12, 10, 1), mottles(40, 10, 1),
                                 panel(cv::Rect(0, 0, 210, height), 60)}) {
    vpLampPicture picture = lampsOf(150, 0.3);
    picture.rowTime = picture.exposure = vpUpwardRig(width, height).shutter.rowTime;
    vpLedDetector detector(vpUpwardRig(width, height), mapOfLamps());
    ASSERT_TRUE(detector.detect(rendered(picture, ceiling)));
    size_t named = 0;
    for (const vpLampObservation &seen : detector.observations()) {
      for (const vpPaintedLamp &lamp : picture.lamps) {
        if (seen.id == nameOf(lamp.frequency)) {
          ++named;
          EXPECT_LT((seen.point - lamp.centre).norm(), 0.3) << seen.id;
        }
      }
      EXPECT_TRUE(seen.id.empty() || seen.features.signal == vpStripeFeatures::Signal::pwm);
    }
    EXPECT_EQ(named, picture.lamps.size());
  }
}

// Neither the ceiling nor discs before it that shine all the time.
TEST(UnevenCeiling, WhatDoesNotBlinkHasNoName)
{
  for (const double amplitude : {0.0, 40.0, 150.0})
    for (const Ceiling &ceiling :
         {gradient(75, 1.6), spot(60, 80), spot(120, 30), mottles(4, 10, 1), mottles(12, 20, 1),
          mottles(40, 20, 2), panel(cv::Rect(300, 40, 120, 250), 180)}) {
      vpLampPicture picture = lampsOf(amplitude, 0.3);
      for (vpPaintedLamp &lamp : picture.lamps)
        lamp.frequency = 0;
      vpLedDetector detector(vpUpwardRig(width, height), mapOfLamps());
      detector.detect(rendered(picture, ceiling));
      for (const vpLampObservation &seen : detector.observations())
        EXPECT_TRUE(seen.id.empty()) << seen.id << " at " << seen.point.transpose() << ", amplitude "
                                     << amplitude;
    }
}
