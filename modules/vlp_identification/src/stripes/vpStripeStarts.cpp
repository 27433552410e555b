/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpStripeStarts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>

BEGIN_VISP_NAMESPACE

namespace
{
//! Whether edges lie within some share of a period from where they should be.
bool agree(const Eigen::VectorXd &residuals, double period)
{
  static const double most = 0.15; // periods, root mean square
  return residuals.norm() < most * period * std::sqrt(static_cast<double>(residuals.size()));
}

//! Least squares of A x = b, of few unknowns: by their normal equations, NaN where these are singular.
Eigen::VectorXd solved(const Eigen::MatrixXd &A, const Eigen::VectorXd &b)
{
  static const int most = 8; // unknowns
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most, most>;
  const Eigen::LDLT<Square> normal(Square(A.transpose() * A));
  static const double singular = 1e-14; // share of the largest
  const auto pivots = normal.vectorD().cwiseAbs();
  if (!(pivots.minCoeff() > singular * pivots.maxCoeff())) {
    return Eigen::VectorXd::Constant(A.cols(), std::numeric_limits<double>::quiet_NaN());
  }
  return normal.solve(A.transpose() * b);
}

double scaledLine(const vpStripeProfile &profile, size_t i)
{
  const double first = profile.time.front(), last = profile.time.back();
  return (2 * profile.time[i] - first - last) / std::max(std::abs(last - first), 1e-12);
}
} // namespace

std::vector<size_t> vpStripeStarts::peaks(const vpStripeProfile &profile)
{
  static const double share = 0.3;
  static const double sigmas = 6;
  // In a long dark gap noise rises far, and so does what little light there is of the neighbours.
  static const double ofTheLast = 0.08, ofAll = 0.012;
  std::vector<size_t> peaks;
  const std::vector<double> &p = profile.light;
  const double brightest = p.empty() ? 0 : *std::max_element(p.begin(), p.end());
  size_t high = 0, low = 0;
  bool rising = true;
  for (size_t i = 1; i < p.size(); ++i) {
    const double least = sigmas * profile.sigma[i];
    if (rising) {
      if (p[i] > p[high]) {
        high = i;
      } else if (p[high] - p[i] > std::max(least, share * p[high])) {
        peaks.push_back(high);
        low = i;
        rising = false;
      }
    } else {
      if (p[i] < p[low]) {
        low = i;
      } else if (p[i] - p[low] > std::max({least, share * p[i], ofTheLast * p[high], ofAll * brightest})) {
        high = i;
        rising = true;
      }
    }
  }
  if (rising && (peaks.empty() || p[high] > 0.3 * p[peaks.back()])) {
    peaks.push_back(high);
  }
  // So it does in the gap that the profile begins with.
  while (peaks.size() > 1 && p[peaks[0]] < std::max(ofTheLast * p[peaks[1]], ofAll * brightest)) {
    peaks.erase(peaks.begin());
  }
  return peaks;
}

std::vector<size_t> vpStripeStarts::wholePeaks(const vpStripeProfile &profile, std::vector<size_t> peaks)
{
  if (peaks.size() > 1 && peaks.back() + 1 == profile.light.size()) {
    peaks.pop_back();
  }
  if (peaks.size() > 1 && peaks.front() == 0) {
    peaks.erase(peaks.begin());
  }
  return peaks;
}

