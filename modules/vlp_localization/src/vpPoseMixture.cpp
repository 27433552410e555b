/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPoseMixture.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <Eigen/LU>

#include "vpLampGeometry.h"

BEGIN_VISP_NAMESPACE

void vpPoseMixture::lose()
{
  m_lamps = lamps();
  m_lamps.forgetPlaces();
  m_places.clear();
}

void vpPoseMixture::restart(const vpPoseHypothesis &place)
{
  m_places.assign(1, place);
  m_places.front().logWeight = 0;
}

void vpPoseMixture::follow(const vpLampFrame &frame, const vpVlpFilter &odometry)
{
  for (vpPoseHypothesis &place : m_places) {
    place.filter.takeOdometry(odometry);
    place.logWeight += place.follow(frame);
  }
  // A stranger hangs still as well: from frame to frame it shows what a lamp in its place would.
  for (size_t k = 0; k < frame.lamps.size(); ++k) {
    double most = -1e300;
    for (const vpPoseHypothesis &place : m_places) {
      most = std::max(most, place.verdicts[k].accepted ? place.verdicts[k].logLikelihood : -1e300);
    }
    for (vpPoseHypothesis &place : m_places) {
      const vpPoseHypothesis::Verdict &verdict = place.verdicts[k];
      if (verdict.wasStranger && !verdict.accepted) {
        place.logWeight += std::max(0.0, most - verdict.logLikelihood);
      }
    }
  }
}

bool vpPoseMixture::mayBeElsewhere(const vpLampFrame &frame, const vpVlpHypotheses &hypotheses) const
{
  static const size_t fewest = 2; // lamps that tell a pose
  if (frame.lamps.size() < fewest) {
    return false;
  }
  // Two lamps may then be anywhere in the picture; two more tell its velocity, by the time between their
  // lines; others are where they should be.
  static const size_t moving = 4;
  static const double height = 1; // m, of a lamp, about
  const vpVlpFilter &filter = likeliest().filter;
  const double unknown =
      filter.startVelocity * (frame.lamps.back().time - frame.lamps.front().time) / height; // of a ray
  double most = std::log(hypotheses.relocation);
  for (size_t k = 0; k < frame.lamps.size(); ++k) {
    const Eigen::Matrix2d wide =
        frame.lamps[k].sight.covariance + unknown * unknown * Eigen::Matrix2d::Identity();
    most += k < fewest   ? std::max(frame.logUniform, 0.0) + 2
            : k < moving ? -std::log(2 * M_PI) - 0.5 * std::log(wide.determinant())
                         : frame.lamps[k].logPeak;
  }
  double now = -1e300;
  for (const vpPoseHypothesis &place : m_places) {
    now = std::max(now, place.logWeight);
  }
  return most > now + std::log(hypotheses.negligible);
}

bool vpPoseMixture::mayBeOff(const vpLampFrame &frame, const vpVlpHypotheses &hypotheses)
{
  static const size_t fewest = 3; // lamps, of which two tell any pose
  vpPoseHypothesis &place = m_places.front();
  if (frame.lamps.size() < fewest || m_places.size() > 1 || place.improbability() < place.allowed) {
    return false;
  }
  place.allowed = place.improbability() - std::log(hypotheses.boast);
  return true;
}

void vpPoseMixture::addWider(vpPoseHypothesis place, const vpVlpHypotheses &hypotheses, bool isFirst)
{
  place.logWeight = likeliest().logWeight + std::log(hypotheses.boast) +
                    (isFirst ? place.logLikelihood() - likeliest().logLikelihood() : 0);
  m_places.push_back(std::move(place));
}

void vpPoseMixture::addElsewhere(const vpLampFrame &frame, vpPoseHypothesis place,
                                 const vpVlpHypotheses &hypotheses, double since)
{
  static const size_t fewest = 2; // lamps that a pose needs
  const vpPoseHypothesis &here = likeliest();
  const vpPoseHypothesis::Begun begun = place.begun(here);
  place.borneOut = place.accepted() > fewest;
  place.logWeight = std::log(hypotheses.relocation * since * here.odometryIsOff()) + begun.put;
  std::vector<vpPoseHypothesis> more;
  if (!place.borneOut) { // or the lamps have given way to others
    more.push_back(here.coasted(frame));
    more.back().logWeight = std::log(hypotheses.copy * since) + begun.copied;
  }
  more.push_back(std::move(place));
  std::move(more.begin(), more.end(), std::back_inserter(m_places));
}

