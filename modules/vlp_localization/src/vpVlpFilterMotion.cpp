/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// How vpVlpFilter predicts: along the odometry, and by random accelerations where there is none.

#include <visp3/vlp_localization/vpVlpFilter.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <visp3/core/vpException.h>
#include <visp3/core/vpMath.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

void vpVlpFilter::addOdometry(const vpOdometry &sample)
{
  const std::pair<const char *, double> fields[] = {
      {"timestamp", sample.timestamp}, {"v", sample.v}, {"w", sample.w}};
  for (const auto &[name, value] : fields) {
    if (!std::isfinite(value)) {
      throw vpException(vpException::badValue, std::string("odometry: ") + name + ": " + vpNumberText(value) +
                                                   ", expected a finite number");
    }
  }
  if (!m_odometry.empty() && sample.timestamp < m_odometry.back().timestamp - clockSetBack) {
    m_odometry.clear();
    m_followed = -1e300;
  }
  if (m_odometry.empty() || sample.timestamp > m_odometry.back().timestamp) {
    m_odometry.push_back(sample);
  }
  static const size_t kept = 1000; // while nothing uses them up
  if (!m_started && m_odometry.size() > kept) {
    m_odometry.erase(m_odometry.begin());
  }
}

void vpVlpFilter::takeOdometry(const vpVlpFilter &other)
{
  for (const vpOdometry &sample : other.m_odometry) {
    if (m_odometry.empty() || sample.timestamp > m_odometry.back().timestamp) {
      m_odometry.push_back(sample);
    }
  }
}

bool vpVlpFilter::rolls() const
{
  static const double standing = 3; // standard deviations of what they may say then
  return !m_odometry.empty() && (std::abs(m_odometry.back().v) > standing * odometrySpeed ||
                                 std::abs(m_odometry.back().w) > standing * odometryTurnRate);
}

//! The base on its arc for \e dt, its velocity constant; backwards where that is negative.
void vpVlpFilter::arc(double dt)
{
  const double bend = 0.5 * m_x(w) * dt, chord = std::abs(bend) > 1e-9 ? std::sin(bend) / bend : 1;
  m_x.head<2>() += Eigen::Rotation2Dd(m_x(yaw) + bend) * (chord * dt * m_x.segment<2>(vx));
  m_x(yaw) = std::remainder(m_x(yaw) + m_x(w) * dt, 2 * M_PI);
  if (freeAttitude) { // along the plane in which it stands, to first order
    m_x(z) += dt * (m_x(roll) * m_x(vy) - m_x(pitch) * m_x(vx));
  }
}

//! The same with its covariance. \e accelerates: its velocity walks at random.
void vpVlpFilter::move(double dt, bool accelerates)
{
  const Eigen::Vector2d v = m_x.segment<2>(vx);
  const double bend = 0.5 * m_x(w) * dt, chord = std::abs(bend) > 1e-9 ? std::sin(bend) / bend : 1;
  const Eigen::Rotation2Dd R(m_x(yaw) + bend);
  const Eigen::Vector2d ahead = R * v, left(-ahead.y(), ahead.x()); // left: derivative by the heading
  arc(dt);

  // P = F P F', F being the identity but for the rows of x, y and yaw.
  const Eigen::Matrix2d turned = dt * R.toRotationMatrix();
  auto carry = [&](auto &&P) { // by rows
    P.row(x) += chord * dt * left.x() * P.row(yaw) + turned(0, 0) * P.row(vx) + turned(0, 1) * P.row(vy) +
                0.5 * dt * dt * left.x() * P.row(w);
    P.row(y) += chord * dt * left.y() * P.row(yaw) + turned(1, 0) * P.row(vx) + turned(1, 1) * P.row(vy) +
                0.5 * dt * dt * left.y() * P.row(w);
    P.row(yaw) += dt * P.row(w);
    if (freeAttitude) {
      P.row(z) +=
          dt * (v.y() * P.row(roll) - v.x() * P.row(pitch) + m_x(roll) * P.row(vy) - m_x(pitch) * P.row(vx));
    }
  };
  carry(m_P);
  carry(m_P.transpose());
  if (m_aside) {
    carry(m_offset);
  }

  const double t = std::abs(dt);
  static const double least = 0.01; // of the drift: lamps' outlines are not wrong anew in every frame
  m_P(z, z) += vpMath::sqr(std::max(manoeuvreShare, least) * drift) * t;
  if (freeAttitude) {
    m_P(roll, roll) += vpMath::sqr(tiltDrift) * t;
    m_P(pitch, pitch) += vpMath::sqr(tiltDrift) * t;
    m_P(z, z) += vpMath::sqr(rollingTilt) * v.squaredNorm() * t; // what leans may be the camera alone
  }
  if (accelerates) {
    // Accelerations along x and y of b are alike, so that the heading does not matter.
    const double a = vpMath::sqr(manoeuvreShare * acceleration),
                 b = vpMath::sqr(manoeuvreShare * turnAcceleration);
    const double sign = dt < 0 ? -1 : 1;
    const Eigen::Matrix2d velocityPlace = sign * 0.5 * a * t * t * R.toRotationMatrix();
    m_P.block<2, 2>(x, x).diagonal().array() += a * t * t * t / 3;
    m_P.block<2, 2>(x, vx) += velocityPlace;
    m_P.block<2, 2>(vx, x) += velocityPlace.transpose();
    m_P.block<2, 2>(vx, vx).diagonal().array() += a * t;
    m_P(yaw, yaw) += b * t * t * t / 3;
    m_P(yaw, w) += sign * 0.5 * b * t * t;
    m_P(w, yaw) += sign * 0.5 * b * t * t;
    m_P(w, w) += b * t;
  }
}

