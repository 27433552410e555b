/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "vpLampConsensus.h"
#include "vpLampGeometry.h"
#include "vpLampNames.h"
#include "vpLampTrust.h"
#include "vpVlpScratch.h"

BEGIN_VISP_NAMESPACE

namespace
{
//! As made anew, its memory kept.
void clear(vpVlpFix &fix)
{
  fix.valid = fix.ambiguous = false;
  fix.refusal.clear();
  fix.wMb.eye();
  fix.wMc.eye();
  fix.other.eye();
  fix.covariance.setZero();
  fix.lamps.clear();
  fix.residuals.clear();
  fix.chiSquare = 0;
  fix.degreesOfFreedom = 0;
}
} // namespace

vpVlpLocalizer::vpVlpLocalizer(const vpVlpRig &rig, const vpLampMap &map)
    : tracker(rig, map), matcher(rig, map), filter(rig), m_rig(rig), m_map(map),
      m_lineTime(rig.lineTiming().meanLineTime()),
      m_halfReadout(rig.lineTiming().middleAt(0.5 * (rig.lineTiming().lines() - 1))),
      m_trust(std::make_unique<vpLampTrust>()), m_scratch(std::make_unique<Scratch>(rig))
{
  for (size_t i = 0; i < map.lamps.size(); ++i) {
    m_lampOf.emplace(map.lamps[i].id, i);
  }
}

vpVlpLocalizer::~vpVlpLocalizer() = default;
vpVlpLocalizer::vpVlpLocalizer(vpVlpLocalizer &&) noexcept = default;

vpVlpLocation vpVlpLocalizer::process(const vpVlpFrame &frame)
{
  vpVlpLocation location;
  process(frame, location);
  return location;
}

void vpVlpLocalizer::process(const vpVlpFrame &frame, vpVlpLocation &location)
{
  if (!open(frame.timestamp, location)) {
    return;
  }
  // Sections 2.1.1 and 2.1.2: LED-ROI, outline, stripe features and LED-ID of every lamp-like region, in the
  // windows of the lamps that are followed and where new ones are searched for.
  location.observations = look(frame);
  if (tracking) {
    location.searched = tracker.searched();
  }
  // Section 2.1.3: the pose from the rays to these lamps.
  locate(location);
}

vpVlpLocation vpVlpLocalizer::locate(double timestamp, std::vector<vpLampObservation> observations)
{
  vpVlpLocation location;
  if (open(timestamp, location)) {
    location.observations = std::move(observations);
    for (vpLampObservation &seen : location.observations) {
      seen.accepted = false;
      seen.remark.clear();
    }
    locate(location);
  }
  return location;
}

//! Makes the location one of a frame that is still to be seen. False: such a frame cannot be used.
bool vpVlpLocalizer::open(double time, vpVlpLocation &location)
{
  location.timestamp = time;
  location.tracked = false;
  location.state = vpVlpFilter::State::starting;
  location.searched.clear();
  clear(location.fix);
  if (tracking && !inOrder(time)) {
    location.observations.clear();
    location.fix.refusal = "the frame is not later than the one before it";
    return false;
  }
  if (filter.started() && filter.state(filterAt(time).pose()) == vpVlpFilter::State::lost) {
    filter.stop(); // so long ago that what it expects of the lamps would mean nothing
  }
  return true;
}

//! The pose from the rays to the lamps that were seen.
void vpVlpLocalizer::locate(vpVlpLocation &location)
{
  // Lamps whose place in the picture can be relied on, and whose id can, once places have told apart what
  // stripes do not: lamps that share an identifier, a lamp and its reflection.
  std::vector<size_t> &usable = m_scratch->usable;
  vpLampConsensus::usable(location.observations, usable);
  std::string doubt;
  if (!namedApart(location.observations, usable)) {
    const vpLampMatch match = matchByPlace(location.observations, usable, location.timestamp);
    nameByPlace(match, m_map, location.observations, usable);
    doubt = match.refusal;
  }

  // Each ray corrects the pose that the filter carries, or, at first, two or all that agree with each other
  // tell it.
  const bool carried = tracking && filter.started();
  if (carried) {
    follow(location, usable);
  } else {
    solveAlone(location, usable);
  }
  if (!location.fix.valid && usable.size() < 2 && !doubt.empty()) {
    location.fix.refusal = doubt;
  }
  if (location.fix.valid && !location.fix.ambiguous) {
    if (!m_lastPose) {
      m_lastPose.emplace();
    }
    m_lastPose->fix = location.fix;
    m_lastPose->time = location.timestamp;
  }
  location.tracked = carried && filter.started() && m_followed > 0 && location.fix.valid;
  location.state = filter.state(location.fix);
}

