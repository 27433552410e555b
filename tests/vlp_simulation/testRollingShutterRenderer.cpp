/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_simulation/vpRollingShutterRenderer.h>

#include <gtest/gtest.h>
#include <visp3/core/vpMeterPixelConversion.h>
#include <visp3/core/vpRotationMatrix.h>

#include "cornerScene.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
using cornerScene::Scene;
using Kind = vpModulation::Kind;
using Readout = vpRollingShutter::Readout;

const double tolerance = 0.5; // grey levels, at every pixel
} // namespace

TEST(RollingShutterRenderer, DiscOfAnySizeAndBlur)
{
  for (double blur : {0.3, 0.7, 1.5})
    for (double size : {0.0125, 0.03, 0.058}) {
      Scene scene;
      scene.camera.blur = blur;
      scene.lamp().lamp.size = size;
      EXPECT_LT(
          scene.largestError("disc of " + std::to_string(size * 954) + " px, blur " + std::to_string(blur)),
          tolerance);
    }
}

TEST(RollingShutterRenderer, SquareAtAnyAngle)
{
  for (double blur : {0.3, 0.7})
    for (double yaw : {0.0, 0.2, 0.7853981633974483}) {
      Scene scene;
      scene.camera.blur = blur;
      scene.lamp().lamp.shape = vpLamp::Shape::square;
      scene.lamp().lamp.size = 0.04;
      scene.lamp().lamp.yaw = yaw;
      EXPECT_LT(scene.largestError("square at " + std::to_string(yaw) + " rad, blur " + std::to_string(blur)),
                tolerance);
    }
}

TEST(RollingShutterRenderer, LampDimmingTowardsItsRimAndOffItsAxis)
{
  Scene scene;
  scene.lamp().rim = 0.5;
  scene.lamp().halfPower = 0.6;
  scene.camera.rig.camera.initPersProjWithoutDistortion(1250, 1250, -500, 400);
  scene.pose[0][3] = -0.55;
  scene.pose[1][3] = 0.36;
  scene.camera.vignetting = 4;
  EXPECT_LT(scene.largestError("rim, half power, vignetting"), tolerance);
}

TEST(RollingShutterRenderer, LensThatDistorts)
{
  Scene scene;
  scene.camera.rig.camera.initPersProjWithDistortion(600, 610, -300, 350, -0.15, 0.16);
  scene.pose[0][3] = -0.75;
  scene.pose[1][3] = 0.65;
  scene.lamp().lamp.size = 0.1;
  EXPECT_LT(scene.largestError("distortion"), tolerance);
}

TEST(RollingShutterRenderer, CameraThatLeans)
{
  Scene scene;
  scene.pose.insert(vpRotationMatrix(0.15, -0.1, 0.4));
  const vpHomogeneousMatrix cMw = scene.pose.inverse();
  Eigen::Vector3d lamp; // in the camera frame
  for (unsigned int i = 0; i < 3; ++i)
    lamp(i) = cMw[i][0] * 0.0123 - cMw[i][1] * 0.0087 + cMw[i][2] * 1.5 + cMw[i][3];
  scene.camera.rig.camera.initPersProjWithoutDistortion(1250, 1250, 42 - 1250 * lamp.x() / lamp.z(),
                                                        38 - 1250 * lamp.y() / lamp.z());
  EXPECT_LT(scene.largestError("tilt"), tolerance);
  double brightest = 0;
  cv::minMaxLoc(scene.fast(), nullptr, &brightest);
  EXPECT_GT(brightest, 150);
}

TEST(RollingShutterRenderer, HaloAndCeiling)
{
  for (bool square : {false, true}) {
    Scene scene;
    scene.camera.haloShare = 0.08;
    scene.camera.haloRadius = 15;
    scene.scene.ceilingShare = 0.05;
    scene.scene.ceilingRadius = 0.05;
    scene.lamp().lamp.shape = square ? vpLamp::Shape::square : vpLamp::Shape::disk;
    EXPECT_LT(scene.largestError(square ? "halo of a square" : "halo of a disc"), tolerance);
  }
}

TEST(RollingShutterRenderer, EveryModulationExposureAndReadout)
{
  vpModulation twoPulse;
  twoPulse.kind = Kind::twoPulse;
  twoPulse.frequency = 1500;
  twoPulse.duty = 0.3;
  twoPulse.phaseDifference = 0.37;
  vpModulation word;
  word.kind = Kind::word;
  word.bits = "0111101011001";
  word.chipRate = 8000;
  vpModulation pwm = Scene().lamp().lamp.modulation;
  pwm.frequency = 7400;
  int k = 0;
  for (const vpModulation &modulation : {twoPulse, word, pwm})
    for (double exposure : {20e-6, 200e-6}) {
      Scene scene;
      scene.lamp().lamp.modulation = modulation;
      scene.camera.rig.shutter.exposure = exposure;
      scene.camera.rig.shutter.readout = static_cast<Readout>(k++ % 4);
      EXPECT_LT(scene.largestError("modulation, exposure, readout " + std::to_string(k)), tolerance);
    }
}

