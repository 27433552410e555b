/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_identification/vpStripeAnalyzer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "vpPulseSearch.h"
#include "vpStripeStarts.h"
#include "waveform/vpDutyRidge.h"
#include "waveform/vpStripeLimits.h"
#include "waveform/vpWaveformFit.h"
#include "words/vpWordSearch.h"

BEGIN_VISP_NAMESPACE

namespace
{

const int even = 2, uneven = 4; // bends of an emitter's envelope

//! How many bends the envelope may have.
int envelopeOrderOf(const vpStripeProfile &profile, const std::vector<size_t> &peaks)
{
  static const double evenEmitter = 1.6; // the brightest stripe over the dimmest
  if (peaks.size() < 2) {
    return 0;
  }
  const auto [dimmest, brightest] = std::minmax_element(
      peaks.begin(), peaks.end(), [&](size_t a, size_t b) { return profile.light[a] < profile.light[b]; });
  const bool bent = profile.isClipped() || profile.light[*brightest] > evenEmitter * profile.light[*dimmest];
  return std::clamp(static_cast<int>(peaks.size()) - 1, even, bent ? uneven : even);
}

//! What a profile shows before anything is fitted to it.
struct Stripes {
  std::vector<size_t> peaks;
  int order; // bends of the envelope
  vpPulseSearch search;
  double depth;

  Stripes(const vpStripeProfile &profile, const vpStripeAnalyzer &analyzer)
      : peaks(vpStripeStarts::peaks(profile)), order(envelopeOrderOf(profile, peaks)),
        search(profile, vpStripeStarts::envelope(profile, vpStripeStarts::wholePeaks(profile, peaks), order),
               order, analyzer),
        depth(profile.depth())
  {
  }

  bool blink(const vpStripeAnalyzer &analyzer)
  {
    return depth >= analyzer.minModulation && search.significant(analyzer.minSignificance);
  }

