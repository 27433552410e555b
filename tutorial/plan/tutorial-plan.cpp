/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
//! \example tutorial-plan.cpp
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>

#include <visp3/core/vpException.h>
#include <visp3/vlp_evaluation/vpCapacityFigure.h>
#include <visp3/vlp_identification/vpIdentifierLayout.h>
#include <visp3/vlp_identification/vpLedIdPlanner.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

const double crystal = 50, rc = 10000; // ppm, standard deviations of lamps' clocks

void draw(const vpLedIdPlanner &planner, double lines, const std::string &picture)
{
  vpCapacityCurve good{"crystal, 50 ppm", {}, false}, cheap{"RC, 10000 ppm", {}, false};
  vpCapacityCurve others{"others: stripes counted, or FFT bins", {}, true};
  for (double size = 15; size < 150; size *= 1.15) {
    const std::vector<size_t> counts = planner.capacities(size, {crystal, rc});
    good.points.push_back({size, static_cast<double>(counts[0])});
    cheap.points.push_back({size, static_cast<double>(counts[1])});
    others.points.push_back({size, static_cast<double>(planner.bins(size))});
  }
  std::ofstream(picture, std::ios::binary) << vpCapacityFigure({good, cheap, others}, {lines}).png();
}

int main(int argc, char **argv)
{
  if (argc != 6) {
    std::cerr << "usage: " << argv[0] << " RIG HEIGHT DIAMETER LAMPS PICTURE" << std::endl;
    return 2;
  }
  try {
    const vpVlpRig rig = vpVlpRig::load(argv[1]);
    const double height = std::atof(argv[2]), diameter = std::atof(argv[3]); // m
    const size_t wanted = static_cast<size_t>(std::atoi(argv[4]));

    vpLedIdPlanner planner(rig);
    const double lines = planner.prediction.lines(diameter, height);
    std::printf("%.0f lines, %.0f to %.0f Hz\n", lines, planner.lowest(lines), planner.highest());

    vpModulation lamp;
    lamp.kind = vpModulation::Kind::pwm;
    lamp.duty = 0.5;
    for (const double frequency : {1000., 2000., 2266.}) {
      lamp.frequency = frequency;
      const vpStripeUncertainty sigma = planner.prediction.uncertainty(lamp, lines, crystal);
      std::printf("%.0f Hz is told to %.1f Hz, its duty to %.3f\n", frequency, sigma.frequency, sigma.duty);
    }

    const vpLedIdPlan all = planner.largest(lines, crystal);
    std::printf("at most %zu: distance %.1f, error %.1g, accepted %.2f %%\n", all.identifiers.size(),
                all.separation, all.error, 100 * all.acceptance);
    const vpLedIdPlan plan = planner.spread(lines, crystal, wanted);
    std::printf("%zu lamps: distance %.1f\n", plan.identifiers.size(), plan.separation);

    vpLampMap map;
    for (const vpModulation &identifier : plan.identifiers) {
      vpLamp known;
      known.id = "L" + std::to_string(map.lamps.size());
      known.position.z() = height + rig.bMc[2][3]; // on the floor stands the robot, on that the camera
      known.size = diameter;
      known.modulation = identifier;
      map.lamps.push_back(known);
    }
    map.lamps.front().modulation.frequency = map.lamps.back().modulation.frequency + 1; // somebody errs
    map.lamps.front().modulation.duty = map.lamps.back().modulation.duty;
    const std::vector<vpLedIdPair> pairs = planner.confusion(map);
    for (size_t i = 0; i < 2; ++i)
      std::printf("%s and %s: distance %.1f, error %.1g\n", map.lamps[pairs[i].first].id.c_str(),
                  map.lamps[pairs[i].second].id.c_str(), pairs[i].distance, pairs[i].error);

    std::vector<Eigen::Vector3d> places; // 64 lamps, a metre apart
    for (int i = 0; i < 64; ++i)
      places.emplace_back(i % 8, i / 8, height + rig.bMc[2][3]);
    vpIdentifierLayout layout;
    layout.viewRadius =
        height * std::hypot(0.5 * rig.width / rig.camera.get_px(), 0.5 * rig.height / rig.camera.get_py());
    const vpIdentifierAssignment laid = layout.lay(places, wanted);
    std::printf("64 lamps of %zu identifiers: alike %zu of %zu pairs, %zu of %zu sets of three\n", wanted,
                laid.repeatedPairs, laid.pairsInView, laid.repeatedTriples, laid.triples);

    planner.frequencyStep = 2; // Hz, quicker
    draw(planner, lines, argv[5]);
    return plan.identifiers.size() == wanted && pairs[0].distance < 1 && pairs[1].distance > 6 ? 0 : 1;
  } catch (const vpException &error) {
    std::cerr << error.getStringMessage() << std::endl;
    return 2;
  }
}