TEST(RollingShutterRenderer, CameraThatDrivesAndTurns)
{
  Scene scene;
  scene.speed = 0.2;
  scene.turn = 1;
  scene.camera.rig.height = 50; // the slow one takes its time
  scene.camera.rig.camera.initPersProjWithoutDistortion(1250, 1250, -500, 400);
  scene.pose[0][3] = -0.55;
  scene.pose[1][3] = 0.36;
  scene.camera.rig.shutter.exposure = 200e-6;
  EXPECT_LT(scene.largestError("driving and turning"), tolerance);
}

//! First harmonic of the light on a row, over that of a lamp seen without exposure: pictures are taken at
//! times spread evenly over a period of the lamp, so that every row sees it in every phase.
double contrast(double frequency, double exposure, int row)
{
  Scene scene;
  scene.lamp().lamp.size = 1; // fills the picture
  scene.lamp().lamp.modulation.frequency = frequency;
  scene.lamp().lamp.modulation.duty = 0.5;
  scene.camera.rig.shutter.exposure = exposure;
  scene.camera.rig.width = 3;
  scene.camera.rig.height = 40;
  scene.fast(); // sets the lamp's light
  const vpRollingShutterRenderer renderer(scene.camera);
  static const int pictures = 200; // the 199th harmonic is the first that they take for the first
  std::complex<double> sum = 0;
  for (int k = 0; k < pictures; ++k) {
    const double time = k / (pictures * frequency);
    const cv::Mat_<float> light = renderer.exact(
        scene.scene, [&](double t) { return scene.at(t); }, time);
    sum += (light(row, 1) - scene.scene.ambient) * std::polar(1.0, -2 * M_PI * k / double(pictures));
  }
  return std::abs(sum) / pictures / (scene.lamp().level / M_PI);
}

TEST(RollingShutterRenderer, ContrastFollowsTheSincOfTheExposure)
{
  for (double exposure : {43e-6, 86e-6, 200e-6})
    for (double frequency = 1000; frequency <= 8000; frequency += 500)
      for (int row : {0, 17, 39}) {
        const double x = M_PI * frequency * exposure;
        EXPECT_NEAR(contrast(frequency, exposure, row), std::abs(std::sin(x) / x), 1e-3)
            << frequency << " Hz, " << exposure << " s, row " << row;
      }
}

//! Middle of the light of the whole lamp.
Eigen::Vector2d centroid(const cv::Mat_<float> &light, double background)
{
  Eigen::Vector2d sum(0, 0);
  double weight = 0;
  for (int v = 0; v < light.rows; ++v)
    for (int u = 0; u < light.cols; ++u) {
      weight += light(v, u) - background;
      sum += (light(v, u) - background) * Eigen::Vector2d(u, v);
    }
  return sum / weight;
}

TEST(RollingShutterRenderer, LampsMiddleIsItsProjectionWhenStandingStill)
{
  for (double dx : {0.0, 0.004, 0.0071}) {
    Scene scene;
    scene.lamp().lamp.size = 0.03;
    if (dx > 0) // about the lens's own middle, where it hardly bends the disc itself
      scene.camera.rig.camera.initPersProjWithDistortion(1250, 1250, 31.4, 44.2, -0.3, 0.31);
    scene.lamp().lamp.modulation.kind = Kind::unmodulated;
    scene.pose[0][3] = dx;
    const Eigen::Vector2d seen = centroid(scene.fast(), scene.scene.ambient);
    const Eigen::Vector3d &lamp = scene.lamp().lamp.position;
    double u = 0, v = 0;
    vpMeterPixelConversion::convertPoint(scene.camera.rig.camera, (lamp.x() - dx) / (lamp.z() - 0.19),
                                         lamp.y() / (lamp.z() - 0.19), u, v);
    EXPECT_NEAR(seen.x(), u, 0.01);
    EXPECT_NEAR(seen.y(), v, 0.01);
  }
}

TEST(RollingShutterRenderer, RowsOfAMovingLampAreDisplacedAsTheRowTimesSay)
{
  Scene scene;
  scene.lamp().lamp.modulation.kind = Kind::unmodulated;
  scene.camera.rig.shutter.rowTime = 500e-6; // slow, so that there is something to see
  scene.speed = 0.2;
  const cv::Mat_<float> light = scene.fast();
  const double scale = 1250 / (1.5 - 0.19); // px per m
  for (int v = 15; v < 60; ++v) {
    const double middle = centroid(light.row(v), scene.scene.ambient).x();
    const double time = scene.time + 500e-6 * v + 0.5 * 43.1e-6;
    EXPECT_NEAR(middle, 31.4 + scale * (0.0123 - 0.2 * time), 0.01) << "row " << v;
  }
}

//! The scene as delivered by software that resizes the sensor's picture.
cv::Mat_<float> resized(vpPictureResize::Method method, unsigned int width, unsigned int height)
{
  Scene scene;
  vpVlpRig &rig = scene.camera.rig;
  rig.resize.method = method;
  rig.resize.sourceWidth = rig.width;
  rig.resize.sourceHeight = rig.height;
  rig.camera = rig.resize.delivered(rig.camera, width, height);
  rig.width = width;
  rig.height = height;
  return scene.fast();
}

