/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Lamps that do not shine evenly: the patterns themselves, and what the renderer makes of them.

#include <visp3/vlp_simulation/vpEmission.h>

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/vpExpectError.h"
#include "cornerScene.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
using cornerScene::Scene;

struct Named {
  const char *name;
  vpEmission emission;
};

//! One of each kind that is bright in places.
std::vector<Named> uneven()
{
  return {{"hot spot", vpEmission::hotSpot({0.3, -0.2}, 0.25, 0.2)},
          {"ring of dies", vpEmission::ringOfDies(7, 0.6, 0.12, 0.1)},
          {"grid of dies", vpEmission::gridOfDies(4, 0.12, 0.15)},
          {"dome", vpEmission::dome(0.1, 1.5)},
          {"edge lit", vpEmission::edgeLit(0.3, 0.3, 0.6)},
          {"cracked", vpEmission::cracked(12, 0.8, 3)}};
}

//! Of its places on a fine raster, those in the outline.
struct Statistics {
  double least = 1e9, most = 0, mean = 0;

  Statistics(const vpEmission &emission, bool disc)
  {
    static const int across = 801;
    int count = 0;
    for (int k = 0; k < across * across; ++k) {
      const Eigen::Vector2d place(2. * (k % across) / (across - 1) - 1, 2. * (k / across) / (across - 1) - 1);
      if (disc && place.norm() > 1) {
        continue;
      }
      const double light = emission.at(place);
      least = std::min(least, light);
      most = std::max(most, light);
      mean += light;
      ++count;
    }
    mean /= count;
  }
};

//! What the renderer draws less the ceiling, summed.
double totalLight(Scene &scene)
{
  const cv::Mat_<float> light = scene.fast();
  return cv::sum(light)[0] - scene.scene.ambient * static_cast<double>(light.total());
}

void unblinking(Scene &scene)
{
  scene.lamp().lamp.modulation = {};
  scene.lamp().lamp.modulation.kind = vpModulation::Kind::unmodulated;
}
} // namespace

TEST(Emission, IsOneAtItsBrightestAndNowhereNegative)
{
  for (const auto &[name, emission] : uneven()) {
    for (const bool disc : {true, false}) {
      const Statistics statistics(emission, disc);
      EXPECT_NEAR(statistics.most, 1, 1e-3) << name;
      EXPECT_GE(statistics.least, 0) << name;
      EXPECT_FALSE(emission.even()) << name;
    }
  }
  // Dies that overlap are brightest between them.
  EXPECT_NEAR(Statistics(vpEmission::ringOfDies(9, 0.5, 0.5, 0), true).most, 1, 1e-3);
  EXPECT_NEAR(Statistics(vpEmission::ringOfDies(1, 0.95, 0.02, 0), true).most, 1, 1e-2);
  EXPECT_TRUE(vpEmission().even() && vpEmission::tube(1).even());
  EXPECT_FALSE(vpEmission::tube(0.2).even() || vpEmission::tube(0.2).patterned());
}

TEST(Emission, PatternsAreWhatTheirNamesSay)
{
  EXPECT_NEAR(vpEmission::hotSpot({0.3, -0.2}, 0.25, 0.2).at({0.3 + 0.25, -0.2}), 0.2 + 0.8 * std::exp(-0.5),
              1e-12);
  const vpEmission ring = vpEmission::ringOfDies(4, 0.6, 0.05, 0.1);
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(ring.at({0.6 * std::cos(k * M_PI / 2), 0.6 * std::sin(k * M_PI / 2)}), 1, 1e-6);
  }
  EXPECT_NEAR(ring.at({0, 0}), 0.1, 1e-6);
  const vpEmission grid = vpEmission::gridOfDies(2, 0.1, 0.1);
  EXPECT_NEAR(grid.at({-0.5, 0.5}), 1, 1e-12);
  EXPECT_NEAR(grid.at({0, 0}), 0.1, 1e-4);
  const vpEmission dome = vpEmission::dome(0.2, 2);
  EXPECT_NEAR(dome.at({0.6, 0}), 0.2 + 0.8 * 0.64, 1e-12);
  EXPECT_NEAR(dome.at({0, 1}), 0.2, 1e-12);
  const vpEmission panel = vpEmission::edgeLit(0.1, 0.2, 0.5);
  EXPECT_NEAR(panel.at({1, 0.3}), 1, 1e-6);
  EXPECT_NEAR(panel.at({-1, 0.3}), 0.6, 1e-6);
  EXPECT_NEAR(panel.at({0, 0.3}), 0.2, 1e-3);
  EXPECT_EQ(vpEmission::tube(0.2).at({0.9, 0.19}), 1);
  EXPECT_EQ(vpEmission::tube(0.2).at({0.9, 0.21}), 0);
}

