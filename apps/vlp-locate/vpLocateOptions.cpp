/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLocateOptions.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include <CLI/CLI.hpp>
#include <visp3/core/vpException.h>

#include "common/vpCommandLine.h"
#include "common/vpProgram.h"

BEGIN_VISP_NAMESPACE

namespace
{
namespace fs = std::filesystem;

const char *const description =
    "Locates a robot in each frame of a rolling-shutter camera that looks up at blinking ceiling lamps.\n";

const char *const footer = R"(
Examples:
  vlp-locate --run recorded --odometry recorded/odometry.csv --poses poses.tum
  vlp-locate --rig rig.yaml --lamps lamps.yaml --images 'frames/%04d.png' --fixes fixes.csv --overlay look
  vlp-locate --rig rig.yaml --lamps lamps.yaml --image a.png b.jpg > poses.tum
  vlp-locate --list-cameras
  vlp-locate --rig rig.yaml --lamps lamps.yaml --camera aravis:// --camera-rate 12 --display

Outputs (m, rad, s, Hz, pixels; the pose is wMb, the robot base in the map):
  poses    TUM: timestamp tx ty tz qx qy qz qw; a frame without a position, or with two that explain it
           alike, has no row. Written to stdout where no output is asked for.
  fixes    timestamp_s,x,y,z,roll,pitch,yaw,sigma_x,sigma_y,sigma_z,sigma_yaw,cov_xy,lamps,state,compute_s:
           a row for each frame read. Angles about the fixed axes x, y, z: R = Rz(yaw) Ry(pitch) Rx(roll).
           lamps: their ids, joined by ';'. state: tracking (the pose is carried from frame to frame, its
           sigma below 20 mm and 0.05 rad); coasting (less certain, sigma below 200 mm: few lamps or none);
           fix (of this frame alone); relocated (where no motion leads to: the robot was put there, or two
           lamps gave way to copies; until a third lamp bears it out); ambiguous (a second pose explains the
           frame as well, this one is the likelier); none (no position, the fields of the pose are empty).
  seen     timestamp_s,file,lamp_id,u,v,diameter_px,frequency_hz,duty,confidence,accepted,symbols:
           a row for each lamp-like region. u, v: the image of the lamp's middle. lamp_id is empty where
           it is no lamp of the map; accepted is 1 where it counts for the position. symbols: the chips of
           a lamp that sends a word, 1 lit, from the rotation that is the greatest as text; else empty.
  overlay  a picture for each frame: outlines green where the lamp counts for the position, yellow where it
           is known and does not, orange where it is no lamp of the map, with the reason; blue, the windows
           in which lamps were looked for, if not in all of the picture. Beside it state, time, pose, and
           the map from above: its lamps, the robot with the ellipse of 3 sigma, its trail, grid in metres.
Pictures without times (--images, --image) get their index, 0 1 2 ..., as their time.
A camera's frames have the time at which the exposure of their first line began, on the computer's clock.
One that goes away is told once, and waited for; frames that were dropped, broken or overtaken are counted.
Frames are taken in the order in which they are listed. One whose time is not after that of the frame before
has state none, unless it is more than a second earlier: then the clock was set back, and all begins anew.
With --no-track it is located all the same. In poses the times rise: a pose with an earlier one has no row.
A picture that cannot be read, or has not the rig's size, is a line on stderr and has no row anywhere.
Files appear whole, at the end. Ctrl-C ends the work and keeps what was done so far.

Exit code: 0 done; 2 bad usage or bad input; 3 no position in any frame.
)";

std::string absolute(const std::string &name)
{
  std::error_code ignored;
  const fs::path path = fs::weakly_canonical(fs::absolute(name, ignored), ignored);
  return path.empty() ? name : path.string();
}

//! An output that would replace an input, or another output.
void refuseClashes(const std::vector<std::pair<std::string, std::string>> &inputs,
                   const std::vector<std::pair<std::string, std::string>> &outputs)
{
  std::vector<std::pair<std::string, std::string>> others = inputs;
  for (const auto &[option, name] : outputs) {
    std::error_code ignored;
    const bool device =
        fs::exists(name, ignored) && !fs::is_regular_file(name, ignored); // /dev/stdout twice is fine
    for (const auto &[otherOption, otherName] : others) {
      if (!name.empty() && !otherName.empty() && !device && absolute(name) == absolute(otherName)) {
        vpBadInput(option + ": " + name + ", which is that of " + otherOption + ", expected another file");
      }
    }
    others.emplace_back(option, name);
  }
}
} // namespace

