/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSpeedScene_h
#define vpSpeedScene_h

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpVlpFrame.h>
#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_simulation/vpRollingShutterRenderer.h>

#include "vpSpeedCeiling.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

//! Which frames: size of the picture, lamps, noise, ceiling.
struct vpSpeedCase {
  unsigned int width = 2048, height = 1536; // px
  int lamps = 4;                            // 2, 4 or 30
  double sigma = 1;                         // grey levels, of the read noise; 0: no photon noise either
  std::string ceiling = "plain";            // a kind of vpSpeedCeiling

  double pixels() const { return static_cast<double>(width) * height; }

  std::string name() const
  {
    std::ostringstream name;
    name << width << "x" << height << "/lamps:" << lamps << "/sigma:" << sigma << "/" << ceiling;
    return name.str();
  }
};

//! What a method made of one frame.
struct vpSpeedResult {
  struct Seen {
    std::string id;
    Eigen::Vector2d point; // px, of its middle
  };
  std::vector<Seen> seen; // with an id
  std::optional<vpHomogeneousMatrix> wMb;
};

/*!
  A robot under lamps at 1.5 m, on a circle of 0.1 m that it goes round in 2 s, and the frames of its camera
  at 12 Hz. It keeps its heading, since pi rad/s is more than a TurtleBot turns; so all lamps stay in sight,
  30 of them, too. Files are found from the top of the repository.
*/
class vpSpeedScene
{
public:
  static constexpr double frameRate = 12; // Hz
  static constexpr int loopFrames = 24;   // after which all comes again

  explicit vpSpeedScene(const vpSpeedCase &what) : m_what(what)
  {
    setRig();
    setMap();
    setScene();
    m_renderer = std::make_unique<vpRollingShutterRenderer>(m_camera);
  }

  const vpSpeedCase &what() const { return m_what; }
  const vpVlpRig &rig() const { return m_camera.rig; }
  const vpLampMap &map() const { return m_map; }
  const vpSimulatedCamera &camera() const { return m_camera; }
  const vpSimulatedScene &scene() const { return m_scene; }

  //! Robot in the map at a time of the loop, s.
  vpHomogeneousMatrix wMb(double time) const
  {
    static const double radius = 0.1, heading = 0.02; // m; rad, so that nothing lies along the rows
    const double angle = 2 * M_PI * time * frameRate / loopFrames;
    return vpHomogeneousMatrix(radius * std::cos(angle), radius * std::sin(angle), 0, 0, 0, heading);
  }
  vpHomogeneousMatrix wMc(double time) const { return wMb(time) * rig().bMc; }

  //! Frames of a robot at rest at wMb(timestamp), here and there on the circle. Rendered when asked for
  //! first.
  const std::vector<vpVlpFrame> &stills()
  {
    for (int k = static_cast<int>(m_stills.size()); k < stillFrames(); ++k) {
      m_stills.push_back(stillFrame(k));
    }
    return m_stills;
  }
  int stillFrames() const
  {
    static const double large = 10e6; // px, pictures that take long
    return m_what.pixels() > large ? 2 : 8;
  }

  //! One of them.
  vpVlpFrame stillFrame(int k) const
  {
    vpVlpFrame frame;
    frame.timestamp = (k + 0.3) * loopFrames / (stillFrames() * frameRate);
    const vpHomogeneousMatrix camera = wMc(frame.timestamp);
    m_renderer->render(
        m_scene, [&camera](double) { return camera; }, frame.timestamp, static_cast<unsigned>(1000 + k),
        frame.I);
    finish(frame);
    return frame;
  }

  //! Frames of the robot as it goes round once.
  std::vector<vpVlpFrame> &loop()
  {
    for (int k = static_cast<int>(m_loop.size()); k < loopFrames; ++k) {
      m_loop.push_back(loopFrame(k));
    }
    return m_loop;
  }

  //! One of them.
  vpVlpFrame loopFrame(int k) const
  {
    vpVlpFrame frame;
    frame.timestamp = k / frameRate;
    m_renderer->render(
        m_scene, [this](double time) { return wMc(time); }, frame.timestamp, static_cast<unsigned>(k),
        frame.I);
    finish(frame);
    return frame;
  }

  //! Where the camera at wMc sees a point of the map, px.
  Eigen::Vector2d pixelOf(const Eigen::Vector3d &point, const vpHomogeneousMatrix &wMc) const
  {
    const vpHomogeneousMatrix cMw = wMc.inverse();
    Eigen::Vector3d c;
    for (unsigned int i = 0; i < 3; ++i) {
      c(i) = cMw[i][0] * point.x() + cMw[i][1] * point.y() + cMw[i][2] * point.z() + cMw[i][3];
    }
    return {rig().camera.get_u0() + rig().camera.get_px() * c.x() / c.z(),
            rig().camera.get_v0() + rig().camera.get_py() * c.y() / c.z()};
  }

  //! Where a frame of the loop shows the middle of a lamp, at the time of its own line, px.
  Eigen::Vector2d lampAt(const vpLamp &lamp, double timestamp) const
  {
    double time = timestamp;
    for (int i = 0; i < 4; ++i) { // converges by the share of the lamp's speed in that of the readout
      time = timestamp + rig().shutter.rowTime * (pixelOf(lamp.position, wMc(time)).y() + 0.5);
    }
    return pixelOf(lamp.position, wMc(time));
  }

