/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef cornerScene_h
#define cornerScene_h

/*!
  \file cornerScene.h
  One lamp over the corner of a sensor, drawn by the renderer and by the slow rolling shutter.
*/

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>

#include <gtest/gtest.h>
#include <visp3/core/vpRotationMatrix.h>
#include <visp3/vlp_simulation/vpRollingShutterRenderer.h>

#include "slowRollingShutter.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace cornerScene
{
//! A corner of a sensor under one lamp; each test changes what it is about.
struct Scene {
  vpSimulatedCamera camera;
  vpSimulatedScene scene;
  vpHomogeneousMatrix pose; // wMc at time 0
  double speed = 0;         // m/s along the map's x
  double turn = 0;          // rad/s about the map's z
  double phase = 0.3;       // periods
  double time = 0.01;       // s, of the frame

  Scene()
  {
    camera.rig.width = 84;
    camera.rig.height = 76;
    camera.rig.camera.initPersProjWithoutDistortion(1250, 1250, 31.4, 44.2);
    camera.rig.shutter.rowTime = 43.1e-6;
    camera.rig.shutter.exposure = 43.1e-6;
    camera.blur = 0.7;
    pose[2][3] = 0.19;
    vpSimulatedLamp lamp;
    lamp.lamp.id = "A";
    lamp.lamp.position = Eigen::Vector3d(0.0123, -0.0087, 1.5);
    lamp.lamp.size = 0.058; // 55 px
    lamp.lamp.modulation.kind = vpModulation::Kind::pwm;
    lamp.lamp.modulation.frequency = 2300;
    lamp.lamp.modulation.duty = 0.4;
    lamp.level = 200;
    scene.lamps.push_back(lamp);
  }

  vpSimulatedLamp &lamp() { return scene.lamps[0]; }

  vpHomogeneousMatrix at(double t) const
  {
    const vpHomogeneousMatrix drive(vpTranslationVector(speed * t, 0, 0), vpRotationMatrix(0, 0, turn * t));
    return drive * pose;
  }

  cv::Mat_<float> fast()
  {
    lamp().light = vpLampLight(lamp().lamp.modulation, 1, phase);
    return vpRollingShutterRenderer(camera).exact(
        scene, [this](double t) { return at(t); }, time);
  }

  double largestError(const std::string &what)
  {
    const cv::Mat_<float> drawn = fast();
    const SlowRollingShutter slow{
        camera, scene, [this](double t) { return at(t); }, time, speed != 0 || turn != 0, {phase}};
    const cv::Mat_<double> expected = slow.exact();
    EXPECT_GT(cv::norm(expected, cv::NORM_INF), 50) << "no lamp in view";
    double largest = 0, brightest = 0;
    for (int v = 0; v < expected.rows; ++v)
      for (int u = 0; u < expected.cols; ++u) {
        largest = std::max(largest, std::abs(drawn(v, u) - expected(v, u)));
        brightest = std::max(brightest, expected(v, u));
      }
    std::cout << what << ": largest error " << largest << " grey levels of " << brightest << "\n";
    return largest;
  }
};
} // namespace cornerScene

#endif
