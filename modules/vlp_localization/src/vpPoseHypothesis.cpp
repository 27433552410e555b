/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPoseHypothesis.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "vpLampPicture.h"
#include "vpVlpFilterParts.h"

BEGIN_VISP_NAMESPACE

namespace
{
const char *const misplaced = "not where the robot's motion has it";

//! Whether lamps are so far from where the filter expected them that their rays are not linear in it.
bool bends(const std::vector<vpPoseHypothesis::Verdict> &verdicts)
{
  static const double most = 0.004; // of what is linear; its square is a few hundredths of a pixel
  return std::any_of(verdicts.begin(), verdicts.end(), [](const vpPoseHypothesis::Verdict &lamp) {
    return lamp.accepted && lamp.innovation.ray.squaredNorm() > most * most;
  });
}
} // namespace

vpPoseHypothesis::vpPoseHypothesis(const vpVlpFilter &filter, const vpVlpHypotheses &hypotheses,
                                   const vpLampHistory &history)
    : filter(filter), history(history), m_hypotheses(hypotheses), m_modes(hypotheses),
      m_passes(vpMotionModes::count, Pass{filter, {}, 0}), m_apart{filter, filter}, m_there(filter),
      m_before(filter), m_apartBefore{filter, filter}, m_modesBefore(hypotheses)
{
}

void vpPoseHypothesis::begin(const vpLampFrame &frame, bool isFirst)
{
  history.forgetPlaces();
  for (const vpFrameLamp &lamp : frame.lamps) { // others than those that agree with each other are left out
    m_changes.push_back(lamp.seen->accepted ? "" : lamp.seen->remark);
  }
  m_time = frame.timestamp;
  weigh(frame, 0);
  filter.startAgain(isFirst); // about what they show
  m_parted = false;
  m_modes = vpMotionModes(m_hypotheses);
  m_logLikelihood = weigh(frame, 0);
  learn(frame);
  borneOut = true;
  asked = -std::log(m_hypotheses.claimsOff);
}

double vpPoseHypothesis::follow(const vpLampFrame &frame)
{
  compare(frame);
  m_before = filter;
  m_apartBefore = m_apart;
  m_modesBefore = m_modes;
  m_since = frame.timestamp - m_time;
  m_logLikelihood = weigh(frame, m_since);
  m_time = frame.timestamp;
  learn(frame);
  ++frames;
  borneOut = borneOut || accepted() > poseLamps;
  return m_logLikelihood;
}

/*!
  Goes on under each mode, and mixes what comes of them (Blom and Bar-Shalom 1988). Whether the odometry is
  right has a filter each, as what tells it takes many frames; the kinds of motion share theirs.
*/
double vpPoseHypothesis::weigh(const vpLampFrame &frame, double dt)
{
  const bool odometry = filter.hasOdometry();
  m_strangers.clear();
  for (const vpFrameLamp &lamp : frame.lamps) {
    m_strangers.push_back(history.isStranger(*lamp.lamp));
    for (vpVlpFilter *each : {&filter, &m_apart[0], &m_apart[1]}) {
      each->expect(lamp.sight);
    }
  }
  if (!odometry || !m_parted) {
    m_apart.fill(filter);
  }
  m_modes.predict(dt, odometry);
  if (odometry && m_parted) {
    const std::array<vpVlpFilter, 2> before = m_apart;
    for (size_t to = 0; to < 2; ++to) {
      m_apart[to].takeOdometry(filter);
      const double from = m_modes.changed(to);
      if (from > m_hypotheses.negligible) {
        m_apart[to].mix({&before[to], &before[1 - to]}, {1 - from, from});
      }
    }
  }
  m_parted = odometry;
  std::array<double, vpMotionModes::count> logLikelihood{};
  std::array<double, 2> most; // of those that share a filter
  most.fill(-std::numeric_limits<double>::infinity());
  for (size_t k = 0; k < m_modes.possible();
       ++k) { // the likeliest one first, so that others are given up soon
    const size_t mode = k == 0 ? m_modes.likeliest() : k - (k <= m_modes.likeliest() ? 1 : 0);
    const size_t which = vpMotionModes::byOdometry(mode) ? 1 : 0;
    const double logPrior = std::log(m_modes[mode]);
    attempt(frame, m_apart[which], mode, most[which] + std::log(m_hypotheses.negligible) - logPrior,
            m_passes[mode]);
    logLikelihood[mode] = m_passes[mode].logLikelihood;
    most[which] = std::max(most[which], logPrior + logLikelihood[mode]);
  }
  const bool told = std::any_of(m_passes.begin(), m_passes.begin() + static_cast<long>(m_modes.possible()),
                                [](const Pass &pass) { return accepted(pass.verdicts) > 0; });
  if (odometry && !told) {
    std::array<double, vpMotionModes::count> samples{};
    std::transform(m_passes.begin(), m_passes.end(), samples.begin(),
                   [](const Pass &pass) { return pass.filter.leastOdometry(); });
    m_modes.heedOdometry(samples);
  }
  const double all = m_modes.correct(logLikelihood);
  for (size_t which = 0; which < (odometry ? 2 : 1); ++which) {
    mix(m_apart[which], which == 0 ? 0 : vpMotionModes::alone,
        which == 0 ? vpMotionModes::alone : vpMotionModes::count);
  }
  const size_t likeliest = mix(filter, 0, m_modes.possible());
  filter.odometry =
      m_modes.odometryIsOff() < 0.5 ? vpVlpFilter::Odometry::followed : vpVlpFilter::Odometry::ignored;
  verdicts = m_passes[likeliest].verdicts;
  if (!told) {
    mixInnovations();
  }
  return all;
}

