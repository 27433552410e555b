/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
//! \example tutorial-camshift-kalman.cpp
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>

#include <visp3/core/vpImageConvert.h>
#include <visp3/core/vpImageDraw.h>
#include <visp3/gui/vpDisplayX.h>
#include <visp3/io/vpVideoReader.h>
#include <visp3/io/vpVideoWriter.h>
#include <visp3/vlp_tracking/vpCamshiftKalmanTracker.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

//! The lamp's window in the first picture, from the command line or from two clicks.
vpRect chooseWindow(const char *text, const vpImage<vpRGBa> &O)
{
  double left = 0, top = 0, width = 0, height = 0;
  if (text != nullptr && std::sscanf(text, "%lf,%lf,%lf,%lf", &left, &top, &width, &height) == 4)
    return vpRect(left, top, width, height);
  vpImagePoint one, other;
  vpDisplay::getClick(O, one);
  vpDisplay::getClick(O, other);
  return vpRect(std::vector<vpImagePoint>{one, other});
}

void draw(const vpCamshiftKalmanTracker &tracker, bool seen, vpImage<vpRGBa> &O)
{
  const vpColor colour = seen ? vpColor::green : vpColor::red;
  const vpRect window = tracker.window();
  if (window.getWidth() > 0) { // else all of it is outside the picture
    vpImageDraw::drawRectangle(O, window, colour, false, 2);
    vpImageDraw::drawEllipse(O, window.getCenter(), window.getWidth() / 2, window.getHeight() / 2, 0, false,
                             colour, 0, 2 * M_PI, 2);
  }
  const vpImagePoint next = tracker.center() + tracker.velocity();
  vpImageDraw::drawCross(O, next, 15, vpColor::yellow, 2);
  vpImageDraw::drawCircle(O, next, static_cast<unsigned int>(3 * tracker.positionSigma()), vpColor::yellow);
}

int main(int argc, char **argv)
{
  if (argc != 3 && argc != 4) {
    std::cerr << "usage: " << argv[0] << " VIDEO FOLLOWED [LEFT,TOP,WIDTH,HEIGHT]" << std::endl;
    return 2;
  }
  try {
    vpImage<unsigned char> I; // as the camera took it
    vpImage<vpRGBa> O;        // as it is shown and saved
    vpVideoReader reader;
    reader.setFileName(argv[1]);
    reader.open(I);
    vpImageConvert::convert(I, O);
    vpVideoWriter writer;
    writer.setFileName(argv[2]);
    writer.open(O);
    std::unique_ptr<vpDisplay> display;
#ifdef VISP_HAVE_X11
    if (std::getenv("DISPLAY") != nullptr) // else there is no screen
      display = std::make_unique<vpDisplayX>(O, 0, 0, "Click two opposite corners of the lamp");
#endif
    vpDisplay::display(O);
    vpDisplay::flush(O);

    vpCamshiftKalmanTracker tracker;
    tracker.initTracking(I, chooseWindow(argv[3], O));
    bool seen = true;
    while (!reader.end()) {
      reader.acquire(I);
      seen = tracker.track(I);
      std::printf("%3ld: (%6.1f, %6.1f) px, similarity %.2f, sigma %4.1f px%s\n", reader.getFrameIndex(),
                  tracker.center().get_u(), tracker.center().get_v(), tracker.similarity(),
                  tracker.positionSigma(), seen ? "" : ", predicted");
      vpImageConvert::convert(I, O);
      draw(tracker, seen, O);
      writer.saveFrame(O);
      vpDisplay::display(O);
      vpDisplay::flush(O);
      if (vpDisplay::getClick(O, false))
        break;
    }
    return seen ? 0 : 3;
  } catch (const vpException &error) {
    std::cerr << error.getStringMessage() << std::endl;
    return 2;
  }
}
