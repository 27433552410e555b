/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "luminaires/vpHalfRealTrial.h"

#include <algorithm>
#include <cmath>

#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE
namespace
{
double even(double from, double to, std::mt19937_64 &generator)
{
  return from + (to - from) * std::uniform_real_distribution<double>(0, 1)(generator);
}

double logEven(double from, double to, std::mt19937_64 &generator)
{
  return std::exp(even(std::log(from), std::log(to), generator));
}

//! Frequencies of the map, Hz, none closer to another than the ranges say.
std::vector<double> drawFrequencies(const vpHalfRealRanges &ranges, double lowest, std::mt19937_64 &generator)
{
  for (int attempt = 0; attempt < 10000; ++attempt) {
    std::vector<double> drawn;
    for (int i = 0; i < ranges.lampsOfMap; ++i) {
      drawn.push_back(logEven(lowest, ranges.highest, generator));
    }
    std::sort(drawn.begin(), drawn.end());
    bool good = true;
    for (size_t i = 1; i < drawn.size(); ++i) {
      good = good && drawn[i] > ranges.apart * drawn[i - 1];
    }
    if (good) {
      std::shuffle(drawn.begin(), drawn.end(), generator);
      return drawn;
    }
  }
  throw vpException(vpException::badValue, "no %d frequencies from %g to %g Hz are %g times each other",
                    ranges.lampsOfMap, lowest, ranges.highest, ranges.apart);
}

vpModulation modulationOf(const vpHalfRealRanges &ranges, double frequency, std::mt19937_64 &generator)
{
  vpModulation modulation;
  modulation.kind = ranges.kind;
  modulation.frequency = frequency;
  modulation.duty = even(ranges.leastDuty, ranges.mostDuty, generator);
  if (ranges.kind == vpModulation::Kind::twoPulse) {
    modulation.duty = even(0.2, 0.4, generator);
    modulation.phaseDifference = even(0.25, 0.42, generator);
  } else if (ranges.kind == vpModulation::Kind::word) {
    static const char *const header = "0111";
    modulation.bits = header;
    for (int i = 0; i < 4; ++i) {
      modulation.bits += generator() % 2 == 0 ? '0' : '1';
    }
    modulation.duty.reset();
    modulation.frequency = 0;
    modulation.chipRate = frequency * static_cast<double>(modulation.chips().size());
  }
  return modulation;
}

void stateRig(const vpHalfRealRanges &ranges, vpHalfRealTrial &trial, std::mt19937_64 &generator)
{
  static const double focalLength = 20000; // px: so long that the picture of a disc's middle is its outline's
  const vpHalfRealPicture &picture = trial.picture;
  vpVlpRig &rig = trial.rig;
  rig.cameraFile = "camera.xml";
  rig.cameraName = "half-real";
  rig.width = static_cast<unsigned int>(picture.width);
  rig.height = static_cast<unsigned int>(picture.height);
  rig.camera.initPersProjWithoutDistortion(focalLength, focalLength, 0.5 * (picture.width - 1),
                                           0.5 * (picture.height - 1));
  std::normal_distribution<double> normal;
  rig.shutter.rowTime = picture.rowTime * (1 + ranges.rowTimeSigma * std::clamp(normal(generator), -2., 2.));
  rig.shutter.rowTimeSigma = ranges.rowTimeSigma * rig.shutter.rowTime;
  rig.shutter.exposure = picture.exposure * logEven(1 / ranges.claimFactor, ranges.claimFactor, generator);
  rig.shutter.exposureSigma = vpVlpRig::uncalibratedExposure * rig.shutter.exposure;
}

bool touches(const vpHalfRealLamp &one, const vpHalfRealLamp &other)
{
  static const double glow = 1.25; // radii of the outline
  return (one.middle - other.middle).norm() < 0.5 * glow * (one.diameter + other.diameter);
}

//! Turns and tilts the lamp, and draws its size among those that show enough periods and lines. False: none
//! does.
bool turn(vpHalfRealLamp &lamp, const vpHalfRealRanges &ranges, double rowTime, std::mt19937_64 &generator)
{
  const double least =
      std::max(ranges.shortest, ranges.periods / (lamp.modulation.repetitionFrequency() * rowTime));
  for (int attempt = 0; attempt < 200; ++attempt) {
    lamp.angle = even(-M_PI, M_PI, generator);
    lamp.tilt = even(0, ranges.tilt, generator);
    lamp.tiltAxis = even(-M_PI, M_PI, generator);
    lamp.diameter = 1;
    const double smallest = std::max(ranges.shortest, least / lamp.lines());
    if (smallest <= ranges.longest) {
      lamp.diameter = logEven(smallest, ranges.longest, generator);
      return true;
    }
  }
  return false;
}

//! Finds the lamp a place among the others. False: there is none.
bool place(vpHalfRealLamp &lamp, const vpHalfRealPicture &picture, std::mt19937_64 &generator)
{
  const double border = 0.6 * lamp.diameter;
  for (int attempt = 0; attempt < 200; ++attempt) {
    lamp.middle = {even(border, picture.width - border, generator),
                   even(border, picture.height - border, generator)};
    if (std::none_of(picture.lamps.begin(), picture.lamps.end(),
                     [&lamp](const vpHalfRealLamp &other) { return touches(lamp, other); })) {
      return true;
    }
  }
  return false;
}
} // namespace

