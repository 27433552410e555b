/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpInflatedMap_h
#define vpInflatedMap_h

#include <vector>

#include <visp3/vlp_calibration/vpLampBundle.h>

BEGIN_VISP_NAMESPACE

/*!
  A solution with inflated positions of lamps: where those that the bundle holds do not explain the
  pictures, they may hang elsewhere, by as much as the pictures show (a variance component). Else their errors
  would be the rig's, with standard deviations as of image points, which average out. Its `inflatedLampSigma`
  says by how much. \param found The bundle's solution: what is returned where all is explained.
*/
vpBundleResult vpSolveWithInflatedMap(const vpBundleResult &found, const vpLampBundle &bundle,
                                      const std::vector<vpLampRun> &runs, const vpVlpRig &rig,
                                      const vpLampMap &map);

END_VISP_NAMESPACE

#endif
