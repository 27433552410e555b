/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_simulation/vpScenario.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include <gtest/gtest.h>
#include <visp3/vlp_simulation/vpSimulation.h>

#include "common/vpExpectError.h"
#include "simulatedRoom.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
using simulatedRoom::frames;
using simulatedRoom::head;
using simulatedRoom::still;

std::vector<std::string> shipped()
{
  std::vector<std::string> files;
  for (const auto &entry : std::filesystem::directory_iterator(VLP_DATA_DIR "/scenarios")) {
    files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}
} // namespace

TEST(Scenario, ShippedOnesLoadAndDraw)
{
  const std::vector<std::string> files = shipped();
  EXPECT_GE(files.size(), 21u);
  for (const std::string &file : files) {
    SCOPED_TRACE(file);
    const vpScenario scenario = vpScenario::load(file);
    EXPECT_GT(scenario.frames, 1u);
    EXPECT_FALSE(scenario.lamps.empty());
    vpSimulation simulation(scenario, 1);
    EXPECT_EQ(simulation.size(), scenario.frames);
    vpVlpFrame frame;
    ASSERT_TRUE(simulation.next(frame));
    EXPECT_EQ(frame.timestamp, 0);
    EXPECT_EQ(frame.I.getWidth(), scenario.rig.width);
    EXPECT_EQ(frame.I.getHeight(), scenario.rig.height);
    EXPECT_GT(frame.I.getMaxValue(), 100) << "no lamp in view";
    EXPECT_LT(frame.I.getMinValue(), 10);
  }
}

TEST(Scenario, ShippedRunsAreAsLongAsTheyShould)
{
  const auto frames = [](const std::string &name) {
    return vpScenario::load(VLP_DATA_DIR "/scenarios/" + name).frames;
  };
  EXPECT_EQ(frames("paper-still.yaml"), 120u);
  EXPECT_EQ(frames("paper-points.yaml"), 36u * 12);
  EXPECT_EQ(frames("paper-points-full.yaml"), 36u * 12);
  EXPECT_EQ(frames("paper-a.yaml"), 2101u); // 0.70002 m at 0.004 m/s and 12 Hz, and the frame at the start
  EXPECT_EQ(frames("straight.yaml"), 51u);
  const vpScenario hall = vpScenario::load(VLP_DATA_DIR "/scenarios/hall.yaml");
  EXPECT_EQ(hall.lamps.size(), 30u);
  EXPECT_EQ(hall.frames, 421u);
}