std::vector<double> vpStripeStarts::envelope(const vpStripeProfile &profile, const std::vector<size_t> &peaks,
                                             int order)
{
  if (peaks.empty()) {
    const double brightest = *std::max_element(profile.light.begin(), profile.light.end());
    return std::vector<double>(profile.light.size(), std::max(1.0, brightest));
  }
  const auto n = static_cast<Eigen::Index>(peaks.size());
  const int fitted = static_cast<int>(std::min<Eigen::Index>(order, n - 1));
  Eigen::MatrixXd A(n + fitted, fitted + 1);
  Eigen::VectorXd b(n + fitted);
  A.setZero();
  b.setZero();
  for (Eigen::Index i = 0; i < n; ++i) {
    const double y = scaledLine(profile, peaks[i]);
    for (int k = 0; k <= fitted; ++k) {
      A(i, k) = std::pow(y, k);
    }
    b(i) = std::log(std::max(profile.light[peaks[i]], 0.5));
  }
  for (int k = 1; k <= fitted; ++k) {
    A(n + k - 1, k) = 0.1; // as flat as the peaks allow
  }
  Eigen::VectorXd coefficients = solved(A, b);
  // A pulse that the lamp's border or a line's exposure cuts short peaks below the envelope: such ones let
  // go.
  static const double below = 0.1; // of a logarithm
  for (int round = 0; round < 4; ++round) {
    Eigen::VectorXd weights = Eigen::VectorXd::Ones(A.rows());
    const Eigen::VectorXd residuals = b - A * coefficients;
    for (Eigen::Index i = 0; i < n; ++i) {
      weights(i) = residuals(i) < -below ? below / -residuals(i) : 1;
    }
    if (round == 0 && (weights.array() == 1).all()) {
      break; // nothing to let go of
    }
    coefficients = solved(weights.asDiagonal() * A, weights.cwiseProduct(b));
  }
  std::vector<double> envelope;
  for (size_t line = 0; line < profile.light.size(); ++line) {
    double log = 0;
    for (int k = fitted; k >= 0; --k) {
      log = log * scaledLine(profile, line) + coefficients(k);
    }
    envelope.push_back(std::exp(std::clamp(log, -20.0, 20.0)));
  }
  return envelope;
}

std::vector<double> vpStripeStarts::envelopeOfPeriod(const vpStripeProfile &profile, double frequency)
{
  const size_t n = profile.light.size();
  const double line =
      std::abs(profile.time.back() - profile.time.front()) / static_cast<double>(std::max<size_t>(1, n - 1));
  const auto half =
      static_cast<size_t>(std::clamp(std::round(0.5 / (frequency * line)), 1.0, static_cast<double>(n)));
  const double brightest = *std::max_element(profile.light.begin(), profile.light.end());
  static const double least = 1e-3; // of the brightest line: dark lines beyond the lamp have no logarithm
  std::vector<double> most(n), smooth(n);
  auto around = [&](size_t i) { return std::make_pair(i - std::min(i, half), std::min(n, i + half + 1)); };
  for (size_t i = 0; i < n; ++i) {
    const auto [first, last] = around(i);
    const auto begin = profile.light.begin();
    most[i] = std::log(
        std::max(*std::max_element(begin + static_cast<long>(first), begin + static_cast<long>(last)),
                 least * brightest));
  }
  for (size_t i = 0; i < n; ++i) {
    const auto [first, last] = around(i);
    const auto begin = most.begin();
    smooth[i] =
        std::exp(std::accumulate(begin + static_cast<long>(first), begin + static_cast<long>(last), 0.0) /
                 static_cast<double>(last - first));
  }
  return smooth;
}

std::vector<double> vpStripeStarts::envelopeOfStripes(const vpStripeProfile &profile,
                                                      const std::vector<size_t> &peaks)
{
  static const double lit = 0.1;         // of the peak's light
  static const size_t part = 5, few = 3; // of a stripe, at each end, that edges may soften; lines
  const size_t n = profile.light.size();
  std::vector<double> logs; // of a stripe's envelope at its first and last line, stripe by stripe
  std::vector<size_t> lines;
  for (const size_t peak : peaks) {
    size_t first = peak, last = peak;
    while (first > 0 && profile.light[first - 1] > lit * profile.light[peak]) {
      --first;
    }
    while (last + 1 < n && profile.light[last + 1] > lit * profile.light[peak]) {
      ++last;
    }
    const size_t cut = (last - first + 1) / part, from = first + cut, to = last - cut;
    double mean = 0, middle = 0.5 * static_cast<double>(from + to), products = 0, squares = 0;
    for (size_t i = from; i <= to; ++i) {
      const double log = std::log(std::max(profile.light[i], 0.5)), at = static_cast<double>(i) - middle;
      mean += log / static_cast<double>(to - from + 1);
      products += at * log;
      squares += at * at;
    }
    const double slope = to - from + 1 > few ? products / squares : 0;
    if (lines.empty() || first > lines.back()) {
      for (const size_t end : {first, last}) {
        lines.push_back(end);
        logs.push_back(mean + slope * (static_cast<double>(end) - middle));
      }
    }
  }
  std::vector<double> envelope;
  size_t next = 0; // of the lines with a known envelope, the first that is not before
  for (size_t i = 0; i < n; ++i) {
    while (next < lines.size() && lines[next] < i) {
      ++next;
    }
    if (next == 0 || next == lines.size()) {
      envelope.push_back(std::exp(logs[next == 0 ? 0 : next - 1]));
    } else {
      const double way = static_cast<double>(i - lines[next - 1]) /
                         std::max(1.0, static_cast<double>(lines[next] - lines[next - 1]));
      envelope.push_back(std::exp(logs[next - 1] + way * (logs[next] - logs[next - 1])));
    }
  }
  return envelope;
}

