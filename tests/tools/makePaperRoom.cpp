/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */

/*!
  \file makePaperRoom.cpp
  Makes data/paper-room, a recorded run in a room like the paper's, by brute force and without any formula of
  the library that is to locate the robot in it. A level camera sees a flat disc as an exact circle. Usage:
  makePaperRoom FOLDER
*/

#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <visp3/core/vpException.h>
#include <visp3/core/vpRzyxVector.h>
#include <visp3/vlp_core/vpAtomicFile.h>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpVlpRig.h>

#include "common/vpLampPicture.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
constexpr unsigned int seed = 20;
constexpr int frames = 9;
constexpr double interval = 10; // s between frames
constexpr double speed = 0.004; // m/s, the paper's
constexpr double radius = 0.28; // m, of the arc that the robot drives, to the left

//! A lamp as it is; the map knows its nominal frequency only.
struct Lamp {
  vpLamp nominal;
  double ppm;       // by which its clock is off
  double amplitude; // grey levels while lit
  double phase;     // periods, at time 0
};

Lamp lamp(const std::string &id, double x, double y, double z, double diameter, double frequency, double duty,
          double ppm, double amplitude, double phase)
{
  Lamp made{vpLamp(), ppm, amplitude, phase};
  made.nominal.id = id;
  made.nominal.position = {x, y, z};
  made.nominal.size = diameter;
  if (frequency > 0) {
    made.nominal.modulation.kind = vpModulation::Kind::pwm;
    made.nominal.modulation.frequency = frequency;
    made.nominal.modulation.duty = duty;
  }
  return made;
}

const std::vector<Lamp> blinking = {lamp("A", -0.36, -0.33, 1.70, 0.175, 1600, 0.5, 21, 185, 0.13),
                                    lamp("B", 0.34, -0.35, 1.70, 0.175, 2000, 0.35, -34, 200, 0.71),
                                    lamp("C", -0.36, 0.40, 1.66, 0.15, 2500, 0.5, 8, 170, 0.42),
                                    lamp("D", 0.37, 0.32, 1.72, 0.15, 3200, 0.65, -15, 190, 0.88)};
const Lamp ordinary = lamp("", 0.03, 0.05, 1.70, 0.12, 0, 1, 0, 150, 0); // unmodulated, in no map

vpVlpRig makeRig()
{
  vpVlpRig rig;
  rig.cameraFile = "camera.xml";
  rig.cameraName = "paper-room";
  rig.camera.initPersProjWithoutDistortion(741.2, 741.2, 403.1, 296.7);
  rig.width = 800;
  rig.height = 600;
  rig.shutter.rowTime = 43.1e-6;
  rig.shutter.rowTimeSigma = 2e-9;
  rig.shutter.exposure = 20e-6; // the paper's Table 1
  rig.shutter.exposureSigma = 0.01 * rig.shutter.exposure;
  rig.bMc = vpHomogeneousMatrix(vpTranslationVector(0, 0, 0.19), vpRotationMatrix(vpRzyxVector(M_PI, 0, 0)));
  return rig;
}

struct Place {
  double x, y, yaw; // m, rad
};

Place place(double time)
{
  const double start = 0.2, yaw = start + speed * time / radius;
  return {-0.16 + radius * (std::sin(yaw) - std::sin(start)),
          -0.13 - radius * (std::cos(yaw) - std::cos(start)), yaw};
}

//! The lamp at the time \e frame + \e after (s) in the picture of the frame.
vpPaintedLamp paint(const Lamp &lamp, const vpVlpRig &rig, double frame, double after)
{
  const Place at = place(frame + after);
  const vpHomogeneousMatrix wMb(vpTranslationVector(at.x, at.y, 0),
                                vpRotationMatrix(vpRzyxVector(at.yaw, 0, 0)));
  const Eigen::Vector3d &w = lamp.nominal.position;
  const vpColVector c = (wMb * rig.bMc).inverse() * vpColVector(std::vector<double>{w.x(), w.y(), w.z(), 1});
  vpPaintedLamp painted;
  painted.centre = {rig.camera.get_u0() + rig.camera.get_px() * c[0] / c[2],
                    rig.camera.get_v0() + rig.camera.get_py() * c[1] / c[2]};
  painted.a = painted.b = 0.5 * rig.camera.get_px() * lamp.nominal.size / c[2];
  painted.amplitude = lamp.amplitude;
  painted.frequency = lamp.nominal.modulation.frequency * (1 + 1e-6 * lamp.ppm);
  painted.phase = lamp.phase + std::fmod(painted.frequency * frame, 1); // its clock runs on between frames
  painted.pwm(lamp.nominal.modulation.duty.value_or(1));
  return painted;
}

cv::Mat picture(const vpVlpRig &rig, int index)
{
  vpLampPicture scene;
  scene.width = static_cast<int>(rig.width);
  scene.height = static_cast<int>(rig.height);
  scene.rowTime = rig.shutter.rowTime;
  scene.exposure = rig.shutter.exposure;
  scene.blur = 0.8;
  scene.background = 6;
  scene.noise = 1;
  scene.seed = seed + static_cast<unsigned int>(index);
  std::vector<Lamp> lamps = blinking;
  lamps.push_back(ordinary);
  for (const Lamp &lamp : lamps) {
    // The lamp is seen at the time of its own line, which depends on where it is seen: two rounds settle it.
    vpPaintedLamp painted = paint(lamp, rig, index * interval, 0);
    for (int round = 0; round < 2; ++round) {
      painted = paint(lamp, rig, index * interval, rig.shutter.rowTime * painted.centre.y());
    }
    scene.lamps.push_back(painted);
  }
  const vpImage<unsigned char> I = scene.render();
  return cv::Mat(scene.height, scene.width, CV_8UC1, I.bitmap).clone();
}

void make(const std::filesystem::path &folder)
{
  std::filesystem::create_directories(folder);
  const vpVlpRig rig = makeRig();
  rig.save((folder / "rig.yaml").string());
  vpLampMap map;
  for (const Lamp &lamp : blinking) {
    map.lamps.push_back(lamp.nominal);
  }
  map.save((folder / "lamps.yaml").string());

  vpAtomicFile list((folder / "frames.csv").string()), truth((folder / "truth.tum").string());
  list.stream() << "timestamp_s,file\n";
  truth.stream()
      << "# timestamp tx ty tz qx qy qz qw: s, m; wMb, the pose of the robot base b in the map w\n";
  for (int index = 0; index < frames; ++index) {
    const double time = index * interval;
    const std::string name = "frame" + std::to_string(index) + ".png";
    if (!cv::imwrite((folder / name).string(), picture(rig, index), {cv::IMWRITE_PNG_COMPRESSION, 9})) {
      throw vpException(vpException::ioError, (folder / name).string() + ": cannot be written");
    }
    const Place at = place(time);
    list.stream() << vpNumberText(time) << "," << name << "\n";
    truth.stream() << vpNumberText(time) << " " << vpNumberText(at.x) << " " << vpNumberText(at.y)
                   << " 0 0 0 " << vpNumberText(std::sin(0.5 * at.yaw)) << " "
                   << vpNumberText(std::cos(0.5 * at.yaw)) << "\n";
  }
  list.commit();
  truth.commit();
}
} // namespace

int main(int argc, char **argv)
{
  if (argc != 2 || argv[1][0] == '-') {
    std::cerr << "usage: makePaperRoom FOLDER" << std::endl;
    return 2;
  }
  try {
    make(argv[1]);
  } catch (const std::exception &error) {
    std::cerr << error.what() << std::endl;
    return 2;
  }
  return 0;
}
