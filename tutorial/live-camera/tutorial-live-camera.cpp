/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
//! \example tutorial-live-camera.cpp
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>

#include <visp3/core/vpException.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp3/vlp_sensor/vpCameraSource.h>
#include <visp3/vlp_sensor/vpPictureSequence.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

std::unique_ptr<vpFrameSource> open(const std::string &name, const vpVlpRig &rig)
{
  if (!vpCameraSource::isUri(name))
    return std::make_unique<vpPictureSequence>(vpPictureSequence::fromRun(name));
  vpCameraSettings settings;
  settings.exposure = rig.shutter.exposure;
  settings.region = vpCameraRegion{0, 0, rig.width, rig.height};
  auto camera = std::make_unique<vpCameraSource>(name, settings);
  std::printf("exposed for %.1f us\n", 1e6 * camera->settings().exposure.value_or(NAN));
  return camera;
}

int main(int argc, char **argv)
{
  if (argc != 4 && argc != 5) {
    std::cerr << "usage: " << argv[0] << " CAMERA_URI|RUN RIG LAMPS [FRAMES]" << std::endl;
    return 2;
  }
  try {
    const vpVlpRig rig = vpVlpRig::load(argv[2]);
    vpVlpLocalizer localizer(rig, vpLampMap::load(argv[3]));
    const std::unique_ptr<vpFrameSource> source = open(argv[1], rig);
    const int frames = argc == 5 ? std::atoi(argv[4]) : 100;

    int poses = 0;
    vpVlpFrame frame;
    for (int k = 0; k < frames; ++k) {
      try {
        if (!source->next(frame))
          break;
      } catch (const vpException &error) { // the camera went away: the next call waits for its return
        std::cerr << error.getStringMessage() << std::endl;
        continue;
      }
      const vpVlpFix fix = localizer.process(frame).fix;
      if (fix.valid)
        std::printf("%.3f s  x %7.3f  y %7.3f m  +/- %.1f mm\n", frame.timestamp, fix.wMb[0][3],
                    fix.wMb[1][3], 1e3 * std::sqrt(fix.covariance(0, 0) + fix.covariance(1, 1)));
      poses += fix.valid;
    }
    if (!source->remark().empty())
      std::cerr << source->remark() << std::endl;
    return poses > 0 ? 0 : 3;
  } catch (const vpException &error) {
    std::cerr << error.getStringMessage() << std::endl;
    return 2;
  }
}