TEST(Emission, SeedsCrackDifferentlyAndTheSameSeedAlike)
{
  const vpEmission a = vpEmission::cracked(20, 0.8, 1), same = vpEmission::cracked(20, 0.8, 1),
                   other = vpEmission::cracked(20, 0.8, 2);
  int equal = 0, differ = 0;
  for (int k = 0; k < 20; ++k) {
    const double x = 0.1 * k - 0.95;
    equal += a.at({x, 0.1}) == same.at({x, 0.1});
    differ += a.at({x, 0.1}) != other.at({x, 0.1});
  }
  EXPECT_EQ(equal, 20);
  EXPECT_GT(differ, 10);
  EXPECT_EQ(Statistics(vpEmission::cracked(20, 0, 1), true).least, 1) << "no spread: even";
}

TEST(Emission, MirrorsAcrossItsXAxis)
{
  for (const auto &[name, emission] : uneven()) {
    EXPECT_EQ(emission.mirrored().at({0.31, 0.17}), emission.at({0.31, -0.17})) << name;
    EXPECT_EQ(emission.mirrored().mirrored().at({0.31, 0.17}), emission.at({0.31, 0.17})) << name;
  }
}

TEST(Emission, NumbersOutOfTheirRangeAreNamed)
{
  vpExpectError(
      [] {
        vpEmission::hotSpot({1, 1}, 0.2, 0.1);
      },
      {"place: 1, 1, expected a place within the unit circle"});
  vpExpectError([] { vpEmission::hotSpot({0, 0}, 0.01, 0.1); }, {"width: 0.01, expected a number from 0.02"});
  vpExpectError([] { vpEmission::ringOfDies(0, 0.5, 0.1, 0.1); },
                {"dies: 0, expected a number from 1 to 100"});
  vpExpectError([] { vpEmission::ringOfDies(5, 1, 0.1, 0.1); }, {"radius: 1, expected"});
  vpExpectError([] { vpEmission::gridOfDies(21, 0.1, 0.1); }, {"across: 21, expected"});
  vpExpectError([] { vpEmission::gridOfDies(3, 0.1, 1.1); }, {"rest: 1.1, expected"});
  vpExpectError([] { vpEmission::dome(-0.1, 1); }, {"rim: -0.1, expected"});
  vpExpectError([] { vpEmission::dome(0.1, std::nan("")); }, {"power: nan, expected"});
  vpExpectError([] { vpEmission::edgeLit(0.3, 0.3, 2); }, {"other: 2, expected"});
  vpExpectError([] { vpEmission::cracked(201, 0.8, 1); }, {"patches: 201, expected"});
  vpExpectError([] { vpEmission::cracked(10, 4, 1); }, {"spread: 4, expected"});
  vpExpectError([] { vpEmission::tube(0); }, {"width: 0, expected a number from 0.01 to 1"});
}

TEST(RollingShutterRendererEmission, SmoothOnesAreExactToAGreyLevel)
{
  bool square = false; // every other one
  for (const auto &[name, emission] : uneven()) {
    if (std::string(name) == "cracked") {
      continue;
    }
    Scene scene;
    scene.lamp().emission = emission;
    scene.lamp().lamp.shape = square ? vpLamp::Shape::square : vpLamp::Shape::disk;
    scene.lamp().lamp.yaw = square ? 0.3 : 0;
    EXPECT_LT(scene.largestError(std::string(name) + (square ? ", square" : ", disc")), 1.0);
    square = !square;
  }
}