TEST(RollingShutterRenderer, NearestResizeTakesTheSensorsOwnPixels)
{
  const cv::Mat_<float> whole = Scene().fast(), part = resized(vpPictureResize::Method::nearest, 33, 30);
  for (int v = 0; v < 30; ++v)
    for (int u = 0; u < 33; ++u)
      EXPECT_NEAR(part(v, u), whole(int(v / (30 / 76.)), int(u / (33 / 84.))), 0.02);
}

TEST(RollingShutterRenderer, AreaResizeIsTheMeanOfTheSensorsPixels)
{
  const cv::Mat_<float> whole = Scene().fast(), part = resized(vpPictureResize::Method::area, 42, 38);
  for (int v = 0; v < 38; ++v)
    for (int u = 0; u < 42; ++u)
      EXPECT_NEAR(part(v, u), 0.25 * cv::sum(whole(cv::Rect(2 * u, 2 * v, 2, 2)))[0], 1e-3);
}

TEST(RollingShutterRenderer, NoiseHasTheVarianceOfPhotonsAndReadout)
{
  Scene scene;
  scene.lamp().lamp.modulation.kind = Kind::unmodulated;
  scene.lamp().lamp.size = 1; // fills the picture
  scene.camera.readNoise = 1.5;
  scene.camera.photonsPerLevel = 40;
  scene.fast();
  const vpRollingShutterRenderer renderer(scene.camera);
  vpImage<unsigned char> I;
  double sum = 0, squares = 0, count = 0;
  for (unsigned int seed = 0; seed < 20; ++seed) {
    renderer.render(
        scene.scene, [&](double t) { return scene.at(t); }, 0, seed, I);
    for (unsigned int k = 0; k < I.getSize(); ++k) {
      sum += I.bitmap[k];
      squares += double(I.bitmap[k]) * I.bitmap[k];
      ++count;
    }
  }
  const double mean = sum / count, variance = squares / count - mean * mean;
  EXPECT_NEAR(mean, 206, 0.05);
  // 8 bits add 1 / 12; of 127 000 pixels the variance is good to 0.4 % (one sigma).
  EXPECT_NEAR(variance, 1.5 * 1.5 + 206 / 40. + 1 / 12., 0.1);
}

TEST(RollingShutterRenderer, SameSeedSameBytes)
{
  Scene scene;
  scene.fast();
  const vpRollingShutterRenderer renderer(scene.camera), again(scene.camera);
  vpImage<unsigned char> I, K, L;
  const auto pose = [&](double t) { return scene.at(t); };
  renderer.render(scene.scene, pose, 0, 7, I);
  again.render(scene.scene, pose, 0, 7, K);
  renderer.render(scene.scene, pose, 0, 8, L);
  EXPECT_TRUE(I == K);
  EXPECT_FALSE(I == L);
}

TEST(RollingShutterRenderer, SaturatesAtWhite)
{
  Scene scene;
  scene.lamp().level = 1000;
  scene.fast();
  vpImage<unsigned char> I;
  vpRollingShutterRenderer(scene.camera)
      .render(
          scene.scene, [&](double t) { return scene.at(t); }, 0, 1, I);
  EXPECT_EQ(I.getMaxValue(), 255);
}

TEST(RollingShutterRenderer, SomeoneWhoStandsUnderALampHidesIt)
{
  Scene scene;
  scene.lamp().lamp.modulation.kind = Kind::unmodulated;
  vpSimulatedPerson person;
  person.radius = 0.1;
  person.height = 1.2;
  person.path = {{0, {2.0, 0.0}}, {1, {0.12, 0.0}}}; // the camera looks past at first
  scene.scene.people.push_back(person);
  const cv::Mat_<float> before = scene.fast();
  scene.time = 1;
  const cv::Mat_<float> after = scene.fast();
  double lit = 0, dark = 0;
  for (int v = 0; v < before.rows; ++v) {
    lit += before(v, 43) > 100;
    dark += after(v, 80) < person.level + 0.1 && after(v, 1) > scene.scene.ambient - 0.1;
  }
  EXPECT_GT(lit, 50);
  EXPECT_EQ(dark, before.rows) << "the right side is hidden, the left is not";
}

TEST(RollingShutterRenderer, BadNumbersAreNamed)
{
  auto message = [](const vpSimulatedCamera &camera) -> std::string {
    try {
      vpRollingShutterRenderer renderer(camera);
    } catch (const vpException &error) {
      return error.getStringMessage();
    }
    return "accepted";
  };
  vpSimulatedCamera camera = Scene().camera;
  EXPECT_EQ(message(camera), "accepted");
  camera.rig.shutter.exposure = -1;
  EXPECT_NE(message(camera).find("exposure"), std::string::npos);
  camera = Scene().camera;
  camera.blur = std::nan("");
  EXPECT_NE(message(camera).find("blur"), std::string::npos);
}
