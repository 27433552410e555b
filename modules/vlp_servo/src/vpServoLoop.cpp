/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_servo/vpServoLoop.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

namespace
{
//! Tells the base to stop, whatever happens.
class StopAtExit
{
public:
  explicit StopAtExit(vpMobileBase &base) : m_base(base) {}
  ~StopAtExit()
  {
    try {
      m_base.stop();
    } catch (const std::exception &) {
      // Out of reach: its own watchdog has to stop it.
    }
  }
  StopAtExit(const StopAtExit &) = delete;
  StopAtExit &operator=(const StopAtExit &) = delete;

private:
  vpMobileBase &m_base;
};
} // namespace

vpServoLoop::vpServoLoop(vpMobileBase &base, vpPoseSource &poses, vpServoClock &clock, const vpPath &path,
                         const vpServoLoopSettings &settings)
    : m_base(base), m_poses(poses), m_clock(clock), m_settings(settings),
      m_follower(path, base.limits(), settings.follower),
      m_safety(settings.safety, base.limits(), poses.needsPictures())
{
}

vpServoRun vpServoLoop::run()
{
  const StopAtExit stop(m_base);
  try {
    for (bool more = true; more;) {
      const double now = m_clock.next();
      const std::vector<vpLocatedPicture> pictures = sense(now);
      const vpServoStep done = step(now);
      noteDelays(pictures);
      more = goesOn(done, pictures);
    }
  } catch (const vpException &error) {
    if (error.getCode() != vpException::ioError) {
      throw;
    }
    m_run.end = vpServoRun::End::failed; // the base is out of reach, or refuses
    m_run.reason = error.getStringMessage();
  }
  m_run.missed = m_clock.missed();
  return std::move(m_run);
}

//! What wheels and camera have said since the last period.
std::vector<vpLocatedPicture> vpServoLoop::sense(double now)
{
  const vpOdometry odometry = m_base.odometry();
  if (m_run.odometry.empty() || odometry.timestamp > m_run.odometry.back().timestamp) {
    m_poses.addOdometry(odometry);
    m_safety.addOdometry(odometry);
    m_run.odometry.push_back(odometry);
  }
  std::vector<vpLocatedPicture> pictures = m_poses.look(now);
  for (const vpLocatedPicture &picture : pictures) {
    m_safety.addPicture(picture.known, picture.location);
  }
  if (const std::string ended = m_poses.ended(); !ended.empty()) {
    m_safety.fail("camera: " + ended);
  }
  constexpr double everySoOften = 1; // s
  if (battery && now - m_batteryAsked > everySoOften) {
    m_safety.setBattery(battery());
    m_batteryAsked = now;
  }
  return pictures;
}

//! From the pose to a command.
vpServoStep vpServoLoop::step(double now)
{
  vpServoStep step;
  step.time = now;
  const vpVlpFix fix = m_poses.at(now + m_settings.actuationDelay);
  const vpServoPermit permit = m_safety.permit(now, fix);
  step.wanted = m_follower.follow(fix.wMb, permit.share, m_clock.period());
  if (permit.share > 0) {
    m_safety.setOffset(now, m_follower.servo().error().norm(), m_follower.atEnd());
  }
  const vpBaseVelocity command = m_safety.limited(step.wanted, m_clock.period());
  step.told = m_base.setVelocity(command.v, command.w);
  m_poses.addCommand(now, step.told);

  const double cut = std::max(std::abs(command.v - step.wanted.v), std::abs(command.w - step.wanted.w));
  if (cut > 1e-9) {
    m_follower.commandWasCut();
  }
  step.located = fix.valid;
  step.wMb = fix.wMb;
  step.sigma = std::sqrt(std::max(fix.covariance(0, 0), fix.covariance(1, 1)));
  step.reference = m_follower.reference();
  step.share = permit.share;
  step.waiting = permit.reason;
  m_failed = permit.final;
  return step;
}

void vpServoLoop::noteDelays(const std::vector<vpLocatedPicture> &pictures)
{
  const double now = m_clock.now();
  for (const vpLocatedPicture &picture : pictures) {
    m_run.pictures.push_back(
        {picture.timestamp, picture.known, now, picture.compute, picture.location.fix.valid});
  }
}

bool vpServoLoop::goesOn(const vpServoStep &step, const std::vector<vpLocatedPicture> &pictures)
{
  m_run.steps.push_back(step);
  if (watch && !watch(step, pictures)) {
    m_run.end = vpServoRun::End::stopped;
    m_run.reason = "stopped";
    return false;
  }
  const bool stands = step.told.v == 0 && step.told.w == 0;
  if (m_follower.arrived()) {
    m_run.end = vpServoRun::End::arrived;
    return !stands;
  }
  if (m_failed) {
    m_run.end = vpServoRun::End::failed;
    m_run.reason = step.waiting;
    return !stands;
  }
  return true;
}

END_VISP_NAMESPACE
