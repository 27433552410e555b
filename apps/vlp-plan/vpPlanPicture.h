/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPlanPicture_h
#define vpPlanPicture_h

#include <string>
#include <vector>

#include "vpPlanOptions.h"

BEGIN_VISP_NAMESPACE

/*!
  The bytes of a PNG file: identifiers against the lines of a lamp, for the options' oscillator, for crystal
  and RC, and for what others have. \param lamps Lines of the smallest and the largest lamp. \param words How
  many there are. \throw vpException where gnuplot cannot draw it, or Ctrl-C was pressed.
*/
std::string vpPlanPicture(const vpPlanOptions &options, const vpLedIdPlanner &planner,
                          const std::vector<double> &lamps, size_t words);

END_VISP_NAMESPACE

#endif
