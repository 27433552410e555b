/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_servo/vpPoseSource.h>

#include <cmath>
#include <utility>

#include <visp3/core/vpExponentialMap.h>

BEGIN_VISP_NAMESPACE

namespace
{
vpVlpFix known(const vpHomogeneousMatrix &wMb)
{
  vpVlpFix fix;
  fix.valid = true;
  fix.wMb = wMb;
  return fix;
}
} // namespace

vpHomogeneousMatrix vpDrivenOn(const vpHomogeneousMatrix &wMb, const vpBaseVelocity &velocity, double time)
{
  vpColVector twist(6, 0);
  twist[0] = velocity.v;
  twist[5] = velocity.w;
  return wMb * vpExponentialMap::direct(twist, time);
}

void vpVlpPose::addOdometry(const vpOdometry &sample)
{
  m_feed.addOdometry(sample);
  m_recent.push_back(sample);
  constexpr double longest = 3; // s, that locating a picture may take
  while (m_recent.front().timestamp < sample.timestamp - longest) {
    m_recent.pop_front();
  }
  if (m_filter) {
    m_filter->addOdometry(sample);
  }
}

std::vector<vpLocatedPicture> vpVlpPose::look(double now)
{
  std::vector<vpLocatedPicture> pictures;
  while (std::optional<vpLocatedPicture> picture = m_feed.next(now)) {
    pictures.push_back(std::move(*picture));
  }
  if (!pictures.empty()) {
    m_filter = pictures.back().filter;
    for (const vpOdometry &sample : m_recent) {
      m_filter->addOdometry(sample); // leaves out those that it has
    }
  }
  return pictures;
}

vpVlpFix vpVlpPose::at(double time) const
{
  if (m_filter) {
    return m_filter->fixAt(time);
  }
  vpVlpFix none;
  none.refusal = "no picture yet";
  return none;
}

vpOdometryPose::vpOdometryPose(const vpHomogeneousMatrix &wMb, double time,
                               const vpOdometryCalibration &calibration)
    : m_wMb(wMb), m_time(time), m_calibration(calibration)
{
}

void vpOdometryPose::addOdometry(const vpOdometry &sample)
{
  if (sample.timestamp <= m_time) {
    return;
  }
  m_velocity = {m_calibration.speedScale * sample.v,
                m_calibration.turnScale * (sample.w - m_calibration.turnBias)};
  m_wMb = vpDrivenOn(m_wMb, m_velocity, sample.timestamp - m_time);
  m_time = sample.timestamp;
}

vpVlpFix vpOdometryPose::at(double time) const
{
  return known(vpDrivenOn(m_wMb, m_velocity, time - m_time));
}

void vpCommandedPose::addCommand(double time, const vpBaseVelocity &told)
{
  m_wMb = vpDrivenOn(m_wMb, m_velocity, time - m_time);
  m_time = time;
  m_velocity = told;
}

vpVlpFix vpCommandedPose::at(double time) const
{
  return known(vpDrivenOn(m_wMb, m_velocity, time - m_time));
}

END_VISP_NAMESPACE
