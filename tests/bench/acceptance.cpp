/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// False acceptance: how often what is no lamp of the map gets an id, while true lamps get theirs.
// bench_acceptance [LAMPS] [true|strangers|steady|all] [SEED] [random|planned] [FRAMES]: other seeds make
// other maps and lamps. Planned maps are those of vpLedIdPlanner. FRAMES of each lamp are taken together as a
// track's are (1). To be run from the top of the repository.

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <vector>

#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_identification/vpLedDetector.h>
#include <visp3/vlp_identification/vpLedIdEvidence.h>
#include <visp3/vlp_identification/vpLedIdPlanner.h>
#include <visp3/vlp_simulation/vpRollingShutterRenderer.h>

#include "vpSimulatedStripes.h"

namespace
{
const double lowest = 500, highest = 7000; // Hz
const double diameter = 0.175;             // m, of the maps' lamps, all discs
const double rowTimeSigma = 5e-5;          // as a share of the row time

struct Map {
  const char *duties;
  vpLampMap map;
};

//! PWM lamps at random frequencies, 12 Hz apart or more.
vpLampMap lampsOf(int count, bool duties, unsigned int seed)
{
  std::mt19937_64 generator(static_cast<unsigned>(count) + 1000 * seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  vpLampMap map;
  while (static_cast<int>(map.lamps.size()) < count) {
    vpLamp lamp;
    lamp.id = std::to_string(map.lamps.size());
    lamp.size = diameter;
    lamp.modulation.kind = vpModulation::Kind::pwm;
    lamp.modulation.frequency = lowest + (highest - lowest) * uniform(generator);
    if (duties) {
      lamp.modulation.duty = 0.2 + 0.1 * std::floor(7 * uniform(generator));
    }
    const bool free = std::all_of(map.lamps.begin(), map.lamps.end(), [&lamp](const vpLamp &other) {
      return std::abs(other.modulation.frequency - lamp.modulation.frequency) > 12;
    });
    if (free) {
      map.lamps.push_back(lamp);
    }
  }
  return map;
}

//! As vpLedIdPlanner lays them out for whole lamps of 146 lines; those that state no duty all at 0.5.
vpLampMap plannedLamps(size_t count, bool duties)
{
  const vpSimulatedStripes stripes;
  vpVlpRig rig = vpVlpRig::load("data/rigs/ub300-2048x1536.yaml");
  rig.shutter.rowTimeSigma = rowTimeSigma * rig.shutter.rowTime;
  vpLedIdPlanner planner(rig);
  planner.lowestFrequency = lowest;
  planner.highestFrequency = highest;
  if (!duties) {
    planner.duties = {0.5};
  }
  vpLampMap map = vpMapOf(planner.spread(stripes.lines, stripes.oscillator, count).identifiers);
  for (vpLamp &lamp : map.lamps) {
    lamp.size = diameter;
    if (!duties) {
      lamp.modulation.duty.reset();
    }
  }
  return map;
}

std::vector<Map> maps(bool planned, unsigned int seed)
{
  std::vector<Map> all;
  for (bool duties : {true, false}) {
    for (int count : {4, 50, 200}) {
      all.push_back({duties ? "stated" : "not stated", planned
                                                           ? plannedLamps(static_cast<size_t>(count), duties)
                                                           : lampsOf(count, duties, seed)});
    }
  }
  return all;
}

vpRollingShutter shutterOf(const vpSimulatedStripes &stripes)
{
  vpRollingShutter shutter;
  shutter.rowTime = stripes.rowTime;
  shutter.rowTimeSigma = rowTimeSigma * stripes.rowTime;
  shutter.exposure = stripes.exposure;
  return shutter;
}

//! Standard deviation of a measured frequency about a map lamp's: the bound of a sinusoid (Rife and Boorstyn
//! 1974), row time, oscillator; Hz.
double combinedSigma(const vpSimulatedStripes &stripes, double frequency)
{
  const double eta = 0.5 * std::pow(10, stripes.snr / 10), n = stripes.lines;
  const double bound = std::sqrt(12 / (eta * n * (n * n - 1))) / (2 * M_PI * stripes.step * stripes.rowTime);
  return std::sqrt(bound * bound + std::pow(rowTimeSigma * frequency, 2) +
                   std::pow(1e-6 * stripes.oscillator * frequency, 2));
}

//! What frames of a lamp say together: errors of the row time and of its clock are the same in all of them,
//! phase and noise are not.
vpLampObservation seen(vpModulation modulation, vpSimulatedStripes stripes, int frames,
                       std::mt19937_64 &generator)
{
  std::normal_distribution<double> normal;
  stripes.rowTimeError = rowTimeSigma * normal(generator);
  if (frames > 1) {
    modulation.frequency *= 1 + 1e-6 * stripes.oscillator * normal(generator);
    stripes.oscillator = 0;
  }
  vpStripeAnalyzer analyzer;
  analyzer.searchTwoPulses = false;
  vpLedIdEvidence evidence;
  for (int frame = 0; frame < frames; ++frame) {
    evidence.add(analyzer.analyze(stripes.profile(modulation, generator)));
  }
  vpLampObservation lamp;
  lamp.features = evidence.features();
  return lamp;
}

void trueLamps(const Map &map, int lamps, int frames, unsigned int seed)
{
  const vpSimulatedStripes stripes;
  const vpLedIdRecognizer recognizer(map.map, shutterOf(stripes));
  std::mutex guard;
  int right = 0, wrong = 0;
  std::vector<int> missed(map.map.lamps.size(), 0);
  vpRunTrials(
      lamps,
      [&](int trial, std::mt19937_64 &generator) {
        const vpLamp &sent = map.map.lamps[static_cast<size_t>(trial) % map.map.lamps.size()];
        vpModulation modulation = sent.modulation;
        if (!modulation.duty) {
          modulation.duty = 0.2 + 0.6 * std::uniform_real_distribution<double>(0, 1)(generator);
        }
        vpLampObservation lamp = seen(modulation, stripes, frames, generator);
        recognizer.recognize(lamp);
        const std::lock_guard<std::mutex> lock(guard);
        right += lamp.id == sent.id;
        wrong += !lamp.id.empty() && lamp.id != sent.id;
        missed[static_cast<size_t>(trial) % missed.size()] += lamp.id != sent.id;
      },
      seed);
  const auto most = std::max_element(missed.begin(), missed.end());
  std::printf("%5zu lamps, duty %-10s %6d true lamps: %7.3f %% accepted, %d with another's id; most missed: "
              "%d of %.0f Hz\n",
              map.map.lamps.size(), map.duties, lamps, 100. * right / lamps, wrong, *most,
              map.map.lamps[static_cast<size_t>(most - missed.begin())].modulation.frequency);
  std::fflush(stdout);
}

//! \param apart From every lamp of the map, combined standard deviations; 0: any frequency.
void strangers(const Map &map, int lamps, double apart, int frames, unsigned int seed)
{
  const vpSimulatedStripes stripes;
  const vpLedIdRecognizer recognizer(map.map, shutterOf(stripes));
  std::mutex guard;
  int accepted = 0, far = 0;
  double overlap = 0;
  vpRunTrials(
      lamps,
      [&](int, std::mt19937_64 &generator) {
        std::uniform_real_distribution<double> uniform(0, 1);
        vpModulation modulation;
        modulation.kind = vpModulation::Kind::pwm;
        auto distance = [&] {
          double least = 1e9;
          for (const vpLamp &lamp : map.map.lamps) {
            least = std::min(least, std::abs(lamp.modulation.frequency - modulation.frequency) /
                                        combinedSigma(stripes, lamp.modulation.frequency));
          }
          return least;
        };
        do {
          modulation.frequency = lowest + (highest - lowest) * uniform(generator);
        } while (distance() < apart);
        modulation.duty = 0.2 + 0.6 * uniform(generator);
        vpLampObservation lamp = seen(modulation, stripes, frames, generator);
        recognizer.recognize(lamp);
        const bool near = std::any_of(map.map.lamps.begin(), map.map.lamps.end(), [&](const vpLamp &other) {
          return std::abs(other.modulation.frequency - modulation.frequency) <
                     recognizer.boundGate * combinedSigma(stripes, other.modulation.frequency) &&
                 (!other.modulation.duty || std::abs(*other.modulation.duty - *modulation.duty) <
                                                recognizer.shapeGate * recognizer.dutyError);
        });
        const std::lock_guard<std::mutex> lock(guard);
        accepted += !lamp.id.empty();
        overlap += near;
        if (!lamp.id.empty()) {
          const double f = map.map.find(lamp.id)->modulation.frequency;
          const double own =
              std::hypot(lamp.features.frequencySigma, rowTimeSigma * f, 1e-6 * stripes.oscillator * f);
          far += std::abs(modulation.frequency - f) > 5 * own;
        }
      },
      seed);
  std::printf("%5zu lamps, duty %-10s %6d strangers %s: %d accepted", map.map.lamps.size(), map.duties, lamps,
              apart > 0 ? "more than 5 sigma off" : "of any frequency", accepted);
  if (apart > 0) {
    std::printf(", %d of them by the standard deviation that the measurement states itself\n", far);
  } else {
    std::printf(" (%.2f %%); %.2f %% blink as a lamp of the map does, within the gate\n",
                100. * accepted / lamps, 100 * overlap / lamps);
  }
  std::fflush(stdout);
}

enum class Steady { lamps, barred, noise };

//! Lamps that never blink and windows; windows with crossbars.
vpImage<unsigned char> steadyPicture(const vpVlpRig &rig, bool barred, std::mt19937_64 &generator)
{
  std::uniform_real_distribution<double> uniform(0, 1);
  vpSimulatedCamera camera;
  camera.rig = rig;
  camera.readNoise = 0.5 + 4 * uniform(generator);
  camera.haloShare = 0.2 * uniform(generator);
  vpSimulatedScene scene;
  scene.ambient = 60 * uniform(generator);
  for (int k = 0; k < 12; ++k) {
    const double x = 0.5 * (k % 4 - 1.5) + 0.1 * uniform(generator),
                 y = 0.5 * (k / 4 - 1) + 0.1 * uniform(generator);
    if (!barred && uniform(generator) < 0.7) {
      vpSimulatedLamp lamp;
      lamp.lamp.id = std::to_string(k);
      lamp.lamp.position = Eigen::Vector3d(x, y, 1.5);
      lamp.lamp.size = 0.05 + 0.3 * uniform(generator);
      if (uniform(generator) < 0.3) {
        lamp.lamp.shape = vpLamp::Shape::square;
        lamp.lamp.yaw = 3 * uniform(generator);
      }
      lamp.level = 10 + 500 * std::pow(uniform(generator), 2);
      lamp.rim = 0.9 * uniform(generator);
      scene.lamps.push_back(lamp);
    } else {
      // Panes side by side and above each other: the bars between them are dark stripes.
      const int across = barred ? 1 + static_cast<int>(3 * uniform(generator)) : 1,
                down = barred ? 2 + static_cast<int>(3 * uniform(generator)) : 1;
      const double turn = uniform(generator) < 0.5 ? 0 : 3 * uniform(generator),
                   level = 40 + 400 * uniform(generator);
      const Eigen::Vector3d right(0.15 * std::cos(turn), 0.15 * std::sin(turn), 0),
          up(-0.15 * std::sin(turn), 0.15 * std::cos(turn), 0);
      for (int i = 0; i < across; ++i) {
        for (int j = 0; j < down; ++j) {
          vpSimulatedWindow pane;
          pane.centre = Eigen::Vector3d(x, y, 1.5) + right * (2. * (i + 0.5) / across - 1) +
                        up * (2. * (j + 0.5) / down - 1);
          pane.halfWidth = right * 0.9 / across;
          pane.halfHeight = up * 0.9 / down;
          pane.level = level;
          scene.windows.push_back(pane);
        }
      }
    }
  }
  vpImage<unsigned char> I;
  vpRollingShutterRenderer(camera).render(
      scene, [](double) { return vpHomogeneousMatrix(); }, 0, generator(), I);
  return I;
}

vpImage<unsigned char> noisePicture(const vpVlpRig &rig, std::mt19937_64 &generator)
{
  // Smooth random shades, line noise as of a poor amplifier, pixel noise.
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  const double shades = 80 * uniform(generator), linewise = 4 * uniform(generator),
               pixelwise = 1 + 10 * uniform(generator);
  struct Wave {
    double u, v, phase;
  };
  std::vector<Wave> waves;
  for (int k = 0; k < 12; ++k) {
    waves.push_back({0.15 * normal(generator), 0.15 * normal(generator), 6.3 * uniform(generator)});
  }
  vpImage<unsigned char> I(rig.height, rig.width);
  for (unsigned int v = 0; v < rig.height; ++v) {
    const double line = linewise * normal(generator);
    for (unsigned int u = 0; u < rig.width; ++u) {
      double grey = 60 + line + pixelwise * normal(generator);
      for (const Wave &wave : waves) {
        grey += shades / 4 * std::cos(wave.u * u + wave.v * v + wave.phase);
      }
      I[v][u] = static_cast<unsigned char>(std::min(255., std::max(0., grey + 0.5)));
    }
  }
  return I;
}

void steady(const std::vector<Map> &all, int least, Steady kind)
{
  vpVlpRig rig;
  rig.width = 800;
  rig.height = 600;
  rig.camera.initPersProjWithoutDistortion(500, 500, 399.5, 299.5);
  rig.shutter.rowTime = rig.shutter.exposure = 43.1e-6;
  rig.shutter.rowTimeSigma = rowTimeSigma * rig.shutter.rowTime;
  std::vector<vpLedIdRecognizer> recognizers;
  for (const Map &map : all) {
    recognizers.emplace_back(map.map, rig.shutter);
  }
  std::mutex guard;
  std::vector<int> accepted(all.size(), 0);
  int regions = 0, blinking = 0, picture = 0;
  while (regions < least && picture < least) {
    static const int atOnce = 100;
    vpRunTrials(atOnce, [&](int trial, std::mt19937_64 &) {
      std::mt19937_64 generator(static_cast<unsigned>(picture + trial) +
                                1000000u * static_cast<unsigned>(kind));
      const vpImage<unsigned char> I = kind == Steady::noise
                                           ? noisePicture(rig, generator)
                                           : steadyPicture(rig, kind == Steady::barred, generator);
      vpLedDetector detector(rig, all.front().map);
      detector.detect(I);
      const std::lock_guard<std::mutex> lock(guard);
      regions += static_cast<int>(detector.observations().size());
      for (const vpLampObservation &lamp : detector.observations()) {
        blinking += lamp.features.signal != vpStripeFeatures::Signal::unmodulated;
      }
      for (size_t m = 0; m < all.size(); ++m) {
        std::vector<vpLampObservation> lamps = detector.observations();
        recognizers[m].recognize(lamps);
        for (const vpLampObservation &lamp : lamps) {
          accepted[m] += !lamp.id.empty() && lamp.outline.shape != vpLampOutline::Shape::region;
        }
      }
    });
    picture += atOnce;
  }
  std::printf("%d regions of %s (%d pictures), %.2f %% with stripes; accepted:", regions,
              kind == Steady::noise    ? "noise and shades"
              : kind == Steady::barred ? "windows with crossbars"
                                       : "steady lamps and windows",
              picture, 100. * blinking / std::max(1, regions));
  for (size_t m = 0; m < all.size(); ++m) {
    std::printf(" %d (%zu lamps, duty %s)", accepted[m], all[m].map.lamps.size(), all[m].duties);
  }
  std::printf("\n");
  std::fflush(stdout);
}
} // namespace

int main(int argc, char **argv)
{
  const int lamps = argc > 1 ? std::atoi(argv[1]) : 10000;
  const std::string part = argc > 2 ? argv[2] : "all";
  const unsigned int seed = argc > 3 ? static_cast<unsigned int>(std::atoi(argv[3])) : 0;
  const bool planned = argc > 4 && std::string(argv[4]) == "planned";
  const int frames = argc > 5 ? std::max(1, std::atoi(argv[5])) : 1;
  const std::vector<Map> all = maps(planned, seed);
  if (part == "all" || part == "true") {
    for (const Map &map : all) {
      trueLamps(map, lamps, frames, seed);
    }
  }
  if (part == "all" || part == "strangers") {
    for (double apart : {5., 0.}) {
      for (const Map &map : all) {
        strangers(map, lamps, apart, frames, seed);
      }
    }
  }
  if (part == "all" || part == "steady") {
    for (Steady kind : {Steady::lamps, Steady::noise, Steady::barred}) {
      steady(all, lamps / 2, kind);
    }
  }
  return 0;
}
