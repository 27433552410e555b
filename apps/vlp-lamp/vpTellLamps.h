/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpTellLamps_h
#define vpTellLamps_h

#include "common/vpProgram.h"
#include "vpLampOptions.h"

BEGIN_VISP_NAMESPACE

//! What vlp-lamp does. \throw vpException on bad input.
vpExitCode vpTellLamps(const vpLampOptions &options);

END_VISP_NAMESPACE

#endif
