/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
//! \example mine.cpp
#include <cmath>
#include <cstdio>
#include <string>
#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp3/vlp_sensor/vpPictureSequence.h>

int main()
{
  const std::string run = "data/paper-room";
  const vpVlpRig rig = vpVlpRig::load(run + "/rig.yaml");     // camera, shutter and mount
  const vpLampMap map = vpLampMap::load(run + "/lamps.yaml"); // where lamps hang and how they blink
  vpVlpLocalizer localizer(rig, map);
  vpPictureSequence source = vpPictureSequence::fromRun(run); // or a camera, a video, a simulation
  for (vpVlpFrame frame; source.next(frame);) {
    const vpVlpFix fix = localizer.process(frame).fix;
    if (fix.valid)
      std::printf("%4.1f s: x %.4f +/- %.4f, y %.4f +/- %.4f m\n", frame.timestamp, fix.wMb[0][3],
                  std::sqrt(fix.covariance(0, 0)), fix.wMb[1][3], std::sqrt(fix.covariance(1, 1)));
    else
      std::printf("%4.1f s: %s\n", frame.timestamp, fix.refusal.c_str());
  }
}
