/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
//! \example tutorial-relocation.cpp
#include <cmath>
#include <cstdio>
#include <iostream>

#include <visp3/core/vpException.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp3/vlp_simulation/vpSimulation.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

const char *stateOf(const vpVlpLocation &location)
{
  return location.fix.ambiguous ? "ambiguous" : location.relocated ? "relocated" : "borne out";
}

int main(int argc, char **argv)
{
  if (argc != 2) {
    std::cerr << "usage: " << argv[0] << " SCENARIO" << std::endl;
    return 2;
  }
  try {
    vpSimulation simulation(vpScenario::load(argv[1]), 1); // the seed of all that is left to chance
    vpVlpLocalizer localizer(simulation.rig(), simulation.map());
    localizer.hypotheses.relocation = 0.1; // 1/s: somebody carries it every ten seconds
    size_t wrong = 0;
    std::string before;
    for (vpVlpFrame frame; simulation.next(frame);) {
      const vpVlpLocation location = localizer.process(frame);
      if (!location.fix.valid)
        continue; // location.fix.refusal says why
      const vpHomogeneousMatrix truth = simulation.wMb(frame.timestamp);
      const double dx = location.fix.wMb[0][3] - truth[0][3], dy = location.fix.wMb[1][3] - truth[1][3];
      const double sx = std::sqrt(location.fix.covariance(0, 0)),
                   sy = std::sqrt(location.fix.covariance(1, 1));
      const std::string state = stateOf(location);
      const bool carried = simulation.wMb(frame.timestamp - 1. / 12)[0][3] != truth[0][3];
      if (state != before || carried)
        std::printf("%5.2f s: x %7.4f +/- %.4f, y %7.4f +/- %.4f m by %zu lamps, %s%s\n", frame.timestamp,
                    location.fix.wMb[0][3], sx, location.fix.wMb[1][3], sy, location.fix.lamps.size(),
                    state.c_str(), carried ? "; carried" : "");
      before = state;
      wrong += std::abs(dx) > 5 * sx || std::abs(dy) > 5 * sy;
    }
    std::printf("%zu poses beyond five standard deviations\n", wrong);
    return wrong == 0 ? 0 : 1;
  } catch (const vpException &error) {
    std::cerr << error.getStringMessage() << std::endl;
    return 2;
  }
}
