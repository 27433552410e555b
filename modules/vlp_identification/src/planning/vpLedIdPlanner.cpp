/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_identification/vpLedIdPlanner.h>

#include <algorithm>
#include <cmath>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "recognition/vpNormalTail.h"
#include "vpFrequencyRows.h"

BEGIN_VISP_NAMESPACE

namespace
{
void demand(bool good, const char *what, double came, const char *expected)
{
  if (!good) {
    throw vpException(vpException::badValue,
                      std::string(what) + ": " + vpNumberText(came) + ", expected " + expected);
  }
}

//! The largest set of rows. \param ofDuty Share of error and refusal that neighbours in duty may cause.
std::vector<vpModulation> most(const vpFrequencyRows &rows, const vpLedIdPlanner &planner, double ofDuty)
{
  std::vector<vpModulation> best;
  for (unsigned int set = 1; set < rows.sets(); ++set) {
    const double share = vpFrequencyRows::several(set) ? ofDuty : 0;
    std::vector<vpModulation> lamps =
        rows.filled(set, planner.neededDistance(1 - share), planner.neededDistance(share > 0 ? share : 1));
    if (lamps.size() > best.size()) {
      best = std::move(lamps);
    }
  }
  return best;
}

bool isGood(double error, double acceptance, const vpLedIdPlanner &planner)
{
  return error <= planner.maxError && acceptance >= planner.minAcceptance;
}

struct Placed {
  const vpModulation *lamp;
  vpStripeUncertainty sigma;
};

//! In standard deviations; 0 of lamps whose stripes tell nothing.
double distanceOf(const Placed &a, const Placed &b)
{
  const double distance =
      std::hypot((a.lamp->frequency - b.lamp->frequency) / std::max(a.sigma.frequency, b.sigma.frequency),
                 (*a.lamp->duty - *b.lamp->duty) / std::max(a.sigma.duty, b.sigma.duty));
  return std::isnan(distance) ? 0 : distance;
}

//! A plan with what may become of each of its lamps.
class Judgement
{
public:
  Judgement(const vpLedIdPlanner &planner, std::vector<vpModulation> identifiers, double lines,
            double oscillatorPpm);

  bool good() const { return isGood(plan.error, plan.acceptance, *m_planner); }
  //! The lamps but for those that fall short, of neighbours the worst alone.
  std::vector<vpModulation> others() const;

  vpLedIdPlan plan;

private:
  const vpLedIdPlanner *m_planner;
  double m_largestSigma = 0;           // Hz
  std::vector<double> m_wrong, m_none; // probabilities: another one's id, no id

