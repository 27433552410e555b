/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The renderer where its approximations end: lamps of few pixels, lamps aslant or beside the camera, tiny
// pictures, light beyond white.

#include <gtest/gtest.h>
#include <visp3/core/vpMeterPixelConversion.h>
#include <visp3/core/vpRotationMatrix.h>

#include "common/vpExpectError.h"
#include "slowRollingShutter.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
//! A lamp that never blinks over a camera that looks straight up.
struct Still {
  vpSimulatedCamera camera;
  vpSimulatedScene scene;
  vpHomogeneousMatrix wMc;

  Still()
  {
    camera.rig.width = 40;
    camera.rig.height = 30;
    camera.rig.camera.initPersProjWithoutDistortion(1000, 1000, 20.3, 14.8);
    camera.rig.shutter.rowTime = camera.rig.shutter.exposure = 43e-6;
    vpSimulatedLamp lamp;
    lamp.lamp.id = "A";
    lamp.lamp.position = Eigen::Vector3d(0, 0, 1);
    lamp.lamp.size = 0.01; // 10 px
    lamp.level = 200;
    scene.lamps.push_back(lamp);
    scene.ambient = 6;
  }

  vpSimulatedLamp &lamp() { return scene.lamps[0]; }
  vpRollingShutterRenderer::Poses poses() const
  {
    return [this](double) { return wMc; };
  }
  cv::Mat_<float> drawn() const { return vpRollingShutterRenderer(camera).exact(scene, poses(), 0); }

  double largestError() const
  {
    const cv::Mat_<float> fast = drawn();
    const cv::Mat_<double> slow = SlowRollingShutter{camera, scene, poses(), 0, false, {0}}.exact();
    double largest = 0;
    for (int v = 0; v < slow.rows; ++v) {
      for (int u = 0; u < slow.cols; ++u) {
        largest = std::max(largest, std::abs(fast(v, u) - slow(v, u)));
      }
    }
    return largest;
  }

  //! Puts the camera into the picture's middle a lamp that it sees \e angle (rad) off the vertical.
  void lookAslant(double angle)
  {
    lamp().lamp.position = Eigen::Vector3d(std::sin(angle), 0, std::cos(angle));
    wMc.insert(vpRotationMatrix(0, angle, 0));
  }
};

double brightest(const cv::Mat_<float> &light)
{
  double most = 0;
  cv::minMaxLoc(light, nullptr, &most);
  return most;
}
} // namespace

TEST(RendererLimits, LampOfFewPixels)
{
  for (const double size : {0.0005, 0.002, 0.004, 0.007}) {
    for (const double rim : {0.0, 0.5}) {
      Still still;
      still.lamp().lamp.size = size;
      still.lamp().rim = rim;
      EXPECT_LT(still.largestError(), rim > 0 ? 1.5 : 1) << 1000 * size << " px, rim " << rim;
    }
  }
}

TEST(RendererLimits, LampSeenAslantAndOnEdge)
{
  for (const double degrees : {50.0, 70.0, 80.0, 86.0}) {
    Still still;
    still.lookAslant(degrees * M_PI / 180);
    still.lamp().lamp.size = 0.025;
    EXPECT_LT(still.largestError(), 1.5) << degrees << " degrees";
  }
}

TEST(RendererLimits, LampStraightBesideTheCameraOrBelowShowsNothing)
{
  for (const double height : {0.0, -1.0}) {
    Still still;
    still.scene.ceilingShare = 0.1;
    still.camera.haloShare = 0.05;
    still.lookAslant(M_PI / 2);
    still.lamp().lamp.position.z() = height;
    still.lamp().lamp.size = 0.5;
    EXPECT_NEAR(brightest(still.drawn()), still.scene.ambient, 1e-3) << height;
  }
}

//! Level with the picture on either side, above and below it. (An assertion of the standard library tells, or
//! a sanitizer.)
TEST(RendererLimits, LampBesideThePictureShowsNothing)
{
  Still still;
  still.lamp().lamp.size = 0.01;
  for (const Eigen::Vector2d &side : {Eigen::Vector2d(1, 0), Eigen::Vector2d(-1, 0), Eigen::Vector2d(0, 1),
                                      Eigen::Vector2d(0, -1), Eigen::Vector2d(1, 1)}) {
    still.lamp().lamp.position.head<2>() = 0.1 * side;
    EXPECT_NEAR(brightest(still.drawn()), still.scene.ambient, 1e-3) << side.transpose();
  }
}

TEST(RendererLimits, CameraThatLooksDownSeesNoLamp)
{
  Still still;
  still.scene.ceilingShare = 0.1;
  still.camera.haloShare = 0.05;
  still.camera.vignetting = 1;
  for (const double turn : {M_PI, 0.99 * M_PI, 0.6 * M_PI}) {
    still.wMc.insert(vpRotationMatrix(turn, 0, 0));
    const cv::Mat_<float> light = still.drawn();
    EXPECT_TRUE(cv::checkRange(light));
    EXPECT_LE(brightest(light), still.scene.ambient + 1e-3) << turn;
  }
}

