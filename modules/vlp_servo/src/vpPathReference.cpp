/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_servo/vpPathReference.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

namespace
{
constexpr double here = 1e-6; // m and rad, that count as nothing

//! The speed from which one can still stop \e way ahead, after one more period of \e dt at it.
double stoppable(double way, double deceleration, double dt)
{
  const double loss = deceleration * dt;
  return std::sqrt(loss * loss + 2 * deceleration * std::max(0.0, way)) - loss;
}
} // namespace

void vpReferenceSettings::check() const
{
  const std::pair<const char *, double> positive[] = {
      {"speed", speed},        {"acceleration", acceleration},          {"braking", braking},
      {"turn rate", turnRate}, {"turn acceleration", turnAcceleration}, {"share", share}};
  for (const auto &[name, value] : positive) {
    if (!(value > 0 && std::isfinite(value))) {
      throw vpException(vpException::badValue, std::string("reference: ") + name + ": " +
                                                   vpNumberText(value) + ", expected a number above 0");
    }
  }
  if (share > 1) {
    throw vpException(vpException::badValue,
                      "reference: share: " + vpNumberText(share) + ", expected at most 1");
  }
  if (laps == 0) {
    throw vpException(vpException::badValue, "reference: laps: 0, expected 1 or more");
  }
}

vpPathReference::vpPathReference(const vpPath &path, const vpBaseLimits &limits,
                                 const vpReferenceSettings &settings)
    : m_path(path), m_limits(limits), m_settings(settings)
{
  settings.check();
  place(0);
}

void vpPathReference::place(double s)
{
  m_now = vpReference();
  m_now.s = std::clamp(s, 0.0, end());
  const vpPathPoint point = m_path.at(m_now.s);
  m_now.place = point.place;
  m_now.heading = point.heading;
  m_toTurn = 0;
  m_left = m_now.s;
}

void vpPathReference::place(double s, double heading)
{
  place(s);
  beginTurn(heading);
}

//! At the place where it stands, from \e heading to that of the path from there on.
void vpPathReference::beginTurn(double heading)
{
  m_now.turning = true;
  m_toTurn = std::remainder(m_path.at(m_now.s).heading - heading, 2 * M_PI);
  m_now.heading = heading;
  m_now.v = m_now.w = 0;
}

double vpPathReference::end() const
{
  return m_path.length() * (m_path.closed() ? m_settings.laps : 1);
}

double vpPathReference::nextStop() const
{
  const double lap = m_path.length();
  const double before = m_path.closed() ? lap * std::floor(m_now.s / lap) : 0;
  for (const double start : {before, before + lap}) {
    for (const double corner : m_path.corners()) {
      const double s = start + corner;
      if (s > m_now.s - here && s > m_left + here) {
        return std::min(s, end());
      }
    }
  }
  return end();
}

//! In the bend at \e s, m/s.
double vpPathReference::fastest(double s) const
{
  const double curvature = std::abs(m_path.at(s).curvature);
  return std::min(m_settings.speed, m_settings.share / (1 / m_limits.v + curvature / m_limits.w));
}

//! The speed at \e s from which it can slow down in time for the bends ahead.
double vpPathReference::braked(double s, double speed) const
{
  constexpr double step = 0.005; // m
  const double reach = speed * speed / (2 * m_settings.acceleration) + step;
  double most = fastest(s);
  for (double ahead = step; ahead < reach; ahead += step) {
    const double there = fastest(std::min(s + ahead, end()));
    most = std::min(most, std::sqrt(there * there + 2 * m_settings.acceleration * ahead));
  }
  return most;
}

const vpReference &vpPathReference::advance(double dt, double share)
{
  if (m_now.turning) {
    turn(dt, share);
    return m_now;
  }
  const double stop = nextStop();
  const double wanted =
      std::min(share * braked(m_now.s + m_now.v * dt, m_now.v), // as of the end of this period
               stoppable(stop - m_now.s, m_settings.acceleration, dt));
  m_now.v = std::clamp(wanted, std::max(0.0, m_now.v - m_settings.braking * dt),
                       m_now.v + m_settings.acceleration * dt);
  m_now.s = std::min(m_now.s + m_now.v * dt, stop);
  const double before = m_now.heading;
  if (stop - m_now.s < here) {
    m_now.s = stop;
    if (stop < end() && share > 0) {
      beginTurn(before);
    }
  }
  const vpPathPoint point = m_path.at(m_now.s);
  m_now.place = point.place;
  const bool standing = stop == m_now.s;
  m_now.heading = standing ? before : point.heading; // at a corner the path's is that of the leg after it
  m_now.v = standing ? 0 : m_now.v;
  m_now.w = m_now.v * point.curvature;
  return m_now;
}

void vpPathReference::turn(double dt, double share)
{
  const double most =
      std::min(share * m_settings.turnRate, stoppable(std::abs(m_toTurn), m_settings.turnAcceleration, dt));
  const double rate = std::min(std::abs(m_now.w) + m_settings.turnAcceleration * dt, most);
  const double step = std::min(rate * dt, std::abs(m_toTurn));
  const double side = m_toTurn < 0 ? -1 : 1;
  m_now.heading = std::remainder(m_now.heading + side * step, 2 * M_PI);
  m_toTurn -= side * step;
  m_now.w = side * rate;
  if (std::abs(m_toTurn) < here) {
    m_toTurn = 0;
    m_now.w = 0;
    m_now.heading = m_path.at(m_now.s).heading;
  }
}

void vpPathReference::leaveCorner()
{
  if (turned()) {
    m_now.turning = false;
    m_left = m_now.s;
  }
}

END_VISP_NAMESPACE
