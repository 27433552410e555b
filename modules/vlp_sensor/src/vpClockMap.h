/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpClockMap_h
#define vpClockMap_h

#include <algorithm>
#include <optional>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  A camera's clock on the host's. Frames arrive late by different amounts and never early: the smallest
  difference of all is the nearest to the truth, and it grows again no faster than two crystals part.
*/
class vpClockMap
{
public:
  //! Host's time of what happened at \e device, known to the host at \e arrival; s each.
  double host(double device, double arrival)
  {
    static const double apart = 2e-4; // s/s, of two crystals, warm and cold
    static const double setBack = 1;  // s: the camera was started anew
    const double difference = arrival - device;
    if (!m_difference || device < m_device - setBack) {
      m_difference = difference;
    } else {
      m_difference = std::min(*m_difference + apart * std::max(0.0, device - m_device), difference);
    }
    m_device = device;
    return device + *m_difference;
  }

private:
  std::optional<double> m_difference; // s, host minus device
  double m_device = 0;                // s, of the frame before
};

END_VISP_NAMESPACE

#endif
