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
#include "vpLampWindows.h"
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
  static const double setBack = 1; // s
  const bool later = std::isfinite(time) && (!m_lastFrame || time > *m_lastFrame),
             anew = std::isfinite(time) && m_lastFrame && time <= *m_lastFrame - setBack;
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
      vpLampWindows::expect(m_scratch->predicted(filter, frame.timestamp + m_scratch->halfReadout), m_map,
                            m_rig, m_scratch->lineTime, windows);
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
    hint = vpPoseHint{m_lastPose->fix.wMb, hintReach + maxSpeed * since, hintTurn + maxTurnRate * since};
  }
  return matcher.match(observations, usable, hint);
}

END_VISP_NAMESPACE
