/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_servo/vpPathFollower.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

namespace
{
Eigen::Vector2d placeOf(const vpHomogeneousMatrix &wMb)
{
  return {wMb[0][3], wMb[1][3]};
}

double headingOf(const vpHomogeneousMatrix &wMb)
{
  return std::atan2(wMb[1][0], wMb[0][0]);
}
} // namespace

void vpPathFollowerSettings::check() const
{
  reference.check();
  servo.check();
  const std::pair<const char *, double> positive[] = {{"error free", errorFree},
                                                      {"slowest share", slowestShare},
                                                      {"turn first", turnFirst},
                                                      {"turn tolerance", turnTolerance},
                                                      {"end tolerance", endTolerance}};
  for (const auto &[name, value] : positive) {
    if (!(value > 0 && std::isfinite(value))) {
      throw vpException(vpException::badValue, std::string("path follower: ") + name + ": " +
                                                   vpNumberText(value) + ", expected a number above 0");
    }
  }
  if (!(errorSlowest > errorFree && slowestShare <= 1)) {
    throw vpException(vpException::badValue, "path follower: error slowest: " + vpNumberText(errorSlowest) +
                                                 " with slowest share " + vpNumberText(slowestShare) +
                                                 ", expected more than error free, " +
                                                 vpNumberText(errorFree) + ", and a share of at most 1");
  }
}

vpPathFollower::vpPathFollower(const vpPath &path, const vpBaseLimits &limits,
                               const vpPathFollowerSettings &settings)
    : m_settings(settings), m_path(path), m_reference(path, limits, settings.reference),
      m_servo(settings.servo)
{
  settings.check();
}

vpBaseVelocity vpPathFollower::follow(const vpHomogeneousMatrix &wMb, double share, double dt)
{
  const double integrated = m_cut ? 0 : dt;
  m_cut = false;
  if (share <= 0) {
    m_waiting = true;
    m_reference.advance(dt, 0);
    return {};
  }
  if (!m_joined) {
    join(wMb);
  } else if (m_waiting) {
    joinAgain(wMb);
  }
  m_waiting = false;

  const vpReference &reference = m_reference.advance(dt, share * shareByError());
  if (reference.turning) {
    vpReference onTheSpot = reference;
    onTheSpot.place = placeOf(wMb);
    if (m_reference.turned() &&
        std::abs(std::remainder(reference.heading - headingOf(wMb), 2 * M_PI)) < m_settings.turnTolerance) {
      m_reference.leaveCorner();
    }
    return m_servo.velocity(wMb, onTheSpot, 0);
  }
  const vpBaseVelocity velocity = m_servo.velocity(wMb, reference, integrated);
  m_arrived = m_reference.arrived() && std::abs(m_servo.error().x()) < m_settings.endTolerance;
  return m_arrived ? vpBaseVelocity() : velocity;
}

void vpPathFollower::join(const vpHomogeneousMatrix &wMb)
{
  const double leg = m_path.corners().empty() ? m_path.length() : m_path.corners().front();
  const double s =
      m_path.closest(placeOf(wMb), 0, m_path.closed() ? std::min(leg, m_path.length() / 2) : leg);
  m_joined = true;
  const double off = std::remainder(m_path.at(s).heading - headingOf(wMb), 2 * M_PI);
  if (std::abs(off) > m_settings.turnFirst) {
    m_reference.place(s, headingOf(wMb));
  } else {
    m_reference.place(s);
  }
}

//! After a wait: the base may stand elsewhere than the reference, which has kept its corner if it was at one.
void vpPathFollower::joinAgain(const vpHomogeneousMatrix &wMb)
{
  const vpReference &now = m_reference.now();
  if (now.turning || now.v > 0) {
    return;
  }
  constexpr double reach = 0.2; // m either way
  const double s = m_path.closest(placeOf(wMb), std::max(0.0, now.s - reach),
                                  std::min(m_reference.nextStop(), now.s + reach));
  if (s < m_reference.nextStop()) {
    m_reference.place(std::min(s, m_reference.end()));
  }
}

//! How fast the reference may go by how far the base is off it.
double vpPathFollower::shareByError() const
{
  const double beyond =
      (m_servo.error().norm() - m_settings.errorFree) / (m_settings.errorSlowest - m_settings.errorFree);
  return 1 - (1 - m_settings.slowestShare) * std::clamp(beyond, 0.0, 1.0);
}

END_VISP_NAMESPACE