//! The pose of this frame alone; the filter begins with it.
void vpVlpLocalizer::solveAlone(vpVlpLocation &location, const std::vector<size_t> &usable)
{
  location.fix = solve(location.observations, usable);
  if (tracking && location.fix.valid && !asBefore(location.observations, location.fix)) {
    clear(location.fix);
    location.fix.refusal = "the lamps are not as large as they were: partly hidden, or one behind the other";
    vpLampConsensus::explain(location.fix, usable, location.observations);
  } else if (tracking && location.fix.valid && !location.fix.ambiguous) {
    begin(location);
  }
}

//! Whether a frame may follow the last one. Where the clock was set back, all begins anew.
bool vpVlpLocalizer::inOrder(double time)
{
  static const double setBack = 1; // s
  if (!std::isfinite(time)) {
    return false;
  }
  if (m_lastFrame && time <= *m_lastFrame && time > *m_lastFrame - setBack) {
    return false;
  }
  if (m_lastFrame && time <= *m_lastFrame) {
    filter.stop();
    tracker.reset();
    m_lastPose.reset();
    m_apart.reset();
    m_contradictions = 0;
    m_unresting = 0;
    *m_trust = vpLampTrust();
  }
  m_lastFrame = time;
  return true;
}

const std::vector<vpLampObservation> &vpVlpLocalizer::look(const vpVlpFrame &frame)
{
  if (tracking) {
    return tracker.track(frame, expectedWindows(frame.timestamp));
  }
  tracker.detector.detect(frame.I);
  return tracker.detector.observations();
}

//! Where the picture shows the map's lamps while their lines are read, by the motion that the filter expects.
const std::vector<vpRect> &vpVlpLocalizer::expectedWindows(double time) const
{
  std::vector<vpRect> &windows = m_scratch->windows;
  windows.clear();
  if (!filter.started()) {
    return windows;
  }
  static const double farthest = 3;   // heights of a lamp above the camera
  static const double doubtful = 0.1; // rad: the lamps are then anywhere
  const vpVlpFilter::Pose pose = filterAt(time + m_halfReadout).pose();
  const double place = std::sqrt(std::max(pose.covariance(0, 0), pose.covariance(1, 1))),
               turn = std::sqrt(pose.covariance(5, 5));
  for (const vpLamp &lamp : m_map.lamps) {
    const double height = lamp.position.z() - pose.wtc.z(),
                 apart = std::hypot(lamp.position.x() - pose.wtc.x(), lamp.position.y() - pose.wtc.y());
    if (!(height > 0 && apart < farthest * height && turn + place / height < doubtful)) {
      continue;
    }
    Eigen::Vector2d middle, motion;
    const Eigen::Vector2d extent =
        vpLampTrust::extentOf(lamp, pose.wMb, filter.velocity(), m_rig, m_lineTime);
    if (!vpLampTrust::motionOf(lamp.position, pose.wMb, filter.velocity(), m_rig, middle, motion)) {
      continue;
    }
    const int along = m_rig.shutter.alongColumns() ? 0 : 1;
    const double lines = middle(along) - 0.5 * ((along == 0 ? m_rig.width : m_rig.height) - 1.0);
    middle += motion * m_lineTime * lines / std::max(0.1, 1 - motion(along) * m_lineTime);
    static const double sigmas = 3, around = 0.7; // of the extent, on each side
    const double doubt = sigmas * m_rig.camera.get_px() * (place + turn * apart) / height;
    const Eigen::Vector2d half =
        (std::isfinite(lamp.size) ? 0.5 + around : 0.2) * extent + Eigen::Vector2d(doubt, doubt);
    const Eigen::Vector2d least = middle - half, most = middle + half;
    if (most.minCoeff() > 0 && least.x() < m_rig.width - 1 && least.y() < m_rig.height - 1) {
      windows.emplace_back(least.x(), least.y(), 2 * half.x(), 2 * half.y());
    }
  }
  return windows;
}

