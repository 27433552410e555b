/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEvaluate_h
#define vpEvaluate_h

#include "common/vpProgram.h"
#include "vpEvaluateOptions.h"

BEGIN_VISP_NAMESPACE

/*!
  The program itself: reads, evaluates, prints the tables and writes what was asked for. \throw vpException
  where something cannot be read or written; the folder is then as it was, or holds whole files.
*/
vpExitCode vpEvaluate(const vpEvaluateOptions &options);

END_VISP_NAMESPACE

#endif