  //! Diameter of a lamp in the picture, px.
  double diameterOf(const vpLamp &lamp) const
  {
    return rig().camera.get_px() * lamp.size / (lamp.position.z() - wMc(0)[2][3]);
  }

private:
  //! The optics of the UB-300 and its readout's duration, whatever the number of pixels.
  void setRig()
  {
    vpVlpRig &rig = m_camera.rig;
    rig = vpVlpRig::load("data/rigs/ub300-2048x1536.yaml");
    vpPictureResize resize;
    resize.method = vpPictureResize::Method::area;
    resize.sourceWidth = std::max(m_what.width, rig.width);
    resize.sourceHeight = std::max(m_what.height, rig.height);
    rig.camera = m_what.width > rig.width ? resize.sensor(rig.camera, rig.width, rig.height)
                                          : resize.delivered(rig.camera, m_what.width, m_what.height);
    const double longer = static_cast<double>(rig.height) / m_what.height;
    rig.shutter.rowTime *= longer;
    rig.shutter.rowTimeSigma *= longer;
    rig.shutter.exposure = rig.shutter.rowTime;
    rig.width = m_what.width;
    rig.height = m_what.height;
    m_camera.readNoise = m_what.sigma;
    if (m_what.sigma <= 0) {
      m_camera.photonsPerLevel = 0;
    }
  }

  void setMap()
  {
    if (m_what.lamps <= 4) {
      m_map = vpLampMap::load("data/lamps/paper.yaml");
      if (m_what.lamps == 2) { // those across the middle
        m_map.lamps = {m_map.lamps.front(), m_map.lamps.back()};
      }
      return;
    }
    static const int columns = 6, rows = 5;
    static const double apart = 0.32, lowest = 500, highest = 3000; // m; Hz
    for (int i = 0; i < columns * rows; ++i) {
      vpLamp lamp;
      lamp.id = "L" + std::to_string(i);
      lamp.position = {apart * (i % columns - 0.5 * (columns - 1)), apart * (i / columns - 0.5 * (rows - 1)),
                       1.5};
      lamp.size = 0.08;
      lamp.modulation.kind = vpModulation::Kind::pwm;
      const int step = 7 * i % (columns * rows); // neighbours are not alike
      lamp.modulation.frequency = lowest + (highest - lowest) * step / (columns * rows - 1);
      lamp.modulation.duty = 0.5;
      m_map.lamps.push_back(lamp);
    }
  }

  void setScene()
  {
    std::mt19937_64 generator(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::normal_distribution<double> normal;
    for (const vpLamp &lamp : m_map.lamps) {
      vpSimulatedLamp simulated;
      simulated.lamp = lamp;
      simulated.light =
          vpLampLight(lamp.modulation, 1 + 1e-6 * lamp.oscillatorPpm * normal(generator), uniform(generator));
      m_scene.lamps.push_back(simulated);
    }
    m_ceiling = std::make_unique<vpSpeedCeiling>(m_what.ceiling, m_map);
    m_ceiling->hang(m_scene, m_camera, rig().camera.get_px());
  }

  //! With what only real pictures show.
  void finish(vpVlpFrame &frame) const
  {
    static const double height = 1.5; // m, of the ceiling
    m_ceiling->add(rig().camera.get_px(), pixelOf({0, 0, height}, wMc(frame.timestamp)), frame.I);
  }

  vpSpeedCase m_what;
  vpSimulatedCamera m_camera;
  vpLampMap m_map;
  vpSimulatedScene m_scene;
  std::unique_ptr<vpSpeedCeiling> m_ceiling;
  std::unique_ptr<vpRollingShutterRenderer> m_renderer;
  std::vector<vpVlpFrame> m_stills, m_loop;
};

//! How good a method is, over frames.
class vpSpeedScore
{
public:
  size_t frames = 0, fixes = 0;
  size_t wrong = 0;   // ids given to what is not that lamp
  size_t missing = 0; // lamps wholly in sight without their id
  double largest = 0; // mm, of the horizontal error

  double mean() const { return fixes > 0 ? m_sum / static_cast<double>(fixes) : NAN; } // mm

  void add(const vpSpeedScene &scene, const vpHomogeneousMatrix &wMb, const vpSpeedResult &result)
  {
    ++frames;
    if (result.wMb) {
      ++fixes;
      const double error =
          1000 * std::hypot((*result.wMb)[0][3] - wMb[0][3], (*result.wMb)[1][3] - wMb[1][3]);
      m_sum += error;
      largest = std::max(largest, error);
    }
    size_t right = 0, inSight = 0;
    for (const vpLamp &lamp : scene.map().lamps) {
      const Eigen::Vector2d middle = scene.pixelOf(lamp.position, wMb * scene.rig().bMc);
      const double radius = 0.5 * scene.diameterOf(lamp);
      inSight += middle.x() > radius && middle.y() > radius && middle.x() < scene.rig().width - 1 - radius &&
                 middle.y() < scene.rig().height - 1 - radius;
      for (const vpSpeedResult::Seen &seen : result.seen) {
        right += seen.id == lamp.id && (seen.point - middle).norm() < radius;
      }
    }
    wrong += result.seen.size() - right;
    missing += inSight > right ? inSight - right : 0;
  }

private:
  double m_sum = 0; // mm
};

#endif
