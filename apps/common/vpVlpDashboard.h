/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpDashboard_h
#define vpVlpDashboard_h

#include <opencv2/core.hpp>
#include <visp3/core/vpImage.h>

#include "common/vpLampChart.h"
#include "common/vpMapPanel.h"

BEGIN_VISP_NAMESPACE

/*!
  What a person sees of a run, in one picture: the frame as vpDrawVlpOverlay() draws it, nothing over it, and
  beside it the state, time, pose with standard deviations or why there is none, lamps, milliseconds, and the
  map as of vpMapPanel.
*/
class vpVlpDashboard
{
public:
  explicit vpVlpDashboard(const vpLampMap &map) : m_panel(map) {}

  /*!
    One more frame. \param compute s, that it took. \param charts As of vpDrawVlpOverlay(). \return BGR, of
    one size for all frames of one size; the frame in its upper left corner.
  */
  cv::Mat draw(const vpImage<unsigned char> &I, const vpVlpLocation &location, double compute,
               const std::vector<vpLampChart> &charts = {});

  //! For what else it shall show.
  vpMapPanel &map() { return m_panel; }

private:
  vpMapPanel m_panel;
};

END_VISP_NAMESPACE

#endif
