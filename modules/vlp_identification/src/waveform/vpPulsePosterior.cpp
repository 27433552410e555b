/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPulsePosterior.h"

#include <algorithm>
#include <cmath>

#include "vpStripeLimits.h"

BEGIN_VISP_NAMESPACE

namespace
{
const double beyond = 1.2; // halves of the profile, to where the middles of its pulses are

//! Places along one axis of the grid: from -reach to +reach about the middle.
struct Axis {
  int count;
  double middle, reach;

  double step() const { return count > 1 ? 2 * reach / (count - 1) : 0; }
  double at(int i) const { return count > 1 ? middle - reach + i * step() : middle; }
  //! The same over places \e first to \e last and a step beyond; where these are most of it, more finely.
  void narrow(int first, int last)
  {
    if (count == 1) {
      return;
    }
    const double from = at(first) - step(), to = at(last) + step();
    static const int most = 20;
    if (2 * (last - first) > count && count < most) {
      count = 2 * count - 1;
    }
    middle = 0.5 * (from + to);
    reach = 0.5 * (to - from);
  }
};
} // namespace

//! The grid. Frequencies are those by which the first and the last line move, in seconds; phases are delays
//! of all pulses, s; lengths are of a pulse, s.
struct vpPulsePosterior::Range {
  Axis frequency, delay, length;

  //! Pulses that are shorter than any are left out.
  void cutAt(double shortest, double step)
  {
    if (length.count > 1 && length.middle - length.reach < shortest) {
      const double longest = length.middle + length.reach;
      length.middle = 0.5 * (shortest + longest);
      length.reach = std::max(0.5 * (longest - shortest), 1e-3 * step);
    }
  }
};

//! What of a grid is likely.
struct vpPulsePosterior::Places {
  int first[3] = {1 << 20, 1 << 20, 1 << 20}, last[3] = {-1, -1, -1}; // frequency, delay, length
};

//! One pulse, tabled by its delay.
struct vpPulsePosterior::Pulse {
  double middle;           // s, at the start
  Eigen::Index first, end; // lines that it may light
  Eigen::ArrayXf shares, products, squares;
};

vpPulsePosterior::vpPulsePosterior(const Lines &lines, const Eigen::Vector3d &start)
    : m_lines(lines), m_start(start), m_inverted(start(2) > 0.5),
      m_length((m_inverted ? 1 - start(2) : start(2)) / start(0)),
      m_half(0.5 * std::abs(lines.time(lines.time.size() - 1) - lines.time(0)))
{
  const Eigen::ArrayXf above = lines.light - static_cast<float>(lines.dark);
  m_weights = lines.weight.sum();
  m_lights = (lines.weight * above).sum();
  m_squares = (lines.weight * above.square()).sum();
  const double lit = m_inverted ? 0.5 * (1 + start(2)) : 0.5 * start(2); // periods, to the pulse's middle
  const double shift = lit - start(1), first = lines.time(0), last = lines.time(lines.time.size() - 1);
  const bool backwards = last < first;
  const double from = std::min(first, last), to = std::max(first, last), period = 1 / start(0);
  Eigen::Index next = backwards ? lines.time.size() : 0;
  for (double k = std::ceil(from * start(0) - shift - 0.5); (k + shift - 0.5) * period <= to; ++k) {
    Pulse pulse{(k + shift) * period, next, next, {}, {}, {}};
    const auto end = static_cast<float>(pulse.middle + 0.5 * period);
    if (backwards) {
      while (pulse.first > 0 && lines.time(pulse.first - 1) < end) {
        --pulse.first;
      }
      next = pulse.first;
    } else {
      while (pulse.end < lines.time.size() && lines.time(pulse.end) < end) {
        ++pulse.end;
      }
      next = pulse.end;
    }
    if (pulse.end > pulse.first) {
      m_pulses.push_back(std::move(pulse));
    }
  }
}

//! All pulses of one length at all delays that the grid asks for.
void vpPulsePosterior::tabulate(const Range &range, double length)
{
  const double step = range.delay.step(), exposure = m_lines.exposure;
  const double farthest =
      range.delay.reach + beyond * (std::abs(range.frequency.middle) + range.frequency.reach) + 2 * step;
  const auto count = static_cast<Eigen::Index>(2 * std::ceil(farthest / step) + 1);
  const Eigen::ArrayXf delay = Eigen::ArrayXf::LinSpaced(count, static_cast<float>(-(count - 1) * 0.5 * step),
                                                         static_cast<float>((count - 1) * 0.5 * step)) +
                               static_cast<float>(range.delay.middle);
  const auto half = static_cast<float>(0.5 * length), reach = static_cast<float>(0.5 * exposure),
             perExposure = static_cast<float>(1 / exposure), dark = static_cast<float>(m_lines.dark);
  Eigen::ArrayXf share;
  for (Pulse &pulse : m_pulses) {
    pulse.shares.setZero(count);
    pulse.products.setZero(count);
    pulse.squares.setZero(count);
    for (Eigen::Index i = pulse.first; i < pulse.end; ++i) {
      const float lit = m_lines.lit(i), weight = m_lines.weight(i), above = m_lines.light(i) - dark,
                  from = m_lines.time(i) - static_cast<float>(pulse.middle);
      share = ((from - delay + reach).min(half) - (from - delay - reach).max(-half)).max(0) * perExposure;
      if (m_inverted) {
        share = 1 - share;
      }
      pulse.shares += weight * lit * share;
      pulse.products += weight * lit * above * share;
      pulse.squares += weight * lit * lit * share.square();
    }
  }
}

