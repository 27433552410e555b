/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEvaluateRuns_h
#define vpEvaluateRuns_h

#include "common/vpProgram.h"
#include "vpEvaluateOptions.h"

BEGIN_VISP_NAMESPACE

/*!
  Sets runs of vlp-servo side by side: one table of how far off their paths they were, and a map of the tracks
  on each path. \throw vpException where something cannot be read or written.
*/
vpExitCode vpEvaluateRuns(const vpEvaluateOptions &options);

END_VISP_NAMESPACE

#endif
