/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// A camera that is a phone in a hand.

#include <functional>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/vpExpectError.h"
#include "cornerScene.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
//! A ceiling of one grey value, and nothing left to chance.
struct Wall : cornerScene::Scene {
  explicit Wall(double level = 100)
  {
    scene.lamps.clear();
    scene.ambient = level;
    camera.readNoise = 0;
    camera.photonsPerLevel = 0;
  }
};

cv::Mat_<unsigned char> picture(const cornerScene::Scene &scene, std::uint64_t seed = 1)
{
  vpImage<unsigned char> I;
  vpRollingShutterRenderer(scene.camera)
      .render(
          scene.scene, [&](double t) { return scene.at(t); }, scene.time, seed, I);
  return cv::Mat_<unsigned char>(static_cast<int>(I.getHeight()), static_cast<int>(I.getWidth()), I.bitmap)
      .clone();
}

//! A lamp without noise, lit or blinking.
struct Lamp : cornerScene::Scene {
  explicit Lamp(bool blinking = false)
  {
    camera.readNoise = 0;
    camera.photonsPerLevel = 0;
    if (!blinking) {
      lamp().lamp.modulation.kind = vpModulation::Kind::unmodulated;
    }
    fast(); // sets the light
  }
};

double deviation(const cv::Mat_<unsigned char> &picture)
{
  cv::Scalar mean, sigma;
  cv::meanStdDev(picture, mean, sigma);
  return sigma[0];
}
} // namespace

TEST(PhonePicture, ToneCurveIsThePowerThatItSays)
{
  for (const double gamma : {0.5, 1.0, 2.2}) {
    int before = -1;
    for (const double level : {0., 1., 20., 100., 180., 255., 400.}) {
      Wall wall(level);
      wall.camera.toneCurve = gamma;
      const int grey = picture(wall)(10, 10);
      EXPECT_EQ(grey, std::lround(255 * std::pow(std::min(level, 255.) / 255, 1 / gamma)))
          << level << " " << gamma;
      EXPECT_GE(grey, before);
      before = grey;
    }
  }
}

TEST(PhonePicture, ChannelThatClipsEarlierMakesASoftShoulder)
{
  const double early = 0.25, green = 0.587;
  int before = -1;
  for (double level = 0; level <= 500; level += 5) {
    Wall wall(level);
    wall.camera.clippedChannels = early;
    const int grey = picture(wall)(10, 10);
    const double knee = 255 * (1 - early);
    if (level <= knee) {
      EXPECT_NEAR(grey, level, 0.6);
    } else if (level < 255) {
      EXPECT_NEAR(grey, knee + (1 - green / (1 - early)) * (level - knee), 0.6);
      EXPECT_LT(grey, level);
    }
    EXPECT_GE(grey, before);
    before = grey;
  }
  EXPECT_EQ(before, 255) << "in the end all channels clip";
}

TEST(PhonePicture, SharpeningOvershootsAtEdgesOnly)
{
  const Lamp plain;
  cornerScene::Scene sharp = plain;
  const cv::Mat_<unsigned char> before = picture(plain);
  double most = 206;
  int darkest = 7;
  for (const double strength : {0.5, 1.0, 2.0}) {
    sharp.camera.sharpening = strength;
    const cv::Mat_<unsigned char> after = picture(sharp);
    double least = 0, brightest = 0;
    cv::minMaxLoc(after, &least, &brightest);
    EXPECT_GT(brightest, most) << "more of it at each strength";
    EXPECT_LE(least, darkest);
    most = brightest;
    darkest = static_cast<int>(least);
    EXPECT_EQ(after(2, 2), before(2, 2)) << "far from the lamp";
    EXPECT_EQ(after(36, 43), before(36, 43)) << "in its middle";
  }
  EXPECT_EQ(darkest, 0);
}

TEST(PhonePicture, ChromaNoiseHasItsDeviationAndIsShared)
{
  Wall wall;
  wall.camera.rig.width = 400;
  wall.camera.rig.height = 300;
  wall.camera.chromaNoise = 6;
  const cv::Mat_<unsigned char> one = picture(wall, 1), other = picture(wall, 2);
  EXPECT_NEAR(deviation(one), 6, 0.2);
  EXPECT_GT(cv::norm(one, other, cv::NORM_L1), 0);
  EXPECT_EQ(cv::norm(one, picture(wall, 1), cv::NORM_L1), 0);
  cv::Mat_<float> centred;
  one.convertTo(centred, CV_32F);
  centred -= cv::mean(centred)[0];
  auto correlation = [&](int lag) {
    const int width = centred.cols - lag;
    return centred.colRange(0, width).dot(centred.colRange(lag, lag + width)) / centred.dot(centred);
  };
  EXPECT_NEAR(correlation(1), std::exp(-0.25 / (1.5 * 1.5)), 0.03);
  EXPECT_NEAR(correlation(2), std::exp(-1 / (1.5 * 1.5)), 0.04);
  EXPECT_LT(std::abs(correlation(12)), 0.05);
  wall.scene.ambient = 400;
  EXPECT_EQ(deviation(picture(wall)), 0) << "what is saturated has none";
}

