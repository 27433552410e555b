/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "vpLampConsensus.h"
#include "vpLampGeometry.h"
#include "vpLampPicture.h"
#include "vpPoseMixture.h"
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

size_t timesSeen(const std::string &id, const std::vector<vpLampObservation> &observations)
{
  return static_cast<size_t>(std::count_if(observations.begin(), observations.end(),
                                           [&](const vpLampObservation &other) { return other.id == id; }));
}

//! Whether each of the \e usable ones is one lamp for sure: with an id, that no observation has besides it.
bool namedApart(const std::vector<vpLampObservation> &observations, const std::vector<size_t> &usable)
{
  return std::all_of(usable.begin(), usable.end(), [&](size_t i) {
    const std::string &id = observations[i].id;
    return !id.empty() && timesSeen(id, observations) == 1;
  });
}

/*!
  Gives each lamp that \e match resolved its id, and keeps it in \e usable. Where the match is not unique,
  keeps those that are one lamp for sure without it. Sets the remark of the others.
*/
void nameByPlace(const vpLampMatch &match, const vpLampMap &map, std::vector<vpLampObservation> &observations,
                 std::vector<size_t> &usable)
{
  const bool unique = match.outcome == vpLampMatch::Outcome::unique;
  std::vector<size_t> named;
  for (size_t i : usable) {
    vpLampObservation &lamp = observations[i];
    const size_t times = lamp.id.empty() ? 0 : timesSeen(lamp.id, observations);
    if (unique && match.lamps[i] != vpLampMatch::noLamp) {
      lamp.id = map.lamps[match.lamps[i]].id;
      lamp.confidence = match.probabilities[i];
      lamp.remark.clear();
      named.push_back(i);
    } else if (unique) {
      lamp.remark = (lamp.id.empty() ? "no lamp of the map hangs there: a reflection"
                                     : "a reflection of lamp " + lamp.id) +
                    ", or another lamp that blinks alike";
    } else if (times == 1) {
      named.push_back(i);
    } else {
      lamp.remark =
          times == 0 ? match.refusal
                     : "seen " + std::to_string(times) + " times, a reflection among them: " + match.refusal;
    }
  }
  usable = named;
}

/*!
  Adds to \e windows (px) where the picture shows the map's lamps while their lines are read, by the pose and
  motion that the filter expects at the middle of the readout. \param lineTime s, from line to line.
*/
void expectWindows(const vpVlpFilter &filter, const vpLampMap &map, const vpVlpRig &rig, double lineTime,
                   std::vector<vpRect> &windows)
{
  static const double farthest = 3;  // heights of a lamp above the camera
  static const double unknown = 0.1; // rad: the lamps are then anywhere
  const vpVlpFilter::Pose pose = filter.pose();
  const double place = std::sqrt(std::max(pose.covariance(0, 0), pose.covariance(1, 1))),
               turn = std::sqrt(pose.covariance(5, 5));
  for (const vpLamp &lamp : map.lamps) {
    const double height = lamp.position.z() - pose.wtc.z(),
                 apart = std::hypot(lamp.position.x() - pose.wtc.x(), lamp.position.y() - pose.wtc.y());
    if (!(height > 0 && apart < farthest * height && turn + place / height < unknown)) {
      continue;
    }
    const vpLampPicture picture(lamp, {pose.wMb.linear(), pose.wMb.translation()}, rig);
    if (!picture.inFront()) {
      continue;
    }
    const Eigen::Vector2d extent = picture.extent(filter.velocity(), lineTime);
    const Eigen::Vector2d motion = picture.motion(filter.velocity());
    Eigen::Vector2d middle = picture.middle();
    const int along = rig.shutter.alongColumns() ? 0 : 1;
    const double lines = middle(along) - 0.5 * ((along == 0 ? rig.width : rig.height) - 1.0);
    middle += motion * lineTime * lines * picture.stretch(filter.velocity(), lineTime);
    static const double sigmas = 3, around = 0.7; // of the extent, on each side
    const double uncertain = sigmas * rig.camera.get_px() * (place + turn * apart) / height;
    const Eigen::Vector2d half =
        (std::isfinite(lamp.size) ? 0.5 + around : 0.2) * extent + Eigen::Vector2d(uncertain, uncertain);
    const Eigen::Vector2d least = middle - half, most = middle + half;
    if (most.minCoeff() > 0 && least.x() < rig.width - 1 && least.y() < rig.height - 1) {
      windows.emplace_back(least.x(), least.y(), 2 * half.x(), 2 * half.y());
    }
  }
}
} // namespace

