/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_simulation/vpSimulation.h>

#include <cmath>
#include <string>
#include <utility>

#include <visp3/core/vpRotationMatrix.h>

#include "vpNormalNoise.h"

BEGIN_VISP_NAMESPACE

namespace
{
//! Streams of random numbers; those of the robot come before.
enum Stream : std::uint32_t { rigStream = 16, clockStream, phaseStream, shiftStream };

//! The camera as it truly is, from what the rig file says of it.
vpVlpRig trueRig(const vpScenario &scenario, std::uint64_t seed)
{
  vpNormalNoise noise(seed, rigStream);
  const vpScenario::Deviation &deviation = scenario.deviation;
  const vpScenario::Draw &draw = scenario.draw;
  const double tiltX = deviation.tilt.x() + draw.tilt * noise(),
               tiltY = deviation.tilt.y() + draw.tilt * noise();
  const double du = deviation.principalPoint.x() + draw.principalPoint * noise();
  const double dv = deviation.principalPoint.y() + draw.principalPoint * noise();
  const double focal = deviation.focalLength * (1 + draw.focalLength * noise());
  const double row = deviation.rowTime * (1 + draw.rowTime * noise());

  vpVlpRig rig = scenario.rig;
  vpRotationMatrix bRc;
  rig.bMc.extract(bRc);
  rig.bMc.insert(vpRotationMatrix(tiltX, tiltY, 0) * bRc);
  double scaleU, scaleV, offset;
  rig.resize.sensorAxis(rig.width, rig.resize.sourceWidth, scaleU, offset);
  rig.resize.sensorAxis(rig.height, rig.resize.sourceHeight, scaleV, offset);
  rig.camera =
      vpPictureResize::withAxes(rig.camera, focal * rig.camera.get_px(), focal * rig.camera.get_py(),
                                rig.camera.get_u0() + du / scaleU, rig.camera.get_v0() + dv / scaleV);
  rig.shutter.rowTime *= row;
  rig.shutter.exposure *= row; // counted by the same clock
  return rig;
}

std::vector<vpSimulatedLamp> trueLamps(const vpScenario &scenario, std::uint64_t seed)
{
  vpNormalNoise clock(seed, clockStream), phase(seed, phaseStream), shift(seed, shiftStream);
  std::vector<vpSimulatedLamp> lamps;
  for (const vpScenario::Lamp &entry : scenario.lamps) {
    vpSimulatedLamp lamp = entry.simulated;
    Eigen::Vector3d drawn;
    for (double &coordinate : drawn) {
      coordinate = shift();
    }
    lamp.lamp.position += entry.shift + scenario.draw.lampShift * drawn;
    const double ppm = entry.clockPpm + (scenario.draw.clocks ? lamp.lamp.oscillatorPpm : 0) * clock();
    lamp.light = vpLampLight(lamp.lamp.modulation, 1 + 1e-6 * ppm, phase.uniform());
    for (const auto &[from, until] : entry.dark) {
      lamp.light.addDark(from, until);
    }
    lamps.push_back(lamp);
  }
  return lamps;
}

vpScenario seeded(const vpScenario &scenario, std::uint64_t seed)
{
  vpScenario drawn = scenario;
  drawn.motion.robot.seed = seed;
  return drawn;
}
} // namespace

vpSimulation::vpSimulation(const vpScenario &scenario, std::uint64_t seed)
    : vpSimulation(scenario, seed, seeded(scenario, seed).makeMotion())
{
}

vpSimulation::vpSimulation(const vpScenario &scenario, std::uint64_t seed,
                           std::unique_ptr<vpRobotMotion> motion)
    : m_scenario(scenario), m_seed(seed), m_camera(scenario.camera), m_scene(scenario.scene),
      m_motion(std::move(motion))
{
  m_camera.rig = trueRig(scenario, seed);
  m_scene.lamps = trueLamps(scenario, seed);
  for (const vpScenario::SecondImage &image : scenario.secondImages) {
    m_scene.images.push_back(
        m_scene.lamps[image.lamp].image(image.shift, image.share, image.blur, image.mirrored));
  }
  m_renderer = std::make_unique<vpRollingShutterRenderer>(m_camera);
}

vpSimulation::~vpSimulation() = default;

bool vpSimulation::next(vpVlpFrame &frame)
{
  if (m_next >= m_scenario.frames) {
    return false;
  }
  frame.timestamp = static_cast<double>(m_next) / m_scenario.frameRate;
  frame.name = "frame " + std::to_string(m_next);
  const auto wMc = [this](double time) { return m_motion->wMb(time) * m_camera.rig.bMc; };
  m_renderer->render(m_scene, wMc, frame.timestamp, ((m_seed << 24) | (m_seed >> 40)) + m_next, frame.I);
  ++m_next;
  return true;
}

END_VISP_NAMESPACE
