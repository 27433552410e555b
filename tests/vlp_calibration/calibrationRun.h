/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef calibrationRun_h
#define calibrationRun_h

/*!
  \file calibrationRun.h
  Drives under lamps for tests and benchmarks of vlp_calibration: a true TurtleBot with errors of its wheels,
  a true camera and lamps, and what a detector of that noise would say of them. Nothing is rendered, and no
  formula of the calibration is used.
*/

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <visp3/core/vpMeterPixelConversion.h>
#include <visp3/vlp_calibration/vpLampRun.h>
#include <visp3/vlp_calibration/vpRigParameters.h>
#include <visp3/vlp_simulation/vpRobotMotion.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace calibrationRun
{
//! The world, and how well it is seen.
struct World {
  vpVlpRig rig;  // true
  vpLampMap map; // true
  vpSimulatorTurtleBot3Settings robot;
  double noise = 0.035;  // px, standard deviation of an image point along each axis
  double stated = 0.035; // px, what the detector says of it
  double frameRate = 12; // Hz
};

//! The paper's camera at 800 x 600 as its rig says, looking up from 0.19 m.
inline vpVlpRig rig()
{
  vpVlpRig rig;
  rig.cameraFile = "camera.xml";
  rig.cameraName = "UB300";
  rig.width = 800;
  rig.height = 600;
  rig.camera.initPersProjWithoutDistortion(488.28125, 488.28125, 399.3, 299.3);
  rig.resize = {vpPictureResize::Method::nearest, 2048, 1536};
  rig.shutter.rowTime = rig.shutter.exposure = 43.1e-6;
  rig.bMc = vpHomogeneousMatrix(vpTranslationVector(0, 0, 0.19), vpRotationMatrix(0, 0, M_PI));
  return rig;
}

//! Lamps as of the paper's Table 1. \param rise m, by which every second one hangs lower.
inline vpLampMap lamps(double rise)
{
  vpLampMap map;
  const double places[4][2] = {{-0.465, 0.495}, {-0.46, -0.42}, {0.46, 0.49}, {0.48, -0.425}};
  for (int i = 0; i < 4; ++i) {
    vpLamp lamp;
    lamp.id = "LED" + std::to_string(i + 1);
    lamp.position = {places[i][0], places[i][1], 1.5 - (i % 2) * rise};
    lamp.size = 0.175;
    lamp.modulation.kind = vpModulation::Kind::pwm;
    lamp.modulation.frequency = 1000 + 450 * i;
    map.lamps.push_back(lamp);
  }
  return map;
}

//! Once round on the spot.
inline std::vector<vpTimedVelocity> spin(double rate = 0.5)
{
  return {{{0, rate}, 2 * M_PI / std::abs(rate)}, {{0, 0}, 0.5}};
}

//! Round a square to the left. \param side m. \param speed m/s.
inline std::vector<vpTimedVelocity> square(double side = 0.5, double speed = 0.1, double rate = 0.5)
{
  std::vector<vpTimedVelocity> commands;
  for (int i = 0; i < 4; ++i) {
    commands.push_back({{speed, 0}, side / speed});
    commands.push_back({{0, rate}, 0.5 * M_PI / rate});
  }
  return commands;
}

inline std::vector<vpTimedVelocity> operator+(std::vector<vpTimedVelocity> first,
                                              const std::vector<vpTimedVelocity> &second)
{
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

//! Wheels whose radii and distance are off by about 1 %, that slip, and whose angles are read in ticks.
inline vpSimulatorTurtleBot3Settings robot(std::uint64_t seed)
{
  std::mt19937_64 random(seed * 7919 + 1);
  std::normal_distribution<double> normal;
  vpSimulatorTurtleBot3Settings robot;
  robot.seed = seed;
  robot.leftRadiusError = 0.01 * normal(random);
  robot.rightRadiusError = 0.01 * normal(random);
  robot.separationError = 0.01 * normal(random);
  robot.slipSigma = 0.01;
  robot.acceleration = 0.5;
  robot.motorLag = 0.03;
  robot.encoderTicks = true;
  return robot;
}

//! Image of a point in the camera, or nothing where the picture does not show it whole. \param radius m.
inline bool imageOf(const vpVlpRig &rig, const vpHomogeneousMatrix &wMb, const Eigen::Vector3d &point,
                    double radius, Eigen::Vector2d &pixel)
{
  const vpHomogeneousMatrix cMw = (wMb * rig.bMc).inverse();
  const vpColVector c = cMw * vpColVector(std::vector<double>{point.x(), point.y(), point.z(), 1});
  vpMeterPixelConversion::convertPoint(rig.camera, c[0] / c[2], c[1] / c[2], pixel.x(), pixel.y());
  const double margin = radius * rig.camera.get_px() / c[2];
  return pixel.x() > margin && pixel.x() < rig.width - 1 - margin && pixel.y() > margin &&
         pixel.y() < rig.height - 1 - margin;
}

//! What the world shows over a drive.
inline vpLampRun drive(const World &world, const std::vector<vpTimedVelocity> &commands, std::uint64_t seed)
{
  vpDrivenMotion motion(world.robot, commands);
  const vpLineTiming timing = world.rig.lineTiming();
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  vpLampRun run;
  const auto frames = static_cast<size_t>(std::floor(motion.duration() * world.frameRate));
  for (size_t i = 0; i < frames; ++i) {
    vpLampView view;
    view.timestamp = static_cast<double>(i) / world.frameRate;
    view.name = "frame " + std::to_string(i);
    for (size_t k = 0; k < world.map.lamps.size(); ++k) {
      const vpLamp &lamp = world.map.lamps[k];
      Eigen::Vector2d pixel(0, 0.5 * world.rig.height);
      double since = 0;
      bool shown = true;
      for (int round = 0; round < 6; ++round) { // the line that sees it, and where it is then
        since = timing.middleAt(pixel.y());
        shown = imageOf(world.rig, motion.wMb(view.timestamp + since), lamp.position, 0.5 * lamp.size, pixel);
      }
      if (!shown) {
        continue;
      }
      vpLampImage image;
      image.lamp = k;
      image.time = view.timestamp + since;
      image.point = pixel + world.noise * Eigen::Vector2d(normal(random), normal(random));
      image.covariance = world.stated * world.stated * Eigen::Matrix2d::Identity();
      view.images.push_back(image);
    }
    run.views.push_back(view);
  }
  run.odometry = motion.odometry();
  return run;
}

//! The true poses at the times of the frames, as somebody would measure them who puts the robot in places.
inline vpTrajectory truth(const World &world, const std::vector<vpTimedVelocity> &commands)
{
  vpDrivenMotion motion(world.robot, commands);
  vpTrajectory poses;
  const auto frames = static_cast<size_t>(std::floor(motion.duration() * world.frameRate));
  for (size_t i = 0; i < frames; ++i) {
    const double time = static_cast<double>(i) / world.frameRate;
    poses.add(time, motion.wMb(time));
  }
  return poses;
}
} // namespace calibrationRun

#endif