vpVlpLocalizer::vpVlpLocalizer(const vpVlpRig &rig, const vpLampMap &map)
    : tracker(rig, map), matcher(rig, map), filter(rig), m_rig(rig), m_map(map),
      m_places(std::make_unique<vpPoseMixture>()), m_scratch(std::make_unique<Scratch>(rig, map))
{
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
  location.tracked = location.relocated = false;
  location.state = vpVlpFilter::State::starting;
  location.searched.clear();
  clear(location.fix);
  const bool later = std::isfinite(time) && (!m_lastFrame || time > *m_lastFrame),
             anew = std::isfinite(time) && m_lastFrame && time <= *m_lastFrame - vpVlpFilter::clockSetBack;
  if (tracking && !later && !anew) {
    location.observations.clear();
    location.fix.refusal = "the frame is not later than the one before it";
    return false;
  }
  if (tracking && anew) { // the clock was set back
    filter.stop();
    tracker.reset();
    m_lastPose.reset();
    *m_places = vpPoseMixture();
  }
  m_lastFrame = time;
  if (filter.started() &&
      filter.state(m_scratch->predicted(filter, time).pose()) == vpVlpFilter::State::lost &&
      m_places->lostAt(time)) {
    filter.stop(); // so long ago that what it expects of the lamps would mean nothing
  }
  if (!filter.started() && !m_places->empty()) {
    m_places->lose();
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
  std::string refusal;
  if (!namedApart(location.observations, usable)) {
    const vpLampMatch match = matchByPlace(location.observations, usable, location.timestamp);
    nameByPlace(match, m_map, location.observations, usable);
    refusal = match.refusal;
  }

  // Each ray corrects the pose that the filter carries, or, at first, two or all that agree with each other
  // tell it.
  const bool carried = tracking && filter.started();
  if (carried) {
    follow(location, usable);
  } else {
    begin(location, usable);
  }
  if (!location.fix.valid && usable.size() < 2 && !refusal.empty()) {
    location.fix.refusal = refusal;
  }
  if (location.fix.valid && !location.fix.ambiguous) {
    if (!m_lastPose) {
      m_lastPose = LastPose();
    }
    m_lastPose->fix = location.fix;
    m_lastPose->time = location.timestamp;
  }
  location.tracked = carried && location.fix.valid && filter.started() && m_places->likeliest().frames > 0;
  location.state = filter.state(location.fix);
}

const std::vector<vpLampObservation> &vpVlpLocalizer::look(const vpVlpFrame &frame)
{
  if (tracking) {
    std::vector<vpRect> &windows = m_scratch->windows;
    windows.clear();
    if (filter.started()) {
      expectWindows(m_scratch->predicted(filter, frame.timestamp + m_scratch->halfReadout), m_map, m_rig,
                    m_scratch->lineTime, windows);
    }
    return tracker.track(frame, windows);
  }
  tracker.detector.detect(frame.I);
  return tracker.detector.observations();
}

vpLampMatch vpVlpLocalizer::matchByPlace(const std::vector<vpLampObservation> &observations,
                                         const std::vector<size_t> &usable, double time) const
{
  if (attitudeIsFree(*this)) {
    vpLampMatch match;
    match.refusal = "lamps that blink alike are told apart by the attitude of the mount only, and it is free";
    return match;
  }
  std::optional<vpPoseHint> hint;
  if (tracking && m_lastPose) {
    const double since = std::abs(time - m_lastPose->time);
    hint = vpPoseHint{m_lastPose->fix.wMb, filter.startPlace + maxSpeed * since,
                      filter.startTurn + maxTurnRate * since};
  }
  return matcher.match(observations, usable, hint);
}

END_VISP_NAMESPACE
