/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// How vpVlpFilter begins, begins again, and mixes what comes of several hypotheses.

#include <visp3/vlp_localization/vpVlpFilter.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <visp3/core/vpMath.h>

#include "vpVlpFilterParts.h"

BEGIN_VISP_NAMESPACE

void vpVlpFilter::start(const vpHomogeneousMatrix &wMb, double time)
{
  const vpBasePose pose = vpBasePose::of(wMb);
  const vpVlpRig &rig = m_given->rig;
  m_started = true;
  m_time = time;
  m_lamps.clear();
  m_x.setZero(lamps);
  m_x.head<3>() = pose.wtb;
  m_x(yaw) = std::atan2(pose.wRb(1, 0), pose.wRb(0, 0));
  m_x(roll) = freeAttitude ? std::atan2(pose.wRb(2, 1), pose.wRb(2, 2)) : 0;
  m_x(pitch) = freeAttitude ? -std::asin(std::clamp(pose.wRb(2, 0), -1.0, 1.0)) : 0;
  Eigen::Matrix<double, lamps, 1> sigma = Eigen::Matrix<double, lamps, 1>::Zero();
  sigma.head<3>().setConstant(startPlace);
  sigma(yaw) = startTurn;
  sigma.segment<2>(roll) =
      freeAttitude
          ? Eigen::Vector2d(startTurn, startTurn)
          : Eigen::Vector2d(rig.rotationSigma.head<2>().array().square() + vpMath::sqr(m_extraTiltSigma))
                .cwiseSqrt()
                .eval();
  sigma(speedScale) = odometryScale;
  sigma(turnScale) = odometryTurnScale;
  sigma(turnBias) = odometryTurnBias;
  sigma(wheels) = odometryHeading;
  sigma.segment<3>(mount) = rig.translationSigma;
  sigma(mount + 3) = rig.rotationSigma.z();
  const bool exact = m_extraTiltSigma == 0 && rig.rotationSigma.isZero(0) && rig.translationSigma.isZero(0);
  const double point =
      rig.principalPointSigma ? *rig.principalPointSigma / rig.camera.get_px() : (exact ? 0 : principalPoint);
  sigma.segment<3>(lens) << point, point, rig.focalLengthSigma.value_or(exact ? 0 : focalLength);
  sigma.segment<3>(vx) << startVelocity, startVelocity, startTurnRate;
  m_P.setZero(lamps, lamps);
  m_P.diagonal() = sigma.cwiseAbs2();
  m_aside = false;
  m_common.setZero();
  while (m_odometry.size() > 1 && m_odometry[1].timestamp <= m_time) {
    m_odometry.erase(m_odometry.begin());
  }
  m_start = std::make_shared<Start>(Start{m_x, m_P, m_odometry});
}

void vpVlpFilter::startAgain(bool odometryToo)
{
  Eigen::Matrix<double, 9, 1> path;
  path << m_x.segment<6>(mark0), m_x.segment<3>(vx);
  m_x = m_start->x;
  m_P = m_start->P;
  if (odometryToo) {
    m_odometry = m_start->odometry;
    m_followed = -1e300;
  }
  m_lamps.clear();
  m_time = m_markTime;
  standAside(path);
}

//! From here on linearised about a pose and velocity that are not the estimate.
void vpVlpFilter::standAside(const Eigen::Matrix<double, 9, 1> &path)
{
  m_offset.setZero(m_x.size());
  m_offset.head<9>() = m_x.head<9>() - path;
  m_offset(yaw) = std::remainder(m_offset(yaw), 2 * M_PI);
  m_x.head<9>() = path;
  carryAlong(x, -m_offset.head<2>());
  mirror();
  m_aside = true;
}

bool vpVlpFilter::linearizeAbout(const vpVlpFilter &corrected)
{
  if (odometry != Odometry::ignored && hasOdometry()) {
    return false;
  }
  const Eigen::Matrix<double, 9, 1> estimate = m_x.head<9>();
  m_x.head<6>() = corrected.m_x.segment<6>(mark0);
  m_x.segment<3>(vx) = corrected.velocity();
  arc(m_time - corrected.m_markTime);
  const Eigen::Matrix<double, 9, 1> path = m_x.head<9>();
  m_x.head<9>() = estimate;
  standAside(path);
  return true;
}