bool vpLocateOptions::parse(int argc, char **argv)
{
  CLI::App app(description, "vlp-locate");
  app.footer(footer);
  app.get_formatter()->column_width(28);
  std::string attitude = "mount", solver = "all";
  vpAddInput(app, "--rig", rigFile, "FILE", "the camera on the robot; default with --run: DIR/rig.yaml");
  vpAddInput(app, "--lamps", lampsFile, "FILE", "the lamp map; default with --run: DIR/lamps.yaml");
  frames.manyRuns = false;
  frames.ofCamera = 0;
  frames.add(app);
  app.add_flag("--list-cameras", listCameras,
               "print the cameras that are found, with what they can do, and end");
  vpAddChoice(
      app, "--attitude", attitude, {"mount", "free"},
      "mount (default): roll and pitch from the rig; free: all six estimated, from three lamps or more");
  vpAddChoice(app, "--solver", solver, {"all", "two"},
              "all (default): all lamps seen; two: the pair of best geometry, as in the paper");
  vpAddName(app, "--odometry", odometry, "FILE",
            "what the wheels or a gyro say of the motion: timestamp_s,v_m_s,w_rad_s, on the frames' clock");
  app.add_flag("--no-track", noTrack,
               "each frame by itself; so it is with --image, whose pictures need be no sequence, and with "
               "--solver two");
  vpAddName(app, "--poses", poses, "FILE", "write the poses as a TUM trajectory");
  vpAddName(app, "--fixes", fixes, "FILE", "write the poses with their standard deviations as CSV");
  vpAddName(app, "--seen", seen, "FILE", "write what was seen in each frame as CSV");
  vpAddName(app, "--overlay", overlay, "DIR",
            "write a picture of each frame with what was seen, and the map; of lamps that blink and have no "
            "id what was read of them");
  app.add_flag("--display", display,
               "show the same live in a window until a click there; without a screen: says so and goes on");
  if (!vpParseCommandLine(app, argc, argv)) {
    return false;
  }

  if (listCameras) {
    return true;
  }
  noTrack = noTrack || !frames.files.empty() || solver == "two";
  freeAttitude = attitude == "free";
  twoLamps = solver == "two";
  if (!frames.runs.empty()) {
    const fs::path run = frames.runs.front();
    rigFile = rigFile.empty() ? (run / "rig.yaml").string() : rigFile;
    lampsFile = lampsFile.empty() ? (run / "lamps.yaml").string() : lampsFile;
  }
  check();
  return true;
}

void vpLocateOptions::check() const
{
  frames.check();
  if (rigFile.empty()) {
    vpBadInput("--rig: nothing, expected the file of the camera on the robot");
  }
  if (lampsFile.empty()) {
    vpBadInput("--lamps: nothing, expected the file of the lamp map");
  }
  if (freeAttitude && twoLamps) {
    vpBadInput("--attitude: free with --solver two, expected mount: two lamps do not tell roll and pitch");
  }
  std::vector<std::pair<std::string, std::string>> inputs = {
      {"--rig", rigFile}, {"--lamps", lampsFile}, {"--video", frames.video}};
  for (const std::string &run : frames.runs) {
    inputs.emplace_back("--run", (fs::path(run) / "frames.csv").string());
  }
  for (const std::string &file : frames.files) {
    inputs.emplace_back("--image", file);
  }
  inputs.emplace_back("--odometry", odometry);
  if (!odometry.empty() && noTrack) {
    vpBadInput("--odometry: " + odometry +
               " with frames that are located each by itself, expected a sequence");
  }
  refuseClashes(inputs, {{"--poses", poses}, {"--fixes", fixes}, {"--seen", seen}});
}

vpVlpLocalizer vpLocateOptions::localizer(const vpVlpRig &rig, const vpLampMap &map) const
{
  // Without a position there can still be lamps to look at.
  const bool positionsOnly = seen.empty() && overlay.empty() && !display;
  const size_t needed = freeAttitude ? 3 : 2, lamps = map.lamps.size();
  if (positionsOnly && lamps < needed) {
    vpBadInput(lampsFile + ": " + std::to_string(lamps) + (lamps == 1 ? " lamp" : " lamps") + ", expected " +
               std::to_string(needed) + " or more for a position");
  }
  vpVlpLocalizer localizer(rig, map);
  localizer.tracking = !noTrack;
  localizer.solver = twoLamps ? vpVlpLocalizer::Solver::two : vpVlpLocalizer::Solver::all;
  localizer.manyLamps.attitude =
      freeAttitude ? vpManyLampSolver::Attitude::free : vpManyLampSolver::Attitude::mount;
  return localizer;
}

END_VISP_NAMESPACE