TEST(RollingShutterRendererEmission, CracksAreExactToThreePercentOfTheirJump)
{
  for (const double blur : {0.3, 0.7, 1.5}) {
    Scene scene;
    scene.camera.blur = blur;
    scene.lamp().emission = vpEmission::cracked(12, 0.8, 3);
    EXPECT_LT(scene.largestError("cracked, blur " + std::to_string(blur)), 0.03 * scene.lamp().level);
  }
}

TEST(RollingShutterRendererEmission, TubeIsAnExactRectangle)
{
  Scene scene;
  scene.lamp().lamp.shape = vpLamp::Shape::square;
  scene.lamp().lamp.yaw = 0.3;
  scene.lamp().emission = vpEmission::tube(0.2);
  EXPECT_LT(scene.largestError("tube"), 0.5);
}

TEST(RollingShutterRendererEmission, DistortionAndFewPixels)
{
  Scene distorted;
  distorted.camera.rig.camera.initPersProjWithDistortion(600, 610, -300, 350, -0.15, 0.16);
  distorted.pose[0][3] = -0.75;
  distorted.pose[1][3] = 0.65;
  distorted.lamp().lamp.size = 0.1;
  distorted.lamp().emission = vpEmission::ringOfDies(7, 0.6, 0.12, 0.1);
  EXPECT_LT(distorted.largestError("distortion"), 1);
  for (const double pixels : {1.5, 5.}) {
    Scene small;
    small.camera.rig.width = small.camera.rig.height = 60;
    small.lamp().level = 3000 / pixels; // some 100 grey levels when blurred
    unblinking(small);
    small.lamp().lamp.size = pixels / 954;
    small.lamp().emission = vpEmission::edgeLit(0.3, 0.1, 0.3);
    EXPECT_LT(small.largestError("edge lit, " + std::to_string(pixels) + " px"), 0.007 * small.lamp().level);
  }
}

TEST(RollingShutterRendererEmission, HaloIsThatOfThePattern)
{
  for (const vpEmission &emission :
       {vpEmission::hotSpot({0.5, -0.3}, 0.2, 0.02), vpEmission::edgeLit(0.3, 0.1, 0)}) {
    Scene scene;
    scene.camera.rig.width = scene.camera.rig.height = 60; // the slow one takes its time
    scene.camera.haloShare = 0.08;
    scene.camera.haloRadius = 15;
    scene.lamp().lamp.size = 0.04;
    scene.lamp().emission = emission;
    EXPECT_LT(scene.largestError("halo"), 0.7);
  }
}

TEST(EmissionRendered, TotalLightIsThatOfAnEvenLampTimesTheMean)
{
  for (const bool disc : {true, false}) {
    Scene scene;
    unblinking(scene);
    scene.lamp().lamp.shape = disc ? vpLamp::Shape::disk : vpLamp::Shape::square;
    scene.lamp().lamp.size = 0.045; // whole in the picture
    const double even = totalLight(scene);
    for (const auto &[name, emission] : uneven()) {
      scene.lamp().emission = emission;
      EXPECT_NEAR(totalLight(scene) / even, Statistics(emission, disc).mean, 2e-3) << name;
    }
    if (!disc) {
      scene.lamp().emission = vpEmission::tube(0.3);
      EXPECT_NEAR(totalLight(scene) / even, 0.3, 1e-3);
    }
  }
}

