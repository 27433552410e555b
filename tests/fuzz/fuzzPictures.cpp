/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>

#include "common/vpSeenLamps.h"
#include "fuzz/vpFuzzBytes.h"
#include "fuzz/vpFuzzLocation.h"

// The whole localizer: pictures of 160 x 120, drawn of discs with stripes, as the input says.
namespace
{
constexpr unsigned int width = 160, height = 120;

vpVlpRig rig()
{
  vpVlpRig rig;
  rig.width = width;
  rig.height = height;
  rig.camera.initPersProjWithoutDistortion(80, 80, 79.5, 59.5);
  rig.shutter.rowTime = 43e-6;
  rig.shutter.exposure = 20e-6;
  return rig;
}

//! A disc whose rows are lit by turns.
void draw(vpImage<unsigned char> &I, vpFuzzBytes &input, double time)
{
  const double u = 0.5 * width * (1 + input.share()), v = 0.5 * height * (1 + input.share());
  const double radius = 1 + input.byte() % 32, frequency = 1500 + 500 * (input.byte() % 8);
  const double duty = 0.1 + 0.8 * input.byte() / 255;
  const unsigned char lit = input.byte();
  for (unsigned int row = 0; row < height; ++row) {
    const double phase = frequency * (time + row * 43e-6);
    if (phase - std::floor(phase) > duty) {
      continue;
    }
    const double half = std::sqrt(std::max(0.0, radius * radius - (row - v) * (row - v)));
    for (unsigned int column = 0; column < width; ++column) {
      if (half > 0 && std::abs(column - u) < half) {
        I[row][column] = std::max(I[row][column], lit);
      }
    }
  }
}
} // namespace

VLP_FUZZ_TARGET(pictures)
{
  vpFuzzBytes input(data, size);
  static const vpLampMap map = vpSeenLamps(4).map;
  vpVlpLocalizer localizer(rig(), map);
  double time = 0; // s
  for (int picture = 0; picture < 8 && !input.empty(); ++picture) {
    vpVlpFrame frame;
    const std::uint8_t deed = input.byte();
    time += deed % 16 == 0 ? 2 * input.share() : 0.083;
    frame.timestamp = time;
    frame.I.resize(height, width);
    frame.I = input.byte() % 64;
    for (int lamp = 0; lamp < deed / 32; ++lamp) {
      draw(frame.I, input, time);
    }
    if (deed % 4 == 1) { // grains of noise
      unsigned int state = input.byte();
      const unsigned int grain = 1 + input.byte() % 64;
      for (unsigned int i = 0; i < frame.I.getSize(); ++i) {
        state = 1664525 * state + 1013904223;
        frame.I.bitmap[i] =
            static_cast<unsigned char>(std::min(255u, frame.I.bitmap[i] + (state >> 24) % grain));
      }
    }
    vpFuzzReads([&] {
      localizer.filter.addOdometry({time, input.share(), 3 * input.share()});
      vpFuzzExpectSound(localizer.process(frame), localizer.filter);
    });
  }
}
