/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLocate_h
#define vpLocate_h

#include "common/vpProgram.h"
#include "vpLocateOptions.h"

BEGIN_VISP_NAMESPACE

/*!
  The program itself: reads the frames, locates the robot in each and writes what was asked for. A frame that
  cannot be used is one line on stderr and the rest goes on; so is a window where there is no screen.
  \throw vpException where the work cannot start, or not be written.
*/
vpExitCode vpLocate(const vpLocateOptions &options);

END_VISP_NAMESPACE

#endif
