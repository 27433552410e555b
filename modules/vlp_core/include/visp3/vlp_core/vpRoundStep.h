/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpRoundStep_h
#define vpRoundStep_h

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! The least 1, 2 or 5 times a power of ten that is no less than \e value > 0: the step of a grid or a bin.
VISP_EXPORT double vpRoundStep(double value);

END_VISP_NAMESPACE

#endif
