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

#include <visp3/core/vpImageConvert.h>
#include <visp3/core/vpIoTools.h>
#include <visp3/gui/vpDisplayX.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp3/vlp_sensor/vpCameraSource.h>
#include <visp3/vlp_sensor/vpPictureSequence.h>
#include <visp3/vlp_sensor/vpResizedSource.h>
#include <visp3/vlp_sensor/vpVideoSource.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

//! A camera, the folder of a run, numbered pictures or a video: the name tells which.
std::unique_ptr<vpFrameSource> open(const std::string &name, const vpVlpRig &rig)
{
  if (vpCameraSource::isUri(name)) {
    vpCameraSettings settings;
    settings.exposure = rig.shutter.exposure;
    if (rig.resize.method == vpPictureResize::Method::none) // else the sensor's whole picture is made smaller
      settings.region = vpCameraRegion{0, 0, rig.width, rig.height};
    auto camera = std::make_unique<vpCameraSource>(name, settings);
    std::printf("exposed for %.1f us\n", 1e6 * camera->settings().exposure.value_or(NAN));
    return std::make_unique<vpResizedSource>(std::move(camera), rig);
  }
  if (vpIoTools::checkDirectory(name))
    return std::make_unique<vpPictureSequence>(vpPictureSequence::fromRun(name));
  if (name.find('%') != std::string::npos)
    return std::make_unique<vpPictureSequence>(vpPictureSequence::fromPattern(name));
  return std::make_unique<vpVideoSource>(name);
}

//! The next frame. What cannot be read is told, and left out.
bool next(vpFrameSource &source, vpVlpFrame &frame)
{
  for (;;) {
    try {
      return source.next(frame);
    } catch (const vpException &error) { // of a camera: it went away, and the next call waits for its return
      std::cerr << error.getStringMessage() << std::endl;
    }
  }
}

void mark(const vpLampObservation &lamp, const vpImage<vpRGBa> &O)
{
  const vpColor colour = lamp.accepted ? vpColor::green : vpColor::orange;
  const vpImagePoint middle(lamp.point.y(), lamp.point.x());
  const double radius = lamp.outline.diameter() / 2 + 3;
  vpDisplay::displayCircle(O, middle, static_cast<unsigned int>(radius), colour, false, 2);
  vpDisplay::displayText(O, middle + vpImagePoint(0, radius + 8), lamp.id.empty() ? "?" : lamp.id, colour);
}

int main(int argc, char **argv)
{
  if (argc != 4) {
    std::cerr << "usage: " << argv[0] << " CAMERA_URI|RUN|PATTERN|VIDEO RIG LAMPS" << std::endl;
    return 2;
  }
  try {
    const vpVlpRig rig = vpVlpRig::load(argv[2]);
    vpVlpLocalizer localizer(rig, vpLampMap::load(argv[3]));
    const std::unique_ptr<vpFrameSource> source = open(argv[1], rig);
    vpImage<vpRGBa> O(rig.height, rig.width); // what is shown
    std::unique_ptr<vpDisplay> display;
#ifdef VISP_HAVE_X11
    if (std::getenv("DISPLAY") != nullptr) // else there is no screen
      display = std::make_unique<vpDisplayX>(O, 0, 0, "A click ends it");
#endif

    size_t poses = 0;
    bool clicked = false;
    for (vpVlpFrame frame; !clicked && next(*source, frame);) {
      const vpVlpLocation location = localizer.process(frame);
      const vpVlpFix &fix = location.fix;
      if (fix.valid)
        std::printf("%.3f s  x %7.3f  y %7.3f m  +/- %.1f mm\n", frame.timestamp, fix.wMb[0][3],
                    fix.wMb[1][3], 1e3 * std::sqrt(fix.covariance(0, 0) + fix.covariance(1, 1)));
      else
        std::printf("%.3f s  %s\n", frame.timestamp, fix.refusal.c_str());
      poses += fix.valid;

      vpImageConvert::convert(frame.I, O);
      vpDisplay::display(O);
      for (const vpLampObservation &lamp : location.observations)
        mark(lamp, O);
      vpDisplay::flush(O);
      clicked = vpDisplay::getClick(O, false);
    }
    if (!clicked)
      vpDisplay::getClick(O); // the last frame stays
    if (!source->remark().empty())
      std::cerr << source->remark() << std::endl;
    return poses > 0 ? 0 : 3;
  } catch (const vpException &error) {
    std::cerr << error.getStringMessage() << std::endl;
    return 2;
  }
}
