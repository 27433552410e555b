/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSimulate_h
#define vpSimulate_h

#include <cstdint>
#include <string>

#include "common/vpProgram.h"

BEGIN_VISP_NAMESPACE

//! What the command line of vlp-simulate says.
struct vpSimulateOptions {
  std::string scenario;
  std::string out; // a folder
  std::uint64_t seed = 1;
  std::string format = "png";
  std::size_t frames = 0; // the first so many; 0: all
  std::size_t every = 1;  // of the camera's frames only each so manieth
  bool typical = false;   // rig errors as vpScenario::useTypicalRig() draws them

  //! \return False where the help was asked for and is printed. \throw vpException on bad usage.
  bool parse(int argc, char **argv);
};

/*!
  The program itself: draws the frames of a scenario into a run folder, which appears whole, at the end.
  \throw vpException where the scenario is bad or the folder cannot be written.
*/
vpExitCode vpSimulate(const vpSimulateOptions &options);

END_VISP_NAMESPACE

#endif
