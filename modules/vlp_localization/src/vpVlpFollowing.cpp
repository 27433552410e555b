/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// How vpVlpLocalizer carries a pose from frame to frame.

#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "vpLampConsensus.h"
#include "vpLampGeometry.h"
#include "vpLampTrust.h"
#include "vpSurprise.h"
#include "vpVlpScratch.h"

BEGIN_VISP_NAMESPACE

namespace
{
const double manoeuvring = 0.05; // share of the random accelerations, which a long readout shows
const int young = 3;             // frames since the start: its velocity is not known, or rests on the claims
const char *const misplaced = "not where the robot's motion has it";

size_t accepted(const vpVlpLocation &location)
{
  return static_cast<size_t>(std::count_if(location.observations.begin(), location.observations.end(),
                                           [](const vpLampObservation &lamp) { return lamp.accepted; }));
}
} // namespace

/*!
  The pose that the filter carries, corrected. A robot that was carried away shows lamps that agree with each
  other on another place; camera and map that are not as good as they say are contradicted by their lamps for
  good. Then the filter begins anew, where the lamps of this frame alone say.
*/
void vpVlpLocalizer::follow(vpVlpLocation &location, const std::vector<size_t> &usable)
{
  std::vector<vpLampObservation> &all = m_scratch->all, &apart = m_scratch->apart;
  all = location.observations;
  const std::vector<size_t> &whole = unchanged(location, usable);
  // Most lamps have changed where the robot is elsewhere; and a filter that is too young is no help.
  const bool changed = 2 * whole.size() < usable.size(),
             unknown = ((m_followed < young && !m_moving) || std::exchange(m_refused, false)) &&
                       vague(location.timestamp);
  if ((changed && beginAnew(location, all, usable, true)) ||
      (unknown && beginAnew(location, location.observations, whole, false))) {
    return;
  }
  const bool scarce = changed || (whole.size() < 2 && usable.size() > 1);
  apart = scarce ? all : location.observations;
  const Motion motion = correctRestless(location, whole);
  const bool contradictory = contradicts(location, whole, motion != Motion::asBefore);
  const std::vector<size_t> &blinking = scarce ? usable : whole;
  const size_t fitting = 2 * accepted(location);
  const bool few = fitting < blinking.size(),
             half = fitting == blinking.size() && (fitting > 2 || misplacedKnown(location, whole)),
             lost = filter.state(location.fix) == vpVlpFilter::State::lost,
             inexplicable = motion == Motion::inexplicable;
  const int before = std::exchange(m_disagreements, 0);
  if (!few && !half && !lost && !contradictory && !inexplicable) {
    if (motion == Motion::sudden) {
      doubtSuddenMotion(location, apart, blinking);
    }
    return;
  }
  const vpVlpFix alone = solve(apart, blinking);
  const bool elsewhere = alone.valid && !alone.ambiguous && asBefore(apart, alone);
  const bool contradicted = fitting == 0 && misplacedKnown(location, whole);
  if (scarce && !elsewhere && !lost && !contradicted) {
    return; // hidden in part, from wherever they are seen
  }
  m_disagreements = (few || fitting == 2 ? before : 0) + (alone.valid ? 1 : 0);
  static const int enough = 2; // frames, where no lamp more than a pose needs bears it out
  if (elsewhere && (lost || contradictory || m_disagreements >= enough ||
                    (alone.degreesOfFreedom > 0 && alone.lamps.size() > accepted(location)))) {
    if (contradictory) {
      filter.doubtClaims();
      m_contradictions = 0;
      m_unresting = 0;
    }
    location.observations = apart;
    location.fix = alone;
    begin(location);
  } else if (lost) {
    filter.stop();
    location.fix = alone;
    location.observations = apart;
  } else if ((few || (fitting == 2 && elsewhere)) && (alone.valid || contradicted)) {
    m_refused = true;
    if (elsewhere) {
      m_apart = LastPose{alone, location.timestamp};
    }
    location.fix = vpVlpFix();
    location.fix.refusal = alone.valid ? "the lamps agree with each other, and not with the robot's motion"
                                       : "the lamp does not agree with the robot's motion";
  } else if (inexplicable && elsewhere) { // by this frame alone, and the filter does not learn from it
    filter = m_scratch->before;
    filter.mark(location.timestamp);
    location.observations = apart;
    location.fix = alone;
    addMotionDoubt(location, membersOf(location));
  }
}

