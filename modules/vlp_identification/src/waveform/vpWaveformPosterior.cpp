/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpWaveformFit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "vpDutyRidge.h"
#include "vpStripeLimits.h"
#include "vpWaveformMoments.h"

BEGIN_VISP_NAMESPACE

//! Numbers between 0 and 1, the same each time.
class vpWaveformFit::Uniform
{
public:
  double operator()() { return (static_cast<double>(m_generator()) - 0.5) / 2147483646.; }

private:
  std::minstd_rand m_generator{1};
};

//! How much more than their noise says the lines are off, by what the model leaves out.
void vpWaveformFit::judgeResiduals()
{
  // What the model leaves out is alike on neighbouring lines: they say less together than each says alone.
  const Eigen::ArrayXd scaled = m_weight.sqrt() * residuals();
  const Eigen::Index pairs = scaled.size() - 1;
  const double along = (scaled.head(pairs) * scaled.tail(pairs)).sum();
  const double alike = along / std::max(m_chiSquare, 1e-12);
  const double together = std::clamp((1 + alike) / std::max(1 - alike, 0.1), 1.0, 10.0);
  // A variance told from few residuals may be any.
  const double degrees = degreesOfFreedom();
  // Timing is told by the lines in which light changes, which the model may be farther off (White 1980).
  const Eigen::ArrayXd timing = m_weight * (envelope() * m_wave.byTurn).square();
  const double atEdges =
      (timing * scaled.square()).sum() / std::max(timing.sum(), 1e-12) * static_cast<double>(scaled.size());
  m_inflation =
      std::max(1.0, together * std::max(m_chiSquare, atEdges) / degrees) * (1 + 6 / (degrees * degrees));
}

void vpWaveformFit::integrate()
{
  judgeResiduals();
  const Posterior found = posterior();
  m_x = found.mean;
  settle();
  const double misplaced = vpStripeLimits::untrue * gap() * m_x(frequency); // periods
  Vector extra = Vector::Zero();
  extra(duty) = extra(phaseDifference) = misplaced;
  extra(frequency) = misplaced / m_half;
  const double here = unlikely(m_x, m_coefficient[0]);
  for (const LookAlike &other : lookAlikes()) {
    extra(duty) =
        std::hypot(extra(duty), vpStripeLimits::spread(other.x(duty) - m_x(duty), other.unlikely - here));
  }
  m_sigma = (found.covariance.diagonal().cwiseMax(0) + extra.cwiseAbs2()).cwiseSqrt();
}

//! About the minimum at m_x.
vpWaveformFit::Posterior vpWaveformFit::posterior()
{
  // Where no line feels an edge, it lies within half the distance of two lines, about.
  Vector reach = Vector::Ones();
  reach(phase) = reach(duty) = reach(phaseDifference) = 0.5 * m_line * m_x(frequency);
  reach(frequency) = reach(phase) / m_half;
  reach(exposure) =
      std::max(m_logExposureSigma * m_x(exposure), std::abs(m_x(exposure) - m_profile->exposure));
  const Matrix wide = reach.cwiseAbs2().cwiseInverse().asDiagonal();
  Posterior bell{m_x, (m_curvature / m_inflation + wide).inverse()};
  // Where exposures follow each other without gaps, what moves few edges from line to line is as bell-shaped
  // as the noise.
  static const double sharp = 0.04; // lines: what one line alone leaves open of an edge in it
  const double open = (m_weight * m_given.square()).inverse().mean() * m_inflation;
  if (!leavesGaps() && open < sharp * sharp && !repeats()) {
    return bell;
  }
  // A line that an exposure of nearly a period shows two pulses of is not one pulse's alone.
  const double pulse = std::min(m_x(duty), 1 - m_x(duty)),
               exposed = m_x(exposure) * m_x(frequency); // periods
  return m_settings.twoPulse || pulse + exposed > 1 - m_line * m_x(frequency) ? sliced(bell) : onGrid(bell);
}

bool vpWaveformFit::hidesDuty() const
{
  static const double hidden = 2; // lines, of the pulse as it was fitted
  return !m_settings.twoPulse && m_x(duty) <= hidden * m_x(exposure) * m_x(frequency) && repeats();
}

bool vpWaveformFit::repeats() const
{
  static const double drift = 1.5;                // lines, of a pattern that repeats, over the profile
  static const int longest = 8;                   // lines, of such a pattern
  const double periods = m_x(frequency) * m_line; // of a line
  // A pulse that is shorter than the exposure shows both its edges to one line: of two such, it takes twice
  // as many lines to tell them all.
  const bool isShort = m_settings.twoPulse && 0.5 * m_x(duty) < m_x(exposure) * m_x(frequency);
  for (int pattern = 1; pattern <= (isShort ? 2 : 1) * longest; ++pattern) {
    if (std::abs(std::remainder(pattern * periods, 1)) * static_cast<double>(m_time.size()) < drift) {
      return true;
    }
  }
  return false;
}

