/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_detection/vpStripeAnalyzer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "vpStripeStarts.h"
#include "vpWaveformFit.h"

BEGIN_VISP_NAMESPACE

namespace
{

const double allExplained = 0.01; // misfit: no other start will do better

//! The best of several starts.
void keepBetter(std::optional<vpWaveformFit> &best, vpWaveformFit &&fit)
{
  if (!best || fit.cost() < best->cost()) {
    best.emplace(std::move(fit));
  }
}

std::optional<vpWaveformFit> fitPwm(const vpStripeProfile &profile,
                                    const std::vector<vpStripeStarts::Sinusoid> &candidates,
                                    const std::optional<vpStripeStarts::Pulses> &pulses,
                                    const vpWaveformFit::Settings &settings,
                                    const std::vector<double> &envelope)
{
  std::optional<vpWaveformFit> best;
  if (pulses) {
    vpWaveformFit fit(profile, settings, envelope);
    if (fit.run(pulses->frequency, pulses->phase, pulses->duty, 0, 0, true) && fit.preferStatedExposure()) {
      if (fit.misfit() < allExplained) {
        return fit;
      }
      keepBetter(best, std::move(fit));
    }
  }
  for (const vpStripeStarts::Sinusoid &candidate : candidates) {
    std::vector<double> exposures{profile.exposure};
    static const double longExposure =
        0.3; // periods: it may be misstated, and from there no way leads to sharp stripes
    if (profile.exposure * candidate.frequency > longExposure) {
      exposures.push_back(0.1 / candidate.frequency);
    }
    for (double exposure : exposures) {
      for (double duty : {0.15, 0.3, 0.5, 0.7, 0.85}) {
        vpWaveformFit fit(profile, settings, envelope);
        // The first harmonic peaks in the middle of the pulse.
        if (fit.run(candidate.frequency, 0.5 * duty - candidate.phase, duty, 0, exposure) &&
            fit.preferStatedExposure()) {
          keepBetter(best, std::move(fit));
        }
      }
    }
  }
  return best;
}

std::optional<vpWaveformFit> fitTwoPulse(const vpStripeProfile &profile,
                                         const std::vector<vpStripeStarts::Sinusoid> &candidates,
                                         const std::optional<vpStripeStarts::Pulses> &pulses,
                                         vpWaveformFit::Settings settings,
                                         const std::vector<double> &envelope)
{
  settings.twoPulse = true;
  std::optional<vpWaveformFit> best;
  if (pulses) {
    vpWaveformFit fit(profile, settings, envelope);
    if (fit.run(pulses->frequency, pulses->phase, pulses->duty, pulses->phaseDifference, 0, true) &&
        fit.preferStatedExposure()) {
      if (fit.misfit() < allExplained) {
        return fit;
      }
      keepBetter(best, std::move(fit));
    }
  }
  const double span = profile.time.back() - profile.time.front();
  for (const vpStripeStarts::Sinusoid &candidate : candidates) {
    for (int multiple = 1; multiple <= 2; ++multiple) { // the second harmonic may be the stronger
      const double f = candidate.frequency / multiple;
      if (f * std::abs(span) < 0.9) {
        continue;
      }
      for (double k : {0.15, 0.25, 0.35, 0.45}) {
        for (double start : {0.0, 0.25, 0.5, 0.75}) {
          vpWaveformFit fit(profile, settings, envelope);
          if (fit.run(f, start, 0.3, k) && fit.preferStatedExposure()) {
            keepBetter(best, std::move(fit));
          }
        }
      }
    }
  }
  return best;
}

void take(vpStripeFeatures &features, const vpWaveformFit &fit, bool twoPulse)
{
  using P = vpWaveformFit;
  features.signal = twoPulse ? vpStripeFeatures::Signal::twoPulse : vpStripeFeatures::Signal::pwm;
  features.frequency = fit.value(P::frequency);
  features.frequencySigma = fit.sigma(P::frequency);
  features.duty = fit.value(P::duty);
  features.dutySigma = fit.sigma(P::duty);
  features.exposure = fit.value(P::exposure);
  features.exposureSigma = fit.sigma(P::exposure);
  features.misfit = fit.misfit();
  if (twoPulse) {
    features.phaseDifference = fit.value(P::phaseDifference);
    features.phaseDifferenceSigma = fit.sigma(P::phaseDifference);
  }
}

} // namespace