/*!
  The robot may have been put where it stands now instead of having come there at a velocity that it did not
  have before: then it is where this frame's lamps alone say. The filter goes on, and learns from the next
  frame.
*/
void vpVlpLocalizer::doubtSuddenMotion(vpVlpLocation &location, std::vector<vpLampObservation> &observations,
                                       const std::vector<size_t> &usable) const
{
  const vpVlpFix put = solve(observations, usable);
  if (put.valid) {
    const Eigen::Matrix<double, 6, 1> apart =
        vpBasePose::of(location.fix.wMb).stepTo(vpBasePose::of(put.wMb));
    location.fix.covariance += apart * apart.transpose();
  }
}

//! Whether a lamp that was in its place in the frames before is not.
bool vpVlpLocalizer::misplacedKnown(const vpVlpLocation &location, const std::vector<size_t> &which) const
{
  const std::vector<const vpLamp *> &lamps = lampsOf(location.observations);
  return std::any_of(which.begin(), which.end(), [&](size_t i) {
    return lamps[i] != nullptr && location.observations[i].remark == misplaced && m_trust->knows(*lamps[i]);
  });
}

/*!
  Corrects by the lamps of a frame: as if the robot went on as before; where that is beyond chance, as if it
  may start, stop or turn; where few lamps fit even so, as if its velocity were anybody's guess. \return What
  the lamps fit.
*/
vpVlpLocalizer::Motion vpVlpLocalizer::correctRestless(vpVlpLocation &location,
                                                       const std::vector<size_t> &whole)
{
  Scratch &scratch = *m_scratch;
  scratch.before = filter;
  scratch.trusted = *m_trust;
  scratch.seen = location.observations;
  auto again = [&] {
    *m_trust = scratch.trusted;
    location.observations = scratch.seen;
    filter = scratch.before;
  };
  // Rays are not linear in a long way to where they say: about that path, then.
  auto attempt = [&] {
    correct(location, whole);
    for (int round = 0; round < 2 && bends(location); ++round) {
      scratch.there = scratch.before;
      if (!scratch.there.linearizeAbout(filter)) {
        return;
      }
      again();
      filter = scratch.there;
      correct(location, whole);
    }
  };
  auto halfOrLess = [&] { return whole.size() > 1 && 2 * accepted(location) <= whole.size(); };
  Motion motion = Motion::asBefore;
  attempt();
  if (accepted(location) == 0 || halfOrLess() ||
      !filter.settle(location.fix.chiSquare, location.fix.degreesOfFreedom)) {
    motion = Motion::restless;
    scratch.before.rouse();
    again();
    attempt();
  }
  auto surprises = [&] { return scratch.before.unrest() == 1 && vpSurprise::of(location.fix); };
  if (halfOrLess() || surprises()) {
    motion = Motion::sudden;
    scratch.before.forgetVelocity();
    again();
    attempt();
  }
  if (surprises()) { // nothing that a robot does
    vpSurprise::doubt(location.fix);
    return Motion::inexplicable;
  }
  return motion;
}

//! Whether lamps are so far from where the filter expected them that their rays are not linear in it.
bool vpVlpLocalizer::bends(const vpVlpLocation &location) const
{
  static const double most = 0.004; // of what is linear; its square is a few hundredths of a pixel
  return std::any_of(location.fix.residuals.begin(), location.fix.residuals.end(),
                     [](const Eigen::Vector2d &ray) { return ray.squaredNorm() > most * most; });
}

/*!
  How far the lamps of a frame contradict each other under what camera and map say of themselves, whatever
  pose and nearly constant velocity the robot has: their innovations in a filter that knows neither, as
  standard deviations of a chi-square beyond its mean.
*/
double vpVlpLocalizer::strain(const vpVlpLocation &location, const std::vector<size_t> &usable) const
{
  const std::vector<const vpLamp *> &lamps = lampsOf(location.observations);
  vpVlpFilter &alone = m_scratch->alone;
  alone = filter;
  alone.restart(location.fix.wMb, location.timestamp);
  double chiSquare = 0, degrees = 0;
  for (int round = 0; round < 2; ++round) {
    chiSquare = degrees = 0;
    alone.calm(manoeuvring);
    alone.mark(location.timestamp);
    for (size_t i : inTime(location, usable)) {
      if (lamps[i] != nullptr && location.observations[i].accepted) {
        const vpLampSight sight = vpLampSight::from(*lamps[i], location.observations[i], m_rig.camera);
        alone.advance(timeOf(location, location.observations[i]));
        chiSquare += alone.innovation(sight).distance(0);
        degrees += 2;
        alone.update(sight);
      }
    }
    if (round == 0) {
      alone.startAgain();
    }
  }
  return vpSurprise::beyondMean(chiSquare, degrees);
}