TEST(PhonePicture, LowerJpegQualityIsFartherFromThePicture)
{
  Lamp lamp(true);
  const cv::Mat_<unsigned char> before = picture(lamp);
  double error = 0;
  for (const int quality : {100, 80, 30, 5}) {
    lamp.camera.jpegQuality = quality;
    const double off = cv::norm(picture(lamp), before, cv::NORM_L2);
    EXPECT_GT(off, error) << quality;
    EXPECT_LT(off / std::sqrt(static_cast<double>(before.total())), quality == 100 ? 1 : 40) << quality;
    error = off;
  }
}

TEST(PhonePicture, StepsThatDoNothingLeaveEveryByte)
{
  cornerScene::Scene scene;
  scene.fast();
  const cv::Mat_<unsigned char> before = picture(scene, 5);
  scene.camera.toneCurve = 1 + 1e-9;
  scene.camera.sharpening = 1e-9;
  scene.camera.clippedChannels = 1e-9;
  scene.camera.chromaNoise = 1e-9;
  EXPECT_EQ(cv::norm(picture(scene, 5), before, cv::NORM_INF), 0);
}

//! Noise of the sensor passes through the tone curve, whose slope it is multiplied with.
TEST(PhonePicture, NoiseComesBeforeTheToneCurve)
{
  for (const double level : {20.0, 100.0}) {
    Wall wall(level);
    wall.camera.rig.width = 300;
    wall.camera.readNoise = 2;
    wall.camera.toneCurve = 2.2;
    const double slope = std::pow(level / 255, 1 / 2.2 - 1) / 2.2;
    EXPECT_NEAR(deviation(picture(wall)), 2 * slope, 0.1 * slope);
  }
}

TEST(PhonePicture, HandBlurSmearsTheLampByItsLength)
{
  Lamp lamp;
  lamp.lamp().lamp.size = 0.02;
  auto spread = [](const cv::Mat_<unsigned char> &picture) { // px^2, over both directions
    cv::Mat_<float> light;
    picture.convertTo(light, CV_32F);
    light -= 6;
    const cv::Moments moments = cv::moments(light);
    return (moments.mu20 + moments.mu02) / moments.m00;
  };
  const double still = spread(picture(lamp));
  for (const double length : {3.0, 8.0}) {
    lamp.camera.handBlur = length;
    EXPECT_NEAR(spread(picture(lamp)) - still, length * length / 12, 0.05 * length * length / 12 + 0.1);
  }
  EXPECT_GT(cv::norm(picture(lamp, 1), picture(lamp, 2), cv::NORM_L1), 100) << "another direction";
  EXPECT_EQ(cv::norm(picture(lamp, 1), picture(lamp, 1), cv::NORM_L1), 0);
}

TEST(PhonePicture, HandBlurLeavesTheStripes)
{
  Lamp lamp(true);
  lamp.lamp().lamp.size = 1; // fills the picture
  lamp.fast();
  const cv::Mat_<unsigned char> before = picture(lamp);
  EXPECT_GT(deviation(before), 50);
  lamp.camera.handBlur = 10;
  EXPECT_LE(cv::norm(picture(lamp), before, cv::NORM_INF), 1);
}

TEST(PhonePicture, NumbersOutOfTheirRangeAreNamed)
{
  auto refused = [](const std::function<void(vpSimulatedCamera &)> &change, const std::string &message) {
    Wall wall;
    change(wall.camera);
    vpExpectError([&] { vpRollingShutterRenderer renderer(wall.camera); }, {message});
  };
  refused([](vpSimulatedCamera &camera) { camera.toneCurve = 0; },
          "tone curve: 0, expected a number from 0.2");
  refused([](vpSimulatedCamera &camera) { camera.clippedChannels = 0.4; }, "clipped channels: 0.4, expected");
  refused([](vpSimulatedCamera &camera) { camera.sharpening = -1; }, "sharpening: -1, expected");
  refused([](vpSimulatedCamera &camera) { camera.chromaNoise = std::nan(""); },
          "chroma noise, grey levels: nan");
  refused([](vpSimulatedCamera &camera) { camera.jpegQuality = 101; }, "JPEG quality: 101, expected");
  refused([](vpSimulatedCamera &camera) { camera.handBlur = 51; }, "hand blur, px: 51, expected 0 to 50");
}

TEST(PhonePicture, IsThatOfTheWholeSensorBeforeAnAreaResize)
{
  Lamp lamp(true);
  lamp.camera.sharpening = 2;
  lamp.camera.toneCurve = 2.2;
  const cv::Mat_<unsigned char> whole = picture(lamp);
  vpVlpRig &rig = lamp.camera.rig;
  rig.resize.method = vpPictureResize::Method::area;
  rig.resize.sourceWidth = rig.width;
  rig.resize.sourceHeight = rig.height;
  rig.camera = rig.resize.delivered(rig.camera, 42, 38);
  rig.width = 42;
  rig.height = 38;
  cv::Mat expected;
  cv::resize(whole, expected, cv::Size(42, 38), 0, 0, cv::INTER_AREA);
  EXPECT_EQ(cv::norm(picture(lamp), expected, cv::NORM_INF), 0);
}