//! Whether two places are one: pose and velocity of the other are within what the first is uncertain by.
bool vpPoseMixture::agree(const vpPoseHypothesis &place, const vpPoseHypothesis &other)
{
  const vpVlpFilter::Pose pose = place.filter.pose(), otherPose = other.filter.pose();
  const Eigen::Matrix3d turn = pose.wMb.linear().transpose() * otherPose.wMb.linear();
  Eigen::Array<double, 6, 1> apart, sigma;
  apart << (otherPose.wMb.translation() - pose.wMb.translation()).head<2>(),
      std::atan2(turn(1, 0), turn(0, 0)), other.filter.velocity() - place.filter.velocity();
  sigma << pose.covariance.diagonal()(0), pose.covariance.diagonal()(1), pose.covariance.diagonal()(5),
      place.filter.velocityCovariance().diagonal();
  return (apart.square() < sigma).all();
}

void vpPoseMixture::reduce(const vpVlpHypotheses &hypotheses)
{
  std::sort(m_places.begin(), m_places.end(),
            [](const vpPoseHypothesis &a, const vpPoseHypothesis &b) { return a.logWeight > b.logWeight; });
  const double most = m_places.front().logWeight;
  const auto negligible = [&](const vpPoseHypothesis &place) {
    return place.logWeight < most + std::log(hypotheses.negligible) ||
           (&place != &m_places.front() &&
            place.filter.state(place.filter.pose()) == vpVlpFilter::State::lost);
  };
  static const size_t many = 4;
  size_t kept = 1;
  while (kept < std::min(many, m_places.size()) && !negligible(m_places[kept])) {
    ++kept;
  }
  m_places.erase(m_places.begin() + static_cast<long>(kept), m_places.end());
  for (size_t p = 1; p < m_places.size();) {
    const bool same = m_places[p].filter.doubtsClaims() == likeliest().filter.doubtsClaims() &&
                      agree(likeliest(), m_places[p]);
    p += same ? 0 : 1;
    if (same) {
      m_places.erase(m_places.begin() + static_cast<long>(p));
    }
  }
  double sum = 0;
  for (const vpPoseHypothesis &place : m_places) {
    sum += std::exp(place.logWeight - most);
  }
  for (vpPoseHypothesis &place : m_places) {
    place.logWeight -= most + std::log(sum);
  }
}

bool vpPoseMixture::lost() const
{
  return likeliest().filter.state(likeliest().filter.pose()) == vpVlpFilter::State::lost;
}

void vpPoseMixture::tell(const vpLampFrame &frame, const vpVlpHypotheses &hypotheses,
                         vpVlpLocation &location) const
{
  likeliest().mark(frame, location.observations);
  vpVlpFix &fix = location.fix;
  likeliest().tell(frame, fix);
  location.relocated = !likeliest().borneOut;
  const vpBasePose pose = vpBasePose::of(fix.wMb);
  double elsewhere = 0;
  for (size_t p = 1; p < m_places.size(); ++p) {
    const vpPoseHypothesis &place = m_places[p];
    const double weight = std::exp(place.logWeight);
    const vpVlpFix there = place.filter.marked();
    const Eigen::Matrix<double, 6, 1> apart = pose.stepTo(vpBasePose::of(there.wMb));
    fix.covariance += weight * apart * apart.transpose();
    if (apart.head<2>().norm() > place.filter.trackingSigma ||
        std::abs(apart(5)) > place.filter.trackingYaw) {
      elsewhere += weight;
      if (elsewhere == weight) {
        fix.other = there.wMb;
      }
    }
  }
  fix.ambiguous = elsewhere > 1 - hypotheses.decided;
}

END_VISP_NAMESPACE