vpStripeFeatures vpStripeAnalyzer::analyze(const vpStripeProfile &profile) const
{
  vpStripeFeatures features;
  static const size_t fewestLines = 6;
  if (profile.light.size() < fewestLines) {
    return features;
  }
  const std::vector<size_t> peaks = vpStripeStarts::peaks(profile);
  features.stripes = static_cast<unsigned int>(peaks.size());
  std::vector<double> sorted = profile.light;
  std::sort(sorted.begin(), sorted.end());
  const double low = std::max(0.0, sorted[sorted.size() / 20]);
  const double high = sorted[sorted.size() - 1 - sorted.size() / 20];
  features.modulation = high > 0 ? std::clamp((high - low) / (high + low), 0.0, 1.0) : 0;

  double dimmest = high, brightest = 0;
  for (size_t line : peaks) {
    dimmest = std::min(dimmest, profile.light[line]);
    brightest = std::max(brightest, profile.light[line]);
  }
  static const double evenEmitter = 1.6;
  vpWaveformFit::Settings settings;
  settings.modelError = modelError;
  settings.exposureTolerance = exposureTolerance;
  settings.envelopeOrder = std::clamp(static_cast<int>(peaks.size()) - 1, peaks.size() > 1 ? 2 : 0,
                                      brightest > evenEmitter * dimmest ? 4 : 2);
  const std::vector<double> envelope = vpStripeStarts::envelope(profile, peaks, settings.envelopeOrder);
  std::vector<vpStripeStarts::Sinusoid> candidates =
      vpStripeStarts::periodogram(profile, envelope, modelError);
  if (candidates.empty() || candidates.front().gain < minSignificance ||
      features.modulation < minModulation) {
    return features;
  }
  candidates.resize(std::min<size_t>(candidates.size(), 3));

  const std::vector<vpStripeStarts::Edge> edges = vpStripeStarts::edges(profile, envelope);
  const std::optional<vpStripeStarts::Pulses> pulses = vpStripeStarts::pulses(edges);
  std::optional<vpWaveformFit> pwm = fitPwm(profile, candidates, pulses, settings, envelope);
  if (pwm) {
    pwm->integrate();
    take(features, *pwm, false);
  }
  // A second pulse explains a little of what blur and tone curve do to one, too.
  static const double wellExplained = 0.003, far = 0.05, muchBetter = 0.2, better = 0.5;
  if (searchTwoPulses && (!pwm || pwm->misfit() > wellExplained)) {
    std::optional<vpWaveformFit> two =
        fitTwoPulse(profile, candidates, vpStripeStarts::pairsOfPulses(edges), settings, envelope);
    if (two && two->misfit() < maxMisfit &&
        (!pwm || two->misfit() < (pwm->misfit() > far ? better : muchBetter) * pwm->misfit())) {
      two->integrate();
      take(features, *two, true);
    }
  }
  // Less than a period shows how long a pulse or a gap is, not how often it comes; and no fit of so few lines
  // is put to the test.
  static const double leastPeriods = 1.2;
  static const double manyPeriods = 2.2; // that show three edges, wherever they begin
  static const size_t leastLines = 8;
  const double span = std::abs(profile.time.back() - profile.time.front());
  const double periods = span * features.frequency;
  if (periods < leastPeriods || (periods < manyPeriods && !pulses) || profile.time.size() < leastLines) {
    features.frequencySigma = std::max(features.frequencySigma, features.frequency);
  }
  // An exposure of a period or more leaves a remainder of the stripes that other exposures, duties and offsets
  // would leave as well.
  static const double longExposure = 0.9; // periods
  if (profile.exposure * features.frequency > longExposure) {
    static const double anyDuty = 0.3, cycles = 0.1; // standard deviations, of cycles over the profile
    features.dutySigma = std::max(features.dutySigma, anyDuty);
    features.frequencySigma = std::max(features.frequencySigma, cycles / span);
  }
  if (!(features.misfit < maxMisfit)) {
    features.signal = vpStripeFeatures::Signal::coded;
    const double none = std::numeric_limits<double>::quiet_NaN(); // what was fitted is not what it sends
    features.frequency = features.frequencySigma = features.duty = features.dutySigma = none;
    features.phaseDifference = features.phaseDifferenceSigma = none;
  }
  return features;
}

END_VISP_NAMESPACE