//! Where the modes together expect each lamp, none of which has corrected them.
void vpPoseHypothesis::mixInnovations()
{
  for (size_t k = 0; k < verdicts.size(); ++k) {
    vpVlpFilter::Innovation &mixed = verdicts[k].innovation;
    const Eigen::Vector2d likeliest = mixed.ray;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
    double sum = 0;
    for (size_t mode = 0; mode < m_modes.possible(); ++mode) {
      if (!(m_modes[mode] > m_hypotheses.negligible)) {
        continue; // may have been given up before it came to the lamp
      }
      const vpVlpFilter::Innovation &one = m_passes[mode].verdicts[k].innovation;
      const Eigen::Vector2d off = one.ray - likeliest;
      mean += m_modes[mode] * off;
      square += m_modes[mode] * (one.covariance + off * off.transpose());
      sum += m_modes[mode];
    }
    mean /= sum;
    mixed.ray += mean;
    mixed.covariance = square / sum - mean * mean.transpose();
  }
}

//! Of the passes of some modes. \return The likeliest of them.
size_t vpPoseHypothesis::mix(vpVlpFilter &mixed, size_t first, size_t end) const
{
  double sum = 0;
  size_t likeliest = first;
  for (size_t mode = first; mode < end; ++mode) {
    sum += m_modes[mode];
    likeliest = m_modes[mode] > m_modes[likeliest] ? mode : likeliest;
  }
  static thread_local std::vector<const vpVlpFilter *> parts; // kept, so that it takes no memory
  static thread_local std::vector<double> weights;
  parts.clear();
  weights.clear();
  for (size_t mode = first; mode < end; ++mode) {
    if (mode == likeliest || m_modes[mode] > m_hypotheses.negligible * sum) {
      parts.push_back(&m_passes[mode].filter);
      weights.push_back(sum > 0 ? m_modes[mode] / sum : 1);
    }
  }
  mixed = m_passes[likeliest].filter;
  mixed.mix(parts, weights);
  return likeliest;
}

//! One mode's: rays are not linear in a long way to where they say, about that path, then.
void vpPoseHypothesis::attempt(const vpLampFrame &frame, const vpVlpFilter &before, size_t mode, double least,
                               Pass &pass)
{
  pass.filter = before;
  m_modes.apply(mode, pass.filter);
  correct(frame, least, pass);
  for (int round = 0; round < 2 && bends(pass.verdicts); ++round) {
    vpVlpFilter &there = m_there;
    there = before;
    m_modes.apply(mode, there);
    if (!there.linearizeAbout(pass.filter)) {
      return;
    }
    pass.filter = there;
    correct(frame, least, pass);
  }
}

