/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPoseMixture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <visp3/core/vpMath.h>

#include "vpLampGeometry.h"

BEGIN_VISP_NAMESPACE

void vpPoseMixture::lose()
{
  m_lamps = lamps();
  m_lamps.forgetPlaces();
  m_places.clear();
  m_logAnywhere = nowhere;
}

void vpPoseMixture::restart(const vpPoseHypothesis &place)
{
  m_places.assign(1, place);
  m_places.front().logWeight = 0;
  m_logAnywhere = nowhere;
}

void vpPoseMixture::follow(const vpLampFrame &frame, const vpVlpFilter &odometry)
{
  for (vpPoseHypothesis &place : m_places) {
    place.filter.takeOdometry(odometry);
    place.logWeight += place.follow(frame);
  }
  for (size_t k = 0; k < frame.lamps.size(); ++k) {
    compare(k);
    m_logAnywhere += frame.logUniform;
  }
}

/*!
  What a lamp of the frame is evidence of. Errors of rig and map are the same in every frame: how exactly a
  place expects a lamp tells how many of them it has yielded to, not where the robot is. So places under the
  same claims are as exact as the least of them. And a stranger hangs still as well: it shows what a lamp in
  its place would, if the robot moves as its place has it.
*/
void vpPoseMixture::compare(size_t lamp)
{
  double asLamp = nowhere;
  for (vpPoseHypothesis &place : m_places) {
    const vpPoseHypothesis::Verdict &seen = place.verdicts[lamp];
    if (!seen.accepted) {
      continue;
    }
    double more = 0; // exact than the least
    for (const vpPoseHypothesis &other : m_places) {
      if (other.verdicts[lamp].accepted && other.filter.extraPlaceSigma() == place.filter.extraPlaceSigma()) {
        more = std::max(more, seen.logPeak() - other.verdicts[lamp].logPeak());
      }
    }
    place.logWeight -= more;
    asLamp = std::max(asLamp, seen.logLikelihood - more);
  }
  for (vpPoseHypothesis &place : m_places) {
    place.logWeight += place.asStill(lamp, asLamp);
  }
}

bool vpPoseMixture::mayBeElsewhere(const vpLampFrame &frame, const vpVlpHypotheses &hypotheses) const
{
  if (frame.lamps.size() < poseLamps) {
    return false;
  }
  // At best the step is the likeliest one, which two lamps show: under lamps about 1 m above and apart rays
  // change as coordinates do. Two more tell the velocity, by the time between their lines; others are where
  // they should be.
  static const size_t moving = 4;
  const vpVlpFilter &filter = likeliest().filter;
  const double unknown =
      filter.startVelocity * (frame.lamps.back().time - frame.lamps.front().time); // of a ray
  double most = std::log(hypotheses.relocation * likeliest().since() /
                         (2 * M_PI * hypotheses.reach * hypotheses.reach) / (M_PI * hypotheses.turn) /
                         (M_PI * hypotheses.floorStep));
  for (size_t k = poseLamps; k < frame.lamps.size(); ++k) {
    const Eigen::Matrix2d wide =
        frame.lamps[k].sight.covariance + unknown * unknown * Eigen::Matrix2d::Identity();
    most += k < moving ? logNormal(Eigen::Vector2d::Zero(), wide) : frame.lamps[k].logPeak;
  }
  double now = nowhere;
  for (const vpPoseHypothesis &place : m_places) {
    now = std::max(now, place.logWeight);
  }
  return most > now + std::log(hypotheses.negligible);
}

bool vpPoseMixture::mayBeOff(const vpLampFrame &frame, const vpVlpHypotheses &hypotheses)
{
  vpPoseHypothesis &place = m_places.front();
  if (frame.lamps.size() <= poseLamps || m_places.size() > 1 || place.information() < place.asked) {
    return false;
  }
  place.asked = place.information() - std::log(hypotheses.claimsOff);
  return true;
}

void vpPoseMixture::addWider(vpPoseHypothesis place, const vpVlpHypotheses &hypotheses, bool isFirst)
{
  place.logWeight = likeliest().logWeight + std::log(hypotheses.claimsOff) +
                    (isFirst ? place.logLikelihood() - likeliest().logLikelihood() : 0);
  m_places.push_back(std::move(place));
}

void vpPoseMixture::addElsewhere(const vpLampFrame &frame, vpPoseHypothesis place,
                                 const vpVlpHypotheses &hypotheses)
{
  const vpPoseHypothesis::Begun begun = place.begun(likeliest());
  place.borneOut = place.accepted() > poseLamps;
  const double before = m_logAnywhere - static_cast<double>(frame.lamps.size()) * frame.logUniform;
  place.logWeight = logSum(before, logPut(hypotheses)) + begun.put;
  m_logAnywhere = nowhere;
  if (!place.borneOut) { // or the lamps have given way to others
    vpPoseHypothesis here = likeliest().coasted(frame);
    here.logWeight = std::log(hypotheses.copy * here.since()) + begun.copied;
    m_places.push_back(std::move(here));
  }
  m_places.push_back(std::move(place));
}

void vpPoseMixture::addAnywhere(const vpLampFrame &frame, const vpVlpHypotheses &hypotheses)
{
  if (likeliest().isSurprised()) {
    m_logAnywhere = logSum(m_logAnywhere,
                           logPut(hypotheses) + static_cast<double>(frame.lamps.size()) * frame.logUniform);
  }
}

