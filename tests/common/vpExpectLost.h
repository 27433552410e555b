/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpExpectLost_h
#define vpExpectLost_h

#include <string>

#include <gtest/gtest.h>
#include <visp3/vlp_sensor/vpCameraSource.h>

#include "common/vpExpectError.h"

//! A camera that is gone: told once, by its URI, after the frames that were on their way.
inline void vpExpectLost(vpCameraSource &camera, const std::string &uri)
{
  static const int onTheirWay = 20;
  vpExpectError(
      [&camera] {
        vpVlpFrame frame;
        for (int k = 0; k < onTheirWay; ++k) {
          camera.next(frame);
        }
      },
      {uri, "waiting for it to come back"});
  EXPECT_FALSE(camera.connected());
}

#endif
