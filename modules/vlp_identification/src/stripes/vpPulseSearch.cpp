/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPulseSearch.h"

#include <algorithm>
#include <cmath>
#include <utility>

BEGIN_VISP_NAMESPACE

namespace
{
//! The best of several starts.
void keepBetter(std::optional<vpWaveformFit> &best, vpWaveformFit &&fit)
{
  if (!best || fit.cost() < best->cost()) {
    best.emplace(std::move(fit));
  }
}

//! The best end of descents from many starts, of one frequency or nearly so: those that have come the
//! farthest down after the first steps go on.
std::optional<vpWaveformFit> bestFrom(std::vector<vpWaveformFit> &&begun)
{
  static const size_t few = 2;
  for (vpWaveformFit &fit : begun) {
    fit.approach();
  }
  const auto end = begun.begin() + static_cast<long>(std::min(few, begun.size()));
  std::partial_sort(begun.begin(), end, begun.end(),
                    [](const vpWaveformFit &a, const vpWaveformFit &b) { return a.cost() < b.cost(); });
  std::optional<vpWaveformFit> best;
  for (auto fit = begun.begin(); fit != end; ++fit) {
    if (fit->arrive() && fit->preferStatedExposure()) {
      keepBetter(best, std::move(*fit));
    }
  }
  return best;
}

//! From where a fit may find the exposure, s: what is stated, and shorter and longer ones where that may be
//! misstated.
std::vector<double> exposuresOf(const vpStripeProfile &profile, double frequency)
{
  static const double longest = 0.3, sharp = 0.1; // periods: from the longest no way leads to sharp stripes
  static const double uncertain = 0.2, factor = 2.5; // of the stated one's logarithm
  std::vector<double> exposures{profile.exposure};
  if (profile.exposure * frequency > longest) {
    exposures.push_back(sharp / frequency);
  } else if (profile.logEdgeSigma() > uncertain) {
    exposures.push_back(factor * profile.exposure);
    exposures.push_back(profile.exposure / factor);
  }
  return exposures;
}

/*!
  Turns from the middle of the pulse that stripes show to the middle of the lamp's. Whole periods of the
  exposure see the same at any time, and what is left of it lies half a period off its middle for each of
  them.
*/
double turnsFromSeen(double frequency, double exposure)
{
  return 0.5 * std::floor(exposure * frequency);
}

//! Whether the exposure is about as stated.
bool asStated(const vpWaveformFit &fit, const vpStripeProfile &profile)
{
  static const double about = 0.35; // of the logarithm
  return std::abs(std::log(fit.value(vpWaveformFit::exposure) / profile.exposure)) < about;
}
} // namespace

vpPulseSearch::vpPulseSearch(const vpStripeProfile &profile, std::vector<double> envelope, int order,
                             const vpStripeAnalyzer &analyzer)
    : m_profile(&profile), m_envelope(std::move(envelope)), m_slowest(analyzer.minFrequency),
      m_maxMisfit(analyzer.maxMisfit)
{
  settings.modelError = analyzer.modelError;
  settings.exposureTolerance = analyzer.exposureTolerance;
  settings.envelopeOrder = order;
  m_edges = vpStripeStarts::edges(profile, m_envelope);
  takePulses(m_edges);
  if (!m_pulses) { // an envelope of few stripes may follow noise
    takePulses(vpStripeStarts::edges(profile, vpStripeStarts::envelope(profile, {}, 0)));
  }
}

void vpPulseSearch::takePulses(const std::vector<vpStripeStarts::Edge> &edges)
{
  m_gap = m_gap || (edges.size() == 2 && !edges.front().rising);
  m_pulses = vpStripeStarts::pulses(edges);
  if (m_pulses && m_pulses->frequency < m_slowest) {
    m_pulses.reset();
  }
}

vpPulseSearch vpPulseSearch::evenly(bool explained, const vpStripeAnalyzer &analyzer) const
{
  vpPulseSearch even(*m_profile, vpStripeStarts::envelope(*m_profile, {}, 0), 0, analyzer);
  if (m_pulses) {
    even.m_pulses = m_pulses;
    even.m_byPulses = explained;
  }
  return even;
}

bool vpPulseSearch::significant(double least)
{
  const bool soon =
      m_pulses && vpStripeStarts::sinusoidAt(*m_profile, m_envelope, settings.modelError, m_pulses->frequency)
                          .beyondBend >= least;
  return soon || (!candidates().empty() && m_clearest >= least);
}

const std::vector<vpStripeStarts::Sinusoid> &vpPulseSearch::candidates()
{
  static const size_t most = 3;
  if (!m_candidates) {
    m_candidates = vpStripeStarts::periodogram(*m_profile, m_envelope, settings.modelError);
    const auto clearest =
        std::max_element(m_candidates->begin(), m_candidates->end(),
                         [](const auto &a, const auto &b) { return a.beyondBend < b.beyondBend; });
    m_clearest = clearest == m_candidates->end() ? 0 : clearest->beyondBend;
    if (m_clearest > 0 && clearest->frequency < m_slowest && !m_gap) {
      m_candidates->clear();
    }
    m_candidates->resize(std::min(m_candidates->size(), most));
  }
  return *m_candidates;
}

//! Whether its frequency is that of the likeliest sinusoid.
bool vpPulseSearch::isLikeliest(const vpWaveformFit &fit)
{
  const double span = std::abs(m_profile->time.back() - m_profile->time.front());
  return std::abs(fit.value(vpWaveformFit::frequency) - candidates().front().frequency) * span < 1;
}