//! The velocity in the sample's interval: followed, it is that, whatever it was before.
void vpVlpFilter::useOdometry(const vpOdometry &before, const vpOdometry &sample)
{
  const double dt = sample.timestamp - before.timestamp;
  const Eigen::RowVector3d forward = Eigen::RowVector3d::UnitX(), sideways = Eigen::RowVector3d::UnitY(),
                           turning = Eigen::RowVector3d::UnitZ();
  const bool follows = odometry == Odometry::followed;
  const double starts = vpMath::sqr(acceleration) * dt; // or stops
  if (follows) {
    m_P.block<2, 2>(vx, vx).diagonal().array() += starts;
    m_P(w, w) += vpMath::sqr(turnAcceleration) * dt;
  }
  const double ahead = std::cos(m_x(wheels)), aside = std::sin(m_x(wheels)), scale = 1 + m_x(speedScale),
               along = ahead * m_x(vx) + aside * m_x(vy), across = ahead * m_x(vy) - aside * m_x(vx);
  Derivative<3> H;
  H.add(vx, scale * ahead * forward - aside * sideways);
  H.add(vy, scale * aside * forward + ahead * sideways);
  H.add(speedScale, along * forward);
  H.add(wheels, scale * across * forward - along * sideways);
  H.add(w, (1 + m_x(turnScale)) * turning);
  H.add(turnScale, m_x(w) * turning);
  H.add(turnBias, turning);
  // An error that changes from sample to sample averages out over samples, however long they are.
  static const double nominal = 0.02; // s
  const double share = odometryShare * std::sqrt(nominal / std::max(dt, 1e-3));
  const Eigen::Vector3d sigma(std::hypot(odometrySpeed, share * sample.v), odometrySpeed,
                              std::hypot(odometryTurnRate, share * sample.w));
  // Where speeds change from sample to sample they do so within one.
  static const double within = 0.3; // share of the change, standard deviation
  const Eigen::Vector3d changes = within * Eigen::Vector3d(sample.v - before.v, 0, sample.w - before.w);
  const Eigen::Vector3d innovation(sample.v - scale * along, -across,
                                   sample.w - (1 + m_x(turnScale)) * m_x(w) - m_x(turnBias)),
      seen = innovation - this->aside(H), noise = sigma.cwiseAbs2() + changes.cwiseAbs2();
  Eigen::Matrix3d S = measure<3>(H, seen, noise.asDiagonal());
  // A steady motion has no changes, and wheels that start or stop do not do so sideways.
  S.diagonal() -= follows ? Eigen::Vector3d(0, starts, 0) : Eigen::Vector3d(changes.cwiseAbs2());
  const double logDensity =
      -0.5 * (seen.dot(S.inverse() * seen) + std::log(S.determinant()) + 3 * std::log(2 * M_PI));
  m_leastOdometry = std::min(m_leastOdometry, logDensity);
}

void vpVlpFilter::advance(double time)
{
  if (!m_started) {
    return;
  }
  while (m_odometry.size() > 1 && m_odometry[1].timestamp <= m_time) {
    m_odometry.erase(m_odometry.begin());
  }
  while (time > m_time && m_odometry.size() > 1) {
    const vpOdometry &begin = m_odometry[0], &end = m_odometry[1];
    static const double gap = 0.5; // s: of a longer interval the mean says little
    if (begin.timestamp > m_time) {
      wander(std::min(time, begin.timestamp));
      continue;
    }
    const double until = std::min(time, end.timestamp);
    const bool tells = odometry != Odometry::ignored && !(end.timestamp - begin.timestamp > gap);
    if (tells && m_followed != end.timestamp) {
      useOdometry(begin, end);
      m_followed = end.timestamp;
    }
    if (tells && odometry == Odometry::followed) {
      move(until - m_time, false);
      m_time = until;
    } else {
      wander(until);
    }
    if (m_time == end.timestamp) {
      m_odometry.erase(m_odometry.begin());
    }
  }
  wander(time);
}

//! To a time by random accelerations.
void vpVlpFilter::wander(double time)
{
  static const double longest = 0.1; // s, of a step
  const double way = time - m_time;
  const int steps = std::clamp(static_cast<int>(std::ceil(std::min(1e6, std::abs(way)) / longest)), 1, 1000);
  for (int k = 0; k < steps && way != 0; ++k) {
    move(way / steps, true);
  }
  m_time = time;
}

END_VISP_NAMESPACE