TEST(EmissionRendered, BrightestPlaceHasTheLampsLevel)
{
  for (const auto &[name, emission] : uneven()) {
    Scene scene;
    unblinking(scene);
    scene.lamp().lamp.size = 1; // hardly anything of the pattern within a pixel
    scene.lamp().lamp.position.head<2>().setZero();
    scene.camera.rig.camera.initPersProjWithoutDistortion(100, 100, 41.5, 37.5);
    scene.scene.ambient = 0;
    double most = 0;
    cv::minMaxLoc(scene.fast(), nullptr, &most);
    EXPECT_NEAR(most, scene.lamp().level, 0.03 * scene.lamp().level) << name;
    EXPECT_LE(most, scene.lamp().level * 1.001) << name;
  }
}

//! The pattern on a camera that turned with the lamp is the pattern.
TEST(EmissionRendered, PatternTurnsWithTheLampsYaw)
{
  Scene scene;
  unblinking(scene);
  scene.lamp().lamp.shape = vpLamp::Shape::square;
  scene.lamp().lamp.position.head<2>().setZero();
  scene.lamp().lamp.size = 0.03;
  scene.lamp().emission = vpEmission::hotSpot({0.6, 0}, 0.2, 0);
  const double scale = 1250 / (1.5 - 0.19); // px per m
  for (const double yaw : {0.0, 0.5, M_PI / 2, 3.0}) {
    scene.lamp().lamp.yaw = yaw;
    double most = 0;
    cv::Point at;
    cv::minMaxLoc(scene.fast(), nullptr, &most, nullptr, &at);
    // The camera of this scene has the map's own axes.
    EXPECT_NEAR(at.x, 31.4 + 0.6 * 0.015 * scale * std::cos(yaw), 1) << yaw;
    EXPECT_NEAR(at.y, 44.2 + 0.6 * 0.015 * scale * std::sin(yaw), 1) << yaw;
  }
}

TEST(EmissionRendered, PatternThatIsOneEverywhereEqualsTheEvenLamp)
{
  Scene scene;
  const cv::Mat_<float> even = scene.fast();
  scene.lamp().emission = vpEmission::cracked(5, 0, 1); // no spread
  EXPECT_LT(cv::norm(scene.fast(), even, cv::NORM_INF), 1e-4);
  scene.lamp().rim = 0.5; // of an even lamp only
  EXPECT_LT(cv::norm(scene.fast(), even, cv::NORM_INF), 1e-4);
}

//! Seen aslant, from beside, from the horizon, or farther away than numbers go.
TEST(EmissionRendered, StaysANumberBetweenDarkAndTheLampsLevel)
{
  for (const auto &[name, emission] : uneven()) {
    Scene scene;
    unblinking(scene);
    scene.camera.haloShare = 0.1;
    scene.camera.haloRadius = 2;
    scene.camera.rig.camera.initPersProjWithoutDistortion(30, 30, 42, 38);
    scene.lamp().emission = emission;
    scene.lamp().lamp.size = 1.2;
    const double most = 1.12 * scene.lamp().level + scene.scene.ambient; // with its halo
    for (double degrees = 0; degrees < 180; degrees += 30) {
      scene.pose.insert(vpRotationMatrix(0, degrees * M_PI / 180, 0));
      for (const Eigen::Vector3d &at : {Eigen::Vector3d(-0.5, 0, 0.25), Eigen::Vector3d(0.3, 0, 0.2),
                                        Eigen::Vector3d(1e9, 0, 1), Eigen::Vector3d(0, 1e300, 1e300)}) {
        scene.lamp().lamp.position = at;
        double least = 0, brightest = 0;
        cv::minMaxLoc(scene.fast(), &least, &brightest);
        EXPECT_TRUE(cv::checkRange(scene.fast())) << name << " " << degrees << " " << at.transpose();
        EXPECT_GE(least, scene.scene.ambient - 1e-3) << name << " " << degrees << " " << at.transpose();
        EXPECT_LE(brightest, most) << name << " " << degrees << " " << at.transpose();
      }
    }
  }
}

TEST(EmissionRendered, DiscWithATubeIsRefused)
{
  Scene scene;
  scene.lamp().emission = vpEmission::tube(0.2);
  vpExpectError([&] { scene.fast(); }, {"lamp A: a disc with the emission of a tube, expected a square"});
}
