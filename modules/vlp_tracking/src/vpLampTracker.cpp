/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_tracking/vpLampTracker.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <tuple>
#include <utility>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "vpLampBoxes.h"
#include "vpLampTrack.h"
#include "vpTrackerScratch.h"

BEGIN_VISP_NAMESPACE

using vpLampBoxes::boxOf;
using vpLampBoxes::inside;
using vpLampBoxes::overlap;
using vpLampBoxes::tells;

namespace
{
bool blinks(const vpLampObservation &seen)
{
  return seen.features.signal != vpStripeFeatures::Signal::unmodulated &&
         seen.outline.shape != vpLampOutline::Shape::region;
}
} // namespace

vpLampTracker::vpLampTracker(const vpVlpRig &rig, const vpLampMap &map)
    : detector(rig, map), m_rig(rig), m_scratch(std::make_unique<Scratch>())
{
}
vpLampTracker::~vpLampTracker() = default;
vpLampTracker::vpLampTracker(vpLampTracker &&) noexcept = default;

size_t vpLampTracker::tracks() const
{
  return m_tracks.size();
}

void vpLampTracker::reset()
{
  m_tracks.clear();
  m_steady.clear();
  m_searched.clear();
  m_inSight = 0;
  m_any = false;
}

const std::vector<vpLampObservation> &vpLampTracker::track(const vpVlpFrame &frame,
                                                           const std::vector<vpRect> &expected)
{
  if (!std::isfinite(frame.timestamp) || (m_any && !(frame.timestamp > m_time))) {
    throw vpException(vpException::badValue,
                      "frame: time " + vpNumberText(frame.timestamp) + " s, expected a finite one" +
                          (m_any ? " after that of the frame before, " + vpNumberText(m_time) + " s" : ""));
  }
  detector.check(frame.I);
  m_again = std::any_of(m_tracks.begin(), m_tracks.end(), [](const Track &track) { return track.shown(); }) &&
            std::all_of(m_tracks.begin(), m_tracks.end(),
                        [&frame](const Track &track) { return !track.shown() || track.showsAgain(frame.I); });
  // Windows from the target trackers, a strip in search of new lamps, or all of the picture.
  setWindows(frame, expected);
  clearObservations();
  m_trackOf.clear();
  if (m_inSight >= needed) {
    reacquire(frame.I);
    moveSteady(frame.timestamp);
    search(frame);
  }
  if (m_inSight < needed || lampsInSight() < needed) { // some are dark, or the camera is elsewhere
    searchAll(frame);
  }

  // Which region is which lamp; what all its frames say of it; what is new.
  const size_t reacquired = m_trackOf.size();
  assign();
  for (size_t i = 0; i < m_observations.size(); ++i) {
    if (i < reacquired) {
      followReacquired(m_tracks[static_cast<size_t>(m_trackOf[i])], m_observations[i], frame);
    } else if (m_trackOf[i] >= 0) {
      follow(m_tracks[static_cast<size_t>(m_trackOf[i])], m_observations[i], frame);
    } else if (tells(m_observations[i])) {
      m_trackOf[i] = bear(m_observations[i], frame);
    }
  }
  if (m_observations.size() > reacquired) { // else all is known as it is
    detector.recognizer.recognize(m_observations);
  }
  for (size_t i = 0; i < m_observations.size(); ++i) {
    if (m_trackOf[i] >= 0) {
      Track &track = m_tracks[static_cast<size_t>(m_trackOf[i])];
      track.learn(m_observations[i], sure, detector.recognizer.minConfidence);
      if (m_inSight < needed) { // it was not tried whether it is as it was
        track.strange = 0;
      } else if (track.strange > 0 && noLampSince(track.place, frame.timestamp) < frame.timestamp) {
        track.strange += sure; // it has been none before
      }
    }
  }
  sortByArea();
  m_inSight = lampsInSight();
  m_time = frame.timestamp;
  m_any = true;
  bury(frame.timestamp);
  for (Track &track : m_tracks) {
    track.remember(frame.I);
  }
  return m_observations;
}

//! Of the map's, that may be among what was seen.
size_t vpLampTracker::lampsInSight() const
{
  return static_cast<size_t>(
      std::count_if(m_observations.begin(), m_observations.end(),
                    [](const vpLampObservation &seen) { return !seen.candidates.empty(); }));
}

//! None is left; their memory is kept for those to come.
void vpLampTracker::clearObservations()
{
  std::move(m_observations.begin(), m_observations.end(), std::back_inserter(m_scratch->spare));
  m_observations.clear();
}

void vpLampTracker::addObservation(const vpLampObservation &seen)
{
  std::vector<vpLampObservation> &spare = m_scratch->spare;
  if (spare.empty()) {
    m_observations.push_back(seen);
  } else {
    m_observations.push_back(std::move(spare.back()));
    m_observations.back() = seen;
    spare.pop_back();
  }
}

//! The largest first; of equal ones that which was first stays so. They are few: by insertion.
void vpLampTracker::sortByArea()
{
  const auto first = m_observations.begin();
  for (auto next = first; next != m_observations.end(); ++next) {
    const auto place =
        std::upper_bound(first, next, *next, [](const vpLampObservation &a, const vpLampObservation &b) {
          return a.features.area > b.features.area;
        });
    std::rotate(place, next, next + 1);
  }
}