//! Lets each lamp correct at the time of its line, strangers last, once the others have told where they are.
//! \param least Log likelihood below which the pass is given up.
void vpPoseHypothesis::correct(const vpLampFrame &frame, double least, Pass &pass) const
{
  double open = 0; // what the lamps that are left may add
  for (const vpFrameLamp &lamp : frame.lamps) {
    open += lamp.logPeak;
  }
  pass.verdicts.assign(frame.lamps.size(), Verdict());
  pass.logLikelihood = 0;
  size_t accepted = 0;
  pass.filter.mark(frame.timestamp);
  for (const bool strangers : {false, true}) {
    for (size_t k = 0; k < frame.lamps.size(); ++k) {
      if (m_strangers[k] != strangers) {
        continue;
      }
      const vpFrameLamp &lamp = frame.lamps[k];
      pass.filter.advance(lamp.time);
      vpLampSight sight = lamp.sight;
      const vpVlpFilter::Predicted predicted = pass.filter.predict(sight);
      pass.verdicts[k] = judge(frame, k, strangers && accepted >= poseLamps, sight, pass.filter, predicted);
      if (pass.verdicts[k].accepted) {
        pass.filter.update(sight, predicted);
        ++accepted;
      }
      pass.logLikelihood += pass.verdicts[k].logLikelihood;
      open -= lamp.logPeak;
      if (pass.logLikelihood + std::max(0.0, open) < least) {
        return;
      }
    }
  }
  pass.filter.conclude();
}

//! \param told Other lamps have shown where the robot is. \param sight Becomes as uncertain as what the lamp
//! may be off by makes it.
vpPoseHypothesis::Verdict vpPoseHypothesis::judge(const vpLampFrame &frame, size_t which, bool told,
                                                  vpLampSight &sight, const vpVlpFilter &filter,
                                                  const vpVlpFilter::Predicted &predicted) const
{
  const vpLamp &lamp = *frame.lamps[which].lamp;
  Verdict verdict;
  verdict.wasStranger = m_strangers[which];
  const Eigen::Vector2d offset = history.offset(lamp);
  sight.covariance += offset * offset.transpose();
  verdict.innovation = filter.innovation(sight, predicted);
  const vpVlpFilter::Innovation &seen = verdict.innovation;
  const double stranger = verdict.wasStranger ? m_hypotheses.staying : m_hypotheses.stranger,
               other = std::log(stranger) + frame.logUniform;
  verdict.logLikelihood = other;
  if (!seen.inFront || !m_changes[which].empty()) {
    return verdict;
  }
  const double tolerance = history.tolerance(lamp) / seen.depth,
               displaced = (1 - stranger) * m_hypotheses.displaced;
  const Eigen::Matrix2d anyOffset = tolerance * tolerance * Eigen::Matrix2d::Identity();
  const double exact = std::log(1 - stranger - displaced) + logNormal(seen.ray, seen.covariance),
               near = std::log(displaced) + logNormal(seen.ray - offset, seen.covariance + anyOffset);
  const double still = told ? std::log(stranger) + history.logStill(lamp, seen) : other;
  verdict.accepted = std::max(exact, near) > std::max(other, still);
  if (near > exact) {
    sight.covariance += anyOffset;
  }
  verdict.logLikelihood = logSum(exact, logSum(near, other));
  return verdict;
}

//! Which lamps are not as large, or not of the shape, as before, and why.
void vpPoseHypothesis::compare(const vpLampFrame &frame)
{
  m_changes.clear();
  for (const vpFrameLamp &lamp : frame.lamps) {
    m_changes.push_back(history.changed(*lamp.lamp, *lamp.seen, expectedExtent(frame, *lamp.lamp)));
  }
}

//! What the frame tells of its lamps.
void vpPoseHypothesis::learn(const vpLampFrame &frame)
{
  for (size_t k = 0; k < frame.lamps.size(); ++k) {
    const vpFrameLamp &lamp = frame.lamps[k];
    if (verdicts[k].accepted) {
      history.add(*lamp.lamp, *lamp.seen, verdicts[k].innovation, expectedExtent(frame, *lamp.lamp));
    } else if (m_changes[k].empty()) {
      learnStranger(frame, k);
    }
  }
}

//! One that is not where it was is another one, where a lamp tells that it is not the robot that moved.
void vpPoseHypothesis::learnStranger(const vpLampFrame &frame, size_t which)
{
  Verdict &verdict = verdicts[which];
  verdict.surprises = !verdict.wasStranger;
  if (!verdict.innovation.inFront) {
    return;
  }
  const vpFrameLamp &lamp = frame.lamps[which];
  verdict.strayed = history.addStranger(*lamp.lamp, verdict.innovation);
  verdict.another =
      accepted() > 0 && lamp.logPeak - verdict.strayed < std::log(m_hypotheses.stranger) + frame.logUniform;
  if (verdict.another) {
    history.setStranger(*lamp.lamp, true);
    history.addStranger(*lamp.lamp, verdict.innovation);
  }
}

