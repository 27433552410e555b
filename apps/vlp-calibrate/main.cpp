/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vlp-calibrate: camera, shutter, mount and lamps, each from pictures.

#include <iostream>
#include <string>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "common/vpInterrupt.h"
#include "common/vpProgram.h"
#include "vpCalibrate.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
const char *const help =
    R"(Finds the parameters of a camera that looks up at blinking lamps, and where these hang.

Usage: vlp-calibrate COMMAND [OPTIONS]

Commands, in the order in which to use them (each has a --help of its own):
  camera   focal length, principal point and distortion, from pictures of a board; prints the board, too
  shutter  row time, effective exposure and readout along rows or columns, from lamps of known frequency
  mount    how the camera sits on the robot, from a spin and a drive under known lamps
  lamps    where the lamps hang, from a drive and two known lamps or one distance

Example:
  vlp-calibrate shutter --run recorded --rig rig.yaml --lamps lamps.yaml

Exit code: 0 done; 2 bad usage or bad input; 3 the pictures do not tell what was asked for.
)";

vpExitCode run(int argc, char **argv)
{
  const std::string command = argc > 1 ? argv[1] : "";
  if (command == "--help" || command == "-h") {
    std::cout << help;
    return vpExitCode::done;
  }
  if (command == "--version") {
    std::cout << vpVersionOf("vlp-calibrate") << "\n";
    return vpExitCode::done;
  }
  vpInterrupt::install();
  --argc;
  ++argv;
  if (command == "camera") {
    return vpCalibrateCamera(argc, argv);
  }
  if (command == "shutter") {
    return vpCalibrateShutter(argc, argv);
  }
  if (command == "mount") {
    return vpCalibrateMount(argc, argv);
  }
  if (command == "lamps") {
    return vpCalibrateLamps(argc, argv);
  }
  throw vpException(vpException::badValue,
                    "command: " + (command.empty() ? std::string("none") : vpShown(command)) +
                        ", expected camera, shutter, mount or lamps (--help explains them)");
}
} // namespace

int main(int argc, char **argv)
{
  return vpRunProgram("vlp-calibrate", [&] { return run(argc, argv); });
}
