/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Single frames of a renderer that shares nothing with the library's own: four lamps of 1130 to 2890 Hz seen
// by the camera of ub300-800x600 at random places. bench_singleFrames [FRAMES_BY_ROWS FRAMES_BY_COLUMNS]

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <string>

#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include "vpPlainRenderer.h"
#include "vpSimulatedStripes.h"

namespace
{
//! What the frames of one kind gave.
struct Results {
  std::vector<double> errors;         // mm, horizontal
  double squares = 0, worst = 0;      // in own standard deviations, of x and y
  std::map<std::string, int> reasons; // of frames without a fix

  void add(const vpVlpFix &fix, double x, double y)
  {
    const double dx = fix.wMb[0][3] - x, dy = fix.wMb[1][3] - y;
    errors.push_back(1e3 * std::hypot(dx, dy));
    for (double own : {dx / std::sqrt(fix.covariance(0, 0)), dy / std::sqrt(fix.covariance(1, 1))}) {
      squares += own * own;
      worst = std::max(worst, std::abs(own));
    }
  }

  void print(const char *name, int frames)
  {
    std::sort(errors.begin(), errors.end());
    double sum = 0;
    for (double error : errors) {
      sum += error;
    }
    const size_t n = errors.size();
    auto at = [&](double share) {
      return n > 0 ? errors[std::min(n - 1, static_cast<size_t>(share * static_cast<double>(n)))] : NAN;
    };
    std::printf("| %s | %d | %zu | %.3f | %.3f | %.3f | %.2f | %.1f |\n", name, frames, n,
                sum / static_cast<double>(n), at(0.95), at(1),
                std::sqrt(squares / (2 * static_cast<double>(n))), worst);
  }
};

//! Where and how a robot stands.
struct Place {
  double x, y, yaw;
};

std::vector<vpPlainRenderer::Disc> lamps()
{
  return {{-0.465, 0.495, 1.5, 1130, 0.5, 0},
          {-0.46, -0.42, 1.5, 1610, 0.35, 0},
          {0.46, 0.49, 1.5, 2210, 0.65, 0},
          {0.48, -0.425, 1.5, 2890, 0.5, 0}};
}

vpLampMap mapOf(const std::vector<vpPlainRenderer::Disc> &discs, double diameter)
{
  vpLampMap map;
  for (const vpPlainRenderer::Disc &disc : discs) {
    vpLamp lamp;
    lamp.id = std::to_string(map.lamps.size() + 1);
    lamp.position = {disc.x, disc.y, disc.z};
    lamp.size = diameter;
    lamp.modulation.kind = vpModulation::Kind::pwm;
    lamp.modulation.frequency = disc.frequency;
    lamp.modulation.duty = disc.duty;
    map.lamps.push_back(lamp);
  }
  return map;
}

//! A random place from which two lamps are whole; or, \e halved, one or two are, one is halved by the border,
//! and of the others nothing is seen.
Place placeWith(bool halved, const vpPlainRenderer &renderer, const std::vector<vpPlainRenderer::Disc> &discs,
                std::mt19937_64 &generator)
{
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (;;) {
    const double reach = halved ? 1.3 : 0.6; // m
    const Place place{reach * uniform(generator), reach * uniform(generator), M_PI * uniform(generator)};
    int whole = 0, half = 0, part = 0;
    for (const vpPlainRenderer::Disc &disc : discs) {
      const double inside = vpPlainRenderer::shareInside(renderer.spotOf(disc, place.x, place.y, place.yaw));
      whole += inside == 1;
      half += inside > 0.4 && inside < 0.6;
      part += inside > 0 && inside < 1;
    }
    if (halved ? (whole == 1 || whole == 2) && half == 1 && part == 1 : whole >= 2) {
      return place;
    }
  }
}

//! Why there is no fix: the lamps of the map that are not named, and the regions that are seen.
std::string reasonOf(const vpVlpLocation &location)
{
  std::string reason = location.fix.refusal;
  for (const vpLampObservation &seen : location.observations) {
    const vpStripeFeatures &stripes = seen.features;
    char text[300];
    std::snprintf(text, sizeof(text),
                  "; at (%.0f, %.0f)%s %s: %.2f (%.2f) Hz, duty %.4f (%.4f), %u stripes, misfit %.3f %s",
                  seen.point.x(), seen.point.y(), seen.cut ? ", cut," : "",
                  seen.id.empty() ? "none" : seen.id.c_str(), stripes.frequency, stripes.frequencySigma,
                  stripes.duty, stripes.dutySigma, stripes.stripes, stripes.misfit, seen.remark.c_str());
    reason += text;
  }
  return reason;
}

void run(const char *name, bool columns, int frames)
{
  vpVlpRig rig = vpVlpRig::load("data/rigs/ub300-800x600.yaml");
  vpPlainRenderer renderer;
  renderer.columns = columns;
  rig.shutter.readout = columns ? vpRollingShutter::Readout::columns : vpRollingShutter::Readout::rows;
  const vpLampMap map = mapOf(lamps(), renderer.diameter);
  Results results;
  std::mutex guard;
  vpRunTrials(frames, [&](int trial, std::mt19937_64 &generator) {
    std::vector<vpPlainRenderer::Disc> discs = lamps();
    const Place place = placeWith(columns, renderer, discs, generator);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (vpPlainRenderer::Disc &disc : discs) {
      disc.phase = uniform(generator);
    }
    vpVlpFrame frame;
    renderer.render(discs, place.x, place.y, place.yaw, generator, frame.I);
    vpVlpLocalizer localizer(rig, map);
    localizer.tracking = false;
    const vpVlpLocation location = localizer.process(frame);
    const std::lock_guard<std::mutex> lock(guard);
    if (location.fix.valid) {
      results.add(location.fix, place.x, place.y);
    } else {
      std::fprintf(stderr, "%s, frame %d: %s\n", name, trial, reasonOf(location).c_str());
    }
  });
  results.print(name, frames);
  std::fflush(stdout);
}
} // namespace

int main(int argc, char **argv)
{
  const int byRows = argc > 1 ? std::atoi(argv[1]) : 72, byColumns = argc > 2 ? std::atoi(argv[2]) : 36;
  std::printf(
      "| frames | of them | with a fix | mean error, mm | 95 %% | largest | in own sigmas, rms | largest |\n"
      "|---|---|---|---|---|---|---|---|\n");
  run("readout by rows, two whole lamps or more", false, byRows);
  run("readout by columns, one lamp halved, one or two whole", true, byColumns);
  return 0;
}
