/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef lampScene_h
#define lampScene_h

/*!
  \file lampScene.h
  Striped lamps before a small camera, from frame to frame, and the tracker that follows them.
*/

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <visp3/vlp_tracking/vpLampTracker.h>

#include "common/vpLampPicture.h"
#include "common/vpPwmLamps.h"
#include "common/vpUpwardRig.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace lampScene
{
const double frameTime = 1.0 / 30; // s

//! A lamp of the scene: its id is its frequency's, as the map has it.
struct Lamp {
  double u, v;      // px
  double frequency; // Hz
};

inline std::string idOf(double frequency)
{
  return "L" + std::to_string(static_cast<int>(frequency));
}

//! A small camera, its lamps, and the tracker that looks at them.
class Scene
{
public:
  int width = 400, height = 320; // px
  bool columns = false;
  double radius = 26;      // px
  double exposure = 40e-6; // s
  double rate = 0;         // frames a second of a camera whose clock is the lamps' own; 0: they share none

  explicit Scene(bool readAlongColumns = false) : columns(readAlongColumns)
  {
    if (columns) {
      std::swap(width, height);
    }
  }

  vpVlpRig rig() const
  {
    vpVlpRig rig = vpUpwardRig(static_cast<unsigned int>(width), static_cast<unsigned int>(height));
    rig.shutter.exposure = exposure;
    rig.shutter.readout = columns ? vpRollingShutter::Readout::columns : vpRollingShutter::Readout::rows;
    return rig;
  }

  static vpLampMap map() { return vpPwmLamps({2000, 2600, 3500, 4400}); }

  vpLampTracker tracker() const { return vpLampTracker(rig(), map()); }

  //! Lamps that share no clock with the camera have another phase in each frame.
  vpVlpFrame frame(int k, const std::vector<Lamp> &lamps) const
  {
    vpLampPicture picture;
    picture.width = width;
    picture.height = height;
    picture.columns = columns;
    picture.rowTime = 40e-6;
    picture.exposure = exposure;
    picture.blur = 0.7;
    picture.seed = static_cast<unsigned int>(1 + k);
    for (const Lamp &lamp : lamps) {
      vpPaintedLamp painted;
      painted.centre = columns ? Eigen::Vector2d(lamp.v, lamp.u) : Eigen::Vector2d(lamp.u, lamp.v);
      painted.a = painted.b = radius;
      painted.frequency = lamp.frequency;
      painted.phase = (rate > 0 ? k * lamp.frequency / rate : 0.37 * k) + 0.1 * lamp.frequency / 1000;
      if (lamp.frequency > 0) {
        painted.pwm(0.5);
      }
      picture.lamps.push_back(painted);
    }
    return {picture.render(), k * frameTime, std::to_string(k)};
  }

  //! The observation at a lamp's place, nullptr where there is none.
  const vpLampObservation *seen(const std::vector<vpLampObservation> &all, const Lamp &lamp) const
  {
    const Eigen::Vector2d place = columns ? Eigen::Vector2d(lamp.v, lamp.u) : Eigen::Vector2d(lamp.u, lamp.v);
    const auto found = std::find_if(all.begin(), all.end(), [&](const vpLampObservation &each) {
      return (each.point - place).norm() < 3;
    });
    return found == all.end() ? nullptr : &*found;
  }
};

inline std::vector<Lamp> moved(std::vector<Lamp> lamps, double right, double down)
{
  for (Lamp &lamp : lamps) {
    lamp.u += right;
    lamp.v += down;
  }
  return lamps;
}

const std::vector<Lamp> three = {{60.3, 60.6, 2000}, {180.7, 70.2, 2600}, {80.4, 200.8, 3500}};
} // namespace lampScene

#endif
