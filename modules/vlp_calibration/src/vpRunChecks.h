/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpRunChecks_h
#define vpRunChecks_h

#include <string>
#include <vector>

#include <visp3/vlp_calibration/vpLampBundle.h>

BEGIN_VISP_NAMESPACE

/*!
  \file vpRunChecks.h
  Why a run cannot calibrate anything, in one line that says what to do; empty where it can.
*/

//! Frames that show \e lamps lamps or more: at least \e fewest of them.
std::string vpTooFewViews(const std::vector<vpLampRun> &runs, size_t lamps, size_t fewest);

//! Whether the robot moved, by where it was found.
std::string vpStandsStill(const std::vector<vpTrajectory> &poses);

//! Whether the odometry tells the drive that the pictures show, on their clock, in m/s and rad/s. \param
//! poses Of each run, as the pictures have them.
std::string vpOdometryMismatch(const std::vector<vpLampRun> &runs, const std::vector<vpTrajectory> &poses);

//! Whether the adjustment came to a minimum.
std::string vpNoMinimum(const vpBundleResult &result);

//! Some of the frames of each run, evenly spread.
std::vector<vpLampRun> vpThinned(const std::vector<vpLampRun> &runs, size_t views);

//! Share of the image points that were left out as outliers.
double vpOutlierShare(const vpBundleResult &result);

END_VISP_NAMESPACE

#endif
