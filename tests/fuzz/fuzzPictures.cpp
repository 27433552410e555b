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

constexpr double speed = 0.1; // m/s, along x

//! Four lamps that are large enough for a few periods in a small picture.
vpLampMap lamps()
{
  vpLampMap map = vpSeenLamps(4).map;
  for (vpLamp &lamp : map.lamps) {
    lamp.size = 0.8;
  }
  return map;
}

//! A disc whose rows are lit by turns: a lamp as the robot sees it, or what the input makes of it.
void draw(vpImage<unsigned char> &I, const vpLampMap &map, vpFuzzBytes &input, double time)
{
  const std::uint8_t deed = input.byte(), stripes = input.byte();
  const vpLamp &lamp = map.lamps[deed % 4];
  const double scale = 80 / lamp.position.z();
  double u = 79.5 + scale * (lamp.position.x() - speed * time), v = 59.5 + scale * lamp.position.y(),
         radius = 0.5 * scale * lamp.size, frequency = lamp.modulation.frequency;
  switch (deed / 4 % 16) {
  case 0: // anything
    u = 0.5 * width * (1 + input.share());
    v = 0.5 * height * (1 + input.share());
    radius = 1 + input.byte() % 32;
    frequency = 1500 + 500 * (input.byte() % 8);
    break;
  case 1: // elsewhere
    u += width * input.share();
    v += height * input.share();
    break;
  case 2: // a little off
    u += 4 * input.share();
    v += 4 * input.share();
    break;
  case 3:
    radius *= std::pow(2, input.share());
    break;
  case 4:
    frequency *= std::pow(2, input.share());
    break;
  default:
    break;
  }
  const double duty = 0.1 + 0.05 * (stripes % 16);
  const int lit = 255 - 8 * (stripes / 16);
  for (unsigned int row = 0; row < height; ++row) {
    int shone = 0; // eighths of the exposure
    for (int k = 0; k < 8; ++k) {
      const double phase = frequency * (time + row * 43e-6 + k * 2.5e-6);
      shone += phase - std::floor(phase) < duty ? 1 : 0;
    }
    const double half = std::sqrt(std::max(0.0, radius * radius - (row - v) * (row - v)));
    for (unsigned int column = 0; column < width; ++column) {
      if (half > 0 && std::abs(column - u) < half) {
        I[row][column] = std::max(I[row][column], static_cast<unsigned char>(lit * shone / 8));
      }
    }
  }
}
} // namespace

VLP_FUZZ_TARGET(pictures)
{
  vpFuzzBytes input(data, size);
  static const vpLampMap map = lamps();
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
      draw(frame.I, map, input, time);
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
      const bool slips = deed % 8 == 3;
      localizer.filter.addOdometry(
          {time, speed + (slips ? input.share() : 0), slips ? 3 * input.share() : 0});
      vpFuzzExpectSound(localizer.process(frame), localizer.filter);
    });
  }
}
