/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCalibrate_h
#define vpCalibrate_h

#include "common/vpProgram.h"

/*!
  \file vpCalibrate.h
  The commands of vlp-calibrate. Each reads its own options, argv[0] being its name.
  \throw vpException with one line where usage or input is bad.
*/

BEGIN_VISP_NAMESPACE

vpExitCode vpCalibrateCamera(int argc, char **argv);
vpExitCode vpCalibrateShutter(int argc, char **argv);
vpExitCode vpCalibrateMount(int argc, char **argv);
vpExitCode vpCalibrateLamps(int argc, char **argv);

END_VISP_NAMESPACE

#endif