void vpVlpFilter::conclude()
{
  if (m_aside) {
    m_aside = false;
    m_x += m_offset;
    for (const Index first : {x, mark0}) {
      m_x(first + yaw) = std::remainder(m_x(first + yaw), 2 * M_PI);
      carryAlong(first, m_offset.segment<2>(first));
    }
    mirror();
  }
  if (m_noise >= 1) {
    m_common.setZero();
  } else if (m_sights > 1) {
    // In a second, which is what a calm robot's pose averages over, an outline moves on below its stripes.
    static const double alike = 0.3; // px, up to which these hide the same of it
    const double share = 1 / (1 + vpMath::sqr(m_imageSpeed / alike));
    const Eigen::Matrix4d common = share * (1 - m_noise) * m_information.inverse();
    if (common.allFinite() && common.diagonal().minCoeff() > 0) {
      m_common = common;
    }
  }
}

void vpVlpFilter::comeFrom(const vpVlpFix &before, double since)
{
  const vpBasePose pose = vpBasePose::of(before.wMb);
  const double heading = std::atan2(pose.wRb(1, 0), pose.wRb(0, 0));
  const double turned = std::remainder(m_x(yaw) - heading, 2 * M_PI);
  const Eigen::Vector2d way = m_x.head<2>() - pose.wtb.head<2>();
  const Eigen::Vector2d mean = Eigen::Rotation2Dd(-heading - turned / 2) * way / since;
  // A single frame's pose is as good as its map, whatever that says.
  const double place = std::sqrt(std::max(before.covariance(0, 0), before.covariance(1, 1))) + claimedPlace,
               turn = std::sqrt(before.covariance(5, 5)) + claimedTilt;
  const auto setVelocity = [&](Index i, double meanVelocity, double error, double random, double prior) {
    // At the end of a way a velocity that walks at random is off its mean by a third of what it walks.
    const double variance = vpMath::sqr(error / since) + vpMath::sqr(random) * since / 3,
                 share = vpMath::sqr(prior) / (vpMath::sqr(prior) + variance);
    m_x(i) = share * meanVelocity;
    m_P.row(i).setZero();
    m_P.col(i).setZero();
    m_P(i, i) = share * variance;
  };
  setVelocity(vx, mean.x(), place, acceleration, startVelocity);
  setVelocity(vy, mean.y(), place, acceleration, startVelocity);
  setVelocity(w, turned / since, turn, turnAcceleration, startTurnRate);
  m_start = std::make_shared<Start>(Start{m_x, m_P, m_start->odometry});
}

void vpVlpFilter::widenClaims()
{
  m_extraTiltSigma = std::max(claimedTilt, 2 * m_extraTiltSigma);
  m_extraPlaceSigma = std::max(claimedPlace, 2 * m_extraPlaceSigma);
}

void vpVlpFilter::mix(const std::vector<const vpVlpFilter *> &parts, const std::vector<double> &weights)
{
  static thread_local Vector mean, apart; // kept, so that it takes no memory
  static thread_local Matrix spread;
  mean.setZero(m_x.size());
  spread.setZero(m_x.size(), m_x.size());
  for (size_t k = 0; k < parts.size(); ++k) {
    apart = parts[k]->m_x - m_x;
    for (const Index first : {x, mark0}) {
      apart(first + yaw) = std::remainder(apart(first + yaw), 2 * M_PI);
    }
    mean += weights[k] * apart;
    spread += weights[k] * parts[k]->m_P;
    for (Eigen::Index column = 0; column < spread.cols(); ++column) {
      spread.col(column) += weights[k] * apart(column) * apart;
    }
  }
  m_P = spread;
  for (Eigen::Index column = 0; column < m_P.cols(); ++column) {
    m_P.col(column) -= mean(column) * mean;
  }
  m_x += mean;
}

END_VISP_NAMESPACE
