/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_servo/vpServoSafety.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_servo/vpPoseSource.h>

BEGIN_VISP_NAMESPACE

namespace
{
//! Standard deviation of the worse of x and y, m.
double placeSigma(const vpVlpFix &fix)
{
  return std::sqrt(std::max(fix.covariance(0, 0), fix.covariance(1, 1)));
}

double yawSigma(const vpVlpFix &fix)
{
  return std::sqrt(fix.covariance(5, 5));
}

//! From \e last towards \e wanted, by no more than speeding up and braking allow.
double ramped(double last, double wanted, double up, double down)
{
  const double side = last < 0 || (last == 0 && wanted < 0) ? -1 : 1;
  return side * std::clamp(side * wanted, std::max(0.0, side * last - down), side * last + up);
}

std::string millimetres(double metres)
{
  return std::to_string(std::lround(1000 * metres)) + " mm";
}

//! To thousandths.
std::string rounded(double value)
{
  return vpNumberText(std::round(1000 * value) / 1000);
}
} // namespace

void vpServoSafetySettings::check() const
{
  const std::pair<const char *, double> positive[] = {
      {"acceleration", acceleration},      {"braking", braking},  {"turn acceleration", turnAcceleration},
      {"sigma slow", sigmaSlow},           {"yaw slow", yawSlow}, {"confirmations", confirmations},
      {"picture timeout", pictureTimeout}, {"give up", giveUp},   {"compare time", compareTime},
      {"way deviations", wayDeviations}};
  for (const auto &[name, value] : positive) {
    if (!(value > 0 && std::isfinite(value))) {
      throw vpException(vpException::badValue, std::string("safety: ") + name + ": " + vpNumberText(value) +
                                                   ", expected a number above 0");
    }
  }
  if (!(sigmaStop > sigmaSlow && yawStop > yawSlow)) {
    throw vpException(vpException::badValue,
                      "safety: sigma stop, yaw stop: " + vpNumberText(sigmaStop) + " m, " +
                          vpNumberText(yawStop) + " rad, expected more than sigma slow, " +
                          vpNumberText(sigmaSlow) + " m, and yaw slow, " + vpNumberText(yawSlow) + " rad");
  }
  if (fence && fence->isEmpty()) {
    throw vpException(vpException::badValue, "safety: fence: nothing within it, expected corners in order");
  }
}

vpServoSafety::vpServoSafety(const vpServoSafetySettings &settings, const vpBaseLimits &limits,
                             bool needsPictures)
    : m_settings(settings), m_limits(limits), m_needsPictures(needsPictures)
{
  settings.check();
}

void vpServoSafety::addPicture(double known, const vpVlpLocation &location)
{
  const double age = known - location.timestamp; // s
  const bool current = age >= 0 && age <= m_settings.pictureTimeout;
  m_misdated.clear();
  if (!current) {
    m_misdated = age < 0 ? "the picture is dated " + rounded(-age) + " s ahead of the clock"
                         : "the picture is " + rounded(age) + " s old, at most " +
                               vpNumberText(m_settings.pictureTimeout) + " are allowed";
  }
  m_lastPicture = current ? known : m_lastPicture;
  const bool good = current && location.fix.valid && !location.fix.ambiguous && location.tracked &&
                    placeSigma(location.fix) < m_settings.sigmaSlow &&
                    yawSigma(location.fix) < m_settings.yawSlow;
  m_confirmed = good ? m_confirmed + 1 : 0;
  m_undecided = location.relocated ? "the lamps show another place than the base's motion leads to, and no "
                                     "third lamp bears it out"
                : location.fix.ambiguous ? "the lamps may have been seen from either of two places"
                                         : "";
}

void vpServoSafety::fail(const std::string &reason)
{
  m_failure = m_failure.empty() ? reason : m_failure;
}

void vpServoSafety::setOffset(double now, double offset, bool atEnd)
{
  m_endBegan = atEnd ? std::make_optional(m_endBegan.value_or(now)) : std::nullopt;
  if (offset > m_settings.farthest || (m_endBegan && now - *m_endBegan > m_settings.giveUp)) {
    fail("the base does not follow: it is " + millimetres(offset) + " off its reference");
  }
}

//! Why the base had better stand for now, or empty.
std::string vpServoSafety::unsafe(double now, const vpVlpFix &fix) const
{
  if (!fix.valid) {
    return "no pose: " + fix.refusal;
  }
  if (!(fix.covariance.allFinite() && placeSigma(fix) <= m_settings.sigmaStop)) {
    return "the position is uncertain by " + millimetres(placeSigma(fix)) + ", at most " +
           millimetres(m_settings.sigmaStop) + " are allowed";
  }
  if (!(yawSigma(fix) <= m_settings.yawStop)) {
    return "the yaw is uncertain by " + rounded(yawSigma(fix)) + " rad, at most " +
           vpNumberText(m_settings.yawStop) + " are allowed";
  }
  if (!m_undecided.empty()) {
    return m_undecided;
  }
  if (!m_misdated.empty()) {
    return m_misdated;
  }
  if (m_needsPictures && !m_lastPicture) {
    return "no picture yet";
  }
  if (m_needsPictures && now - *m_lastPicture > m_settings.pictureTimeout) {
    return "no picture for " + vpNumberText(m_settings.pictureTimeout) + " s";
  }
  return "";
}