  //! Whether they are several, too shallow to be peaks, as where the exposure is nearly a period: what rises
  //! at one end and falls at the other is the light's own shape.
  bool ripple(const vpStripeProfile &profile, const vpStripeAnalyzer &analyzer)
  {
    static const double fewest = 2;
    const double span = std::abs(profile.time.back() - profile.time.front());
    return blink(analyzer) && !search.candidates().empty() &&
           search.candidates().front().frequency * span >= fewest;
  }
};

const size_t fewestLines = 6;

//! The lines of a profile between the first and the last that have half of its brightest line's light.
vpStripeProfile insideOf(const vpStripeProfile &profile)
{
  static const double half = 0.5;
  const double level = half * *std::max_element(profile.light.begin(), profile.light.end());
  const auto lit = [level](double light) { return light > level; };
  const auto begin = std::find_if(profile.light.begin(), profile.light.end(), lit) - profile.light.begin();
  const auto end =
      std::find_if(profile.light.rbegin(), profile.light.rend(), lit).base() - profile.light.begin();
  vpStripeProfile inside = profile;
  for (std::vector<double> *each : {&inside.time, &inside.light, &inside.sigma}) {
    *each = std::vector<double>(each->begin() + begin, each->begin() + std::max(begin, end));
  }
  return inside;
}

//! \param middle s, of the profile, after the start of the frame.
void take(vpStripeFeatures &features, const vpWaveformFit &fit, bool twoPulse, double middle)
{
  using P = vpWaveformFit;
  features.signal = twoPulse ? vpStripeFeatures::Signal::twoPulse : vpStripeFeatures::Signal::pwm;
  features.frequency = fit.value(P::frequency);
  features.frequencySigma = fit.sigma(P::frequency);
  features.frequencyBound = fit.frequencyBound();
  features.frequencyNoise = fit.frequencyNoise();
  features.duty = fit.value(P::duty);
  features.dutySigma = fit.sigma(P::duty);
  features.phase = fit.value(P::phase) - middle * features.frequency;
  features.phase -= std::floor(features.phase);
  features.exposure = fit.value(P::exposure);
  features.exposureSigma = fit.sigma(P::exposure);
  features.misfit = fit.misfit();
  features.alongDuty.clear();
  if (twoPulse) {
    features.phaseDifference = fit.value(P::phaseDifference);
    features.phaseDifferenceSigma = fit.sigma(P::phaseDifference);
  }
}

/*!
  A word in place of what leaves \e unexplained of the stripes' power. It has many chips to choose: it has to
  explain as much more as their number asks for (Schwarz 1978). Chips seen only once can follow any light:
  such a word has to explain all but noise.
*/
std::optional<vpWordSearch::Found> findWord(const vpStripeProfile &profile,
                                            const std::vector<double> &envelope, int envelopeOrder,
                                            const vpStripeAnalyzer &analyzer, double unexplained,
                                            size_t stripes)
{
  static const double wordMisfit = 0.1;
  static const double explained = 2, nearlyExplained = 3; // chi-square per degree of freedom
  static const double exposureTolerance = 0.5;            // of its logarithm
  const double tolerance = std::hypot(exposureTolerance, profile.logExposureSigma);
  const vpWordSearch search(profile, {envelopeOrder, analyzer.modelError, tolerance}, envelope);
  std::optional<vpWordSearch::Found> word = search.known(analyzer.words, wordMisfit);
  // A word without a name has two pulses or more, and fewer than three stripes would repeat none of them; its
  // lamp is off between them.
  static const size_t fewest = 3;
  static const double off = 0.7; // depth
  if (analyzer.searchUnknownWords && stripes >= fewest && profile.depth() > off &&
      (!word || word->inflation > explained)) {
    const std::optional<vpWordSearch::Found> other = search.blind(wordMisfit);
    static const double clearlyLess = 0.8;
    if (!word || (other && other->inflation < clearlyLess * word->inflation)) {
      word = other;
    }
  }
  if (!word || word->confidence < analyzer.minWordConfidence || vpWordSearch::singlePulse(word->word.chips)) {
    return std::nullopt;
  }
  static const double repeated = 1.3, noise = 0.005; // share of the power that no comparison goes below
  static const double clearly = 10;                  // in chi-square
  const auto chips = static_cast<double>(word->word.chips.size());
  const double span = std::abs(profile.time.back() - profile.time.front());
  const bool once = span < repeated * chips * word->word.chip;
  const double gain = static_cast<double>(profile.time.size()) *
                      std::log((unexplained + noise) / (word->word.misfit + noise));
  if (gain < 2 * M_LN2 * chips + clearly || (once && !(word->inflation < nearlyExplained))) {
    return std::nullopt;
  }
  return word;
}

//! What was fitted is not what it sends: a word is, where it is known.
void takeCoded(vpStripeFeatures &features, const std::optional<vpWordSearch::Found> &found)
{
  const double none = std::numeric_limits<double>::quiet_NaN();
  features.signal = vpStripeFeatures::Signal::coded;
  features.frequency = features.frequencySigma = features.frequencyBound = none;
  features.duty = features.dutySigma = none;
  features.alongDuty.clear();
  features.phaseDifference = features.phaseDifferenceSigma = features.phase = none;
  features.exposure = features.exposureSigma = none;
  if (found) {
    features.chips = vpWordFit::canonical(found->word.chips);
    features.chipsConfidence = found->confidence;
    features.frequency = 1 / (found->word.chip * static_cast<double>(features.chips.size()));
    features.frequencySigma = found->durationSigma * features.frequency;
    features.misfit = found->word.misfit;
  }
}

//! Whether the edges that stripes show under the envelope that was fitted are those of its pulses.
bool edgesAgree(const vpStripeProfile &profile, const vpWaveformFit &fit, bool twoPulse)
{
  const Eigen::ArrayXd light = fit.envelope();
  const std::vector<vpStripeStarts::Edge> edges =
      vpStripeStarts::edges(profile, {light.data(), light.data() + light.size()});
  return twoPulse ? vpStripeStarts::pairsOfPulses(edges).has_value()
                  : vpStripeStarts::pulses(edges).has_value();
}

//! Where stripes are too few or too blurred for what was fitted to mean much.
void widen(vpStripeFeatures &features, const vpStripeProfile &profile, bool edgesAgree)
{
  // Less than a period shows how long a pulse or a gap is, not how often it comes; and no fit of so few lines
  // is put to the test.
  static const double leastPeriods = 1.2;
  static const double manyPeriods = 2.2; // that show three edges, wherever they begin
  static const size_t leastLines = 8;
  const double span = std::abs(profile.time.back() - profile.time.front());
  const double periods = span * features.frequency;
  // Two stripes are soon explained: what is none, a shaded wall, leaves more of itself unexplained than a
  // lamp.
  static const double few = 2, fewMisfit = 0.03, enough = 3, enoughMisfit = 0.09, many = 5;
  const double share = std::clamp((periods - few) / (enough - few), 0.0, 1.0);
  const double most = periods > many ? 1 : fewMisfit + (enoughMisfit - fewMisfit) * share;
  static const double atTheEnd = 0.001;
  const bool shines = std::min(features.duty, 1 - features.duty) > vpStripeLimits::leastDuty + atTheEnd;
  if (!shines || periods < leastPeriods || (periods < manyPeriods && !edgesAgree) ||
      profile.time.size() < leastLines || features.misfit > most) {
    features.frequencySigma = std::max(features.frequencySigma, features.frequency);
  }
  // A clipped line does not tell how bright it was, and so not how much of an edge is exposure: pulse and
  // exposure are known together only.
  if (profile.isClipped()) {
    features.dutyClipped = profile.exposure * features.frequency;
    features.dutySigma = std::hypot(features.dutySigma, features.dutyClipped);
  }
}

} // namespace

