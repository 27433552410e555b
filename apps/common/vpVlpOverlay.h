/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpOverlay_h
#define vpVlpOverlay_h

#include <vector>

#include <opencv2/core.hpp>
#include <visp3/core/vpImage.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include "common/vpLampChart.h"

BEGIN_VISP_NAMESPACE

/*!
  A picture by which a person checks quickly what was made of a frame: the frame in grey, brightened;
  blue, the windows in which lamps were looked for, if not in all of it; each lamp-like region's outline in
  green where it counts for the position, yellow where its lamp is known and does not count, orange where it
  is no lamp of the map; a cross at the lamp's image point; beside it id, confidence, frequency and duty with
  their standard deviations, and the remark.

  \param charts Of observations of \e location that have no id: each stands above its lamp's text.

  \return BGR, between 800 and 1600 pixels on the longer side: small frames are enlarged by a whole number,
  large ones made smaller.
*/
cv::Mat vpDrawVlpOverlay(const vpImage<unsigned char> &I, const vpVlpLocation &location,
                         const std::vector<vpLampChart> &charts = {});

END_VISP_NAMESPACE

#endif