//! The horizon in view: pixels whose neighbours see the other side of it.
TEST(RendererLimits, NoLightAtTheHorizon)
{
  Still still;
  still.camera.rig.camera.initPersProjWithoutDistortion(30, 30, 20.3, 14.8);
  still.camera.rig.width = 41;
  for (double degrees = 60; degrees <= 120; degrees += 2.5) {
    still.wMc.insert(vpRotationMatrix(0, degrees * M_PI / 180, 0));
    still.lamp().lamp.position = Eigen::Vector3d(-0.5, 0, 0.06); // behind
    still.lamp().lamp.size = 1.2;                                // and overhead
    const cv::Mat_<float> light = still.drawn();
    EXPECT_TRUE(cv::checkRange(light)) << degrees;
    for (int v = 0; v < light.rows; ++v) {
      for (int u = 0; u < light.cols; ++u) {
        const Eigen::Vector3d ray((u - 20.3) / 30, (v - 14.8) / 30, 1);
        const double up = still.wMc[2][0] * ray.x() + still.wMc[2][1] * ray.y() + still.wMc[2][2];
        if (up / ray.norm() < 0.06) { // where the lamp's edge is 0.6 of that, farther than a pixel's blur
          EXPECT_NEAR(light(v, u), still.scene.ambient, 1) << degrees << " " << u << " " << v;
        }
      }
    }
  }
}

TEST(RendererLimits, NarrowHaloOfALargeLamp)
{
  Still still;
  still.camera.haloShare = 0.1;
  for (const double radius : {2.0, 5.0, 15.0}) {
    still.camera.haloRadius = radius;
    for (const double size : {1.0, 100.0}) { // far beyond the picture: the halo is even
      still.lamp().lamp.size = size;
      const cv::Mat_<float> light = still.drawn();
      EXPECT_NEAR(light(15, 20), 6 + 200 * 1.1, 0.1) << radius << " px, lamp of " << size << " m";
      EXPECT_NEAR(light(0, 0), light(15, 20), 0.2);
    }
  }
}

TEST(RendererLimits, PictureOfOnePixel)
{
  Still still;
  still.camera.rig.width = still.camera.rig.height = 1;
  still.camera.rig.camera.initPersProjWithoutDistortion(1000, 1000, 0, 0);
  still.camera.haloShare = 0.1;
  still.scene.ceilingShare = 0.01;
  vpSimulatedPerson person;
  person.path = {{0, {5, 5}}};
  still.scene.people.push_back(person);
  for (const auto readout : {vpRollingShutter::Readout::rows, vpRollingShutter::Readout::columnsReversed}) {
    still.camera.rig.shutter.readout = readout;
    still.scene.people[0].path[0].position = Eigen::Vector2d(5, 5);
    const cv::Mat_<float> light = still.drawn();
    ASSERT_EQ(light.size(), cv::Size(1, 1));
    EXPECT_GT(light(0, 0), 205);
    still.scene.people[0].path[0].position.setZero(); // overhead
    EXPECT_NEAR(still.drawn()(0, 0), person.level, 0.1);
  }
}

TEST(RendererLimits, LightBeyondWhiteIsWhite)
{
  Still still;
  still.lamp().lamp.size = 1;
  vpImage<unsigned char> I;
  for (const double level : {1e3, 1e9, 1e12, 1e300}) {
    still.lamp().level = level;
    vpRollingShutterRenderer(still.camera).render(still.scene, still.poses(), 0, 1, I);
    EXPECT_EQ(I.getMinValue(), 255) << level;
  }
  still.lamp().level = 100;
  still.camera.readNoise = 1e300; // none of it a number out of range
  vpRollingShutterRenderer(still.camera).render(still.scene, still.poses(), 0, 1, I);
  EXPECT_EQ(I.getMaxValue(), 255);
  EXPECT_EQ(I.getMinValue(), 0);
}

//! Barrel distortion bends what is far off the axis back into the picture; a window whose corners are there
//! is whole.
TEST(RendererLimits, WindowThatReachesBeyondTheLens)
{
  Still still;
  still.camera.rig.camera.initPersProjWithDistortion(60, 60, 20, 15, -0.15, 0.16);
  vpSimulatedWindow window;
  window.centre = Eigen::Vector3d(0, 0, 1);
  window.level = 100;
  still.scene.lamps.clear();
  still.scene.windows.push_back(window);
  for (const double half : {1.0, 2.0, 3.0, 6.0, 50.0}) {
    still.scene.windows[0].halfWidth = Eigen::Vector3d(half, 0, 0);
    still.scene.windows[0].halfHeight = Eigen::Vector3d(0, half, 0);
    const cv::Mat_<float> light = still.drawn();
    double least = 0;
    cv::minMaxLoc(light, &least);
    EXPECT_NEAR(least, 106, 0.1) << half << " m";
  }
}

TEST(RendererLimits, PersonWithoutAPathIsRefused)
{
  Still still;
  still.scene.people.emplace_back();
  vpExpectError([&] { still.drawn(); }, {"person: no path"});
}

TEST(RendererLimits, FarPlacesAndHugeThingsStayNumbers)
{
  Still still;
  still.camera.haloShare = 0.1;
  still.scene.ceilingShare = 0.01;
  vpSimulatedPerson person;
  person.path = {{-1e300, {1e300, -1e300}}, {1e300, {0, 1e300}}};
  still.scene.people.push_back(person);
  for (const double place : {1e4, 1e9, 1e150, 1e300}) {
    for (const Eigen::Vector3d &at : {Eigen::Vector3d(place, 0, 1), Eigen::Vector3d(0, -place, place)}) {
      still.lamp().lamp.position = at;
      EXPECT_TRUE(cv::checkRange(still.drawn())) << at.transpose();
    }
  }
}