void vpServoSafety::addOdometry(const vpOdometry &sample)
{
  if (m_odometry) {
    m_oMb = vpDrivenOn(m_oMb, {sample.v, sample.w}, sample.timestamp - m_odometry->timestamp);
  }
  m_odometry = sample;
}

//! Why the pose's way cannot be that of the wheels, or empty.
std::string vpServoSafety::leavesWheels(double now, const vpVlpFix &fix)
{
  if (!m_needsPictures || !m_odometry) {
    return "";
  }
  m_places.push_back({now, fix, m_oMb});
  while (m_places.front().time < now - m_settings.compareTime) {
    m_places.pop_front();
  }
  const Place &before = m_places.front();
  const vpHomogeneousMatrix driven = before.oMb.inverse() * m_oMb;
  const vpHomogeneousMatrix off = driven.inverse() * before.fix.wMb.inverse() * fix.wMb;
  const double place = std::hypot(off[0][3], off[1][3]), turn = std::abs(std::atan2(off[1][0], off[0][0]));
  const double mostPlace = std::max(
      m_settings.sigmaStop, m_settings.wayDeviations * std::hypot(placeSigma(before.fix), placeSigma(fix)));
  const double mostTurn = std::max(m_settings.yawStop, m_settings.wayDeviations *
                                                           std::hypot(yawSigma(before.fix), yawSigma(fix)));
  if (place <= mostPlace && turn <= mostTurn) {
    return "";
  }
  return "the pose moves otherwise than the wheels, by " + millimetres(place) + " and " + rounded(turn) +
         " rad within " + rounded(now - before.time) + " s, at most " + millimetres(mostPlace) + " and " +
         rounded(mostTurn) + " rad are allowed";
}

vpServoPermit vpServoSafety::permit(double now, const vpVlpFix &fix)
{
  if (m_now && now < *m_now) {
    fail("the clock was set back by " + rounded(*m_now - now) + " s");
  }
  m_now = now;
  if (m_battery && *m_battery < m_settings.batteryLow) {
    fail("the battery is low: " + vpNumberText(*m_battery) + " V, at least " +
         vpNumberText(m_settings.batteryLow) + " V are needed");
  }
  std::string reason = unsafe(now, fix);
  if (!reason.empty()) {
    m_places.clear(); // while it stands, somebody may put it elsewhere
  } else if (const std::string off = leavesWheels(now, fix); !off.empty()) {
    fail(off);
  }
  if (reason.empty() && leavesFence(fix)) {
    fail("the base is about to leave the fence at x " + rounded(fix.wMb[0][3]) + " m, y " +
         rounded(fix.wMb[1][3]) + " m");
  }
  if (reason.empty() && m_needsPictures && !m_moving && m_confirmed < m_settings.confirmations) {
    reason = "the pose is not confirmed yet";
  } else if (!reason.empty() && m_moving) {
    m_confirmed = 0; // it has to be confirmed anew
  }
  if (reason.empty()) {
    m_waitBegan.reset();
  } else if (!m_waitBegan) {
    m_waitBegan = now;
  } else if (now - *m_waitBegan > m_settings.giveUp) {
    fail(reason);
  }
  m_moving = reason.empty() && m_failure.empty();
  if (m_moving) {
    return {share(fix), "", false};
  }
  return {0, m_failure.empty() ? reason : m_failure, !m_failure.empty()};
}

//! As certain as that, from 1 down to a fifth.
double vpServoSafety::share(const vpVlpFix &fix) const
{
  constexpr double slowest = 0.2;
  const double place =
      (placeSigma(fix) - m_settings.sigmaSlow) / (m_settings.sigmaStop - m_settings.sigmaSlow);
  const double yaw = (yawSigma(fix) - m_settings.yawSlow) / (m_settings.yawStop - m_settings.yawSlow);
  return 1 - (1 - slowest) * std::clamp(std::max(place, yaw), 0.0, 1.0);
}

//! Whether the base would come to its stand beyond the fence if it braked now.
bool vpServoSafety::leavesFence(const vpVlpFix &fix) const
{
  if (!m_settings.fence) {
    return false;
  }
  const double v = m_command.v;
  const double way = std::abs(v) * m_settings.reaction + v * v / (2 * m_settings.braking);
  const Eigen::Vector2d place(fix.wMb[0][3], fix.wMb[1][3]);
  const Eigen::Vector2d ahead(fix.wMb[0][0], fix.wMb[1][0]);
  constexpr double sigmas = 3;
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(sigmas * placeSigma(fix));
  const Eigen::AlignedBox2d inner(m_settings.fence->min() + margin, m_settings.fence->max() - margin);
  return !inner.contains(place) || !inner.contains(place + (v < 0 ? -way : way) * ahead);
}

vpBaseVelocity vpServoSafety::limited(const vpBaseVelocity &wanted, double dt)
{
  if (!(std::isfinite(wanted.v) && std::isfinite(wanted.w))) {
    fail("the control law gave no number");
  }
  if (!m_moving || !m_failure.empty()) {
    m_command = vpBaseVelocity();
    return m_command;
  }
  const vpBaseVelocity target = m_limits.saturated(wanted);
  const double turnStep = m_settings.turnAcceleration * dt;
  m_command.v = ramped(m_command.v, target.v, m_settings.acceleration * dt, m_settings.braking * dt);
  m_command.w = std::clamp(target.w, m_command.w - turnStep, m_command.w + turnStep);
  m_command = m_limits.saturated(m_command); // the ramps of v and w cut their corner otherwise
  return m_command;
}

END_VISP_NAMESPACE
