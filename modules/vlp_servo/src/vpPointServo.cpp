/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_servo/vpPointServo.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vs/vpAdaptiveGain.h>

BEGIN_VISP_NAMESPACE

void vpPointServoSettings::check() const
{
  const std::pair<const char *, double> positive[] = {
      {"look-ahead", lookAhead}, {"gain", gain}, {"gain of large errors", gainFar}};
  for (const auto &[name, value] : positive) {
    if (!(value > 0 && std::isfinite(value))) {
      throw vpException(vpException::badValue, std::string("servo: ") + name + ": " + vpNumberText(value) +
                                                   ", expected a number above 0");
    }
  }
  const std::pair<const char *, double> notNegative[] = {
      {"gain slope", gainSlope}, {"integral gain", integralGain},      {"steepest", steepest},
      {"slowest", slowest},      {"most speed scale", mostSpeedScale}, {"most curvature", mostCurvature}};
  for (const auto &[name, value] : notNegative) {
    if (!(value >= 0 && std::isfinite(value))) {
      throw vpException(vpException::badValue, std::string("servo: ") + name + ": " + vpNumberText(value) +
                                                   ", expected a number of 0 or more");
    }
  }
  if (gainFar > gain) {
    throw vpException(vpException::badValue, "servo: gain of large errors: " + vpNumberText(gainFar) +
                                                 ", expected no more than that of small ones, " +
                                                 vpNumberText(gain));
  }
}

vpPointServo::vpPointServo(const vpPointServoSettings &settings) : m_settings(settings)
{
  settings.check();
  vpMatrix eJe(6, 2, 0); // q = (v, w): along x, about z
  eJe[0][0] = 1;
  eJe[5][1] = 1;
  m_unicycle.set_eJe(eJe);
  m_unicycle.set_cMe(vpHomogeneousMatrix(-settings.lookAhead, 0, 0, 0, 0, 0));

  m_desired.set_XYZ(0, 0, 0);
  m_task.setServo(vpServo::EYEINHAND_L_cVe_eJe);
  m_task.setInteractionMatrixType(vpServo::CURRENT, vpServo::PSEUDO_INVERSE);
  if (settings.gain > settings.gainFar && settings.gainSlope > 0) {
    m_task.setLambda(vpAdaptiveGain(settings.gain, settings.gainFar, settings.gainSlope));
  } else {
    m_task.setLambda(settings.gain);
  }
  m_task.addFeature(m_point, m_desired, vpFeaturePoint3D::selectX() | vpFeaturePoint3D::selectY());
}

vpPointServo::~vpPointServo()
{
  m_task.kill();
}

vpBaseVelocity vpPointServo::velocity(const vpHomogeneousMatrix &wMb, const vpReference &reference, double dt)
{
  const double ahead = m_settings.lookAhead;
  const Eigen::Rotation2Dd bRw(-std::atan2(wMb[1][0], wMb[0][0])), wRr(reference.heading);
  const Eigen::Vector2d point = reference.place + wRr * Eigen::Vector2d(ahead, 0);
  m_error = bRw * (point - Eigen::Vector2d(wMb[0][3], wMb[1][3])) - Eigen::Vector2d(ahead, 0);
  const Eigen::Vector2d error = limited(m_error, reference.v);

  m_point.set_XYZ(error.x(), error.y(), 0);
  m_task.set_cVe(m_unicycle.get_cVe());
  m_task.set_eJe(m_unicycle.get_eJe());
  const vpColVector feedback = m_task.computeControlLaw();

  const Eigen::Vector2d rate = bRw * (wRr * Eigen::Vector2d(reference.v, ahead * reference.w));
  vpColVector dedt(2);
  dedt[0] = rate.x();
  dedt[1] = rate.y();
  const vpColVector q = feedback - m_task.getTaskJacobianPseudoInverse() * dedt;

  if (error == m_error) {
    integrate(reference.v, dt);
  }
  return {q[0] + reference.v * m_integral.x(), q[1] + reference.v * m_integral.y()};
}

//! The error that feedback is to work on.
Eigen::Vector2d vpPointServo::limited(const Eigen::Vector2d &error, double speed) const
{
  const double across = m_settings.steepest * std::max(speed, m_settings.slowest) / m_settings.gain;
  constexpr double along = 0.05;  // m
  constexpr double nearest = 0.4; // of the look-ahead that is left of it, lest J be singular
  return {std::clamp(error.x(), std::max(-along, (nearest - 1) * m_settings.lookAhead), along),
          std::clamp(error.y(), -across, across)};
}

/*!
  An error that stays tells of wheels that err in proportion to the speed. With gain lambda and integral gain
  mu, errors obey s^2 + lambda s + lambda mu = 0: no overshoot as long as mu <= lambda / 4. At a crawl, as on
  the way out of a corner, an error is more likely left over from before, and is summed up the less.
*/
void vpPointServo::integrate(double speed, double dt)
{
  constexpr double crawl = 0.05; // m/s
  const double rate =
      m_settings.gain * m_settings.integralGain * dt / std::max(speed, crawl) * std::min(1.0, speed / crawl);
  const Eigen::Vector2d most(m_settings.mostSpeedScale, m_settings.mostCurvature);
  const Eigen::Vector2d error(m_error.x(), m_error.y() / m_settings.lookAhead);
  // More than the largest disturbance would leave is not its doing: the base was put there, or pushed.
  if ((m_settings.gain * error.cwiseAbs().array() > speed * most.array()).any()) {
    return;
  }
  m_integral = (m_integral + rate * error).cwiseMax(-most).cwiseMin(most);
}

END_VISP_NAMESPACE
