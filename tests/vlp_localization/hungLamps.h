/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef hungLamps_h
#define hungLamps_h

/*!
  \file hungLamps.h
  Lamps of 0.16 m over a level camera that looks up, and its pictures of them, for the tests of the localizer.
*/

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpVlpFrame.h>
#include <visp3/vlp_core/vpVlpRig.h>

#include "common/vpLampPicture.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace hungLamps
{
//! Of the base, which is where the camera is: m, rad.
struct Place {
  double x = 0, y = 0, yaw = 0;
};

//! The place at a time, s.
using Path = std::function<Place(double)>;

struct Hung {
  std::string id;
  Eigen::Vector3d position; // m, where it really hangs
  double frequency;         // Hz, 0: steady
  bool lit = true;
};

//! The corners of a rectangle about the origin, 1.6 m high.
inline std::vector<Hung> rectangle(double halfLength, double halfWidth)
{
  return {{"A", {-halfLength, -halfWidth, 1.6}, 1800},
          {"B", {halfLength, -halfWidth, 1.6}, 2300},
          {"C", {halfLength, halfWidth, 1.6}, 2900},
          {"D", {-halfLength, halfWidth, 1.6}, 3600}};
}

//! A map that has the lamps where they hang.
inline vpLampMap mapOf(const std::vector<Hung> &lamps)
{
  vpLampMap map;
  for (const Hung &hung : lamps) {
    vpLamp lamp;
    lamp.id = hung.id;
    lamp.position = hung.position;
    lamp.size = 0.16;
    lamp.modulation.kind = vpModulation::Kind::pwm;
    lamp.modulation.frequency = hung.frequency;
    map.lamps.push_back(lamp);
  }
  return map;
}

struct Camera {
  int width, height; // px
  double px;         // px, focal length

  double u0() const { return 0.5 * (width - 1); }
  double v0() const { return 0.5 * (height - 1); }

  vpVlpRig rig() const
  {
    vpVlpRig rig;
    rig.width = static_cast<unsigned int>(width);
    rig.height = static_cast<unsigned int>(height);
    rig.camera.initPersProjWithoutDistortion(px, px, u0(), v0());
    rig.shutter.rowTime = rig.shutter.exposure = 40e-6;
    rig.shutter.rowTimeSigma = 4e-9;
    return rig;
  }

  Eigen::Vector2d project(const Eigen::Vector3d &position, const Place &at) const
  {
    const double east = position.x() - at.x, north = position.y() - at.y;
    const double right = std::cos(at.yaw) * east + std::sin(at.yaw) * north;
    const double down = -std::sin(at.yaw) * east + std::cos(at.yaw) * north;
    return {u0() + px * right / position.z(), v0() + px * down / position.z()};
  }

  //! Lamps are painted where the robot sees them at the time of the line through their middle; \e phase
  //! (periods) is what the clocks of all of them have in common.
  vpVlpFrame frame(const std::vector<Hung> &lamps, double time, const Path &path, double phase,
                   unsigned int seed) const
  {
    vpLampPicture picture;
    picture.width = width;
    picture.height = height;
    picture.rowTime = picture.exposure = 40e-6;
    picture.blur = 0.7;
    picture.seed = seed;
    for (const Hung &hung : lamps) {
      if (!hung.lit) {
        continue;
      }
      vpPaintedLamp lamp;
      lamp.centre.y() = v0();
      for (int round = 0; round < 3; ++round) {
        lamp.centre = project(hung.position, path(time + 40e-6 * (lamp.centre.y() + 0.5)));
      }
      lamp.a = lamp.b = 0.08 * px / hung.position.z();
      lamp.frequency = hung.frequency;
      lamp.phase = phase + 0.1 * hung.frequency / 1000;
      if (hung.frequency > 0) {
        lamp.pwm(0.5);
      }
      picture.lamps.push_back(lamp);
    }
    return {picture.render(), time, ""};
  }
};
} // namespace hungLamps

#endif
