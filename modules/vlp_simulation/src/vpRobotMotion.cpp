/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_simulation/vpRobotMotion.h>

#include <algorithm>
#include <cmath>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

vpStationMotion::vpStationMotion(const std::vector<vpHomogeneousMatrix> &places, double hold)
    : m_places(places), m_hold(hold)
{
  if (places.empty()) {
    throw vpException(vpException::badValue, "stations: none, expected one place or more");
  }
  if (!(hold > 0 && std::isfinite(hold))) {
    throw vpException(vpException::badValue,
                      "stations: held for " + vpNumberText(hold) + " s, expected a number above 0");
  }
}

vpHomogeneousMatrix vpStationMotion::wMb(double time)
{
  // A frame that begins with a place sees that place, whatever the last digit of its time.
  static const double early = 1e-9; // s
  const double index = std::floor((time + early) / m_hold);
  return m_places[static_cast<size_t>(std::clamp(index, 0.0, static_cast<double>(m_places.size() - 1)))];
}

vpDrivenMotion::vpDrivenMotion(const vpSimulatorTurtleBot3Settings &robot,
                               const std::vector<vpTimedVelocity> &commands)
    : m_robot(robot), m_commands(commands), m_start(robot.startTime), m_latest(m_start), m_nextTime(m_start)
{
  if (commands.empty()) {
    throw vpException(vpException::badValue, "drive: no commands, expected one or more");
  }
  for (const vpTimedVelocity &command : commands) {
    if (!(command.duration > 0 && std::isfinite(command.duration))) {
      throw vpException(vpException::badValue, "drive: a command of " + vpNumberText(command.duration) +
                                                   " s, expected a number above 0");
    }
    m_duration += command.duration;
  }
}

//! Lets the world run up to \e time, giving the commands that are due.
void vpDrivenMotion::advance(double time)
{
  while (m_next <= m_commands.size() && m_nextTime <= time) {
    m_robot.advance(m_nextTime);
    if (m_next == m_commands.size()) {
      m_robot.stop();
    } else {
      m_robot.setVelocity(m_commands[m_next].velocity.v, m_commands[m_next].velocity.w);
      m_nextTime += m_commands[m_next].duration;
    }
    ++m_next;
  }
  m_robot.advance(time);
}

vpHomogeneousMatrix vpDrivenMotion::wMb(double time)
{
  if (time > m_robot.time()) {
    static const double ahead = 0.1; // s, since a picture asks for many times, not all in order
    advance(time + ahead);
  }
  m_latest = std::max(m_latest, time);
  return m_robot.wMb(std::max(time, m_start));
}

std::vector<vpOdometry> vpDrivenMotion::odometry() const
{
  const std::vector<vpOdometry> &samples = m_robot.odometrySamples(); // the world may have run ahead
  const auto later =
      std::upper_bound(samples.begin(), samples.end(), m_latest,
                       [](double time, const vpOdometry &sample) { return time < sample.timestamp; });
  return {samples.begin(), later};
}

END_VISP_NAMESPACE
