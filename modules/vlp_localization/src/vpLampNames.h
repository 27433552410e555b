/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampNames_h
#define vpLampNames_h

#include <optional>
#include <string>
#include <vector>

#include <visp3/vlp_localization/vpLampMatcher.h>

BEGIN_VISP_NAMESPACE

/*!
  \file vpLampNames.h
  Which lamp each observation is, between recognition and the solver. Private to the module.
*/

//! Whether each of the \e usable ones is one lamp for sure: with an id, that no observation has besides it.
bool namedApart(const std::vector<vpLampObservation> &observations, const std::vector<size_t> &usable);

/*!
  Gives each lamp that \e match resolved its id, and keeps it in \e usable. Where the match is not unique,
  keeps those that are one lamp for sure without it. Sets the remark of the others.
*/
void nameByPlace(const vpLampMatch &match, const vpLampMap &map, std::vector<vpLampObservation> &observations,
                 std::vector<size_t> &usable);

END_VISP_NAMESPACE

#endif
