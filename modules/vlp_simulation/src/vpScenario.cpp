/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_simulation/vpScenario.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "vpScenarioYaml.h"

BEGIN_VISP_NAMESPACE

namespace
{
using Range = vpYamlNode::Range;

const double degree = M_PI / 180;

std::string beside(const vpYamlNode &node, const std::string &file)
{
  return (std::filesystem::path(node.filename()).parent_path() / file).string();
}

//! Loads a file that the scenario names; a missing one is told with the field that asked for it.
template <class File>
File loaded(const vpYamlNode &top, const std::string &key)
{
  try {
    return File::load(beside(top, top.text(key)));
  } catch (const vpException &error) {
    if (error.getCode() == vpException::ioError) {
      top.fail(key, error.getStringMessage());
    }
    throw;
  }
}

void readCamera(const vpYamlNode &top, vpScenario &scenario)
{
  vpSimulatedCamera &camera = scenario.camera;
  bool wholeLines = true;
  if (top.has("camera")) {
    const vpYamlNode node = top.mapping("camera");
    camera.blur = node.number("blur_px", Range::notNegative, camera.blur);
    camera.vignetting = node.number("vignetting", Range::notNegative, camera.vignetting);
    camera.readNoise = node.number("read_noise", Range::notNegative, camera.readNoise);
    camera.photonsPerLevel = node.number("photons_per_level", Range::notNegative, camera.photonsPerLevel);
    scenario.rig.shutter.exposure = node.number("exposure_s", Range::positive, scenario.rig.shutter.exposure);
    wholeLines = !node.has("whole_line_exposure") || node.boolean("whole_line_exposure");
    if (node.has("halo")) {
      const vpYamlNode halo = node.mapping("halo");
      camera.haloShare = halo.number("share", Range::openUnit);
      camera.haloRadius = halo.number("radius_px", Range::positive);
      if (camera.haloRadius < 2) {
        halo.fail("radius_px", vpNumberText(camera.haloRadius) + ", expected 2 or more");
      }
      halo.finish();
    }
    node.finish();
  }
  if (wholeLines) { // as such sensors have it
    vpRollingShutter &shutter = scenario.rig.shutter;
    shutter.exposure = std::max(1.0, std::round(shutter.exposure / shutter.rowTime)) * shutter.rowTime;
  }
}

Eigen::Vector2d pair(const vpYamlNode &node, const std::string &key)
{
  const std::vector<double> values = node.has(key) ? node.numbers(key, 2) : std::vector<double>{0, 0};
  return {values[0], values[1]};
}

void readDeviation(const vpYamlNode &node, vpScenario::Deviation &deviation)
{
  deviation.tilt = degree * pair(node, "tilt_deg");
  deviation.principalPoint = pair(node, "principal_point_px");
  deviation.focalLength = node.number("focal_length", Range::positive, 1);
  deviation.rowTime = node.number("row_time", Range::positive, 1);
}

void readDraw(const vpYamlNode &node, vpScenario::Draw &draw)
{
  draw.tilt = degree * node.number("tilt_deg", Range::notNegative, 0);
  draw.principalPoint = node.number("principal_point_px", Range::notNegative, 0);
  draw.focalLength = node.number("focal_length", Range::notNegative, 0);
  draw.rowTime = node.number("row_time", Range::notNegative, 0);
  draw.lampShift = node.number("lamp_shift_m", Range::notNegative, 0);
  draw.clocks = !node.has("clocks") || node.boolean("clocks");
  for (const auto &[key, share] :
       {std::pair("focal_length", draw.focalLength), std::pair("row_time", draw.rowTime)}) {
    static const double most = 0.1; // a draw of 5 sigma still leaves half of it
    if (share > most) {
      node.fail(key, vpNumberText(share) + ", expected a share of at most " + vpNumberText(most));
    }
  }
  node.finish();
}

void readFrames(const vpYamlNode &node, vpScenario &scenario)
{
  scenario.frameRate = node.number("rate_hz", Range::positive);
  const bool count = node.has("count"), duration = node.has("duration_s");
  if (count && duration) {
    node.fail("duration_s", "beside count, expected one of them");
  }
  if (count) {
    scenario.frames = node.wholeNumber("count", 1);
  } else if (duration) {
    scenario.frames = static_cast<size_t>(
        std::max(1.0, std::floor(node.number("duration_s", Range::positive) * scenario.frameRate)));
  }
  node.finish();
}

//! A camera sees lamps that hang above it; one beside or below it has no picture.
void checkHeights(const vpYamlNode &top, const vpScenario &scenario)
{
  static const double least = 0.05; // m
  const double camera = scenario.rig.bMc[2][3];
  for (const vpScenario::Lamp &lamp : scenario.lamps) {
    const vpLamp &known = lamp.simulated.lamp;
    const double height = known.position.z() + lamp.shift.z();
    if (!(height > camera + least)) {
      top.fail("lamps", "lamp " + vpShown(known.id) + " hangs at a height of " + vpNumberText(height) +
                            " m, expected it above the camera, at more than " + vpNumberText(camera + least) +
                            " m");
    }
    if (!(known.size > 0)) {
      top.fail("lamps",
               "lamp " + vpShown(known.id) + " without diameter_m or size_m, expected one to draw it by");
    }
  }
}
} // namespace

