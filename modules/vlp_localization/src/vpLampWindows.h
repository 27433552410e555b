/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampWindows_h
#define vpLampWindows_h

#include <vector>

#include <visp3/core/vpRect.h>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_localization/vpVlpFilter.h>

BEGIN_VISP_NAMESPACE

namespace vpLampWindows
{
/*!
  Adds to \e windows (px) where the picture shows the map's lamps while their lines are read, by the pose and
  motion that the filter expects at the middle of the readout. \param lineTime s, from line to line.
*/
void expect(const vpVlpFilter &filter, const vpLampMap &map, const vpVlpRig &rig, double lineTime,
            std::vector<vpRect> &windows);
} // namespace vpLampWindows

END_VISP_NAMESPACE

#endif