/*!
  Whether lamps contradict what camera and map say of themselves, frame after frame: each other, or any but a
  robot that never comes to rest. A frame or two of it may be one that starts or stops.
*/
bool vpVlpLocalizer::contradicts(const vpVlpLocation &location, const std::vector<size_t> &usable,
                                 bool roused)
{
  const int often = ++m_followed <= young && !filter.doubtsClaims() ? 2 : 8; // frames
  const auto apart = std::count_if(usable.begin(), usable.end(), [&location](size_t i) {
    return location.observations[i].remark == misplaced;
  });
  // What lamps do not contradict where a pose is expected they contradict less where none is.
  const bool calm =
      !m_scratch->displaced && filter.unrest() <= manoeuvring &&
      vpSurprise::beyondMean(location.fix.chiSquare, location.fix.degreesOfFreedom) < mostStrain;
  const bool now = usable.size() > 2 && (roused || 2 * static_cast<size_t>(apart) >= usable.size() ||
                                         (!calm && strain(location, usable) > mostStrain));
  m_contradictions = now ? m_contradictions + 1 : std::max(0, m_contradictions - 1);
  static const double unresting = 0.2;            // share of the random accelerations
  static const double forGood = 2, longest = 0.4; // s; between two frames
  const double since = m_lastPose ? std::min(longest, location.timestamp - m_lastPose->time) : 0;
  // What moves sideways from pose to pose is carried by more than wheels, and may never come to rest.
  static const double sideways = 0.1; // m/s
  double aside = 0;                   // m, since the last pose
  for (unsigned int i = 0; i < 2 && m_lastPose; ++i) {
    aside += m_lastPose->fix.wMb[i][1] * (location.fix.wMb[i][3] - m_lastPose->fix.wMb[i][3]);
  }
  const bool restless = usable.size() > 2 && filter.unrest() > unresting && !filter.doubtsClaims() &&
                        std::abs(aside) < sideways * since;
  m_unresting = restless ? m_unresting + since : std::max(0.0, m_unresting - 2 * since);
  return m_contradictions >= often || m_unresting >= forGood;
}

//! Predicts to the frame and lets each lamp correct at the time of its line.
void vpVlpLocalizer::correct(vpVlpLocation &location, const std::vector<size_t> &usable)
{
  const std::vector<const vpLamp *> &lamps = lampsOf(location.observations);
  vpVlpFix &fix = location.fix;
  fix.lamps.clear();
  fix.residuals.clear();
  fix.refusal.clear();
  fix.chiSquare = 0;
  fix.degreesOfFreedom = 0;
  fix.ambiguous = false;
  m_scratch->displaced = false;
  if (attitudeIsFree()) {
    placeMiddles(location.observations, filter.pose().wMb.rotation());
  }
  const bool calm = filter.unrest() <= manoeuvring;
  filter.mark(location.timestamp);
  for (size_t i : inTime(location, usable)) {
    vpLampObservation &seen = location.observations[i];
    const vpLamp *lamp = lamps[i];
    if (lamp == nullptr) {
      continue;
    }
    if (!calm && m_trust->doubts(*lamp)) { // many motions would bring it to its place
      seen.remark = misplaced;
      continue;
    }
    filter.advance(timeOf(location, seen));
    vpLampSight sight = vpLampSight::from(*lamp, seen, m_rig.camera);
    const Eigen::Vector2d offset = m_trust->offset(*lamp);
    sight.covariance += offset * offset.transpose();
    m_scratch->displaced = m_scratch->displaced || !offset.isZero();
    const vpVlpFilter::Innovation innovation = filter.innovation(sight);
    if (!innovation.inFront || !m_trust->inPlace(*lamp, innovation)) {
      seen.remark = misplaced;
      continue;
    }
    m_trust->believe(*lamp, seen, innovation, expectedExtent(*lamp));
    filter.update(sight);
    seen.accepted = true;
    seen.remark.clear();
    fix.lamps.push_back(lamp->id);
    fix.residuals.push_back(innovation.ray);
    fix.chiSquare += innovation.distance(0);
    fix.degreesOfFreedom += 2;
  }
  fix.valid = true;
  filter.conclude();
  filter.tellMarked(fix);
}