vpScenario vpScenario::load(const std::string &filename)
{
  const vpYamlNode top = vpYamlNode::load(filename);
  vpScenario scenario;
  scenario.rig = loaded<vpVlpRig>(top, "rig");
  scenario.map = loaded<vpLampMap>(top, "lamps");
  readFrames(top.mapping("frames"), scenario);
  readCamera(top, scenario);
  std::optional<vpYamlNode> truth;
  if (top.has("truth")) {
    truth = top.mapping("truth");
    readDeviation(*truth, scenario.deviation);
  }
  vpScenarioYaml::readScene(top, truth, scenario);
  if (top.has("draw")) {
    readDraw(top.mapping("draw"), scenario.draw);
  }
  scenario.motion = vpScenarioYaml::readMotion(top, scenario.frameRate);
  if (scenario.frames == 0) {         // a last frame at the very end
    static const double early = 1e-9; // of a frame
    const double frames = scenario.makeMotion()->duration() * scenario.frameRate;
    scenario.frames = static_cast<size_t>(
        std::max(1.0, std::floor(frames + early) + (scenario.motion.stations.empty() ? 1 : 0)));
  }
  top.finish();
  checkHeights(top, scenario);
  return scenario;
}

void vpScenario::useTypicalRig()
{
  draw.tilt = 0.15 * degree;
  draw.lampShift = 0.002;
  draw.principalPoint = 1;
  draw.focalLength = 0.003;
  draw.rowTime = 0.0005;

  const vpCameraParameters sensor = rig.resize.sensor(rig.camera, rig.width, rig.height);
  const double lean = std::hypot(draw.tilt, draw.principalPoint / sensor.get_px());
  double height = 0; // m, of the lamps above the camera
  for (vpLamp &lamp : map.lamps) {
    lamp.positionSigma = draw.lampShift;
    height += (lamp.position.z() - rig.bMc[2][3]) / static_cast<double>(map.lamps.size());
  }
  rig.rotationSigma = Eigen::Vector3d(lean, lean, 0);
  rig.translationSigma = Eigen::Vector3d(0, 0, draw.focalLength * height);
  rig.shutter.rowTimeSigma = draw.rowTime * rig.shutter.rowTime;
}

std::unique_ptr<vpRobotMotion> vpScenario::makeMotion() const
{
  if (!motion.stations.empty()) {
    return std::make_unique<vpStationMotion>(motion.stations, motion.hold);
  }
  return std::make_unique<vpDrivenMotion>(motion.robot, motion.commands);
}

END_VISP_NAMESPACE