//! Sums over all pulses at all delays of the grid, at one frequency: the delay of the last line by it, s.
void vpPulsePosterior::addPulses(const Range &range, double ofFrequency)
{
  const Eigen::Index n = range.delay.count;
  m_shares.setZero(n);
  m_products.setZero(n);
  m_shareSquares.setZero(n);
  const double step = range.delay.step();
  for (const Pulse &pulse : m_pulses) {
    const double middle =
                     0.5 * static_cast<double>(pulse.shares.size() - 1) - 0.5 * static_cast<double>(n - 1),
                 at = middle + std::clamp(pulse.middle / m_half, -beyond, beyond) * ofFrequency / step;
    const auto first = static_cast<Eigen::Index>(
        std::clamp(std::floor(at), 0.0, static_cast<double>(pulse.shares.size() - n - 1)));
    const auto part = static_cast<float>(at - static_cast<double>(first));
    auto between = [&](const Eigen::ArrayXf &table) {
      return (1 - part) * table.segment(first, n) + part * table.segment(first + 1, n);
    };
    m_shares += between(pulse.shares);
    m_products += between(pulse.products);
    m_shareSquares += between(pulse.squares);
  }
}

//! Chi-square of each place, offset and amplitude at their best.
void vpPulsePosterior::evaluate(const Range &range)
{
  const Axis &lengths = range.length, &frequencies = range.frequency;
  m_chiSquares.resize(static_cast<size_t>(lengths.count * frequencies.count * range.delay.count));
  float *out = m_chiSquares.data();
  static const double amplitude = 0.3; // of the amplitude, as a share of it, standard deviation
  const auto ofAmplitude = static_cast<float>(1 / (amplitude * amplitude)),
             ofOffset = static_cast<float>(m_weights + m_lines.darkness),
             lights = static_cast<float>(m_lights - m_lines.darkness * m_lines.dark),
             squares =
                 static_cast<float>(m_squares + m_lines.darkness * m_lines.dark * m_lines.dark) + ofAmplitude;
  for (int k = 0; k < lengths.count; ++k) {
    tabulate(range, lengths.at(k));
    for (int i = 0; i < frequencies.count; ++i, out += range.delay.count) {
      addPulses(range, frequencies.at(i));
      Eigen::Map<Eigen::ArrayXf> chiSquare(out, range.delay.count);
      const auto second = m_products + ofAmplitude, ofSecond = m_shareSquares + ofAmplitude;
      chiSquare = squares -
                  (lights * lights * ofSecond - 2 * lights * m_shares * second + ofOffset * second.square()) /
                      (ofOffset * ofSecond - m_shares.square()).max(1e-12f);
    }
  }
}

/*!
  By how much chi-square may change from a place of the grid to half the way to the next: an edge that moves
  by a share of the exposure changes the light of the line that sees it by as large a share.
*/
double vpPulsePosterior::changeBetween(const Range &range) const
{
  // Along the profile a frequency's move is a third in the mean square; of a length each edge moves by half.
  const double moved = (std::pow(range.frequency.step(), 2) / 3 + std::pow(range.delay.step(), 2) +
                        std::pow(0.5 * range.length.step(), 2)) /
                       4;
  const double edges = 2 * static_cast<double>(m_pulses.size()), seen = m_lines.exposure / m_lines.step,
               weight = (m_lines.weight * m_lines.lit.square()).mean();
  return edges * seen * weight * moved / (m_lines.exposure * m_lines.exposure);
}

//! The places of the grid whose chi-square is below \e limit.
vpPulsePosterior::Places vpPulsePosterior::likely(const Range &range, double limit) const
{
  Places places;
  const float *chiSquares = m_chiSquares.data();
  for (int k = 0; k < range.length.count; ++k)
    for (int i = 0; i < range.frequency.count; ++i, chiSquares += range.delay.count)
      for (int j = 0; j < range.delay.count; ++j) {
        if (!(chiSquares[j] < limit)) {
          continue;
        }
        const int at[3] = {i, j, k};
        for (int axis = 0; axis < 3; ++axis) {
          places.first[axis] = std::min(places.first[axis], at[axis]);
          places.last[axis] = std::max(places.last[axis], at[axis]);
        }
      }
  return places;
}