//! Whether the pose is so uncertain by then that rays to lamps are no longer linear in its error.
bool vpVlpLocalizer::vague(double time) const
{
  static const double most = 0.1; // rad, of a lamp's direction
  vpVlpFilter &there = m_scratch->there;
  there = filter;
  there.advance(time);
  const vpVlpFilter::Pose pose = there.pose();
  double height = 1e9; // m, of the lowest lamp
  for (const vpLamp &lamp : m_map.lamps) {
    height = std::min(height, lamp.position.z() - pose.wtc.z());
  }
  const double place = std::sqrt(std::max(pose.covariance(0, 0), pose.covariance(1, 1))),
               turn = std::sqrt(pose.covariance(5, 5));
  return turn + place / std::max(height, 0.1) > most;
}

/*!
  Begins anew where the lamps of this frame alone say that the robot is, if they look from there as they did
  before. \param proven A lamp more than a pose needs has to bear it out.
*/
bool vpVlpLocalizer::beginAnew(vpVlpLocation &location, std::vector<vpLampObservation> observations,
                               const std::vector<size_t> &usable, bool proven)
{
  const vpVlpFix alone = solve(observations, usable);
  if (!alone.valid || alone.ambiguous || (proven && alone.degreesOfFreedom == 0) ||
      !asBefore(observations, alone)) {
    return false;
  }
  location.observations = std::move(observations);
  location.fix = alone;
  begin(location);
  return true;
}

//! Whether the lamps of a fix look from there as large as they did in the frames before.
bool vpVlpLocalizer::asBefore(const std::vector<vpLampObservation> &observations, const vpVlpFix &fix) const
{
  const std::vector<const vpLamp *> &lamps = lampsOf(observations);
  Eigen::Isometry3d wMb = Eigen::Isometry3d::Identity();
  for (unsigned int row = 0; row < 3; ++row) {
    for (unsigned int column = 0; column < 4; ++column) {
      wMb(row, column) = fix.wMb[row][column];
    }
  }
  vpLampTrust trust = *m_trust;      // which counts how often it is asked
  static const double moving = 0.01; // stretch of a lamp by an unknown velocity, standard deviation
  for (size_t i = 0; i < observations.size(); ++i) {
    if (!observations[i].accepted || lamps[i] == nullptr) {
      continue;
    }
    const vpLampExtent expected = {
        vpLampTrust::extentOf(*lamps[i], wMb, Eigen::Vector3d::Zero(), m_rig, m_lineTime), moving};
    if (!trust.changed(*lamps[i], observations[i], expected).empty()) {
      return false;
    }
  }
  return true;
}

//! Those that are as large and of the shape as before; the others get a remark.
const std::vector<size_t> &vpVlpLocalizer::unchanged(vpVlpLocation &location,
                                                     const std::vector<size_t> &usable)
{
  const std::vector<const vpLamp *> &lamps = lampsOf(location.observations);
  std::vector<size_t> &same = m_scratch->same;
  same.clear();
  for (size_t i : usable) {
    vpLampObservation &seen = location.observations[i];
    const std::string change =
        lamps[i] == nullptr ? "" : m_trust->changed(*lamps[i], seen, expectedExtent(*lamps[i]));
    if (change.empty()) {
      same.push_back(i);
    } else {
      seen.remark = change;
    }
  }
  return same;
}

//! Of a lamp in the picture, seen from where the filter is.
vpLampExtent vpVlpLocalizer::expectedExtent(const vpLamp &lamp) const
{
  const vpVlpFilter::Pose pose = filter.pose();
  const Eigen::Matrix3d doubt = filter.velocityCovariance();
  const double height = lamp.position.z() - pose.wtc.z(), apart = (lamp.position - pose.wtc).head<2>().norm();
  const double speed = std::sqrt(std::max(doubt(0, 0), doubt(1, 1))) + apart * std::sqrt(doubt(2, 2));
  return {vpLampTrust::extentOf(lamp, pose.wMb, filter.velocity(), m_rig, m_lineTime),
          m_rig.camera.get_px() * speed / std::max(height, 1e-3) * std::abs(m_lineTime)};
}

//! Lamps in the order in which their lines were read.
const std::vector<size_t> &vpVlpLocalizer::inTime(const vpVlpLocation &location,
                                                  const std::vector<size_t> &which) const
{
  std::vector<size_t> &ordered = m_scratch->ordered;
  ordered = which;
  std::sort(ordered.begin(), ordered.end(), [&location](size_t a, size_t b) {
    return location.observations[a].time < location.observations[b].time;
  });
  return ordered;
}

//! At which a lamp was seen, s.
double vpVlpLocalizer::timeOf(const vpVlpLocation &location, const vpLampObservation &seen) const
{
  return location.timestamp + (compensateShutter ? seen.time : 0);
}

END_VISP_NAMESPACE