  static constexpr double m_far = 14; // standard deviations, from where on a neighbour does no harm
};

Judgement::Judgement(const vpLedIdPlanner &planner, std::vector<vpModulation> identifiers, double lines,
                     double oscillatorPpm)
    : m_planner(&planner)
{
  plan.identifiers = std::move(identifiers);
  std::sort(plan.identifiers.begin(), plan.identifiers.end(),
            [](const vpModulation &a, const vpModulation &b) {
              return std::make_pair(a.frequency, *a.duty) < std::make_pair(b.frequency, *b.duty);
            });
  std::vector<Placed> placed;
  for (const vpModulation &lamp : plan.identifiers) {
    placed.push_back({&lamp, planner.prediction.uncertainty(lamp, lines, oscillatorPpm)});
    m_largestSigma = std::max(m_largestSigma, placed.back().sigma.frequency);
  }
  const double odds = std::log(planner.minConfidence / (1 - planner.minConfidence));
  m_wrong.assign(placed.size(), 0);
  m_none.assign(placed.size(), planner.refusedByGates());
  for (size_t i = 0; i < placed.size(); ++i) {
    for (size_t j = i + 1; j < placed.size(); ++j) {
      const double along = (placed[j].lamp->frequency - placed[i].lamp->frequency) / m_largestSigma;
      if (along > std::max(m_far, std::min(plan.separation, 1e6))) {
        break;
      }
      const double distance = distanceOf(placed[i], placed[j]);
      plan.separation = std::min(plan.separation, distance);
      const double wrong = vpNormalTail(0.5 * distance);
      const double undecided = distance > 0 ? vpNormalTail(0.5 * distance - odds / distance) : 1;
      for (const size_t k : {i, j}) {
        m_wrong[k] += wrong;
        m_none[k] += undecided;
      }
    }
  }
  if (!placed.empty()) {
    plan.error = std::min(1.0, *std::max_element(m_wrong.begin(), m_wrong.end()));
    plan.acceptance = std::max(0.0, 1 - *std::max_element(m_none.begin(), m_none.end()));
  }
}

std::vector<vpModulation> Judgement::others() const
{
  std::vector<size_t> worstFirst;
  for (size_t i = 0; i < m_wrong.size(); ++i) {
    if (!isGood(m_wrong[i], 1 - m_none[i], *m_planner)) {
      worstFirst.push_back(i);
    }
  }
  const auto shortfall = [this](size_t i) {
    return std::max(m_wrong[i] / m_planner->maxError, m_none[i] / (1 - m_planner->minAcceptance));
  };
  std::stable_sort(worstFirst.begin(), worstFirst.end(),
                   [&](size_t a, size_t b) { return shortfall(a) > shortfall(b); });
  std::vector<bool> out(m_wrong.size(), false);
  std::vector<double> gone; // Hz
  for (const size_t i : worstFirst) {
    const double frequency = plan.identifiers[i].frequency;
    if (std::none_of(gone.begin(), gone.end(),
                     [&](double other) { return std::abs(other - frequency) < m_far * m_largestSigma; })) {
      out[i] = true;
      gone.push_back(frequency);
    }
  }
  std::vector<vpModulation> left;
  for (size_t i = 0; i < out.size(); ++i) {
    if (!out[i]) {
      left.push_back(plan.identifiers[i]);
    }
  }
  return left;
}

/*!
  The same, judged. A lamp of a large sigma has many neighbours in duty, so the first share may be too large;
  and sigma may peak between the frequencies at which the rows know it: then those are left out whom it
  concerns.
*/
vpLedIdPlan mostGood(vpFrequencyRows &rows, const vpLedIdPlanner &planner, double lines, double oscillatorPpm)
{
  rows.setOscillator(oscillatorPpm);
  vpLedIdPlan best;
  for (double ofDuty = 0.1; ofDuty > 1e-4; ofDuty *= 0.3) {
    Judgement judgement(planner, most(rows, planner, ofDuty), lines, oscillatorPpm);
    if (judgement.good()) {
      return judgement.plan;
    }
    while (!judgement.good() && judgement.plan.identifiers.size() > best.identifiers.size()) {
      judgement = Judgement(planner, judgement.others(), lines, oscillatorPpm);
    }
    if (judgement.plan.identifiers.size() > best.identifiers.size()) {
      best = std::move(judgement.plan);
    }
  }
  return best;
}
} // namespace

void vpLedIdPlanner::checkSettings() const
{
  const char *const probability = "a probability above 0 and below 0.5";
  demand(maxError > 0 && maxError < 0.5, "error", maxError, probability);
  demand(minAcceptance >= 0.5 && minAcceptance < 1 - refusedByGates(), "acceptance", minAcceptance,
         ("a probability from 0.5 to below " + vpNumberText(1 - refusedByGates()) + ", what the gates leave")
             .c_str());
  demand(minConfidence >= 0.5 && minConfidence < 1, "confidence", minConfidence,
         "a probability from 0.5 to below 1");
  demand(!duties.empty() && duties.size() <= 8, "duties: number of them", static_cast<double>(duties.size()),
         "1 to 8");
  for (const double duty : duties) {
    demand(duty > 0 && duty < 1, "duties", duty, "numbers between 0 and 1 (both excluded)");
  }
  demand(std::isfinite(frequencyStep) && frequencyStep > 0, "frequency step", frequencyStep,
         "a number of Hz above 0");
  demand(std::isfinite(clock) && clock >= 0, "clock", clock, "a number of Hz from 0 up");
  demand(std::isfinite(prediction.snrDb), "SNR", prediction.snrDb, "a finite number of dB");
  demand(prediction.margin > 0, "margin", prediction.margin, "a number above 0");
}

