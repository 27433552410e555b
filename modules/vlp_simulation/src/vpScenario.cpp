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
using vpScenarioYaml::degree;
using Range = vpYamlNode::Range;

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

//! A phone in a hand.
void readPhone(const vpYamlNode &node, vpSimulatedCamera &camera)
{
  camera.handBlur = vpScenarioYaml::between(node, "hand_blur_px", 0, 50, camera.handBlur);
  camera.chromaNoise = vpScenarioYaml::between(node, "chroma_noise", 0, 255, camera.chromaNoise);
  camera.clippedChannels = vpScenarioYaml::between(node, "clipped_channels", 0, 0.3, camera.clippedChannels);
  camera.toneCurve = vpScenarioYaml::between(node, "tone_curve", 0.2, 5, camera.toneCurve);
  camera.sharpening = vpScenarioYaml::between(node, "sharpening", 0, 10, camera.sharpening);
  if (node.has("jpeg_quality")) {
    const unsigned int quality = node.wholeNumber("jpeg_quality");
    if (quality > 100) {
      node.fail("jpeg_quality", std::to_string(quality) + ", expected a whole number from 0 to 100");
    }
    camera.jpegQuality = static_cast<int>(quality);
  }
}

void readCamera(const vpYamlNode &top, vpScenario &scenario)
{
  vpSimulatedCamera &camera = scenario.camera;
  bool wholeLines = true;
  if (top.has("camera")) {
    const vpYamlNode node = top.mapping("camera");
    camera.blur = vpScenarioYaml::between(node, "blur_px", 0, 100, camera.blur);
    camera.vignetting = vpScenarioYaml::between(node, "vignetting", 0, 100, camera.vignetting);
    camera.readNoise = vpScenarioYaml::between(node, "read_noise", 0, 255, camera.readNoise);
    camera.photonsPerLevel = node.number("photons_per_level", Range::notNegative, camera.photonsPerLevel);
    scenario.rig.shutter.exposure = node.number("exposure_s", Range::positive, scenario.rig.shutter.exposure);
    static const double longest = 1; // s
    if (scenario.rig.shutter.exposure > longest) {
      node.fail("exposure_s",
                vpNumberText(scenario.rig.shutter.exposure) + ", expected at most " + vpNumberText(longest));
    }
    wholeLines = !node.has("whole_line_exposure") || node.boolean("whole_line_exposure");
    readPhone(node, camera);
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

//! Two numbers of at most so much either way.
Eigen::Vector2d pair(const vpYamlNode &node, const std::string &key, double most)
{
  const std::vector<double> values = node.has(key) ? node.numbers(key, 2) : std::vector<double>{0, 0};
  for (double value : values) {
    if (std::abs(value) > most) {
      node.fail(key, vpNumberText(value) + ", expected two numbers from " + vpNumberText(-most) + " to " +
                         vpNumberText(most));
    }
  }
  return {values[0], values[1]};
}

void readDeviation(const vpYamlNode &node, vpScenario::Deviation &deviation)
{
  deviation.tilt = degree * pair(node, "tilt_deg", 90);
  deviation.principalPoint = pair(node, "principal_point_px", 1e4);
  deviation.focalLength = vpScenarioYaml::between(node, "focal_length", 0.1, 10, 1);
  deviation.rowTime = vpScenarioYaml::between(node, "row_time", 0.1, 10, 1);
}

void readDraw(const vpYamlNode &node, vpScenario::Draw &draw)
{
  static const double most = 0.1; // a share: a draw of 5 sigma still leaves half of it
  draw.tilt = degree * vpScenarioYaml::between(node, "tilt_deg", 0, 10, 0);
  draw.principalPoint = vpScenarioYaml::between(node, "principal_point_px", 0, 1e3, 0);
  draw.focalLength = vpScenarioYaml::between(node, "focal_length", 0, most, 0);
  draw.rowTime = vpScenarioYaml::between(node, "row_time", 0, most, 0);
  draw.lampShift = vpScenarioYaml::between(node, "lamp_shift_m", 0, 10, 0);
  draw.clocks = !node.has("clocks") || node.boolean("clocks");
  node.finish();
}

//! So many frames as a number of them, none too many; \e key is the field that asks for them.
size_t countOf(double frames, double frameRate, const vpYamlNode &node, const std::string &key)
{
  if (!(frames <= vpScenarioYaml::mostFrames)) {
    node.fail(key,
              vpNumberText(frames) + " frames, expected at most " + vpNumberText(vpScenarioYaml::mostFrames));
  }
  const double duration = (frames - 1) / frameRate;
  if (!(duration <= vpScenarioYaml::longestRun)) {
    node.fail(key, "frames over " + vpNumberText(duration) + " s, expected a run of at most " +
                       vpNumberText(vpScenarioYaml::longestRun) + " s");
  }
  return static_cast<size_t>(std::max(1.0, frames));
}

void readFrames(const vpYamlNode &node, vpScenario &scenario)
{
  node.number("rate_hz", Range::positive);
  scenario.frameRate = vpScenarioYaml::between(node, "rate_hz", 1e-3, 1e4, 0);
  const bool count = node.has("count"), duration = node.has("duration_s");
  if (count && duration) {
    node.fail("duration_s", "beside count, expected one of them");
  }
  if (count) {
    scenario.frames = countOf(node.wholeNumber("count", 1), scenario.frameRate, node, "count");
  } else if (duration) {
    const double frames = std::floor(node.number("duration_s", Range::positive) * scenario.frameRate);
    scenario.frames = countOf(frames, scenario.frameRate, node, "duration_s");
  }
  node.finish();
}

const double leastHeight = 0.05; // m, above the camera

//! What a lamp must be like to be drawn. A camera sees lamps that hang above it; one beside or below it has
//! no picture.
void checkLamps(const vpYamlNode &top, const vpScenario &scenario)
{
  static const double mostPpm = 1e5; // a draw of 8 sigma still runs forwards
  const double camera = scenario.rig.bMc[2][3];
  for (const vpScenario::Lamp &lamp : scenario.lamps) {
    const vpLamp &known = lamp.simulated.lamp;
    const double height = known.position.z() + lamp.shift.z();
    if (!(height > camera + leastHeight)) {
      top.fail("lamps", "lamp " + vpShown(known.id) + " hangs at a height of " + vpNumberText(height) +
                            " m, expected it above the camera, at more than " +
                            vpNumberText(camera + leastHeight) + " m");
    }
    if (lamp.simulated.emission.strip() < 1 && known.shape != vpLamp::Shape::square) {
      top.fail("lamps",
               "lamp " + vpShown(known.id) + " is a disc with the emission of a tube, expected a square");
    }
    if (!(known.size > 0)) {
      top.fail("lamps",
               "lamp " + vpShown(known.id) + " without diameter_m or size_m, expected one to draw it by");
    }
    const Eigen::Vector3d place = known.position + lamp.shift;
    for (const double metres : {place.x(), place.y(), place.z(), known.size}) {
      if (!(std::abs(metres) <= vpScenarioYaml::farthest)) {
        top.fail("lamps", "lamp " + vpShown(known.id) + " reaches to " + vpNumberText(metres) +
                              " m, expected at most " + vpNumberText(vpScenarioYaml::farthest) + " m");
      }
    }
    if (scenario.draw.clocks && known.oscillatorPpm > mostPpm) {
      top.fail("lamps", "lamp " + vpShown(known.id) + " with oscillator_ppm " +
                            vpNumberText(known.oscillatorPpm) + ", expected at most " +
                            vpNumberText(mostPpm) + " to draw its clock by");
    }
    try {
      const vpLampLight light(known.modulation);
    } catch (const vpException &error) {
      top.fail("lamps", "lamp " + vpShown(known.id) + ": " + error.getStringMessage());
    }
  }
}

//! Second images, too, are seen from below.
void checkImages(const vpYamlNode &top, const vpScenario &scenario)
{
  const double camera = scenario.rig.bMc[2][3];
  for (const vpScenario::SecondImage &image : scenario.secondImages) {
    const vpScenario::Lamp &lamp = scenario.lamps[image.lamp];
    const double height = lamp.simulated.lamp.position.z() + lamp.shift.z() + image.shift.z();
    if (!(height > camera + leastHeight)) {
      top.fail("truth", "second image of lamp " + vpShown(lamp.simulated.lamp.id) + " at a height of " +
                            vpNumberText(height) + " m, expected it above the camera, at more than " +
                            vpNumberText(camera + leastHeight) + " m");
    }
  }
}
} // namespace

double vpScenarioYaml::between(const vpYamlNode &node, const std::string &key, double least, double most,
                               double otherwise)
{
  const double value = node.number(key, Range::any, otherwise);
  if (node.has(key) && !(value >= least && value <= most)) {
    node.fail(key, vpNumberText(value) + ", expected a number from " + vpNumberText(least) + " to " +
                       vpNumberText(most));
  }
  return value;
}

void vpScenarioYaml::expectNear(const vpYamlNode &node, const std::string &key,
                                const std::vector<double> &coordinates)
{
  for (const double coordinate : coordinates) {
    if (!(std::abs(coordinate) <= farthest)) {
      node.fail(key,
                vpNumberText(coordinate) + ", expected at most " + vpNumberText(farthest) + " m either way");
    }
  }
}

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
    scenario.frames = countOf(std::floor(frames + early) + (scenario.motion.stations.empty() ? 1 : 0),
                              scenario.frameRate, top, "motion");
  }
  top.finish();
  checkLamps(top, scenario);
  checkImages(top, scenario);
  return scenario;
}

void vpScenario::useTypicalRig()
{
  draw.tilt = 0.15 * degree;
  draw.lampShift = 0.002;
  draw.principalPoint = 1;
  draw.focalLength = 0.003;
  draw.rowTime = 0.0005;

  for (vpLamp &lamp : map.lamps) {
    lamp.positionSigma = draw.lampShift;
  }
  rig.rotationSigma = Eigen::Vector3d(draw.tilt, draw.tilt, 0);
  const vpCameraParameters sensor = rig.resize.sensor(rig.camera, rig.width, rig.height);
  rig.principalPointSigma = draw.principalPoint * rig.camera.get_px() / sensor.get_px();
  rig.focalLengthSigma = draw.focalLength;
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