vpHalfRealTrial vpDrawTrial(const vpHalfRealRanges &ranges, std::mt19937_64 &generator)
{
  vpHalfRealTrial trial;
  vpHalfRealPicture &picture = trial.picture;
  picture.rowTime = even(ranges.leastRowTime, ranges.mostRowTime, generator);
  const double mostLines = ranges.longest * std::cos(ranges.tilt); // of the largest lamp, at least
  const double lowest = std::max(ranges.lowest, ranges.periods / (mostLines * picture.rowTime));
  double fastest = 0;
  for (double frequency : drawFrequencies(ranges, lowest, generator)) {
    vpLamp lamp;
    lamp.id = std::string(1, static_cast<char>('A' + trial.map.lamps.size()));
    lamp.position = {0.5 * static_cast<double>(trial.map.lamps.size()), 0, 2.5};
    lamp.modulation = modulationOf(ranges, frequency, generator);
    trial.truth.lamps.push_back(lamp);
    if (ranges.kind == vpModulation::Kind::pwm && even(0, 1, generator) >= ranges.dutyStated) {
      lamp.modulation.duty.reset();
    }
    trial.map.lamps.push_back(lamp);
    fastest = std::max(fastest, frequency);
  }
  const double longest = std::min(ranges.mostExposure, ranges.exposurePeriods / fastest);
  picture.exposure = logEven(ranges.leastExposure, longest, generator);
  picture.background = even(1, 12, generator);
  picture.gradient = Eigen::Vector2d::NullaryExpr([&] { return even(-0.003, 0.003, generator); });
  picture.blur = even(0.5, 1.3, generator);
  picture.noise = even(ranges.leastNoise, ranges.mostNoise, generator);
  picture.electrons = ranges.electrons;
  picture.gamma = ranges.gamma;
  picture.jpeg = ranges.jpeg;
  stateRig(ranges, trial, generator);
  return trial;
}

void vpDrawLamps(const vpHalfRealRanges &ranges, const std::vector<vpEmissionPattern> &patterns,
                 vpHalfRealTrial &trial, std::mt19937_64 &generator)
{
  vpHalfRealPicture &picture = trial.picture;
  picture.lamps.clear();
  picture.seed = generator();
  std::vector<const vpLamp *> order;
  for (const vpLamp &lamp : trial.truth.lamps) {
    order.push_back(&lamp);
  }
  std::shuffle(order.begin(), order.end(), generator);
  order.resize(
      std::min<size_t>(order.size(), ranges.fewest + generator() % (ranges.most - ranges.fewest + 1)));
  for (const vpLamp *known : order) {
    vpHalfRealLamp lamp;
    lamp.pattern = &patterns[generator() % patterns.size()];
    lamp.id = known->id;
    lamp.modulation = known->modulation;
    lamp.rate = 1 + 1e-6 * known->oscillatorPpm * std::normal_distribution<double>()(generator);
    lamp.phase = even(0, 1, generator);
    if (!turn(lamp, ranges, picture.rowTime, generator)) {
      continue;
    }
    // The grey level after the tone curve is what is drawn.
    const double level = even(ranges.leastLevel, ranges.mostLevel, generator);
    lamp.level = 255 * std::pow(level / 255, picture.gamma);
    if (place(lamp, picture, generator)) {
      picture.lamps.push_back(lamp);
    }
  }
}

END_VISP_NAMESPACE
