/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPulseSearch_h
#define vpPulseSearch_h

#include <optional>
#include <vector>

#include "vpStripeStarts.h"
#include "waveform/vpWaveformFit.h"

BEGIN_VISP_NAMESPACE

//! The pulses that explain the stripes best, were the lamp that bright while it is lit.
class vpPulseSearch
{
public:
  static constexpr double allExplained = 0.01; // misfit: no other start will do better

  vpWaveformFit::Settings settings;

  //! \param envelope Of each line, grey levels, about. \param order Bends that it may have beyond that.
  vpPulseSearch(const vpStripeProfile &profile, std::vector<double> envelope, int order,
                const vpStripeAnalyzer &analyzer);

  /*!
    The same lamp, were it as bright all over: the fewest unknowns. A pulse that lies between two lines looks
    dim, and an envelope that may bend takes it for a dim part of the lamp. \param explained Whether the bent
    one explains the stripes.
  */
  vpPulseSearch evenly(bool explained, const vpStripeAnalyzer &analyzer) const;

  //! Whether there are stripes at all: a sinusoid explains that much more than level, slope and bend.
  bool significant(double least);
  /*!
    The likeliest sinusoids, the best first. None where the one that stands out the most is slower than any
    lamp: what shades a lamp, or a room, changes slowly. Two stripes with one gap are exempt: cut short, they
    look slow.
  */
  const std::vector<vpStripeStarts::Sinusoid> &candidates();
  //! Whether no more shows than where one stripe begins, ends, or both.
  bool isOneStripe() const { return !m_edges.empty() && m_edges.size() < 3 && !m_gap; }

  //! \param explained Misfit of the best fit so far, with another envelope.
  std::optional<vpWaveformFit> onePulse(double explained = 1);
  std::optional<vpWaveformFit> twoPulses();

private:
  bool isLikeliest(const vpWaveformFit &fit);
  std::optional<vpWaveformFit> fitFrom(const vpStripeStarts::Pulses &start, double exposure) const;
  std::optional<vpWaveformFit> fromPulses(double exposure) const;
  void takePulses(const std::vector<vpStripeStarts::Edge> &edges);

  const vpStripeProfile *m_profile;
  std::vector<double> m_envelope;
  double m_slowest;   // Hz
  double m_maxMisfit; // of a lamp
  std::vector<vpStripeStarts::Edge> m_edges;
  std::optional<vpStripeStarts::Pulses> m_pulses;
  bool m_gap = false;      // all that shows is parts of two stripes and the gap between them
  bool m_byPulses = false; // what the edges say is all there is to try
  std::optional<std::vector<vpStripeStarts::Sinusoid>> m_candidates;
  double m_clearest = 0; // what the one of all sinusoids explains that does so the most, beyond a bend
};

END_VISP_NAMESPACE

#endif