double vpLedIdPlanner::lowest(double lines) const
{
  if (!std::isnan(lowestFrequency)) {
    return lowestFrequency;
  }
  return std::max(flicker, leastStripes / (lines * prediction.lineTime()));
}

double vpLedIdPlanner::highest() const
{
  if (!std::isnan(highestFrequency)) {
    return std::min(highestFrequency, prediction.fold());
  }
  return std::min(prediction.frequencyOfContrast(leastContrast), foldShare * prediction.fold());
}

double vpLedIdPlanner::made(double rate) const
{
  static const double perHertz = 1000;
  return clock > 0 ? std::round(perHertz * clock / std::round(clock / rate)) / perHertz : rate;
}

double vpLedIdPlanner::refusedByGates() const
{
  return 2 * vpNormalTail(gate) + 2 * vpNormalTail(shapeGate);
}

double vpLedIdPlanner::neededDistance(double share) const
{
  const double forError = 2 * vpNormalTailAt(0.5 * share * maxError);
  const double t = vpNormalTailAt(0.5 * share * (1 - minAcceptance - refusedByGates()));
  const double odds = std::log(minConfidence / (1 - minConfidence));
  return std::max(forError, t + std::sqrt(t * t + 2 * odds));
}

std::vector<size_t> vpLedIdPlanner::capacities(double lines, const std::vector<double> &oscillatorsPpm) const
{
  checkSettings();
  vpFrequencyRows rows(*this, lines);
  std::vector<size_t> capacities;
  for (const double ppm : oscillatorsPpm) {
    capacities.push_back(mostGood(rows, *this, lines, ppm).identifiers.size());
  }
  return capacities;
}

size_t vpLedIdPlanner::bins(double lines) const
{
  const double range = highest() - lowest(lines);
  return range < 0 ? 0 : static_cast<size_t>(range * lines * prediction.lineTime()) + 1;
}

vpLedIdPlan vpLedIdPlanner::largest(double lines, double oscillatorPpm) const
{
  checkSettings();
  vpFrequencyRows rows(*this, lines);
  return mostGood(rows, *this, lines, oscillatorPpm);
}

vpLedIdPlan vpLedIdPlanner::spread(double lines, double oscillatorPpm, size_t count) const
{
  checkSettings();
  vpFrequencyRows rows(*this, lines);
  rows.setOscillator(oscillatorPpm);
  std::vector<vpModulation> best;
  double widest = 0;
  for (unsigned int set = 1; set < rows.sets() && count > 0; ++set) {
    double low = 0, high = rows.widest();
    std::vector<vpModulation> lamps = rows.filled(set, low, low);
    const bool enough = lamps.size() >= count;
    for (int i = 0; i < 40 && enough && high > widest; ++i) { // what cannot be better need not be known
      const double middle = 0.5 * (low + high);
      std::vector<vpModulation> wider = rows.filled(set, middle, middle);
      if (wider.size() >= count) {
        low = middle;
        lamps = std::move(wider);
      } else {
        high = middle;
      }
    }
    if (enough ? low > widest || best.size() < count : lamps.size() > best.size()) {
      widest = low;
      best = std::move(lamps);
    }
  }
  best.resize(std::min(best.size(), count));
  vpLedIdPlan plan = judged(best, lines, oscillatorPpm);
  if (!isGood(plan.error, plan.acceptance,
              *this)) { // near the limit, where duty needs more room than frequency
    std::vector<vpModulation> all = mostGood(rows, *this, lines, oscillatorPpm).identifiers;
    if (all.size() >= count) {
      all.resize(count);
      return judged(all, lines, oscillatorPpm);
    }
  }
  return plan;
}

vpLedIdPlan vpLedIdPlanner::judged(std::vector<vpModulation> identifiers, double lines,
                                   double oscillatorPpm) const
{
  return Judgement(*this, std::move(identifiers), lines, oscillatorPpm).plan;
}

END_VISP_NAMESPACE
