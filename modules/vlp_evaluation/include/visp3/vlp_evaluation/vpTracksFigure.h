/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpTracksFigure_h
#define vpTracksFigure_h

#include <string>
#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_evaluation/vpEvaluationFigures.h>

BEGIN_VISP_NAMESPACE

//! A line in the map, and what it is.
struct VISP_EXPORT vpNamedTrack {
  std::string name;
  std::vector<Eigen::Vector2d> places; // m
};

/*!
  A map of tracks, axes of equal scale: the path that was to be driven, broad, and the tracks on it. Of more
  than 2000 places of a track as many are drawn, evenly.
*/
VISP_EXPORT vpFigure vpTracksFigure(const std::string &name, const std::string &caption,
                                    const vpNamedTrack &path, const std::vector<vpNamedTrack> &tracks);

END_VISP_NAMESPACE

#endif
