/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLocateScene_h
#define vpLocateScene_h

/*!
  \file vpLocateScene.h
  A small world for the tests of the programs: three blinking lamps, a camera of 640 x 480 pixels on a robot,
  and the files and pictures that a program gets to see of it.
*/

#include <cmath>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/core/vpRzyxVector.h>

#include "common/vpLampPicture.h"
#include "common/vpTemporaryFolder.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace vpLocateScene
{
constexpr double focal = 600, u0 = 322.5, v0 = 238; // px
constexpr double diameter = 0.16;                   // m
const vpHomogeneousMatrix bMc(0.02, -0.01, 0.11, 0, 0, 0);

struct Lamp {
  std::string id;
  double x, y, z;   // m
  double frequency; // Hz
};
const std::vector<Lamp> lamps = {
    {"A", -0.35, -0.28, 1.6, 2000}, {"B", 0.36, -0.25, 1.6, 3000}, {"C", 0.05, 0.33, 1.6, 4100}};

//! What --fixes writes.
const std::vector<std::string> fixColumns = {"timestamp_s", "x",      "y",       "z",       "roll",
                                             "pitch",       "yaw",    "sigma_x", "sigma_y", "sigma_z",
                                             "sigma_yaw",   "cov_xy", "lamps",   "state",   "compute_s"};

//! A robot that stands level on the floor: m, rad.
inline vpHomogeneousMatrix robot(double x, double y, double yaw)
{
  return {vpTranslationVector(x, y, 0), vpRotationMatrix(vpRzyxVector(yaw, 0, 0))};
}

//! What the camera sees from there of lamps of that diameter.
inline cv::Mat picture(const vpHomogeneousMatrix &wMb = robot(0.06, -0.04, 0.5),
                       const std::vector<Lamp> &seen = lamps, double size = diameter)
{
  vpLampPicture scene;
  scene.blur = 0.7;
  scene.background = 4;
  scene.noise = 1;
  const vpHomogeneousMatrix cMw = (wMb * bMc).inverse();
  for (const Lamp &lamp : seen) {
    const vpColVector c = cMw * vpColVector(std::vector<double>{lamp.x, lamp.y, lamp.z, 1});
    vpPaintedLamp painted;
    painted.centre = {u0 + focal * c[0] / c[2], v0 + focal * c[1] / c[2]};
    painted.a = painted.b = 0.5 * focal * size / c[2];
    painted.frequency = lamp.frequency;
    painted.pwm(0.5);
    scene.lamps.push_back(painted);
  }
  const vpImage<unsigned char> I = scene.render();
  return cv::Mat(scene.height, scene.width, CV_8UC1, I.bitmap).clone();
}

//! Bytes of a picture's file.
inline std::string encoded(const std::string &extension, const cv::Mat &picture)
{
  std::vector<unsigned char> bytes;
  cv::imencode(extension, picture, bytes);
  return std::string(bytes.begin(), bytes.end());
}

inline std::string lampsText(const std::vector<Lamp> &listed = lamps, bool sizes = true)
{
  std::string text = "lamps:\n";
  for (const Lamp &lamp : listed) {
    text += "  - {id: " + lamp.id + ", position_m: [" + std::to_string(lamp.x) + ", " +
            std::to_string(lamp.y) + ", " + std::to_string(lamp.z) + "], " +
            (sizes ? "diameter_m: " + std::to_string(diameter) + ", " : "") +
            "frequency_hz: " + std::to_string(lamp.frequency) + ", duty: 0.5}\n";
  }
  return text;
}

//! Writes rig.yaml, camera.xml and lamps.yaml. \return The options that name them.
inline std::vector<std::string> writeRig(const vpTemporaryFolder &folder, int width = 640, int height = 480,
                                         const std::string &mountSigma = "")
{
  folder.write("camera.xml",
               "<?xml version=\"1.0\"?>\n<root><camera><name>test</name><image_width>" +
                   std::to_string(width) + "</image_width><image_height>" + std::to_string(height) +
                   "</image_height><model><type>perspectiveProjWithoutDistortion</type><px>" +
                   std::to_string(focal) + "</px><py>" + std::to_string(focal) + "</py><u0>" +
                   std::to_string(u0) + "</u0><v0>" + std::to_string(v0) + "</v0></model></camera></root>\n");
  return {"--rig",
          folder.write(
              "rig.yaml",
              "camera: {file: camera.xml, name: test}\n"
              "shutter: {row_time_s: 43.1e-6, row_time_sigma_s: 2e-9, exposure_s: 43.1e-6, readout: rows}\n"
              "mount: {translation_m: [0.02, -0.01, 0.11], rotation_rpy_deg: [0, 0, 0]" +
                  mountSigma + "}\n"),
          "--lamps", folder.write("lamps.yaml", lampsText())};
}

//! The same with more words behind.
inline std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string> &more)
{
  words.insert(words.end(), more.begin(), more.end());
  return words;
}
} // namespace vpLocateScene

#endif
