/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// How vpVlpLocalizer begins to carry a pose.

#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "vpLampConsensus.h"
#include "vpLampGeometry.h"
#include "vpLampTrust.h"
#include "vpSurprise.h"
#include "vpVlpScratch.h"

BEGIN_VISP_NAMESPACE

//! Starts the filter at the location's pose, with the lamps that it rests on.
void vpVlpLocalizer::begin(vpVlpLocation &location)
{
  filter.freeAttitude = manyLamps.attitude == vpManyLampSolver::Attitude::free;
  const bool first = !filter.started();
  bool moving = startAt(location);
  m_trust->forgetPlaces();
  m_trust->mapTolerance = mapTolerance;
  const std::vector<const vpLamp *> &lamps = lampsOf(location.observations);
  for (size_t i = 0; i < lamps.size(); ++i) {
    const vpLampObservation &seen = location.observations[i];
    if (lamps[i] != nullptr && (seen.accepted || seen.remark == vpLampConsensus::elsewhere)) {
      m_trust->doubtPlace(*lamps[i], !seen.accepted);
    }
  }
  m_disagreements = m_followed = 0; // what contradicts the claims of camera and map does so still
  m_refused = false;
  const std::vector<size_t> members = membersOf(location);
  if (first && strain(location, members) > mostStrain) { // later it may be a robot that starts or stops
    filter.doubtClaims();
    moving = startAt(location);
  }
  vpVlpLocation rough = location, fine = location;
  correct(rough, members);
  filter.startAgain();
  m_trust->forgetPlaces();
  addMotionDoubt(location, members);
  correct(fine, members);
  m_moving = moving;
  // One frame alone hardly tells a robot that moves from lamps that hang a little elsewhere.
  if (moving && fine.fix.valid) {
    vpSurprise::doubt(fine.fix);
    location.fix.wMb = fine.fix.wMb;
    location.fix.wMc = fine.fix.wMc;
    location.fix.covariance = fine.fix.covariance;
  }
}

//! Observations that the location's pose rests on.
std::vector<size_t> vpVlpLocalizer::membersOf(const vpVlpLocation &location)
{
  std::vector<size_t> members;
  for (size_t i = 0; i < location.observations.size(); ++i) {
    if (location.observations[i].accepted) {
      members.push_back(i);
    }
  }
  return members;
}

/*!
  What a single frame's pose is off by where the robot moved between its time stamp and the lamps' lines: the
  rays of each are those of a base that has moved on, and the pose that explains all of them best is that of a
  base that stands, and errs in height as well.
*/
void vpVlpLocalizer::addMotionDoubt(vpVlpLocation &location, const std::vector<size_t> &members) const
{
  const std::vector<const vpLamp *> &lamps = lampsOf(location.observations);
  const vpBasePose pose = vpBasePose::of(location.fix.wMb);
  const vpMountFrame frame(m_rig);
  Eigen::Matrix<double, 6, 3> byVelocity = Eigen::Matrix<double, 6, 3>::Zero(); // of the base, in one second
  byVelocity.topLeftCorner<3, 2>() = pose.wRb.leftCols<2>();
  byVelocity(5, 2) = 1;
  vpMatrix6d normal = vpMatrix6d::Zero();
  Eigen::Matrix<double, 6, 3> moved = Eigen::Matrix<double, 6, 3>::Zero();
  for (size_t i : members) {
    const vpLampObservation &seen = location.observations[i];
    const vpLampSight sight = vpLampSight::from(*lamps[i], seen, m_rig.camera);
    const vpPredictedRay ray = predictRay(sight.position, pose, frame);
    if (ray.inFront) {
      const vpMatrix6d weight = ray.derivative.transpose() * rayDoubt(sight, ray).inverse() * ray.derivative;
      normal += weight;
      moved += (timeOf(location, seen) - location.timestamp) * weight * byVelocity;
    }
  }
  const bool level = manyLamps.attitude != vpManyLampSolver::Attitude::free;
  if (level) { // roll and pitch are the rig's, whatever the rays say
    normal.middleRows<2>(3).setZero();
    normal.middleCols<2>(3).setZero();
    normal.block<2, 2>(3, 3).setIdentity();
    moved.middleRows<2>(3).setZero();
  }
  const Eigen::Matrix<double, 6, 3> error = normal.ldlt().solve(moved);
  location.fix.covariance +=
      error * (filter.velocityCovariance() + filter.velocity() * filter.velocity().transpose()) *
      error.transpose();
}

//! \return Whether the velocity is what the last pose tells: there is one that the robot can have come from.
bool vpVlpLocalizer::startAt(const vpVlpLocation &location)
{
  static const double recently = 1; // s
  filter.start(location.fix.wMb, location.timestamp);
  // What a frame showed that was refused since then has proved right: the robot was elsewhere already.
  const bool already = m_apart && !(m_lastPose && m_lastPose->time > m_apart->time);
  const std::optional<LastPose> &last = already ? m_apart : m_lastPose;
  if (!last || location.timestamp - last->time >= recently) {
    return false;
  }
  const double since = location.timestamp - last->time;
  const vpHomogeneousMatrix way = last->fix.wMb.inverse() * location.fix.wMb;
  const double turn = std::atan2(way[1][0], way[0][0]);
  if (std::hypot(way[0][3], way[1][3]) > maxSpeed * since || std::abs(turn) > maxTurnRate * since) {
    return false; // it was carried
  }
  filter.comeFrom(last->fix, since);
  return true;
}

END_VISP_NAMESPACE
