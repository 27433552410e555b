/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */

#include <CLI/CLI.hpp>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "common/vpCommandLine.h"
#include "vpSimulate.h"

BEGIN_VISP_NAMESPACE

namespace
{
const char *const description =
    "Draws what a rolling-shutter camera on a robot sees of blinking lamps: frames with ground truth.\n";

const char *const footer = R"(
Examples:
  vlp-simulate --scenario data/scenarios/paper-a.yaml --out run-a
  vlp-simulate --scenario data/scenarios/paper-points.yaml --seed 7 --out points-7
  vlp-locate --run run-a --poses poses.tum && vlp-evaluate --truth run-a/truth.tum --estimate poses.tum

The run folder (m, s, rad):
  frames.csv     timestamp_s,file: start of exposure of the first line of each picture
  rig.yaml, camera XML, lamps.yaml   the robot's files, which may differ from the simulated truth
  truth.tum      where the robot base was, wMb; at each frame, and of a driven robot 50 times a second
  odometry.csv   timestamp_s,v_m_s,w_rad_s: what a driven robot's wheels say
The same scenario and seed give the same bytes. data/README.md explains the scenario file.
The folder appears whole, at the end. Ctrl-C ends the work and keeps the frames done so far.

Exit code: 0 done; 2 bad usage or bad input.
)";
} // namespace

bool vpSimulateOptions::parse(int argc, char **argv)
{
  CLI::App app(description, "vlp-simulate");
  app.footer(footer);
  app.get_formatter()->column_width(28);
  vpAddInput(app, "--scenario", scenario, "FILE", "what to draw");
  vpAddName(app, "--out", out, "DIR", "the run folder to make; new, or empty");
  vpAddSeed(app, "--seed", seed, "what is left to chance; default 1");
  vpAddChoice(app, "--format", format, {"png", "pgm"},
              "of the pictures; pgm is quicker and larger; default png");
  vpAddCount(app, "--frames", frames, "only the first N frames");
  vpAddCount(app, "--every", every, "only every N-th frame of the camera");
  app.add_flag(
      "--typical", typical,
      "draw the errors of a typical rig, unknown to the robot: camera and lamps off by 0.15 degree of roll "
      "and "
      "pitch, 2 mm of each lamp, 1 px, 0.3 % of focal length, 0.05 % of row time (standard deviations)");
  if (!vpParseCommandLine(app, argc, argv)) {
    return false;
  }
  if (scenario.empty()) {
    throw vpException(vpException::badValue, "--scenario: nothing, expected the file of a scenario");
  }
  if (out.empty()) {
    throw vpException(vpException::badValue, "--out: nothing, expected the run folder to make");
  }
  return true;
}

END_VISP_NAMESPACE
