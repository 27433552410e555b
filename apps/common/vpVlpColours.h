/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpColours_h
#define vpVlpColours_h

#include <string>

#include <opencv2/core.hpp>
#include <visp3/vlp_localization/vpVlpLocalizer.h>

BEGIN_VISP_NAMESPACE

/*!
  \file vpVlpColours.h
  What our pictures mean by a colour, BGR.
*/
namespace vpVlpColours
{
const cv::Scalar green(90, 230, 60), yellow(0, 225, 255), orange(100, 165, 225), white(240, 240, 240),
    grey(150, 150, 150), blue(215, 130, 70), violet(235, 120, 200);

//! Green where a lamp counts for the position, yellow where it is known and does not, orange where it is no
//! lamp of the map.
cv::Scalar ofLamp(const vpLampObservation &lamp);

//! Of a pose, by its state.
cv::Scalar ofState(const std::string &state);
} // namespace vpVlpColours

//! `tracking`, `coasting`, `fix`, `relocated`, `ambiguous` or `none`.
std::string vpStateOf(const vpVlpLocation &location);

END_VISP_NAMESPACE

#endif