double vpPoseMixture::logPut(const vpVlpHypotheses &hypotheses) const
{
  const double off = likeliest().odometryIsOff(),
               untold = likeliest().filter.rolls() ? off + (1 - off) * hypotheses.rolling : 1; // by wheels
  return std::log(hypotheses.relocation * likeliest().since() * untold);
}

//! Whether two places are one: pose and velocity of the other are within what the first is uncertain by.
bool vpPoseMixture::agree(const vpPoseHypothesis &place, const vpPoseHypothesis &other)
{
  const vpVlpFilter::Pose pose = place.filter.pose(), otherPose = other.filter.pose();
  const Eigen::Matrix3d turn = pose.wMb.linear().transpose() * otherPose.wMb.linear();
  Eigen::Array<double, 6, 1> apart, variance;
  apart << (otherPose.wMb.translation() - pose.wMb.translation()).head<2>(),
      std::atan2(turn(1, 0), turn(0, 0)), other.filter.velocity() - place.filter.velocity();
  variance << pose.covariance.diagonal()({0, 1, 5}), place.filter.velocityCovariance().diagonal();
  return (apart.square() < variance).all();
}

void vpPoseMixture::reduce(const vpVlpHypotheses &hypotheses)
{
  if (m_places.size() > 1 && !lost()) {
    m_places.erase(std::remove_if(m_places.begin(), m_places.end(), isLost), m_places.end());
  }
  std::sort(m_places.begin(), m_places.end(),
            [](const vpPoseHypothesis &a, const vpPoseHypothesis &b) { return a.logWeight > b.logWeight; });
  const double most = m_places.front().logWeight;
  const auto negligible = [&](const vpPoseHypothesis &place) {
    return place.logWeight < most + std::log(hypotheses.negligible);
  };
  static const size_t many = 4; // places, each of which takes as long as one
  size_t kept = 1;
  while (kept < std::min(many, m_places.size()) && !negligible(m_places[kept])) {
    ++kept;
  }
  m_places.erase(m_places.begin() + static_cast<long>(kept), m_places.end());
  for (size_t p = 1; p < m_places.size();) {
    const bool same = m_places[p].filter.claimsWidened() == likeliest().filter.claimsWidened() &&
                      agree(likeliest(), m_places[p]);
    p += same ? 0 : 1;
    if (same) {
      m_places.erase(m_places.begin() + static_cast<long>(p));
    }
  }
  m_logAnywhere = m_logAnywhere < most + std::log(hypotheses.negligible) ? nowhere : m_logAnywhere;
  double sum = m_logAnywhere;
  for (const vpPoseHypothesis &place : m_places) {
    sum = logSum(sum, place.logWeight);
  }
  for (vpPoseHypothesis &place : m_places) {
    place.logWeight -= sum;
  }
  m_logAnywhere -= sum;
}

void vpPoseMixture::settle(const vpLampFrame &frame, const vpVlpHypotheses &hypotheses, vpVlpFilter &filter,
                           vpVlpLocation &location)
{
  reduce(hypotheses);
  filter = likeliest().filter;
  tell(frame, hypotheses, location);
}

bool vpPoseMixture::isLost(const vpPoseHypothesis &place)
{
  return place.filter.state(place.filter.pose()) == vpVlpFilter::State::lost;
}

bool vpPoseMixture::lost() const
{
  return std::all_of(m_places.begin(), m_places.end(), isLost);
}

bool vpPoseMixture::lostAt(double time) const
{
  return std::all_of(m_places.begin(), m_places.end(), [time](const vpPoseHypothesis &place) {
    return place.filter.state(place.filter.fixAt(time)) == vpVlpFilter::State::lost;
  });
}

void vpPoseMixture::tell(const vpLampFrame &frame, const vpVlpHypotheses &hypotheses,
                         vpVlpLocation &location) const
{
  likeliest().mark(frame, location.observations);
  vpVlpFix &fix = location.fix;
  likeliest().tell(frame, fix);
  location.relocated = !likeliest().borneOut;
  const double anywhere = std::exp(m_logAnywhere);
  if (m_places.size() == 1 && anywhere == 0) {
    return;
  }
  const vpBasePose pose = vpBasePose::of(fix.wMb);
  fix.covariance *= std::exp(likeliest().logWeight);
  double elsewhere = 0; // probability
  for (size_t p = 1; p < m_places.size(); ++p) {
    const vpPoseHypothesis &place = m_places[p];
    const double weight = std::exp(place.logWeight);
    const vpVlpFilter::Pose there = place.filter.markedPose();
    const vpBasePose base{there.wMb.linear(), there.wMb.translation()};
    const Eigen::Matrix<double, 6, 1> apart = pose.stepTo(base);
    fix.covariance += weight * (there.covariance + apart * apart.transpose());
    if (apart.head<2>().norm() > place.filter.trackingSigma ||
        std::abs(apart(5)) > place.filter.trackingYaw) {
      fix.other = elsewhere > 0 ? fix.other : base.wMb();
      elsewhere += weight;
    }
  }
  const vpVlpFilter &filter = likeliest().filter;
  fix.covariance.topLeftCorner<3, 3>().diagonal().array() += anywhere * vpMath::sqr(filter.startPlace);
  fix.covariance(5, 5) += anywhere * vpMath::sqr(M_PI) / 3; // any heading
  fix.ambiguous = elsewhere > 1 - hypotheses.decided;
}

END_VISP_NAMESPACE
