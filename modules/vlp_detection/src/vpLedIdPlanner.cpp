/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_detection/vpLedIdPlanner.h>

#include <algorithm>
#include <cmath>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "vpFrequencyRows.h"
#include "vpNormalTail.h"

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

bool isGood(const vpLedIdPlan &plan, const vpLedIdPlanner &planner)
{
  return plan.error <= planner.maxError && plan.acceptance >= planner.minAcceptance;
}

//! The same, judged. A lamp of much doubt has many neighbours in duty, so the first share may be too large.
vpLedIdPlan mostGood(vpFrequencyRows &rows, const vpLedIdPlanner &planner, double lines, double oscillatorPpm)
{
  rows.setOscillator(oscillatorPpm);
  vpLedIdPlan plan;
  for (double ofDuty = 0.1; ofDuty > 1e-4; ofDuty *= 0.3) {
    plan = planner.judged(most(rows, planner, ofDuty), lines, oscillatorPpm);
    if (isGood(plan, planner)) {
      break;
    }
  }
  return plan;
}

struct Placed {
  const vpModulation *lamp;
  vpStripeDoubt doubt;
};

double distanceOf(const Placed &a, const Placed &b)
{
  return std::hypot((a.lamp->frequency - b.lamp->frequency) / std::max(a.doubt.frequency, b.doubt.frequency),
                    (*a.lamp->duty - *b.lamp->duty) / std::max(a.doubt.duty, b.doubt.duty));
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
  const vpLedIdPlan plan = judged(best, lines, oscillatorPpm);
  if (!isGood(plan, *this)) { // near the limit, where duty needs more room than frequency
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
  vpLedIdPlan plan;
  plan.identifiers = std::move(identifiers);
  std::sort(plan.identifiers.begin(), plan.identifiers.end(),
            [](const vpModulation &a, const vpModulation &b) {
              return std::make_pair(a.frequency, *a.duty) < std::make_pair(b.frequency, *b.duty);
            });
  std::vector<Placed> placed;
  double largestDoubt = 0;
  for (const vpModulation &lamp : plan.identifiers) {
    placed.push_back({&lamp, prediction.doubt(lamp, lines, oscillatorPpm)});
    largestDoubt = std::max(largestDoubt, placed.back().doubt.frequency);
  }
  static const double far = 14; // standard deviations, from where on a neighbour does no harm
  const double odds = std::log(minConfidence / (1 - minConfidence));
  std::vector<double> error(placed.size(), 0), refused(placed.size(), refusedByGates());
  for (size_t i = 0; i < placed.size(); ++i) {
    for (size_t j = i + 1; j < placed.size(); ++j) {
      const double along = (placed[j].lamp->frequency - placed[i].lamp->frequency) / largestDoubt;
      if (along > std::max(far, std::min(plan.separation, 1e6))) {
        break;
      }
      const double distance = distanceOf(placed[i], placed[j]);
      plan.separation = std::min(plan.separation, distance);
      const double wrong = vpNormalTail(0.5 * distance);
      const double doubtful = distance > 0 ? vpNormalTail(0.5 * distance - odds / distance) : 1;
      for (const size_t k : {i, j}) {
        error[k] += wrong;
        refused[k] += doubtful;
      }
    }
  }
  if (!placed.empty()) {
    plan.error = std::min(1.0, *std::max_element(error.begin(), error.end()));
    plan.acceptance = std::max(0.0, 1 - *std::max_element(refused.begin(), refused.end()));
  }
  return plan;
}

END_VISP_NAMESPACE