//! One pulse a period, from there. Nothing where it leads to none.
std::optional<vpWaveformFit> vpPulseSearch::fitFrom(const vpStripeStarts::Pulses &start,
                                                    double exposure) const
{
  vpWaveformFit fit(*m_profile, settings, m_envelope);
  return fit.run(start.frequency, start.phase, start.duty, 0, exposure) && fit.preferStatedExposure()
             ? std::make_optional(std::move(fit))
             : std::nullopt;
}

/*!
  From where the edges are. Stripes that repeat with the lines, and such as drift along them by a part of a
  line, leave the lines' light alike, but for an envelope that bends: from one no descent leads to the other.
*/
std::optional<vpWaveformFit> vpPulseSearch::fromPulses(double exposure) const
{
  using P = vpWaveformFit;
  static const double drift = 0.5, longer = 0.3; // lines: over the profile; a pulse
  vpStripeStarts::Pulses start = *m_pulses;
  start.phase += turnsFromSeen(start.frequency, exposure);
  std::optional<vpWaveformFit> best = fitFrom(start, exposure);
  if (best && best->repeats()) {
    const vpWaveformFit still = *best;
    const auto lines = static_cast<double>(m_profile->light.size());
    const double f = still.value(P::frequency),
                 perLine = f * std::abs(m_profile->time.back() - m_profile->time.front()) / lines; // periods
    for (const double away : {-drift, drift}) {
      for (const double more : {-longer, 0.0, longer}) {
        // The pulse's middle stays.
        const double longerBy = more * perLine, phase = still.value(P::phase) + 0.5 * longerBy;
        std::optional<vpWaveformFit> other = fitFrom(
            {f * (1 + away / lines), phase, still.value(P::duty) + longerBy, 0}, still.value(P::exposure));
        if (other) {
          keepBetter(best, std::move(*other));
        }
      }
    }
  }
  return best;
}

std::optional<vpWaveformFit> vpPulseSearch::onePulse(double explained)
{
  std::optional<vpWaveformFit> best;
  if (m_pulses) {
    for (double exposure : exposuresOf(*m_profile, m_pulses->frequency)) {
      if (std::optional<vpWaveformFit> fit = fromPulses(exposure)) {
        if (fit->misfit() > allExplained) {
          fit->leaveGap();
        }
        if (fit->misfit() < allExplained && asStated(*fit, *m_profile)) {
          return fit;
        }
        keepBetter(best, std::move(*fit));
      }
    }
  }
  if (m_byPulses || (best && best->misfit() < allExplained)) {
    return best;
  }
  for (const vpStripeStarts::Sinusoid &candidate : candidates()) {
    // Where a start has led to most of the stripes, others lead there, too, or to less of them; but lines
    // that leave gaps may show the edges of every other pulse alone.
    if (best && std::min(explained, best->misfit()) < m_maxMisfit && isLikeliest(*best)) {
      break;
    }
    std::vector<vpWaveformFit> begun;
    for (double exposure : exposuresOf(*m_profile, candidate.frequency)) {
      for (double duty : {0.15, 0.3, 0.5, 0.7, 0.85}) {
        // The first harmonic peaks in the middle of the pulse.
        begun.emplace_back(*m_profile, settings, m_envelope);
        begun.back().begin(candidate.frequency,
                           0.5 * duty - candidate.phase + turnsFromSeen(candidate.frequency, exposure), duty,
                           0, exposure);
      }
    }
    if (std::optional<vpWaveformFit> found = bestFrom(std::move(begun))) {
      found->leaveGap();
      keepBetter(best, std::move(*found));
    }
  }
  return best;
}

std::optional<vpWaveformFit> vpPulseSearch::twoPulses()
{
  vpWaveformFit::Settings both = settings;
  both.twoPulse = true;
  std::optional<vpWaveformFit> best;
  if (const std::optional<vpStripeStarts::Pulses> pulses = vpStripeStarts::pairsOfPulses(m_edges)) {
    vpWaveformFit fit(*m_profile, both, m_envelope);
    const double phase = pulses->phase + turnsFromSeen(pulses->frequency, m_profile->exposure);
    if (fit.run(pulses->frequency, phase, pulses->duty, pulses->phaseDifference) &&
        fit.preferStatedExposure()) {
      if (fit.misfit() < allExplained) {
        return fit;
      }
      keepBetter(best, std::move(fit));
    }
  }
  const double span = m_profile->time.back() - m_profile->time.front();
  for (const vpStripeStarts::Sinusoid &candidate : candidates()) {
    for (int multiple = 1; multiple <= 2; ++multiple) { // the second harmonic may be the stronger
      const double f = candidate.frequency / multiple;
      if (f * std::abs(span) < 0.9) {
        continue;
      }
      std::vector<vpWaveformFit> begun;
      for (double k : {0.15, 0.25, 0.35, 0.45}) {
        for (double phase : {0.0, 0.25, 0.5, 0.75}) {
          begun.emplace_back(*m_profile, both, m_envelope);
          begun.back().begin(f, phase, 0.3, k);
        }
      }
      if (std::optional<vpWaveformFit> found = bestFrom(std::move(begun))) {
        keepBetter(best, std::move(*found));
      }
    }
  }
  return best;
}

END_VISP_NAMESPACE