/*!
  Regions to tracks, the surest pairs first: near the window that the target tracker has, and blinking as the
  lamp did. One that blinks otherwise is taken where nothing else is: it replaced the lamp.
*/
void vpLampTracker::assign()
{
  static const double farthest = 1.5, disagreement = 1; // of the window's diagonal
  std::vector<std::tuple<double, size_t, size_t>> pairs;
  for (size_t i = 0; i < m_observations.size(); ++i) {
    const vpLampObservation &seen = m_observations[i];
    if (i < m_trackOf.size()) {
      continue; // reacquired
    }
    if (!blinks(seen) && seen.features.signal != vpStripeFeatures::Signal::unmodulated) {
      continue;
    }
    const vpRect box = boxOf(seen.outline);
    for (size_t t = 0; t < m_tracks.size(); ++t) {
      const vpImagePoint centre =
          m_tracks[t].astray ? m_tracks[t].place.getCenter() : m_tracks[t].target->center();
      const double size = std::hypot(m_tracks[t].window.getWidth(), m_tracks[t].window.getHeight());
      const double apart =
          std::hypot(seen.outline.centre.x() - centre.get_u(), seen.outline.centre.y() - centre.get_v()) /
          std::max({size, box.getWidth(), box.getHeight(), 1.0});
      if (apart < farthest) {
        pairs.emplace_back(apart + (m_tracks[t].evidence.agrees(seen.features) ? 0 : disagreement), i, t);
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  m_trackOf.resize(m_observations.size(), -1);
  for (const auto &[cost, i, t] : pairs) {
    if (m_trackOf[i] < 0 && !m_tracks[t].taken) {
      m_trackOf[i] = static_cast<int>(t);
      m_tracks[t].taken = true;
    }
  }
  for (Track &track : m_tracks) {
    const bool another =
        std::any_of(m_observations.begin(), m_observations.end(), [&track](const vpLampObservation &seen) {
          static const double same = 0.5;
          return overlap(boxOf(seen.outline), track.window) > same;
        });
    track.astray = track.astray || (!track.taken && another);
  }
}

//! A lamp that was reacquired is as it was.
void vpLampTracker::followReacquired(Track &track, vpLampObservation &seen, const vpVlpFrame &frame)
{
  track.seenLast = frame.timestamp;
  track.told = boxOf(seen.outline);
  setRight(track, seen, frame);
}

//! Adds what a frame says of a lamp to what is known of it.
void vpLampTracker::follow(Track &track, vpLampObservation &seen, const vpVlpFrame &frame)
{
  if (blinks(seen)) {
    if (track.isElsewhere(seen)) {
      track.evidence.clear();
      track.number = ++m_born;
    }
    const bool tells = !m_again || !track.evidence.agrees(seen.features);
    if (tells && !track.evidence.add(seen.features)) {
      track.number = ++m_born; // another lamp in its place
    }
    track.told = boxOf(seen.outline);
    // What tells nothing may be any part of this lamp and of others before it: old evidence is none of it.
    if (vpLedIdEvidence::tells(seen.features)) {
      const double area = seen.features.area;
      seen.features = track.evidence.features();
      seen.features.area = area;
    }
    track.seenLast = frame.timestamp;
  }
  setRight(track, seen, frame);
}

//! The target tracker goes on from where the lamp is.
void vpLampTracker::setRight(Track &track, vpLampObservation &seen, const vpVlpFrame &frame)
{
  seen.track = track.number;
  static const double alike = 0.7;
  const vpRect box = inside(boxOf(seen.outline), frame.I);
  track.place = box;
  if (box.getWidth() < 4 || box.getHeight() < 4) {
    return;
  }
  if (track.astray) { // on a way of another lamp
    if (std::unique_ptr<vpTargetTracker> target = targetAt(frame.I, box)) {
      track.target = std::move(target);
      track.astray = false;
    }
  } else if (overlap(box, track.target->window()) < alike) {
    try {
      track.target->correct(frame.I, box);
    } catch (const vpException &) { // nothing there that the method can follow
      track.astray = true;
    }
  }
}

//! None where the box shows nothing that the method can follow.
std::unique_ptr<vpTargetTracker> vpLampTracker::targetAt(const vpImage<unsigned char> &I,
                                                         const vpRect &box) const
{
  std::unique_ptr<vpTargetTracker> target = vpTargetTracker::make(method);
  try {
    target->initTracking(I, box);
  } catch (const vpException &) {
    return nullptr;
  }
  return target;
}

//! \return The new track's index; -1 where nothing can be followed.
int vpLampTracker::bear(vpLampObservation &seen, const vpVlpFrame &frame)
{
  const vpRect box = inside(boxOf(seen.outline), frame.I);
  if (box.getWidth() < 4 || box.getHeight() < 4) {
    return -1;
  }
  Track track;
  track.target = targetAt(frame.I, box);
  if (!track.target) {
    return -1;
  }
  track.number = ++m_born;
  track.evidence.add(seen.features);
  track.seenLast = frame.timestamp;
  track.window = track.place = track.told = box;
  track.taken = true;
  seen.track = track.number;
  m_tracks.push_back(std::move(track));
  return static_cast<int>(m_tracks.size()) - 1;
}

//! Lamps that were not seen for long, or that left the picture, and what is none.
void vpLampTracker::bury(double time)
{
  auto isStranger = [this](const Track &track) { return track.strange > sure; };
  for (const Track &track : m_tracks) {
    if (isStranger(track)) {
      rememberSteady(track.place, noLampSince(track.place, time), false, time);
    }
  }
  m_tracks.erase(std::remove_if(m_tracks.begin(), m_tracks.end(),
                                [&](const Track &track) {
                                  const vpRect window = track.astray ? track.place : track.target->window();
                                  const bool gone = !(window.getWidth() > 0 && window.getHeight() > 0);
                                  return time - track.seenLast > patience || (gone && !track.taken) ||
                                         isStranger(track);
                                }),
                 m_tracks.end());
}

END_VISP_NAMESPACE
