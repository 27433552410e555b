/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_calibration/vpShutterCalibration.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_identification/vpLedDetector.h>

BEGIN_VISP_NAMESPACE

namespace
{
using Signal = vpStripeFeatures::Signal;

const size_t none = static_cast<size_t>(-1);

//! Row time of all analysis; what comes of it is in lines, so that any would do.
const double unitRowTime = 40e-6; // s

double median(std::vector<double> values)
{
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

//! Weighted mean, its standard deviation by what theirs say and, the more values there are, by how they
//! scatter.
struct Mean {
  double value = 0;
  double sigma = 0;

  Mean(const std::vector<double> &values, const std::vector<double> &sigmas)
  {
    double weights = 0, chiSquare = 0;
    for (size_t i = 0; i < values.size(); ++i) {
      const double weight = 1 / (sigmas[i] * sigmas[i]);
      weights += weight;
      value += weight * values[i];
    }
    value /= weights;
    for (size_t i = 0; i < values.size(); ++i) {
      chiSquare += std::pow((values[i] - value) / sigmas[i], 2);
    }
    static const double stated = 2; // values, that what they say of themselves weighs as much as
    const double factor = (stated + chiSquare) / (stated + static_cast<double>(values.size()) - 1);
    sigma = std::sqrt(factor / weights);
  }
};
} // namespace

vpShutterCalibration::vpShutterCalibration(const vpVlpRig &rig, const vpLampMap &lamps) : m_rig(rig)
{
  for (const vpLamp &lamp : lamps.lamps) {
    const vpModulation::Kind kind = lamp.modulation.kind;
    if (kind == vpModulation::Kind::pwm || kind == vpModulation::Kind::twoPulse) {
      m_map.lamps.push_back(lamp);
    }
  }
  if (m_map.lamps.empty()) {
    throw vpException(vpException::badValue,
                      "lamps: none with frequency_hz, expected one or more of known frequency");
  }
  for (const bool columns : {false, true}) {
    for (const double exposure : {1.0, 4.0, 16.0}) {
      m_readings.push_back({columns, exposure, {}, 0});
    }
  }
}

void vpShutterCalibration::add(const vpVlpFrame &frame)
{
  if (m_rig.width == 0 || m_rig.height == 0) {
    m_rig.width = frame.I.getWidth();
    m_rig.height = frame.I.getHeight();
  }
  m_pictures.push_back(frame.name);
  for (Reading &reading : m_readings) {
    look(frame, reading);
  }
}

void vpShutterCalibration::look(const vpVlpFrame &frame, Reading &reading) const
{
  vpVlpRig rig = m_rig;
  rig.shutter.readout =
      reading.alongColumns ? vpRollingShutter::Readout::columns : vpRollingShutter::Readout::rows;
  rig.shutter.rowTime = unitRowTime;
  rig.shutter.rowTimeSigma = vpVlpRig::uncalibratedRowTime * unitRowTime;
  rig.shutter.exposure = reading.exposure * unitRowTime;
  if (!(rig.camera.get_px() > 1)) { // unknown: no matter to stripes
    rig.camera.initPersProjWithoutDistortion(rig.width, rig.width, 0.5 * rig.width, 0.5 * rig.height);
  }
  vpLedDetector detector(rig, m_map);
  static const double anyExposure = 3; // share of the one to start from
  detector.stripeAnalyzer.exposureTolerance = anyExposure;
  detector.longestPeriod = detector.roiDetector.longestPeriod =
      std::numeric_limits<double>::infinity(); // in units of a row time not yet known
  detector.detect(frame.I);
  for (const vpLampObservation &lamp : detector.observations()) {
    const vpStripeFeatures &seen = lamp.features;
    if ((seen.signal == Signal::pwm || seen.signal == Signal::twoPulse) &&
        seen.frequencySigma < worstRelativeSigma * seen.frequency) {
      reading.stripes.push_back({m_pictures.size() - 1, seen.frequency * unitRowTime,
                                 seen.frequencySigma * unitRowTime, seen.duty, seen.exposure / unitRowTime,
                                 seen.exposureSigma / unitRowTime, seen.misfit});
      reading.score += std::max(0.0, 1 - seen.misfit / detector.stripeAnalyzer.maxMisfit);
    }
  }
}

//! The lamp whose stripes have that many cycles a line, or none.
size_t vpShutterCalibration::lampOf(double cycles, double relativeSigma, double rowTime) const
{
  static const double sigmas = 5, rounding = 1e-4; // a share
  size_t best = none;
  double least = sigmas;
  for (size_t k = 0; k < m_map.lamps.size(); ++k) {
    const vpLamp &lamp = m_map.lamps[k];
    const double off = std::log(cycles / (lamp.modulation.frequency * rowTime));
    const double sigma = std::sqrt(relativeSigma * relativeSigma + std::pow(1e-6 * lamp.oscillatorPpm, 2) +
                                   rounding * rounding);
    if (std::abs(off) / sigma < least) {
      least = std::abs(off) / sigma;
      best = k;
    }
  }
  return best;
}

double vpShutterCalibration::likeliestRowTime(const std::vector<Stripes> &stripes, std::string &refusal) const
{
  if (m_map.lamps.size() == 1) {
    std::vector<double> rowTimes;
    for (const Stripes &seen : stripes) {
      rowTimes.push_back(seen.cycles / m_map.lamps[0].modulation.frequency);
    }
    const double middle = median(rowTimes);
    const auto agree = std::count_if(stripes.begin(), stripes.end(), [&](const Stripes &seen) {
      static const double same = 0.01, sigmas = 5;
      const double cycles = middle * m_map.lamps[0].modulation.frequency;
      return std::abs(seen.cycles - cycles) < same * cycles + sigmas * seen.cyclesSigma;
    });
    if (2 * static_cast<size_t>(agree) <= stripes.size()) {
      refusal =
          "row times from " + vpNumberText(*std::min_element(rowTimes.begin(), rowTimes.end())) + " to " +
          vpNumberText(*std::max_element(rowTimes.begin(), rowTimes.end())) +
          " s: not all that blinks has that frequency; show one lamp only, or name all of them (--lamps)";
      return 0;
    }
    return middle;
  }
  // Each pair of stripes and lamp says what the row time would be, were it that lamp.
  struct Vote {
    double rowTime, sigma; // s; a share of it
    size_t explained;
  };
  std::vector<Vote> votes;
  size_t most = 0;
  for (const Stripes &seen : stripes) {
    for (const vpLamp &lamp : m_map.lamps) {
      Vote vote{seen.cycles / lamp.modulation.frequency, seen.cyclesSigma / seen.cycles, 0};
      for (const Stripes &other : stripes) {
        // The voter is off as well.
        const double relative = std::hypot(other.cyclesSigma / other.cycles, vote.sigma);
        vote.explained += lampOf(other.cycles, relative, vote.rowTime) != none;
      }
      most = std::max(most, vote.explained);
      votes.push_back(vote);
    }
  }
  static const double nearlyAsMany = 0.9;
  votes.erase(std::remove_if(votes.begin(), votes.end(),
                             [most](const Vote &vote) {
                               return static_cast<double>(vote.explained) <
                                      nearlyAsMany * static_cast<double>(most);
                             }),
              votes.end());
  std::vector<double> rowTimes;
  std::transform(votes.begin(), votes.end(), std::back_inserter(rowTimes),
                 [](const Vote &vote) { return vote.rowTime; });
  std::sort(rowTimes.begin(), rowTimes.end());
  const double middle = median(rowTimes);
  const bool one = std::all_of(votes.begin(), votes.end(), [middle](const Vote &vote) {
    static const double same = 0.01, sigmas = 3; // a lamp that the border cuts says little
    return std::abs(vote.rowTime / middle - 1) < same + sigmas * vote.sigma;
  });
  if (one) {
    return middle;
  }
  if (!(m_rig.shutter.rowTime > 0)) {
    refusal = "row times from " + vpNumberText(rowTimes.front()) + " to " + vpNumberText(rowTimes.back()) +
              " s explain the stripes alike; show two lamps or more at once, or give the rig's row time as a "
              "first guess";
    return 0;
  }
  const double rig = m_rig.shutter.rowTime;
  const double nearest = *std::min_element(rowTimes.begin(), rowTimes.end(), [rig](double a, double b) {
    return std::abs(std::log(a / rig)) < std::abs(std::log(b / rig));
  });
  // Where a good part of the stripes fits no lamp, frequencies may be wrong: then the rig must rule the other
  // row times out.
  static const double goodPart = 0.75, same = 0.01, sigmas = 4;
  const auto other = std::find_if(rowTimes.begin(), rowTimes.end(), [&](double rowTime) {
    return std::abs(rowTime / nearest - 1) > same &&
           std::abs(rowTime - rig) < sigmas * m_rig.shutter.rowTimeSigma;
  });
  if (static_cast<double>(most) < goodPart * static_cast<double>(stripes.size()) && other != rowTimes.end()) {
    refusal = "row times of " + vpNumberText(nearest) + " and " + vpNumberText(*other) +
              " s explain a part of the stripes each, and the rig's row_time_sigma_s admits both; correct "
              "frequency_hz of the lamps, or show only those of the map";
    return 0;
  }
  return nearest;
}

std::vector<vpShutterSight> vpShutterCalibration::sightsAt(double rowTime,
                                                           const std::vector<Stripes> &stripes,
                                                           std::vector<size_t> &lamps) const
{
  std::vector<vpShutterSight> sights;
  for (const Stripes &seen : stripes) {
    const bool only = m_map.lamps.size() == 1;
    const size_t k = only ? 0 : lampOf(seen.cycles, seen.cyclesSigma / seen.cycles + 1e-3, rowTime);
    if (k == none) {
      continue;
    }
    const vpLamp &lamp = m_map.lamps[k];
    vpShutterSight sight;
    sight.picture = m_pictures[seen.picture];
    sight.lamp = lamp.id;
    sight.rowTime = seen.cycles / lamp.modulation.frequency;
    sight.sigma = seen.cyclesSigma / lamp.modulation.frequency;
    sight.exposure = seen.exposure * sight.rowTime;
    sight.exposureSigma = seen.exposureSigma * sight.rowTime;
    // Two boxes, the pulse and the exposure: which is which, the lamp's duty tells, or else the longer is the
    // pulse.
    if (lamp.modulation.kind == vpModulation::Kind::pwm) {
      const double exposed = seen.exposure * seen.cycles, pulse = seen.duty; // periods
      const bool swapped = lamp.modulation.duty ? std::abs(exposed - *lamp.modulation.duty) <
                                                      std::abs(pulse - *lamp.modulation.duty)
                                                : exposed > pulse;
      sight.exposure = swapped ? pulse / lamp.modulation.frequency : sight.exposure;
    }
    lamps.push_back(k);
    sights.push_back(sight);
  }
  return sights;
}

//! Means over the sights, in two steps. \param lamps Of each sight.
void vpShutterCalibration::average(vpShutterEstimate &estimate, const std::vector<size_t> &lamps) const
{
  std::vector<vpShutterSight> &sights = estimate.sights;
  std::vector<double> all, offs;
  for (const vpShutterSight &sight : sights) {
    all.push_back(sight.rowTime);
  }
  const double middle = median(all);
  for (const vpShutterSight &sight : sights) {
    offs.push_back(std::abs(sight.rowTime - middle));
  }
  static const double sigmaOfMedian = 1.4826; // of a normal distribution's median absolute deviation
  const double scatter = sigmaOfMedian * median(offs);
  std::map<size_t, std::pair<std::vector<double>, std::vector<double>>> byLamp;
  std::vector<double> exposures, exposureSigmas;
  for (size_t i = 0; i < sights.size(); ++i) {
    vpShutterSight &sight = sights[i];
    const double clock = 1e-6 * m_map.lamps[lamps[i]].oscillatorPpm * sight.rowTime;
    sight.used = offs[i] < gate * std::sqrt(sight.sigma * sight.sigma + clock * clock + scatter * scatter);
    if (!sight.used) {
      continue;
    }
    byLamp[lamps[i]].first.push_back(sight.rowTime);
    byLamp[lamps[i]].second.push_back(sight.sigma);
    if (std::isfinite(sight.exposure) && sight.exposureSigma > 0) {
      exposures.push_back(sight.exposure);
      exposureSigmas.push_back(sight.exposureSigma);
    }
  }
  std::vector<double> values, sigmas;
  for (const auto &[lamp, own] : byLamp) {
    const Mean mean(own.first, own.second);
    values.push_back(mean.value);
    sigmas.push_back(std::hypot(mean.sigma, 1e-6 * m_map.lamps[lamp].oscillatorPpm * mean.value));
  }
  const Mean mean(values, sigmas);
  estimate.rowTime = mean.value;
  estimate.rowTimeSigma = mean.sigma;
  estimate.exposure = estimate.exposureSigma = std::numeric_limits<double>::quiet_NaN();
  if (!exposures.empty()) {
    const Mean exposure(exposures, exposureSigmas);
    estimate.exposure = exposure.value;
    estimate.exposureSigma = exposure.sigma;
  }
}

vpShutterEstimate vpShutterCalibration::solve() const
{
  vpShutterEstimate estimate;
  estimate.pictures = m_pictures.size();
  const Reading &best =
      *std::max_element(m_readings.begin(), m_readings.end(),
                        [](const Reading &a, const Reading &b) { return a.score < b.score; });
  estimate.alongColumns = best.alongColumns;
  if (best.stripes.empty()) {
    estimate.refusal =
        "no stripes of a blinking lamp along rows or columns; bring the camera nearer to the lamp, shorten "
        "the "
        "exposure below a fifth of the lamp's period, and see that the lamp is not white all over";
    return estimate;
  }
  const double rowTime = likeliestRowTime(best.stripes, estimate.refusal);
  if (!estimate.refusal.empty()) {
    return estimate;
  }
  static const double shortest = 1e-7, longest = 1e-2; // s: no camera is that quick, nor that slow
  if (!(rowTime > shortest && rowTime < longest)) {
    estimate.refusal = "the stripes tell a row time of " + vpNumberText(rowTime) + " s, expected " +
                       vpNumberText(shortest) + " to " + vpNumberText(longest) +
                       " s; see that the lamps' frequency_hz is what they blink at";
    return estimate;
  }
  std::vector<size_t> lamps;
  estimate.sights = sightsAt(rowTime, best.stripes, lamps);
  average(estimate, lamps);
  estimate.valid = true;
  return estimate;
}

END_VISP_NAMESPACE