bool vpStripeAnalyzer::blinks(const vpStripeProfile &profile) const
{
  if (profile.light.size() < fewestLines) {
    return false;
  }
  Stripes stripes(profile, *this);
  if (stripes.peaks.size() > 1 || !stripes.search.isOneStripe()) {
    return stripes.blink(*this);
  }
  const vpStripeProfile inside = insideOf(profile);
  return inside.light.size() >= fewestLines && Stripes(inside, *this).ripple(inside, *this);
}

vpStripeFeatures vpStripeAnalyzer::analyze(const vpStripeProfile &profile) const
{
  vpStripeFeatures features;
  if (profile.light.size() < fewestLines) {
    return features;
  }
  Stripes stripes(profile, *this);
  const std::vector<size_t> &peaks = stripes.peaks;
  const int order = stripes.order;
  vpPulseSearch &byAll = stripes.search;
  features.stripes = static_cast<unsigned int>(peaks.size());
  features.modulation = stripes.depth;
  if (profile.agreement < minAgreement || !stripes.blink(*this)) {
    return features;
  }
  features.misfit = 1; // where no pulses explain anything
  const auto [earliest, latest] = std::minmax_element(profile.time.begin(), profile.time.end());
  const double middle = 0.5 * (*earliest + *latest);
  std::optional<vpPulseSearch> byPeriod;
  std::optional<vpWaveformFit> pwm = byAll.onePulse(), two;
  const auto explained = [&pwm] { return pwm && pwm->misfit() < vpPulseSearch::allExplained; };
  const auto alsoFrom = [&pwm](vpPulseSearch &search) {
    std::optional<vpWaveformFit> other = search.onePulse(pwm ? pwm->misfit() : 1);
    if (other && (!pwm || other->criterion() < pwm->criterion())) {
      pwm = std::move(other);
    }
  };
  if (order > 0 && !profile.isClipped()) { // beyond the end of the grey scale nothing tells an even lamp
    vpPulseSearch evenly = byAll.evenly(explained(), *this);
    alsoFrom(evenly);
  }
  if (!explained() && !byAll.candidates().empty()) {
    // An emitter of any pattern is as bright as the brightest that a period shows.
    const double frequency = byAll.candidates().front().frequency,
                 periods = frequency * std::abs(profile.time.back() - profile.time.front());
    byPeriod.emplace(profile, vpStripeStarts::envelopeOfPeriod(profile, frequency),
                     std::clamp(static_cast<int>(periods) - 1, order, uneven), *this);
    byPeriod->settings.envelopeUnknowns = static_cast<int>(periods);
    alsoFrom(*byPeriod);
  }
  if (!explained() && peaks.size() > 1) {
    vpPulseSearch byStripes(profile, vpStripeStarts::envelopeOfStripes(profile, peaks), 0, *this);
    byStripes.settings.envelopeUnknowns = 2 * static_cast<int>(peaks.size());
    alsoFrom(byStripes);
  }
  if (pwm) {
    pwm->integrate();
    take(features, *pwm, false, middle);
    if (pwm->hidesDuty()) {
      features.alongDuty = pwm->alongDuty();
      vpDutyRidge::settle(features);
    }
  }
  // A second pulse explains a little of what blur and tone curve do to one, too.
  static const double wellExplained = 0.003, far = 0.05, muchBetter = 0.2, better = 0.5;
  if (searchTwoPulses && (!pwm || pwm->misfit() > wellExplained)) {
    two = byAll.twoPulses();
    if (byPeriod && !(two && two->misfit() < vpPulseSearch::allExplained)) {
      std::optional<vpWaveformFit> other = byPeriod->twoPulses();
      if (other && (!two || other->cost() < two->cost())) {
        two = std::move(other);
      }
    }
    if (two && two->misfit() < maxMisfit && (!pwm || two->criterion() < pwm->criterion()) &&
        (!pwm || two->misfit() < (pwm->misfit() > far ? better : muchBetter) * pwm->misfit())) {
      two->integrate();
      take(features, *two, true, middle);
    }
  }
  const bool twoPulse = features.signal == vpStripeFeatures::Signal::twoPulse;
  const std::optional<vpWaveformFit> &fit = twoPulse ? two : pwm;
  widen(features, profile, fit && edgesAgree(profile, *fit, twoPulse));
  static const double certain = 0.04; // misfit from which a word may explain the stripes better
  if (!(features.misfit < certain)) {
    const std::optional<vpWordSearch::Found> word =
        findWord(profile, vpStripeStarts::envelope(profile, peaks, order), order, *this, features.misfit,
                 peaks.size());
    if (word || !(features.misfit < maxMisfit)) {
      takeCoded(features, word);
    }
  }
  return features;
}

END_VISP_NAMESPACE