//! The filter as predicted to a time: by a robot that may start and stop. Until the next call.
const vpVlpFilter &vpVlpLocalizer::filterAt(double time) const
{
  vpVlpFilter &there = m_scratch->there;
  there = filter;
  there.rouse();
  there.advance(time);
  return there;
}

//! Whether roll and pitch are estimated with the pose.
bool vpVlpLocalizer::attitudeIsFree() const
{
  return manyLamps.attitude == vpManyLampSolver::Attitude::free && solver == Solver::all;
}

/*!
  Places the lamps' middles in their outlines anew. The detector did so for a robot that stands level; a
  camera that leans otherwise sees the middle of a disc elsewhere in its ellipse.
*/
void vpVlpLocalizer::placeMiddles(std::vector<vpLampObservation> &observations,
                                  const Eigen::Matrix3d &wRb) const
{
  const Eigen::Vector3d vertical = vpMountFrame(m_rig).bRc.transpose() * wRb.row(2).transpose();
  for (vpLampObservation &lamp : observations) {
    lamp.point = lamp.outline.middle(m_rig.camera, vertical);
  }
}

//! The pose of these lamps alone, of two of them or of all that agree with each other.
vpVlpFix vpVlpLocalizer::solve(std::vector<vpLampObservation> &observations,
                               const std::vector<size_t> &usable) const
{
  const std::vector<const vpLamp *> &lamps = lampsOf(observations);
  std::vector<size_t> which;
  std::copy_if(usable.begin(), usable.end(), std::back_inserter(which),
               [&](size_t i) { return lamps[i] == nullptr || !m_trust->doubts(*lamps[i]); });
  static const size_t enough = 3; // of which one bears the others out
  if (which.size() < enough) {
    which = usable;
  }
  auto solved = [&] {
    const vpLampConsensus consensus(lampsOf(observations), m_rig, observations, mapTolerance,
                                    outlierLikelihood);
    return consensus.solve(which, [this](const std::vector<vpLampSight> &lamps) {
      return solver == Solver::two ? twoLamps.solveBestPair(lamps, m_rig) : manyLamps.solve(lamps, m_rig);
    });
  };
  vpVlpFix fix = solved();
  if (fix.valid && attitudeIsFree()) {
    placeMiddles(observations, vpBasePose::of(fix.wMb).wRb);
    fix = solved();
  }
  vpLampConsensus::explain(fix, usable, observations);
  return fix;
}

const std::vector<const vpLamp *> &
vpVlpLocalizer::lampsOf(const std::vector<vpLampObservation> &observations) const
{
  std::vector<const vpLamp *> &lamps = m_scratch->lamps;
  lamps.clear();
  for (const vpLampObservation &observation : observations) {
    const auto found = m_lampOf.find(observation.id);
    lamps.push_back(found == m_lampOf.end() ? nullptr : &m_map.lamps[found->second]);
  }
  return lamps;
}

vpLampMatch vpVlpLocalizer::matchByPlace(const std::vector<vpLampObservation> &observations,
                                         const std::vector<size_t> &usable, double time) const
{
  if (attitudeIsFree()) {
    vpLampMatch match;
    match.refusal = "lamps that blink alike are told apart by the attitude of the mount only, and it is free";
    return match;
  }
  std::optional<vpPoseHint> hint;
  if (tracking && m_lastPose) {
    const double since = std::abs(time - m_lastPose->time);
    hint = vpPoseHint{m_lastPose->fix.wMb, hintReach + maxSpeed * since, hintTurn + maxTurnRate * since};
  }
  return matcher.match(observations, usable, hint);
}

END_VISP_NAMESPACE
