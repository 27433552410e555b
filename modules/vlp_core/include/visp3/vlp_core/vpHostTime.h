/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpHostTime_h
#define vpHostTime_h

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  The clock of live frames and odometry, s since 1970: the host's as it was when the program first asked,
  counted on by the steady clock, so that it never jumps.
*/
VISP_EXPORT double vpHostTime();

END_VISP_NAMESPACE

#endif