std::vector<vpStripeStarts::Edge> vpStripeStarts::edges(const vpStripeProfile &profile,
                                                        const std::vector<double> &envelope)
{
  static const double half = 0.5; // of the envelope
  static const double off = 0.2;  // from there, before a crossing counts
  const size_t n = profile.light.size();
  const double middle = 0.5 * (profile.time.front() + profile.time.back());
  auto share = [&](size_t i) { return profile.light[i] / envelope[i]; };
  std::vector<Edge> found;
  const bool backwards = profile.time.back() < profile.time.front();
  auto at = [&](size_t k) { return backwards ? n - 1 - k : k; };
  double before = share(at(0));
  bool lit = before > half;
  size_t latest = 0; // last line on the side that it is on
  double latestShare = before;
  for (size_t k = 1; k < n; ++k) {
    const double now = share(at(k));
    if ((now > half) == lit) {
      latest = k;
      latestShare = now;
    } else if (std::abs(now - half) > off || (k + 1 < n && (share(at(k + 1)) > half) != lit)) {
      const double way = (half - latestShare) / (now - latestShare);
      const double from = profile.time[at(latest)], to = profile.time[at(k)];
      found.push_back({from + std::clamp(way, 0.0, 1.0) * (to - from) - middle, !lit});
      lit = !lit;
      latest = k;
      latestShare = now;
    }
  }
  return found;
}

std::optional<vpStripeStarts::Pulses> vpStripeStarts::pulses(const std::vector<Edge> &edges)
{
  if (edges.size() < 3) {
    return std::nullopt;
  }
  // Unknown: start of the pulse with the first rise, period, length of a pulse.
  Eigen::MatrixXd A(static_cast<Eigen::Index>(edges.size()), 3);
  Eigen::VectorXd b(A.rows());
  int pulse = edges.front().rising ? -1 : 0;
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    const Edge &edge = edges[static_cast<size_t>(i)];
    pulse += edge.rising ? 1 : 0;
    A.row(i) << 1, pulse, edge.rising ? 0 : 1;
    b(i) = edge.time;
  }
  const Eigen::Vector3d x = solved(A, b);
  const double period = x(1), length = x(2);
  if (!(period > 0 && length > 0.01 * period && length < 0.99 * period) || !agree(A * x - b, period)) {
    return std::nullopt;
  }
  return Pulses{1 / period, -x(0) / period, length / period, 0};
}

std::optional<vpStripeStarts::Pulses> vpStripeStarts::pairsOfPulses(const std::vector<Edge> &edges)
{
  if (edges.size() < 6) {
    return std::nullopt;
  }
  // Unknown: start of a first pulse, period, length of a pulse, from a first pulse to its second. Which of
  // two neighbours is the first one shows by the shorter way.
  Eigen::MatrixXd A(static_cast<Eigen::Index>(edges.size()), 4);
  Eigen::VectorXd b(A.rows());
  int pulse = edges.front().rising ? -1 : 0;
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    const Edge &edge = edges[static_cast<size_t>(i)];
    pulse += edge.rising ? 1 : 0;
    A.row(i) << 1, pulse / 2, edge.rising ? 0 : 1, pulse % 2;
    b(i) = edge.time;
  }
  Eigen::Vector4d x = solved(A, b);
  const double period = x(1), length = x(2);
  if (!(period > 0 && length > 0.01 * period && x(3) > length && period - x(3) > length) ||
      !agree(A * x - b, period)) {
    return std::nullopt;
  }
  if (x(3) > 0.5 * period) {
    x(0) += x(3);
    x(3) = period - x(3);
  }
  return Pulses{1 / period, -x(0) / period, 2 * length / period, x(3) / period};
}

END_VISP_NAMESPACE
