/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpServo_h
#define vpVlpServo_h

#include "common/vpProgram.h"
#include "vpVlpServoOptions.h"

BEGIN_VISP_NAMESPACE

/*!
  The program itself: drives, prints what came of it and writes the log. \throw vpException where an input is
  bad or the log cannot be written.
*/
vpExitCode vpVlpServo(const vpVlpServoOptions &options);

END_VISP_NAMESPACE

#endif
