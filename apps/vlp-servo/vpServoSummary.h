/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpServoSummary_h
#define vpServoSummary_h

#include <string>

#include <visp3/vlp_servo/vpServoLog.h>

BEGIN_VISP_NAMESPACE

//! Prints to stdout how far off the path the robot was, how often it knew where, and how late.
//! \param period s, of the control loop.
void vpPrintServoSummary(const vpServoLog &log, double period);

//! Draws the path and the tracks on it, as track.svg and track.png; says so where there is no gnuplot.
void vpDrawServoTracks(const vpServoLog &log, const std::string &folder);

END_VISP_NAMESPACE

#endif
