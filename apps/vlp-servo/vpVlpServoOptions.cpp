/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpVlpServoOptions.h"

#include <cmath>
#include <vector>

#include <CLI/CLI.hpp>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "common/vpCommandLine.h"
#include "common/vpProgram.h"

BEGIN_VISP_NAMESPACE

namespace
{
const char *const description =
    "Drives a robot along a path on the floor, its pose from the blinking lamps above it.\n";

const char *const footer = R"(
Examples:
  vlp-servo --robot sim --scenario data/scenarios/servo.yaml --path data/paths/line-a.yaml --speed 0.004
  vlp-servo --robot sim --scenario data/scenarios/servo.yaml --path data/paths/square.yaml --laps 2 --log run
  vlp-servo --robot opencr:usb --camera aravis://UB300 --rig rig.yaml --lamps lamps.yaml --path line.yaml
  vlp-servo --robot ros:/robot1 --path data/paths/line-a.yaml --log run
  vlp-servo --list-robots

Robots:
  sim              the TurtleBot of a scenario: its rig, lamps, light and errors; its motion is not driven
  opencr:usb       a TurtleBot3 on its USB cable
  opencr:DEVICE    the same through a serial device, as opencr:/dev/ttyACM0
  ros:NAMESPACE    a robot on ROS, as ros:/robot1: cmd_vel, odom and vlp_location of that namespace; camera,
                   rig and lamps are those of its nodes (apps/ros)

Paths (YAML, metres):
  {type: polyline, points_m: [[-0.35, 0], [0.35, 0]], closed: false}
  {type: circle, centre_m: [0, 0], radius_m: 0.3}
  {type: arc, centre_m: [0, 0], radius_m: 0.3, from_deg: 0, to_deg: 90}
  {type: lemniscate, centre_m: [0, 0], width_m: 0.7}
At a polyline's corners the robot stops and turns on the spot.

The folder --log gets path.yaml, poses.tum (of each picture, at its own time), odometry.csv, commands.csv
(timestamp_s,v_m_s,w_rad_s: what the base was told, then the law's own v and w, the share of the speed that was
allowed, the reference's s, and why it had to wait), track.tum (the pose that each command rests on, at the time
for which it was predicted), in simulation truth.tum, and track.svg and track.png where there is gnuplot.
The folder appears whole, at the end.

The robot does not move before three pictures in a row have shown a tracked pose. It slows where the pose is
uncertain by more than 20 mm. It stands and waits beyond 50 mm, where no picture of the last 0.5 s comes, and where
a pose is relocated or ambiguous; standard error says why. The run ends after 20 s of waiting, at the fence, with a
low battery, where the pose moves otherwise than the wheels, where the clock is set back, and on any error of the
base. It ends too on Ctrl-C, SIGTERM, any key in the terminal and a click in the window. The base is told to stop
in each of these cases.

Exit code: 0 the path was driven to its end, or somebody ended it; 2 bad usage or bad input; 3 the run failed,
or --list-robots found none.
)";

//! Into \e value, where \e text was given.
void readPositive(const std::string &option, const std::string &text, double &value)
{
  if (!text.empty()) {
    value = vpNumbersOf(option, text, 1, "a number above 0")[0];
    if (value <= 0) {
      vpBadInput(option + ": " + vpShown(text) + ", expected a number above 0");
    }
  }
}

//! Into \e fence, where \e text was given.
void readFence(const std::string &text, std::optional<Eigen::AlignedBox2d> &fence)
{
  if (text.empty()) {
    return;
  }
  const std::string expected = "four numbers x1,y1,x2,y2 (m), the lower left corner first";
  const std::vector<double> corners = vpNumbersOf("--fence", text, 4, expected);
  fence =
      Eigen::AlignedBox2d(Eigen::Vector2d(corners[0], corners[1]), Eigen::Vector2d(corners[2], corners[3]));
  if (fence->isEmpty()) {
    vpBadInput("--fence: " + vpShown(text) + ", expected " + expected);
  }
}
} // namespace

