/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpServoTracks_h
#define vpServoTracks_h

#include <string>
#include <utility>
#include <vector>

#include <visp3/vlp_evaluation/vpReportTable.h>
#include <visp3/vlp_evaluation/vpTracksFigure.h>
#include <visp3/vlp_servo/vpServoLog.h>

BEGIN_VISP_NAMESPACE

//! A run of vlp-servo and what it is called.
using vpNamedServoLog = std::pair<std::string, vpServoLog>;

//! How far off their paths runs were: truly, where the truth is known, and as their loops estimated.
vpReportTable vpTrackErrorTable(const std::vector<vpNamedServoLog> &runs);

//! The map of a path and the tracks of runs on it: the true ones, where they are known, else the
//! estimated ones.
vpFigure vpServoTracksFigure(const std::string &name, const vpPath &path,
                             const std::vector<vpNamedServoLog> &runs);

END_VISP_NAMESPACE

#endif
