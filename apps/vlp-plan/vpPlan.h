/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPlan_h
#define vpPlan_h

#include "common/vpProgram.h"
#include "vpPlanOptions.h"

BEGIN_VISP_NAMESPACE

/*!
  The program itself: plans, or judges a map with --check; prints its tables and writes what was asked for.
  \throw vpException where something cannot be read or written.
*/
vpExitCode vpPlan(const vpPlanOptions &options);

//! The part behind --check.
vpExitCode vpPlanCheck(const vpPlanOptions &options);

END_VISP_NAMESPACE

#endif