bool vpVlpServoOptions::parse(int argc, char **argv)
{
  CLI::App app(description, "vlp-servo");
  app.footer(footer);
  app.get_formatter()->column_width(28);
  std::string speed, gain, delay, startText, fence;
  bool openLoop = false, odometryOnly = false, headless = false;
  vpAddName(app, "--robot", robot, "ROBOT", "sim, opencr:usb, opencr:DEVICE or ros:NAMESPACE");
  app.add_flag("--list-robots", listRobots, "print the boards that are attached by USB, and end");
  vpAddInput(app, "--scenario", scenario, "FILE", "sim: the world, see data/scenarios/servo.yaml");
  vpAddSeed(app, "--seed", seed, "sim: of all that is left to chance (default 1)");
  app.add_flag("--typical", typical, "sim: draw the errors of a typical rig, unknown to the robot");
  app.add_flag("--wheels-only", wheelsOnly,
               "sim: the odometry's turns from the wheels, whatever the scenario says");
  app.add_flag("--real-time", realTime,
               "sim: as fast as the world really goes, camera in a thread of its own");
  vpAddName(app, "--latency", delay, "S", "sim: of the localizer after a picture's readout (default 0.02 s)");
  vpAddInput(app, "--rig", rigFile, "FILE", "the camera on the robot; default with sim: the scenario's");
  vpAddInput(app, "--lamps", lampsFile, "FILE", "the lamp map; default with sim: the scenario's");
  camera.add(app);
  vpAddInput(app, "--path", pathFile, "FILE", "the path to drive, see data/paths");
  vpAddName(app, "--speed", speed, "M/S", "along the path (default 0.1)");
  vpAddName(app, "--gain", gain, "1/S", "lambda of the visual task for small errors (default 2.5)");
  size_t laps = loop.follower.reference.laps;
  vpAddCount(app, "--laps", laps, "of a closed path (default 1)", 1000000);
  vpAddName(app, "--start", startText, "X,Y,YAW_DEG",
            "where the robot stands (m); default: on the path's start");
  vpAddName(app, "--fence", fence, "X1,Y1,X2,Y2",
            "where the robot has to stay (m); default: 0.3 m around the path");
  app.add_flag("--open-loop", openLoop, "for comparison: without any feedback");
  app.add_flag("--odometry-only", odometryOnly, "for comparison: feedback from odometry, from the start on");
  vpAddName(app, "--log", log, "DIR", "write what happened into a new folder");
  app.add_flag("--display", display, "show picture, map, velocities and errors live; a click ends the run");
  app.add_flag("--headless", headless, "without a window; so it is unless --display is given");
  if (!vpParseCommandLine(app, argc, argv)) {
    return false;
  }
  loop.follower.reference.laps = static_cast<unsigned int>(laps);
  if (listRobots) {
    return true;
  }
  if (openLoop && odometryOnly) {
    vpBadInput("--open-loop: beside --odometry-only, expected one of them");
  }
  if (display && headless) {
    vpBadInput("--display: beside --headless, expected one of them");
  }
  pose = openLoop ? Pose::commands : (odometryOnly ? Pose::odometry : Pose::lamps);
  readPositive("--speed", speed, loop.follower.reference.speed);
  readPositive("--gain", gain, loop.follower.servo.gain);
  loop.follower.servo.gainFar *= gain.empty() ? 1 : loop.follower.servo.gain / vpPointServoSettings().gain;
  readPositive("--latency", delay, latency);
  readFence(fence, loop.safety.fence);
  if (!startText.empty()) {
    const std::vector<double> numbers =
        vpNumbersOf("--start", startText, 3, "three numbers x,y,yaw (m, m, degrees)");
    start = vpServoStart{numbers[0], numbers[1], numbers[2] * M_PI / 180};
  }
  check();
  return true;
}

void vpVlpServoOptions::check() const
{
  if (robot.empty()) {
    vpBadInput("--robot: nothing, expected sim, opencr:usb, opencr:DEVICE or ros:NAMESPACE (--help explains "
               "the options)");
  }
  if (pathFile.empty()) {
    vpBadInput("--path: nothing, expected the file of the path to drive");
  }
  const bool sim = robot == "sim";
  if (!sim && !onRos() && robot.rfind("opencr:", 0) != 0) {
    vpBadInput("--robot: " + vpShown(robot) + ", expected sim, opencr:usb, opencr:DEVICE or ros:NAMESPACE");
  }
  if (onRos() && (!rigFile.empty() || !lampsFile.empty() || !camera.uri.empty() || display)) {
    vpBadInput("--rig, --lamps, --camera, --display: beside --robot " + vpShown(robot) +
               ", whose nodes have them");
  }
  if (sim && scenario.empty()) {
    vpBadInput("--scenario: nothing, expected the file of the world that sim drives in");
  }
  camera.check();
  if (sim && !camera.uri.empty()) {
    vpBadInput("--camera: " + vpShown(camera.uri) + " beside --robot sim, whose camera is the scenario's");
  }
  if (!sim && (!scenario.empty() || typical || wheelsOnly || realTime)) {
    vpBadInput("--scenario, --typical, --wheels-only, --real-time: beside --robot " + vpShown(robot) +
               ", expected them with sim only");
  }
  if (!sim && !onRos() && pose == Pose::lamps &&
      (rigFile.empty() || lampsFile.empty() || camera.uri.empty())) {
    vpBadInput("--rig, --lamps, --camera: expected all of them with a real robot");
  }
}

vpServoStart vpVlpServoOptions::startOn(const vpPath &path) const
{
  const vpPathPoint begin = path.at(0);
  return start.value_or(vpServoStart{begin.place.x(), begin.place.y(), begin.heading});
}

END_VISP_NAMESPACE
