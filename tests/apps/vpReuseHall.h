/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpReuseHall_h
#define vpReuseHall_h

/*!
  \file vpReuseHall.h
  A hall whose lamps share few identifiers, drawn as the paper's camera sees it, for tests and benchmarks of
  everything from picture to pose.
*/

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <visp3/core/vpMeterPixelConversion.h>
#include <visp3/core/vpRzyxVector.h>
#include <visp3/vlp_identification/vpIdentifierLayout.h>
#include <visp3/vlp_identification/vpLedIdPlanner.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp3/vlp_simulation/vpRollingShutterRenderer.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

class vpReuseHall
{
public:
  static constexpr double spacing = 1.5;  // m, of the lamps' grid, from (0, 0) on
  static constexpr double diameter = 0.3; // m
  static constexpr double height = 3;     // m

  vpVlpRig rig = vpVlpRig::load(std::string(VLP_DATA_DIR) + "/rigs/ub300-800x600.yaml");
  vpLampMap map;
  vpSimulatedScene scene; // what truly hangs there: the map's lamps first

  vpReuseHall(size_t columns, size_t rows, size_t identifiers, unsigned int seed) : m_random(seed)
  {
    const double above = height - rig.bMc[2][3];
    const vpLedIdPlanner planner(rig);
    const std::vector<vpModulation> signals =
        planner.spread(planner.prediction.lines(diameter, above), 50, identifiers).identifiers;
    std::vector<Eigen::Vector3d> places;
    for (size_t k = 0; k < columns * rows; ++k) {
      places.emplace_back(spacing * static_cast<double>(k % columns),
                          spacing * static_cast<double>(k / columns), height);
    }
    vpIdentifierLayout layout;
    layout.viewRadius =
        above * std::hypot(0.5 * rig.width / rig.camera.get_px(), 0.5 * rig.height / rig.camera.get_py());
    const std::vector<size_t> laid = layout.lay(places, signals.size()).identifiers;
    for (size_t k = 0; k < places.size(); ++k) {
      add("L" + std::to_string(k), places[k], signals[laid[k]]);
    }
  }

  //! A lamp more, with a clock of its own.
  void add(const std::string &id, const Eigen::Vector3d &place, const vpModulation &signal)
  {
    vpLamp lamp;
    lamp.id = id;
    lamp.position = place;
    lamp.size = diameter;
    lamp.modulation = signal;
    map.lamps.push_back(lamp);
    vpSimulatedLamp shining;
    shining.lamp = lamp;
    const double clock = 1 + 50e-6 * std::normal_distribution<double>()(m_random);
    shining.light = vpLampLight(signal, clock, uniform(0, 1));
    scene.lamps.push_back(shining);
  }

  double uniform(double from, double to)
  {
    return std::uniform_real_distribution<double>(from, to)(m_random);
  }

  //! Of the base, m.
  vpHomogeneousMatrix randomPose(double fromX, double toX, double fromY, double toY)
  {
    const double x = uniform(fromX, toX), y = uniform(fromY, toY), yaw = uniform(-M_PI, M_PI);
    return {vpTranslationVector(x, y, 0), vpRotationMatrix(vpRzyxVector(yaw, 0, 0))};
  }

  //! Where the camera of a base there has a place, px; in the picture or beside it.
  Eigen::Vector2d pixelOf(const Eigen::Vector3d &place, const vpHomogeneousMatrix &wMb) const
  {
    const vpColVector c =
        (wMb * rig.bMc).inverse() * vpColVector(std::vector<double>{place.x(), place.y(), place.z(), 1});
    Eigen::Vector2d pixel;
    vpMeterPixelConversion::convertPoint(rig.camera, c[0] / c[2], c[1] / c[2], pixel.x(), pixel.y());
    return pixel;
  }

  //! Whether the picture from there shows the whole of a lamp in that place.
  bool shows(const Eigen::Vector3d &place, const vpHomogeneousMatrix &wMb) const
  {
    const Eigen::Vector2d pixel = pixelOf(place, wMb);
    const double margin = 0.5 * diameter * rig.camera.get_px() / (height - rig.bMc[2][3]) + 4;
    return pixel.x() > margin && pixel.x() < rig.width - margin && pixel.y() > margin &&
           pixel.y() < rig.height - margin;
  }

  //! Lamps of the map that the picture from there shows whole.
  size_t inView(const vpHomogeneousMatrix &wMb) const
  {
    size_t count = 0;
    for (const vpLamp &lamp : map.lamps) {
      count += shows(lamp.position, wMb);
    }
    return count;
  }

  vpVlpFrame look(const vpHomogeneousMatrix &wMb, std::uint64_t seed) const
  {
    vpSimulatedCamera camera;
    camera.rig = rig;
    vpSimulatedScene near = scene; // those farther off cost time and show nothing
    near.lamps.clear();
    for (const vpSimulatedLamp &lamp : scene.lamps) {
      if (std::hypot(lamp.lamp.position.x() - wMb[0][3], lamp.lamp.position.y() - wMb[1][3]) < 5) {
        near.lamps.push_back(lamp);
      }
    }
    vpVlpFrame frame;
    vpRollingShutterRenderer(camera).render(
        near, [&](double) { return wMb * rig.bMc; }, 0, seed, frame.I);
    return frame;
  }

private:
  std::mt19937 m_random;
};

#endif
