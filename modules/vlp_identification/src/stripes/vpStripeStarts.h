/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpStripeStarts_h
#define vpStripeStarts_h

#include <optional>
#include <vector>

#include <visp3/vlp_identification/vpStripeAnalyzer.h>

BEGIN_VISP_NAMESPACE

//! Where a fit of a blinking lamp to its profile may start.
namespace vpStripeStarts
{

/*!
  Lines of the bright stripes: alternating highs and lows, each standing out from the one before by four
  standard deviations and by three tenths of itself. Works alike for stripes of a few grey levels and of two
  hundred.
*/
std::vector<size_t> peaks(const vpStripeProfile &profile);

//! Those that are surely as bright as the lamp: one on the profile's first or last line may be the end of a
//! stripe whose rest is not seen.
std::vector<size_t> wholePeaks(const vpStripeProfile &profile, std::vector<size_t> peaks);

/*!
  How bright the lamp is at each line while it is lit, grey levels: the exponential of a polynomial of the
  given order through the logarithms of the peaks' heights. Of no peaks, that of a lamp as bright all over.
*/
std::vector<double> envelope(const vpStripeProfile &profile, const std::vector<size_t> &peaks, int order);

//! The same of a lamp that blinks about so fast (Hz), whatever its pattern: the most light within half a
//! period, smoothed over a period.
std::vector<double> envelopeOfPeriod(const vpStripeProfile &profile, double frequency);

/*!
  The same of an emitter whose light grows or falls within a stripe by as much as that of a hot spot: each
  stripe has a slope of its own. \param peaks One at least.
*/
std::vector<double> envelopeOfStripes(const vpStripeProfile &profile, const std::vector<size_t> &peaks);

struct Sinusoid {
  double frequency;  // Hz
  double phase;      // periods, of its maximum, at the middle of the profile
  double gain;       // in chi-square over a level and a slope
  double beyondBend; // the same, over an emitter without stripes: a level, a slope and a bend
};

/*!
  Least-squares periodogram of the profile with its envelope divided out: at each frequency a sinusoid beside
  a level and a slope. Local maxima of the gain, the best first.
*/
std::vector<Sinusoid> periodogram(const vpStripeProfile &profile, const std::vector<double> &envelope,
                                  double modelError);

//! The same at one frequency, Hz.
Sinusoid sinusoidAt(const vpStripeProfile &profile, const std::vector<double> &envelope, double modelError,
                    double frequency);

struct Edge {
  double time; // s, from the middle of the profile
  bool rising;
};

//! Times at which the profile crosses half its envelope, where the stripes are wide enough to show them.
std::vector<Edge> edges(const vpStripeProfile &profile, const std::vector<double> &envelope);

struct Pulses {
  double frequency;       // Hz
  double phase;           // periods, at the middle of the profile: a first pulse begins where it is whole
  double duty;            // lit share of the period
  double phaseDifference; // periods, of two pulses
};

//! One pulse a period: least squares of rises at t0 + m T and falls at t0 + (m + duty) T. Nothing where three
//! edges or more do not agree on that.
std::optional<Pulses> pulses(const std::vector<Edge> &edges);

//! The same of two pulses a period; nothing of less than six edges.
std::optional<Pulses> pairsOfPulses(const std::vector<Edge> &edges);

} // namespace vpStripeStarts

END_VISP_NAMESPACE

#endif
