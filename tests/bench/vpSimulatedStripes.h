/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSimulatedStripes_h
#define vpSimulatedStripes_h

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_identification/vpStripeAnalyzer.h>
#include <visp3/vlp_simulation/vpLampLight.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

//! The lines of one lamp as a sensor would give them: what the statistics of stripes are made of.
struct vpSimulatedStripes {
  int lines = 146;          // of the lamp in the picture
  double step = 1;          // sensor lines from one line of the picture to the next, on average
  double rowTime = 43.1e-6; // s, as the rig states it
  double rowTimeError = 0;  // of the true one, as a share of it
  double exposure = 43e-6;  // s
  double amplitude = 75;    // grey levels, half the swing of the stripes where no exposure blurs them
  double snr = 20;          // dB, amplitude over the noise of one line
  double oscillator = 50;   // ppm, standard deviation

  double noise() const { return amplitude * std::pow(10, -snr / 20); }

  //! \param rim Light of the emitter's first and last line, as a share of its middle's.
  vpStripeProfile profile(const vpModulation &modulation, std::mt19937_64 &generator, double rim = 1) const
  {
    const double rate = 1 + 1e-6 * oscillator * std::normal_distribution<double>()(generator);
    const vpLampLight light(modulation, rate, std::uniform_real_distribution<double>(0, 1)(generator));
    return profile([&light](double from, double to) { return light.over(from, to).share; }, generator, rim);
  }

  //! \param lit Share of the time between two times, s, during which the lamp is lit.
  vpStripeProfile profile(const std::function<double(double from, double to)> &lit,
                          std::mt19937_64 &generator, double rim = 1) const
  {
    std::normal_distribution<double> normal;
    const double first = // of the sensor's lines
        std::floor(1000 * std::uniform_real_distribution<double>(0, 1)(generator));
    vpStripeProfile profile;
    profile.exposure = exposure;
    for (int i = 0; i < lines; ++i) {
      const double line = std::floor((first + i) * step), start = line * rowTime * (1 + rowTimeError);
      const double y = 2 * (i + 0.5) / lines - 1, emitted = rim + (1 - rim) * std::sqrt(1 - y * y);
      profile.time.push_back(line * rowTime + exposure / 2);
      profile.light.push_back(2 * amplitude * emitted * lit(start, start + exposure) +
                              noise() * normal(generator));
      profile.sigma.push_back(noise());
    }
    return profile;
  }
};

//! Lamps that blink like this, their ids their numbers. \param oscillator ppm.
inline vpLampMap vpMapOf(const std::vector<vpModulation> &identifiers, double oscillator = 50)
{
  vpLampMap map;
  for (const vpModulation &modulation : identifiers) {
    vpLamp lamp;
    lamp.id = std::to_string(map.lamps.size());
    lamp.modulation = modulation;
    lamp.oscillatorPpm = oscillator;
    map.lamps.push_back(lamp);
  }
  return map;
}

//! Does \e count trials on all cores, each with a generator that its number and \e seed seed.
inline void vpRunTrials(int count, const std::function<void(int trial, std::mt19937_64 &generator)> &trial,
                        unsigned int seed = 0)
{
  const int workers = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::vector<std::thread> threads;
  for (int worker = 0; worker < workers; ++worker) {
    threads.emplace_back([=, &trial] {
      for (int i = worker; i < count; i += workers) {
        std::mt19937_64 generator((static_cast<uint64_t>(seed) << 32) + 1000003u * static_cast<unsigned>(i) +
                                  17u);
        trial(i, generator);
      }
    });
  }
  for (std::thread &thread : threads) {
    thread.join();
  }
}

#endif
