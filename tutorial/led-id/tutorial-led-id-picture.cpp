/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
//! \example tutorial-led-id-picture.cpp
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>

#include <visp3/core/vpException.h>
#include <visp3/gui/vpDisplayX.h>
#include <visp3/vlp_identification/vpLedDetector.h>
#include <visp3/vlp_sensor/vpReadGreyPicture.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

void show(vpImage<unsigned char> &I, vpLedDetector &detector)
{
#ifdef VISP_HAVE_X11
  vpDisplayX display(I, 0, 0, "LED-ID");
  vpDisplay::display(I);
  for (size_t i = 0; i < detector.getNbObjects(); ++i) {
    const vpColor colour = detector.getMessage(i).empty() ? vpColor::orange : vpColor::green;
    vpDisplay::displayPolygon(I, detector.getPolygon(i), colour, 2);
    vpDisplay::displayText(I, detector.getCog(i), detector.getMessage(i), vpColor::red);
  }
  vpDisplay::flush(I);
  vpDisplay::getClick(I);
#else
  (void)I, (void)detector;
  std::cerr << "no display: this ViSP was built without X11" << std::endl;
#endif
}

int main(int argc, char **argv)
{
  const bool display = std::string(argv[argc - 1]) == "--display";
  const int words = argc - (display ? 1 : 0);
  if (words != 4 && words != 5) {
    std::cerr << "usage: " << argv[0] << " RIG LAMPS PICTURE [KNOWN] [--display]" << std::endl;
    return 2;
  }
  try {
    const vpVlpRig rig = vpVlpRig::load(argv[1]);
    const vpLampMap map = vpLampMap::load(argv[2]);
    vpImage<unsigned char> I;
    vpReadGreyPicture(argv[3], I);

    vpLedDetector detector(rig, map);
    detector.detect(I);

    int known = 0;
    for (const vpLampObservation &lamp : detector.observations()) {
      std::printf("%-2s at (%6.2f, %6.2f) px, diameter %5.2f px%s, ", lamp.id.empty() ? "?" : lamp.id.c_str(),
                  lamp.point.x(), lamp.point.y(), lamp.outline.diameter(), lamp.cut ? " (cut)" : "");
      if (lamp.features.frequency > 0) // not so where it is NaN: no stripes
        std::printf("%6.1f +/- %.1f Hz, duty %.3f, ", lamp.features.frequency, lamp.features.frequencySigma,
                    lamp.features.duty);
      std::printf("confidence %.4f%s%s\n", lamp.confidence, lamp.remark.empty() ? "" : ": ",
                  lamp.remark.c_str());
      known += lamp.id.empty() ? 0 : 1;
    }
    std::printf("%d of the %zu lamps of the map\n", known, map.lamps.size());
    if (display)
      show(I, detector);
    const int expected = words == 5 ? std::atoi(argv[4]) : known;
    return known > 0 && known == expected ? 0 : 1;
  } catch (const vpException &error) {
    std::cerr << error.getStringMessage() << std::endl;
    return 2;
  }
}
