/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <random>

#include "common/vpSeenLamps.h"
#include "fuzz/vpFuzzBytes.h"
#include "fuzz/vpFuzzLocation.h"

// A drive under four lamps, by their image points. The input spoils what is seen, odometry and times, and
// chooses the localizer's settings.
namespace
{
//! \return Whether the lamp is seen at all.
bool spoiled(vpLampObservation &lamp, vpFuzzBytes &input)
{
  switch (const std::uint8_t deed = input.byte(); deed % 13) {
  case 0:
    return false;
  case 1: // elsewhere
    lamp.point += 400 * Eigen::Vector2d(input.share(), input.share());
    lamp.outline.centre = lamp.point;
    break;
  case 2: // a little off
    lamp.point += 4 * Eigen::Vector2d(input.share(), input.share());
    break;
  case 3: // another lamp's
    lamp.id = std::string(1, static_cast<char>('A' + input.byte() % 6));
    break;
  case 4:
    lamp.id.clear();
    break;
  case 5:
    lamp.covariance *= std::pow(10, 6 * input.share());
    lamp.outline.centreCovariance = lamp.covariance;
    break;
  case 6:
    lamp.time += 0.1 * input.share();
    break;
  case 7:
    lamp.outline.a *= std::pow(10, input.share());
    lamp.outline.b = std::min(lamp.outline.b, lamp.outline.a);
    break;
  case 8:
    lamp.cut = true;
    break;
  case 9: // one of two
    lamp.id.clear();
    lamp.candidates = {{input.byte() % 4u, 0.6}, {input.byte() % 4u, 0.4}};
    break;
  default:
    break;
  }
  return true;
}
} // namespace

VLP_FUZZ_TARGET(observations)
{
  vpFuzzBytes input(data, size);
  static const vpSeenLamps ceiling(4);
  static const vpPlannedDrive drive({-0.3, -0.1, 0.2}, {{4, 0.2, 0.3}, {3, 0, 1}, {3, 0.2, -0.4}});
  static const std::vector<vpOdometry> wheels = drive.odometry(0.02);
  vpVlpLocalizer localizer(ceiling.rig, ceiling.map);
  const std::uint8_t settings = input.byte();
  std::mt19937_64 generator(settings);
  using Localizer = vpVlpLocalizer;
  localizer.tracking = settings % 8 != 1;
  localizer.solver = settings % 16 == 2 ? Localizer::Solver::two : Localizer::Solver::all;
  localizer.compensateShutter = settings % 16 != 3;
  if (settings % 4 == 0) {
    localizer.manyLamps.attitude = vpManyLampSolver::Attitude::free;
  }
  size_t told = 0;
  double time = 0, stamped = 0; // s, of the world and of the stamps
  for (int frame = 0; frame < 40 && !input.empty(); ++frame) {
    const std::uint8_t deed = input.byte();
    time += deed % 16 == 0 ? 0.01 * input.byte() : 0.083;
    stamped += deed % 32 == 1 ? 20 * input.share() : 0; // a clock that is set
    for (; told < wheels.size() && wheels[told].timestamp <= time; ++told) {
      vpOdometry sample = wheels[told];
      sample.timestamp += stamped;
      if (deed % 32 == 2) {
        sample.v *= 10 * input.share();
        sample.w += 10 * input.share();
      }
      if (deed % 32 != 3) {
        localizer.filter.addOdometry(sample);
      }
    }
    std::vector<vpLampObservation> seen = ceiling.see(
                                       time, [](double when) { return drive.at(when); }, generator),
                                   kept;
    for (vpLampObservation &lamp : seen) {
      if (deed < 128 || spoiled(lamp, input)) {
        kept.push_back(lamp);
      }
    }
    if (deed % 64 == 5 && !kept.empty()) { // a reflection
      kept.push_back(kept.front());
      kept.back().point += 100 * Eigen::Vector2d(input.share(), input.share());
    }
    vpFuzzReads([&] {
      vpFuzzExpectSound(localizer.locate(time + stamped, kept), localizer.filter);
      const vpVlpFix later = localizer.filter.fixAt(time + stamped + input.share());
      vpFuzzExpect(!later.valid || later.covariance.allFinite(), "a finite prediction");
    });
  }
}
