/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPlanReuse_h
#define vpPlanReuse_h

#include <vector>

#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_evaluation/vpReportTable.h>

BEGIN_VISP_NAMESPACE

/*!
  Radius (m) of the smallest circle that holds what the picture shows of a ceiling so high (m) above the
  camera. \throw vpException where the camera leans so far that the picture shows the horizon.
*/
double vpViewRadius(const vpVlpRig &rig, double height);

/*!
  Lays \e signals, fewer than there are lamps, over the lamps of \e map (vpIdentifierLayout). \param
  viewRadius m, of what one picture shows of the ceiling. \return What came of it.
*/
vpReportTable vpLayOver(vpLampMap &map, const std::vector<vpModulation> &signals, double viewRadius);

END_VISP_NAMESPACE

#endif