std::vector<vpDutySlice> vpWaveformFit::alongDuty() const
{
  static const double step = 0.04, least = 0.06, // of the duty
      farthest = 25;                             // chi-square
  std::vector<vpDutySlice> slices;
  double best = std::numeric_limits<double>::infinity();
  for (const double direction : {-step, step}) {
    vpWaveformFit fit = *this;
    for (double at = m_x(duty) + (direction > 0 ? direction : 0); at > least && at < 1 - least;
         at += direction) {
      slices.push_back(fit.slice(at));
      best = std::min(best, slices.back().chiSquare);
      if (slices.back().chiSquare > best + farthest * m_inflation) {
        break;
      }
    }
  }
  for (vpDutySlice &slice : slices) {
    slice.chiSquare = (slice.chiSquare - best) / m_inflation;
  }
  std::sort(slices.begin(), slices.end(),
            [](const vpDutySlice &a, const vpDutySlice &b) { return a.duty < b.duty; });
  return vpDutyRidge::whereOpen(std::move(slices));
}

//! With a given duty, from the nearest one's minimum.
vpDutySlice vpWaveformFit::slice(double atDuty)
{
  m_freeDuty = false;
  m_x(phase) += 0.5 * (atDuty - m_x(duty)); // the pulse's middle stays
  m_x(duty) = atDuty;
  descend(20);
  const Vector minimum = m_x;
  const double least = m_cost;
  const Posterior found = posterior();
  m_x = minimum;
  return {atDuty, found.mean(frequency), std::sqrt(std::max(0.0, found.covariance(frequency, frequency))),
          least};
}

//! Of the frequency of a sinusoid as strong and as noisy, Hz.
double vpWaveformFit::sinusoidSigma() const
{
  // Of all lines that there might be: those that there are may all miss the brightest moment.
  static const int moments = 64;
  vpPulseWave period, second;
  evaluateWave(m_x, Eigen::ArrayXd::LinSpaced(moments, 0, (moments - 1) / (moments * m_x(frequency))), period,
               second);
  const double swing = period.value.maxCoeff() - period.value.minCoeff();
  const Eigen::ArrayXd information = 0.5 / m_inflation * m_weight * (0.5 * swing * envelope()).square();
  const double weight = information.sum(), mean = (information * m_time).sum() / weight,
               spread = (information * (m_time - mean).square()).sum();
  return 1 / (2 * M_PI * std::sqrt(std::max(spread, 1e-300)));
}

double vpWaveformFit::frequencyBound() const
{
  // Edges that lie in a gap are anywhere in it; a line through all of them over the time has this slope's
  // error.
  const double f = m_x(frequency);
  const double edges = std::max(2.0, 2 * m_half * 2 * pulses() * f);
  return std::hypot(sinusoidSigma(), f * gap() / (2 * m_half * std::sqrt(edges)));
}

double vpWaveformFit::frequencyNoise() const
{
  return gap() > 0 || repeats() ? std::min(m_sigma(frequency), sinusoidSigma()) : m_sigma(frequency);
}

/*!
  Mean and covariance of exp(-cost / (2 inflation)) by slice sampling (Neal 2003) from the minimum, which
  needs no shape to be right: first hot, which finds a deeper minimum where walls hide it and tells the axes
  of the shape; then as it is. Along a ridge samples change slowly: it goes on, each time as long again and
  along the axes of all samples so far, until the mean holds.
*/
vpWaveformFit::Posterior vpWaveformFit::sliced(const Posterior &bell)
{
  static const int hotSweeps = 10, leastSweeps = 20, mostSweeps = 1280;
  static const double hot = 32, // temperature
      holds = 1 / 3.;           // standard deviations, from one half of the samples to the other
  Uniform uniform;
  Vector x = m_x;
  const Moments first = sweep(bell.covariance, hotSweeps, hot, x, uniform);
  if (first.leastCost() < m_cost) {
    m_x = first.likeliest();
    descend(hotSweeps);
    judgeResiduals();
  }
  x = m_x;
  Moments all = sweep(first.covariance(), leastSweeps, 1, x, uniform);
  bool held = false;
  for (int sweeps = leastSweeps; !held && 2 * sweeps <= mostSweeps; sweeps *= 2) {
    const Moments again = sweep(all.covariance(), sweeps, 1, x, uniform);
    held = all.isNear(again, holds);
    all.add(again);
  }
  return {all.mean(), all.covariance()};
}