TEST(Scenario, EveryKeyIsRead)
{
  const simulatedRoom::Folder folder;
  const vpScenario scenario = folder.load(
      head +
      "frames: {rate_hz: 10, duration_s: 2.05}\n"
      "motion: {type: commands, start_m: [0.1, -0.2], start_yaw_deg: 90, commands: [{v_m_s: 0.1, w_rad_s: "
      "0.2, "
      "duration_s: 1}, {duration_s: 3}]}\n"
      "robot: {model: waffle, slip: 0.01, slip_sigma: 0.02, slip_length_m: 0.1, motor_lag_s: 0.03, "
      "command_delay_s: 0.01, acceleration_m_s2: 1, left_radius_error: 0.01, right_radius_error: -0.01, "
      "separation_error: 0.02, odometry_rate_hz: 30, encoder_sigma_rad: 0.001, turn_from: gyro, "
      "gyro_noise_density_deg_s_sqrt_hz: 0.1, gyro_bias_deg_s: 1, velocity_quantum: true, motor_unit: true, "
      "encoder_ticks: true, floor_tilt_deg: [0.5, -1]}\n"
      "light: {lamp_level: 150, rim: 0.2, half_power_deg: 50, ambient: 9, ceiling: {share: 0.1, radius_m: "
      "0.5}}\n"
      "camera: {blur_px: 1, vignetting: 2, read_noise: 3, photons_per_level: 50, exposure_s: 100e-6, "
      "halo: {share: 0.02, radius_px: 10}}\n"
      "truth:\n"
      "  {tilt_deg: [1, 2], principal_point_px: [3, 4], focal_length: 1.01, row_time: 0.99, lamps: [{id: A, "
      "shift_m: [0.1, 0.2, 0.3], clock_ppm: 40, level: 99, rim: 0.3, half_power_deg: 40, dark: [{from_s: 1, "
      "until_s: 2}, {from_s: 3}]}], more_lamps: [{id: C, position_m: [0, 0, 2], diameter_m: 0.1, "
      "unmodulated: true}]}\n"
      "draw: {tilt_deg: 0.15, principal_point_px: 1, focal_length: 0.003, row_time: 0.0005, lamp_shift_m: "
      "0.002, "
      "clocks: false}\n"
      "windows: [{centre_m: [1, 2, 3], half_width_m: [1, 0, 0], half_height_m: [0, 0, 2], level: 250, shut: "
      "[{from_s: 0, until_s: 4}]}]\n"
      "people: [{radius_m: 0.2, height_m: 1.8, level: 4, path: [{time_s: 0, at_m: [1, 2]}, {time_s: 0, at_m: "
      "[2, "
      "2]}]}]\n");
  const double degree = M_PI / 180;
  EXPECT_EQ(scenario.frameRate, 10);
  EXPECT_EQ(scenario.frames, 20u);
  EXPECT_EQ(scenario.motion.commands.size(), 2u);
  const vpSimulatorTurtleBot3Settings &robot = scenario.motion.robot;
  EXPECT_EQ(robot.startX, 0.1);
  EXPECT_NEAR(robot.startYaw, M_PI / 2, 1e-12);
  EXPECT_EQ(robot.model, vpTurtleBot3::Model::waffle);
  EXPECT_EQ(robot.rightRadiusError, -0.01);
  EXPECT_EQ(robot.slipLength, 0.1);
  EXPECT_EQ(robot.turnSource, vpSimulatorTurtleBot3Settings::TurnSource::gyro);
  EXPECT_NEAR(robot.gyroBias, degree, 1e-12);
  EXPECT_NEAR(robot.floorTiltY, -degree, 1e-12);
  EXPECT_TRUE(robot.velocityQuantum && robot.motorUnit && robot.encoderTicks);
  EXPECT_EQ(scenario.scene.ambient, 9);
  EXPECT_EQ(scenario.scene.ceilingRadius, 0.5);
  EXPECT_EQ(scenario.camera.readNoise, 3);
  EXPECT_EQ(scenario.camera.haloShare, 0.02);
  EXPECT_NEAR(scenario.deviation.tilt.y(), 2 * degree, 1e-12);
  EXPECT_EQ(scenario.deviation.principalPoint, Eigen::Vector2d(3, 4));
  EXPECT_EQ(scenario.deviation.focalLength, 1.01);
  EXPECT_EQ(scenario.deviation.rowTime, 0.99);
  EXPECT_NEAR(scenario.draw.tilt, 0.15 * degree, 1e-12);
  EXPECT_EQ(scenario.draw.lampShift, 0.002);
  EXPECT_FALSE(scenario.draw.clocks);
  ASSERT_EQ(scenario.lamps.size(), 3u);
  EXPECT_EQ(scenario.map.lamps.size(), 2u);
  const vpScenario::Lamp &a = scenario.lamps[0], &b = scenario.lamps[1];
  EXPECT_EQ(a.shift, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(a.clockPpm, 40);
  EXPECT_EQ(a.dark.size(), 2u);
  EXPECT_EQ(a.simulated.level, 99);
  EXPECT_EQ(b.simulated.level, 150);
  EXPECT_EQ(b.simulated.rim, 0.2);
  EXPECT_NEAR(b.simulated.halfPower, 50 * degree, 1e-12);
  EXPECT_EQ(scenario.lamps[2].simulated.lamp.id, "C");
  ASSERT_EQ(scenario.scene.windows.size(), 1u);
  EXPECT_EQ(scenario.scene.windows[0].light.over(1, 2).share, 0);
  ASSERT_EQ(scenario.scene.people.size(), 1u);
  EXPECT_EQ(scenario.scene.people[0].at(0.5).x(), 2);
}

TEST(Scenario, ExposureIsInWholeLines)
{
  const simulatedRoom::Folder folder; // row time 50 us
  const auto exposure = [&](const std::string &camera) {
    return folder.load(head + frames + still + camera).rig.shutter.exposure;
  };
  EXPECT_DOUBLE_EQ(exposure(""), 50e-6);
  EXPECT_DOUBLE_EQ(exposure("camera: {exposure_s: 200e-6}\n"), 200e-6);
  EXPECT_DOUBLE_EQ(exposure("camera: {exposure_s: 120e-6}\n"), 100e-6);
  EXPECT_DOUBLE_EQ(exposure("camera: {exposure_s: 1e-6}\n"), 50e-6); // one line at least
  EXPECT_DOUBLE_EQ(exposure("camera: {exposure_s: 1e-6, whole_line_exposure: false}\n"), 1e-6);
}

TEST(Scenario, StationsOfAGridAreInRows)
{
  const simulatedRoom::Folder folder;
  const vpScenario scenario =
      folder.load(head + frames +
                  "motion: {type: stations, yaw_deg: 90, frames_each: 5, grid: {x_m: [-1, 1], "
                  "y_m: [0, 3], columns: 3, rows: 2}}\n");
  ASSERT_EQ(scenario.motion.stations.size(), 6u);
  EXPECT_EQ(scenario.frames, 30u);
  EXPECT_EQ(scenario.motion.stations[1][0][3], 0);
  EXPECT_EQ(scenario.motion.stations[3][0][3], -1);
  EXPECT_EQ(scenario.motion.stations[3][1][3], 3);
  EXPECT_NEAR(scenario.motion.stations[5][1][0], 1, 1e-12);
}

//! Each of these replaces or adds a part of a good scenario. What its error has to say: line and field first.
TEST(Scenario, BadOnesAreRefusedWithFileLineAndField)
{
  struct Bad {
    std::string text;
    std::vector<std::string> parts;
  };
  const std::string good = head + frames + still; // lines 1 to 4; what follows is on line 5
  const std::string move = head + frames;         // the motion is on line 4
  const std::string commands = move + "motion: {type: commands, start_m: [0, 0], commands: ";
  const std::string lamps = "truth: {lamps: ", more = "truth: {more_lamps: ";
  const std::vector<Bad> all = {
      // keys
      {good + "colour: red\n", {":5: colour: unknown key, expected one of rig, lamps"}},
      {good + "camera: {blur: 1}\n", {":5: camera.blur: unknown key"}},
      {good + "camera: {halo: {share: 0.1, radius_px: 5, colour: red}}\n",
       {":5: camera.halo.colour: unknown key"}},
      {good + "light: {ceiling: {share: 0.1, radius_m: 5, x: 1}}\n", {":5: light.ceiling.x: unknown key"}},
      {good + "draw: {tilt: 1}\n", {":5: draw.tilt: unknown key"}},
      {good + "truth: {tilt: 1}\n", {":5: truth.tilt: unknown key"}},
      {good + lamps + "[{id: A, size: 2}]}\n", {":5: truth.lamps[0].size: unknown key"}},
      {good + "camera: {halo: {share: 0.1}}\n", {":5: camera.halo.radius_px: missing"}},
      {"lamps: lamps.yaml\n" + frames + still, {":1: rig: missing, expected text"}},
      {"rig: rig.yaml\n" + frames + still, {":1: lamps: missing, expected text"}},
      {head + still, {":1: frames: missing, expected a mapping"}},
      {head + frames, {":1: motion: missing, expected a mapping"}},
      {head + "frames: {count: 3}\n" + still, {":3: frames.rate_hz: missing"}},
      {move + "motion: {start_m: [0, 0]}\n", {":4: motion.type: missing, expected one of stations, line"}},
      {move + "motion: {type: line, from_m: [0, 0], to_m: [1, 0]}\n", {":4: motion.speed_m_s: missing"}},
      {move + "motion: {type: stations, frames_each: 2}\n", {":4: motion.grid: missing"}},
      {move + "motion: {type: stations, points: [{at_m: [0, 0]}]}\n", {":4: motion.frames_each: missing"}},
      {move + "motion: {type: spin, start_m: [0, 0], rate_rad_s: 1, duration_s: 1, speed_m_s: 1}\n",
       {":4: motion.speed_m_s: unknown key"}},
      {"", {":1: nothing, expected a mapping"}},
      {good + "camera: {}\ncamera: {}\n", {":6: camera: twice"}},
      // types
      {head + "frames: 12\n" + still, {":3: frames: 12, expected a mapping"}},
      {head + "frames: {rate_hz: fast}\n" + still, {":3: frames.rate_hz: fast, expected a number"}},
      {head + "frames: {rate_hz: 12, count: 2.5}\n" + still,
       {":3: frames.count: 2.5, expected a whole number"}},
      {head + "frames: {rate_hz: 12, count: -1}\n" + still,
       {":3: frames.count: -1, expected a whole number"}},
      {move + "motion: spin\n", {":4: motion: spin, expected a mapping"}},
      {move + "motion: {type: fly}\n", {":4: motion.type: fly, expected one of"}},
      {good + "camera: {whole_line_exposure: 1}\n",
       {":5: camera.whole_line_exposure: 1, expected true or false"}},
      {good + "people: {radius_m: 1}\n", {":5: people: a mapping, expected a list of mappings"}},
      {good + "windows: [1]\n", {":5: windows[0]: 1, expected a mapping"}},
      {good + "draw: {clocks: yes}\n", {":5: draw.clocks: yes, expected true or false"}},
      {good + "truth: {tilt_deg: 1}\n", {":5: truth.tilt_deg: 1, expected 2 numbers"}},
      // files
      {"rig: none.yaml\nlamps: lamps.yaml\n" + frames + still, {":1: rig: ", "none.yaml: cannot be opened"}},
      {"rig: rig.yaml\nlamps: none.yaml\n" + frames + still, {":2: lamps: ", "none.yaml: cannot be opened"}},
      {"rig: lamps.yaml\nlamps: lamps.yaml\n" + frames + still, {"lamps.yaml:1: camera: missing"}},
      // frames
      {head + "frames: {rate_hz: 0}\n" + still, {":3: frames.rate_hz: 0, expected a number above 0"}},
      {head + "frames: {rate_hz: 12, count: 0}\n" + still,
       {":3: frames.count: 0, expected a whole number of 1"}},
      {head + "frames: {rate_hz: 12, count: 3, duration_s: 1}\n" + still,
       {":3: frames.duration_s: beside count, expected one of them"}},
      {head + "frames: {rate_hz: 12, duration_s: 1e300}\n" + still,
       {":3: frames.duration_s: ", "at most 1e+06"}},
      {head + "frames: {rate_hz: 12, duration_s: 21600}\n" + still,
       {":3: frames.duration_s: ", "at most 21000 s"}},
      {head + "frames: {rate_hz: 12, count: 4000000000}\n" + still, {":3: frames.count: ", "at most 1e+06"}},
      {head + "frames: {rate_hz: 12, count: 5000000000}\n" + still,
       {":3: frames.count: 5000000000, expected"}},
      {head + "frames: {rate_hz: 1e-300, count: 3}\n" + still, {":3: frames.rate_hz: 1e-300, expected"}},
      {head + "frames: {rate_hz: 1e300, count: 3}\n" + still, {":3: frames.rate_hz: 1e+300, expected"}},
      // camera
      {good + "camera: {exposure_s: -1e-6}\n", {":5: camera.exposure_s: -1e-6, expected a number above 0"}},
      {good + "camera: {exposure_s: 0}\n", {":5: camera.exposure_s: 0, expected a number above 0"}},
      {good + "camera: {exposure_s: 1e300}\n", {":5: camera.exposure_s: 1e+300, expected at most 1"}},
      {good + "camera: {blur_px: -1}\n", {":5: camera.blur_px: -1, expected a number from 0"}},
      {good + "camera: {blur_px: 1e300}\n", {":5: camera.blur_px: 1e+300, expected"}},
      {good + "camera: {read_noise: 1e300}\n", {":5: camera.read_noise: 1e+300, expected"}},
      {good + "camera: {halo: {share: 1.5, radius_px: 5}}\n", {":5: camera.halo.share: 1.5, expected"}},
      {good + "camera: {halo: {share: 0.5, radius_px: 1}}\n",
       {":5: camera.halo.radius_px: 1, expected 2 or more"}},
      // light
      {good + "light: {half_power_deg: 90}\n", {":5: light.half_power_deg: 90, expected", "below 90"}},
      {good + "light: {half_power_deg: 120}\n", {":5: light.half_power_deg: 120, expected", "below 90"}},
      {good + "light: {half_power_deg: 1e-300}\n", {":5: light.half_power_deg: 1e-300, expected"}},
      {good + "light: {lamp_level: -1}\n", {":5: light.lamp_level: -1, expected"}},
      {good + "light: {lamp_level: 1e300}\n", {":5: light.lamp_level: 1e+300, expected"}},
      {good + "light: {rim: 1.1}\n", {":5: light.rim: 1.1, expected a number from 0 to 1"}},
      // motion
      {move + "motion: {type: stations, points: [], frames_each: 1}\n", {":4: motion.points: an empty list"}},
      {move + "motion: {type: stations, points: [{at_m: [1e300, 0]}], frames_each: 1}\n",
       {":4: motion.points[0].at_m: 1e+300, expected at most 10000 m"}},
      {move + "motion: {type: stations, points: [{at_m: [0, 0]}], frames_each: 0}\n",
       {":4: motion.frames_each: 0"}},
      {move + "motion: {type: stations, points: [{at_m: [0, 0]}], frames_each: 4000000000}\n",
       {":4: motion: 4e+09 frames, expected at most 1e+06"}},
      {move + "motion: {type: stations, frames_each: 1, grid: {x_m: [0, 1], y_m: [0, 1], columns: "
              "4000000000, rows: "
              "4000000000}}\n",
       {":4: motion.grid: 1.6e+19 points, expected at most 1e+06"}},
      {move + "motion: {type: stations, frames_each: 1, grid: {x_m: [0, 1e300], y_m: [0, 1], columns: 2, "
              "rows: 1}}\n",
       {":4: motion.grid.x_m: 1e+300, expected"}},
      {commands + "[]}\n", {":4: motion.commands: an empty list"}},
      {commands + "[{v_m_s: 0.1}]}\n", {":4: motion.commands[0].duration_s: missing"}},
      {commands + "[{v_m_s: 0.1, duration_s: -1}]}\n", {":4: motion.commands[0].duration_s: -1, expected"}},
      {commands + "[{v_m_s: 0.1, duration_s: 1e300}]}\n",
       {":4: motion: 1e+300 s of driving, expected at most 21000"}},
      {commands + "[{v_m_s: 0.1, duration_s: 1e308}, {duration_s: 1e308}]}\n",
       {":4: motion: inf s of driving"}},
      {commands + "[{v_m_s: 0.3, duration_s: 1}]}\n",
       {":4: motion: v 0.3 m/s with w 0 rad/s is beyond this robot"}},
      {move + "motion: {type: line, from_m: [0, 0], to_m: [1, 0], speed_m_s: 1}\n",
       {":4: motion: v 1 m/s with w 0 rad/s is beyond this robot"}},
      {move + "motion: {type: line, from_m: [0, 0], to_m: [1, 0], speed_m_s: -0.1}\n",
       {":4: motion.speed_m_s: -0.1"}},
      {move + "motion: {type: line, from_m: [0, 0], to_m: [0, 0], speed_m_s: 0.1}\n",
       {":4: motion.to_m: the same place as from_m"}},
      {move + "motion: {type: line, from_m: [0, 0], to_m: [1, 0], speed_m_s: 1e-300}\n",
       {":4: motion: ", "driving"}},
      {move + "motion: {type: line, from_m: [1e300, 0], to_m: [1, 0], speed_m_s: 0.1}\n",
       {":4: motion: simulated TurtleBot3: startX: 1e+300, expected"}},
      {move + "motion: {type: arc, start_m: [0, 0], speed_m_s: 0.1, radius_m: 0, duration_s: 1}\n",
       {":4: motion.radius_m: 0, expected"}},
      {move + "motion: {type: arc, start_m: [0, 0], speed_m_s: 0.1, radius_m: 1e-300, duration_s: 1}\n",
       {":4: motion: v 0.1 m/s with w", "beyond this robot"}},
      {move + "motion: {type: spin, start_m: [0, 0], rate_rad_s: 1, duration_s: 1e300}\n",
       {":4: motion: 1e+300 s"}},
      {move + "motion: {type: spin, start_m: [0, 0], rate_rad_s: 9, duration_s: 1}\n",
       {":4: motion: v 0 m/s with w 9"}},
      {good + "robot: {slip: 0.1}\n", {":5: robot: beside a motion of stations"}},
      {commands + "[{duration_s: 1}]}\nrobot: {slip: 2}\n", {":5: robot: ", "slip: 2, expected 0 to 1"}},
      {commands + "[{duration_s: 1}]}\nrobot: {model: tank}\n",
       {":5: robot.model: tank, expected one of burger"}},
      // lamps of the truth
      {good + lamps + "[{id: Z}]}\n",
       {":5: truth.lamps[0].id: Z, expected a lamp of the map or of more_lamps"}},
      {good + lamps + "[{id: A}, {id: A}]}\n", {":5: truth.lamps[1].id: A a second time"}},
      {good + lamps + "[{id: A, shift_m: [0, 0, -2]}]}\n", {":2: lamps: lamp A hangs at a height of -0.5 m"}},
      {good + lamps + "[{id: A, shift_m: [1e300, 0, 0]}]}\n", {"lamp A reaches to 1e+300 m"}},
      {good + lamps + "[{id: A, clock_ppm: -2000000}]}\n",
       {":5: truth.lamps[0].clock_ppm: -2e+06, expected"}},
      {good + lamps + "[{id: A, dark: [{from_s: 2, until_s: 1}]}]}\n",
       {":5: truth.lamps[0].dark[0].until_s: 1, expected more than from_s, 2"}},
      {good + lamps + "[{id: A, half_power_deg: 90}]}\n", {":5: truth.lamps[0].half_power_deg: 90"}},
      {good + more + "[{id: A, position_m: [0, 0, 2], diameter_m: 0.1, unmodulated: true}]}\n",
       {":5: truth.more_lamps[0].id: A a second time"}},
      {good + more + "[{id: C, position_m: [0, 0, 2], unmodulated: true}]}\n",
       {"lamp C without diameter_m or size_m"}},
      {good + more + "[{id: C, position_m: [0, 0, 0.19], diameter_m: 0.1, unmodulated: true}]}\n",
       {"lamp C hangs at a height of 0.19 m, expected it above the camera"}},
      {good + more + "[{id: C, position_m: [0, 0, -1], diameter_m: 0.1, unmodulated: true}]}\n",
       {"height of -1 m"}},
      {good + more + "[{id: C, position_m: [0, 0, 2], diameter_m: 1e300, unmodulated: true}]}\n",
       {"lamp C reaches to 1e+300 m"}},
      {good + more + "[{id: C, position_m: [0, 0, 2], diameter_m: 0.1, frequency_hz: 1e300}]}\n",
       {"truth.more_lamps[0].frequency_hz: 1e+300, expected Hz"}},
      {good + more +
           "[{id: C, position_m: [0, 0, 2], diameter_m: 0.1, frequency_hz: 1e3, phase_difference: 0.1}]}\n",
       {"lamp C: lamp light: phase difference 0.1", "overlap"}},
      {good + more +
           "[{id: C, position_m: [0, 0, 2], diameter_m: 0.1, frequency_hz: 1e3, oscillator_ppm: 1e6}]}\n",
       {"lamp C with oscillator_ppm 1e+06, expected at most 1e+05"}},
      // the camera's truth, and draws
      {good + "truth: {focal_length: 0}\n", {":5: truth.focal_length: 0, expected"}},
      {good + "truth: {row_time: 1e300}\n", {":5: truth.row_time: 1e+300, expected"}},
      {good + "truth: {tilt_deg: [1e300, 0]}\n", {":5: truth.tilt_deg: 1e+300, expected"}},
      {good + "draw: {focal_length: 0.5}\n", {":5: draw.focal_length: 0.5, expected"}},
      {good + "draw: {tilt_deg: -1}\n", {":5: draw.tilt_deg: -1, expected"}},
      {good + "draw: {tilt_deg: 1e308}\n", {":5: draw.tilt_deg: 1e+308, expected"}},
      {good + "draw: {lamp_shift_m: 1e300}\n", {":5: draw.lamp_shift_m: 1e+300, expected"}},
      // people and windows
      {good + "people: [{path: []}]\n", {":5: people[0].path: an empty list, expected one step or more"}},
      {good + "people: [{radius_m: 0.2}]\n", {":5: people[0].path: missing"}},
      {good + "people: [{path: [{time_s: 1, at_m: [0, 0]}, {time_s: 0.5, at_m: [1, 0]}]}]\n",
       {":5: people[0].path[1].time_s: 0.5, expected no less than 1"}},
      {good + "people: [{radius_m: -1, path: [{time_s: 1, at_m: [0, 0]}]}]\n",
       {":5: people[0].radius_m: -1"}},
      {good + "windows: [{centre_m: [0, 0, 2], half_width_m: [1, 0, 0], half_height_m: [1, 1, 0]}]\n",
       {":5: windows[0].half_height_m: ", "at right angles"}},
      {good + "windows: [{centre_m: [0, 0, 2], half_width_m: [0, 0, 0], half_height_m: [1, 1, 0]}]\n",
       {":5: windows[0].half_height_m: ", "longer than 0"}},
      {good + "windows: [{centre_m: [0, 0, 2], half_width_m: [1e300, 0, 0], half_height_m: [0, 1, 0]}]\n",
       {":5: windows[0].half_width_m: 1e+300, expected"}},
  };
  for (const Bad &bad : all) {
    SCOPED_TRACE(bad.text.substr(0, 400));
    const simulatedRoom::Folder folder;
    vpExpectError([&] { vpSimulation(folder.load(bad.text), 1); }, bad.parts);
  }
}

TEST(Scenario, LampsOfTheMapThatCannotBeDrawn)
{
  const simulatedRoom::Folder folder;
  folder.write("lamps.yaml", "lamps: [{id: A, position_m: [0, 0, 1.5], frequency_hz: 1000}]\n");
  vpExpectError([&] { folder.load(head + frames + still); },
                {"scenario.yaml:2: lamps: lamp A without diameter_m or size_m"});
  folder.write("lamps.yaml",
               "lamps: [{id: A, position_m: [0, 0, 0.2], diameter_m: 0.1, frequency_hz: 1000}]\n");
  vpExpectError([&] { folder.load(head + frames + still); },
                {"scenario.yaml:2: lamps: lamp A hangs at a height of 0.2 m, expected it above the camera"});
}

TEST(Scenario, FileThatIsNotThere)
{
  vpExpectError([] { vpScenario::load("/nowhere/scenario.yaml"); },
                {"/nowhere/scenario.yaml: cannot be opened"});
}