double vpPoseHypothesis::asStill(size_t lamp, double asLamp) const
{
  const Verdict &seen = verdicts[lamp];
  if (!seen.wasStranger || seen.accepted) {
    return 0;
  }
  return seen.another ? std::log(m_hypotheses.stranger / m_hypotheses.staying)
                      : std::max(0.0, asLamp - seen.strayed - seen.logLikelihood);
}

//! Of a lamp in the picture, seen from where the filter is.
vpLampExtent vpPoseHypothesis::expectedExtent(const vpLampFrame &frame, const vpLamp &lamp) const
{
  const vpVlpFilter::Pose pose = filter.pose();
  const Eigen::Matrix3d open = filter.velocityCovariance();
  const double height = lamp.position.z() - pose.wtc.z(), apart = (lamp.position - pose.wtc).head<2>().norm();
  const double speed = std::sqrt(std::max(open(0, 0), open(1, 1))) + apart * std::sqrt(open(2, 2));
  return {vpLampPicture(lamp, {pose.wMb.linear(), pose.wMb.translation()}, *frame.rig)
              .extent(filter.velocity(), frame.lineTime),
          frame.rig->camera.get_px() * speed / std::max(height, 1e-3) * std::abs(frame.lineTime)};
}

vpPoseHypothesis vpPoseHypothesis::coasted(const vpLampFrame &frame) const
{
  vpPoseHypothesis other = *this;
  other.filter = m_before;
  other.m_apart = m_apartBefore;
  other.m_modes = m_modesBefore;
  other.m_changes.assign(frame.lamps.size(), misplaced);
  other.m_logLikelihood = other.weigh(frame, m_since);
  for (size_t k = 0; k < frame.lamps.size(); ++k) {
    other.learnStranger(frame, k);
  }
  return other;
}

vpPoseHypothesis::Begun vpPoseHypothesis::begun(const vpPoseHypothesis &before) const
{
  const vpHomogeneousMatrix way = before.m_before.now().wMb.inverse() * filter.marked().wMb;
  const vpVlpHypotheses &of = m_hypotheses;
  const auto cauchy = [](double x, double scale) {
    return -std::log(M_PI * scale * (1 + x * x / (scale * scale)));
  };
  const auto across = [&way](double scale) { // bivariate
    const double square = (way[0][3] * way[0][3] + way[1][3] * way[1][3]) / (scale * scale);
    return -std::log(2 * M_PI * scale * scale) - 1.5 * std::log1p(square);
  };
  // Begun about where it was found, which is no prior.
  const double logBegun =
                   -2 * std::log(2 * M_PI) - 3 * std::log(filter.startPlace) - std::log(filter.startTurn),
               common = m_logLikelihood - logBegun + cauchy(way[2][3], of.floorStep);
  return {common + across(of.reach) + cauchy(std::atan2(way[1][0], way[0][0]), of.turn),
          common + across(of.copyReach) - std::log(2 * M_PI)};
}

size_t vpPoseHypothesis::accepted(const std::vector<Verdict> &verdicts)
{
  return static_cast<size_t>(
      std::count_if(verdicts.begin(), verdicts.end(), [](const Verdict &lamp) { return lamp.accepted; }));
}

bool vpPoseHypothesis::isSurprised() const
{
  return accepted() == 0 &&
         std::any_of(verdicts.begin(), verdicts.end(), [](const Verdict &lamp) { return lamp.surprises; });
}

void vpPoseHypothesis::tell(const vpLampFrame &frame, vpVlpFix &fix) const
{
  fix.valid = true;
  fix.refusal.clear();
  fix.lamps.clear();
  fix.residuals.clear();
  fix.chiSquare = 0;
  for (size_t k = 0; k < frame.lamps.size(); ++k) {
    if (verdicts[k].accepted) {
      fix.lamps.push_back(frame.lamps[k].lamp->id);
      fix.residuals.push_back(verdicts[k].innovation.ray);
      fix.chiSquare += verdicts[k].innovation.distance(0);
    }
  }
  fix.degreesOfFreedom = 2 * static_cast<int>(fix.lamps.size());
  filter.tellMarked(fix);
}

void vpPoseHypothesis::mark(const vpLampFrame &frame, std::vector<vpLampObservation> &observations) const
{
  for (size_t k = 0; k < frame.lamps.size(); ++k) {
    vpLampObservation &seen = observations[frame.lamps[k].observation];
    seen.accepted = verdicts[k].accepted;
    seen.remark = seen.accepted ? "" : m_changes[k].empty() ? misplaced : m_changes[k];
  }
}

END_VISP_NAMESPACE