//! Over these places, of frequency, delay and length as the grid has them.
vpPulsePosterior::Moments vpPulsePosterior::moments(const Range &range, double limit, double inflation) const
{
  const float least = *std::min_element(m_chiSquares.begin(), m_chiSquares.end());
  const Eigen::Vector3d about(range.frequency.middle, range.delay.middle, range.length.middle);
  double sum = 0;
  Eigen::Vector3d ofFirst = Eigen::Vector3d::Zero();
  Eigen::Matrix3d ofSecond = Eigen::Matrix3d::Zero();
  size_t place = 0;
  for (int k = 0; k < range.length.count; ++k)
    for (int i = 0; i < range.frequency.count; ++i)
      for (int j = 0; j < range.delay.count; ++j, ++place) {
        if (m_chiSquares[place] < limit) {
          const double weight = std::exp(-0.5 * (m_chiSquares[place] - least) / inflation);
          const Eigen::Vector3d x =
              Eigen::Vector3d(range.frequency.at(i), range.delay.at(j), range.length.at(k)) - about;
          sum += weight;
          ofFirst += weight * x;
          ofSecond += weight * x * x.transpose();
        }
      }
  ofFirst /= sum;
  const auto cell = [](const Axis &axis) { return axis.count > 1 ? axis.step() : 1; };
  Moments moments;
  moments.mean = about + ofFirst;
  moments.covariance = ofSecond / sum - ofFirst * ofFirst.transpose();
  moments.chiSquare = least;
  moments.logEvidence = std::log(sum * cell(range.frequency) * cell(range.delay) * cell(range.length)) -
                        0.5 * least / inflation;
  return moments;
}

//! A line to both sides of the start.
vpPulsePosterior::Range vpPulsePosterior::firstRange(bool freeDuty) const
{
  const double line = m_lines.step;
  Range range{{15, 0, line}, {25, 0, line}, {freeDuty ? 13 : 1, m_length, freeDuty ? 1.2 * line : 0}};
  range.cutAt(vpStripeLimits::leastDuty / m_start(0), line);
  return range;
}

/*!
  Frequency, phase and duty by the delay of the last line, the delay and the length: t = (k + shift - phase) /
  f, later by d is a phase less by f d. A longer pulse's middle stays.
*/
Eigen::Matrix3d vpPulsePosterior::byPlace() const
{
  const double f = m_start(0), sign = m_inverted ? -1 : 1;
  Eigen::Matrix3d by = Eigen::Matrix3d::Zero();
  by(0, 0) = -f / m_half;
  by(1, 1) = -f;
  by(2, 2) = sign * f;
  by(1, 2) = 0.5 * sign * f;
  return by;
}

Eigen::Vector3d vpPulsePosterior::parametersAt(const Eigen::Vector3d &place) const
{
  return m_start + byPlace() * (place - Eigen::Vector3d(0, 0, m_length));
}

vpPulsePosterior::Place vpPulsePosterior::likeliest(const Lines &lines, const Eigen::Vector3d &start,
                                                    bool freeDuty)
{
  vpPulsePosterior posterior(lines, start);
  const Range range = posterior.firstRange(freeDuty);
  posterior.evaluate(range);
  const auto &chiSquares = posterior.m_chiSquares;
  const auto best = std::min_element(chiSquares.begin(), chiSquares.end());
  const int place = static_cast<int>(best - chiSquares.begin()), row = place / range.delay.count;
  return {posterior.parametersAt({range.frequency.at(row % range.frequency.count),
                                  range.delay.at(place % range.delay.count),
                                  range.length.at(row / range.frequency.count)}),
          *best - posterior.changeBetween(range)};
}

vpPulsePosterior::Moments vpPulsePosterior::about(const Lines &lines, const Eigen::Vector3d &start,
                                                  bool freeDuty, double inflation)
{
  vpPulsePosterior posterior(lines, start);
  Range range = posterior.firstRange(freeDuty);
  static const int mostRounds = 5;
  double limit = 0;
  for (int round = 1;; ++round) {
    posterior.evaluate(range);
    // Places between those of a coarse grid may be better, by as much as edges move on the way to them.
    static const double explained = 25;
    const double between = posterior.changeBetween(range);
    limit = *std::min_element(posterior.m_chiSquares.begin(), posterior.m_chiSquares.end()) +
            explained * inflation + between;
    if (round == mostRounds) {
      break;
    }
    const Places places = posterior.likely(range, limit);
    const int *first = places.first, *last = places.last;
    const bool filled = 2 * (last[0] - first[0]) >= range.frequency.count &&
                        2 * (last[1] - first[1]) >= range.delay.count &&
                        (!freeDuty || 2 * (last[2] - first[2]) >= range.length.count);
    if (filled && between < explained * inflation) {
      break;
    }
    range.frequency.narrow(first[0], last[0]);
    range.delay.narrow(first[1], last[1]);
    range.length.narrow(first[2], last[2]);
    range.cutAt(vpStripeLimits::leastDuty / start(0), lines.step);
  }
  Moments moments = posterior.moments(range, limit, inflation);
  moments.mean = posterior.parametersAt(moments.mean);
  moments.covariance = posterior.byPlace() * moments.covariance * posterior.byPlace().transpose();
  return moments;
}

END_VISP_NAMESPACE