//! Samples of exp(-cost / (2 inflation temperature)) from \e x on, along the axes of a covariance. \param x
//! Becomes the last one.
vpWaveformFit::Moments vpWaveformFit::sweep(const Matrix &covariance, int sweeps, double temperature,
                                            Vector &x, Uniform &uniform)
{
  // Axes of the correlations: the parameters have units of their own.
  Vector scale = covariance.diagonal().cwiseMax(0).cwiseSqrt();
  for (int p = 0; p < parameters; ++p) {
    scale(p) = isFree(p) ? std::max(scale(p), 1e-9 * std::abs(m_x(p))) : 0;
  }
  const Vector perScale = scale.unaryExpr([](double s) { return s > 0 ? 1 / s : 0; });
  const Eigen::SelfAdjointEigenSolver<Matrix> shape(perScale.asDiagonal() * covariance *
                                                    perScale.asDiagonal());
  const Matrix axes =
      scale.asDiagonal() * shape.eigenvectors() * shape.eigenvalues().cwiseMax(1e-9).cwiseSqrt().asDiagonal();
  Vector width = Vector::Constant(2 * std::sqrt(temperature));
  double here = cost(x);
  Moments moments(m_x);
  for (int k = 0; k < sweeps * parameters; ++k) {
    const int which = k % parameters;
    const Vector axis = axes.col(which);
    if (!axis.isZero(0)) {
      width(which) = slice(axis, width(which), here - 2 * m_inflation * temperature * std::log(uniform()), x,
                           here, uniform);
      moments.add(x, 1, here);
    }
  }
  return moments;
}

/*!
  One step of slice sampling: moves \e x, whose cost is \e here, along \e axis to where the cost is below \e
  level. \return Length of the stretch that it was drawn from, a good one to begin with next time.
*/
double vpWaveformFit::slice(const Vector &axis, double width, double level, Vector &x, double &here,
                            Uniform &uniform)
{
  auto costAt = [&](double step) {
    const Vector there = x + step * axis;
    return isPossible(there) ? cost(there) : std::numeric_limits<double>::infinity();
  };
  static const int mostWidths = 6;
  double from = -width * uniform(), to = from + width;
  for (int k = 0; k < mostWidths && costAt(from) < level; ++k) {
    from -= width;
  }
  for (int k = 0; k < mostWidths && costAt(to) < level; ++k) {
    to += width;
  }
  static const int mostDraws = 12;
  for (int k = 0; k < mostDraws; ++k) {
    const double step = from + (to - from) * uniform(), there = costAt(step);
    if (there < level) {
      x += step * axis;
      here = there;
      break;
    }
    (step < 0 ? from : to) = step;
  }
  return to - from;
}

/*!
  Chi-square of pulse, exposure and offset, and not those of a profile that looks alike. \param darkest Light
  of the dark lamp, grey levels.
*/
double vpWaveformFit::unlikely(const Vector &x, double darkest) const
{
  return vpStripeLimits::unlikely(x(exposure) / m_profile->exposure, m_logEdgeSigma, x(duty)) +
         m_darkness * darkest * darkest;
}

/*!
  What pulse and exposure would be were each taken for the other, each for the dark rest of the period, or
  both: of the same shape, but for what light the dark lamp has. After settle().
*/
std::vector<vpWaveformFit::LookAlike> vpWaveformFit::lookAlikes() const
{
  const double pulse = m_x(duty) / pulses(), exposed = m_x(exposure) * m_x(frequency); // periods
  const double dark = m_coefficient[0];
  std::vector<LookAlike> found;
  auto add = [&](double otherPulse, double otherExposure, double offset) {
    static const double wholePeriod = 0.98;
    const double exposed = otherExposure / m_x(frequency);
    const bool possible = otherPulse * pulses() <= wholePeriod && otherPulse > 1 - wholePeriod &&
                          exposed > m_leastExposure && exposed < m_mostExposure &&
                          offset >= leastOffset(m_coefficient[1]);
    if (possible) {
      LookAlike other{m_x, 0};
      other.x(phase) += 0.5 * (otherPulse - pulse); // the pulse's middle stays
      other.x(duty) = otherPulse * pulses();
      other.x(exposure) = otherExposure / m_x(frequency);
      other.unlikely = unlikely(other.x, offset);
      found.push_back(other);
    }
  };
  add(exposed, pulse, dark);
  if (!m_settings.twoPulse) {
    // Boxes that overlap by more than a period are nowhere apart.
    const double light = m_coefficient[1] * m_given(m_given.size() / 2),
                 never = dark + light * (pulse + exposed - 1) / exposed;
    add(1 - exposed, 1 - pulse, never);
    add(1 - pulse, 1 - exposed, never);
  }
  return found;
}

bool vpWaveformFit::preferStatedExposure()
{
  const std::vector<LookAlike> others = lookAlikes();
  const auto least =
      std::min_element(others.begin(), others.end(), [](const LookAlike &one, const LookAlike &other) {
        return one.unlikely < other.unlikely;
      });
  if (least == others.end() || unlikely(m_x, m_coefficient[0]) <= least->unlikely) {
    return true;
  }
  // The fit from there may find its way back.
  const Vector &x = least->x;
  return run(x(frequency), x(phase), x(duty), x(phaseDifference), x(exposure));
}

END_VISP_NAMESPACE
