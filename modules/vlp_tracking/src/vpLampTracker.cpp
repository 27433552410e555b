/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_tracking/vpLampTracker.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "vpLampTrack.h"

BEGIN_VISP_NAMESPACE

namespace
{
vpRect boxOf(const vpLampOutline &outline)
{
  const Eigen::Vector4d box = outline.box();
  return {box(0), box(1), box(2) - box(0), box(3) - box(1)};
}

//! Larger by \e share of its size on each side.
vpRect widened(const vpRect &rect, double share)
{
  const double x = share * rect.getWidth(), y = share * rect.getHeight();
  return {rect.getLeft() - x, rect.getTop() - y, rect.getWidth() + 2 * x, rect.getHeight() + 2 * y};
}

//! The part of a rectangle that lies in a picture; of no size where there is none.
vpRect inside(const vpRect &rect, const vpImage<unsigned char> &I)
{
  const double left = std::max(0.0, std::ceil(rect.getLeft())), top = std::max(0.0, std::ceil(rect.getTop())),
               right = std::min(I.getWidth() - 1.0, std::floor(rect.getLeft() + rect.getWidth())),
               bottom = std::min(I.getHeight() - 1.0, std::floor(rect.getTop() + rect.getHeight()));
  return {left, top, std::max(0.0, right - left + 1), std::max(0.0, bottom - top + 1)};
}

double overlap(const vpRect &a, const vpRect &b)
{
  const double x = std::min(a.getLeft() + a.getWidth(), b.getLeft() + b.getWidth()) -
                   std::max(a.getLeft(), b.getLeft()),
               y = std::min(a.getTop() + a.getHeight(), b.getTop() + b.getHeight()) -
                   std::max(a.getTop(), b.getTop());
  const double common = std::max(0.0, x) * std::max(0.0, y);
  return common / std::max(1.0, a.getWidth() * a.getHeight() + b.getWidth() * b.getHeight() - common);
}

bool blinks(const vpLampObservation &seen)
{
  return seen.features.signal != vpStripeFeatures::Signal::unmodulated &&
         seen.outline.shape != vpLampOutline::Shape::region;
}
} // namespace

vpLampTracker::vpLampTracker(const vpVlpRig &rig, const vpLampMap &map) : detector(rig, map), m_rig(rig) {}
vpLampTracker::~vpLampTracker() = default;
vpLampTracker::vpLampTracker(vpLampTracker &&) noexcept = default;

size_t vpLampTracker::tracks() const
{
  return m_tracks.size();
}

void vpLampTracker::reset()
{
  m_tracks.clear();
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
  m_searched = windows(frame, expected);
  m_observations.clear();
  m_trackOf.clear();
  if (m_inSight < needed) {
    m_searched.clear();
    detector.detect(frame.I);
    m_observations = detector.observations();
  } else {
    glance(frame.I);
    search(frame.I);
  }

  // Which region is which lamp; what all its frames say of it; what is new.
  const size_t glanced = m_trackOf.size();
  assign();
  for (size_t i = 0; i < m_observations.size(); ++i) {
    if (i < glanced) {
      followGlanced(m_tracks[static_cast<size_t>(m_trackOf[i])], m_observations[i], frame);
    } else if (m_trackOf[i] >= 0) {
      follow(m_tracks[static_cast<size_t>(m_trackOf[i])], m_observations[i], frame);
    } else if (blinks(m_observations[i])) {
      bear(m_observations[i], frame);
    }
  }
  if (m_observations.size() > glanced) { // else all is known as it is
    detector.recognizer.recognize(m_observations);
  }
  for (size_t i = 0; i < m_observations.size(); ++i) {
    if (m_trackOf[i] >= 0) {
      m_tracks[static_cast<size_t>(m_trackOf[i])].learn(m_observations[i], sure,
                                                        detector.recognizer.minConfidence);
    }
  }
  std::stable_sort(m_observations.begin(), m_observations.end(),
                   [](const vpLampObservation &a, const vpLampObservation &b) {
                     return a.features.area > b.features.area;
                   });
  m_inSight = static_cast<size_t>(
      std::count_if(m_observations.begin(), m_observations.end(),
                    [](const vpLampObservation &seen) { return !seen.candidates.empty(); }));
  m_time = frame.timestamp;
  m_any = true;
  bury(frame.timestamp);
  for (Track &track : m_tracks) {
    track.remember(frame.I);
  }
  return m_observations;
}

//! Whether the lamp has its middle about there, and is as it was.
bool vpLampTracker::glanceAt(Track &track, const vpImage<unsigned char> &I, const vpImagePoint &place)
{
  if (!track.known) {
    return false;
  }
  vpLampObservation lamp = *track.known;
  lamp.outline.centre = {place.get_u(), place.get_v()};
  if (detector.glance(I, lamp)) {
    track.found = std::move(lamp);
  }
  return track.found.has_value();
}

//! The same in the middle of the nearest window in which a lamp is expected.
bool vpLampTracker::glanceAsExpected(Track &track, const vpImage<unsigned char> &I,
                                     const std::vector<vpRect> &expected)
{
  static const double farthest = 1; // of the lamp's extent, since the frame before
  const vpImagePoint before = track.place.getCenter();
  auto way = [&before](const vpRect &window) { return vpImagePoint::distance(window.getCenter(), before); };
  const auto nearest = std::min_element(expected.begin(), expected.end(), [&way](const auto &a, const auto &b) {
    return way(a) < way(b);
  });
  return nearest != expected.end() &&
         way(*nearest) < farthest * std::max(track.place.getWidth(), track.place.getHeight()) &&
         glanceAt(track, I, nearest->getCenter());
}

//! The lamps that are where their targets are, and as they were.
void vpLampTracker::glance(const vpImage<unsigned char> &I)
{
  for (size_t t = 0; t < m_tracks.size(); ++t) {
    Track &track = m_tracks[t];
    if (track.astray) {
      continue;
    }
    if (track.found || glanceAt(track, I, track.target->center())) {
      track.taken = true;
      m_observations.push_back(*track.found);
      m_trackOf.push_back(static_cast<int>(t));
    }
  }
  // Of lamps that blink alike, the target of one that is hidden may be another one: it is that which came
  // from nearer by.
  static const double same = 0.3;
  auto way = [this](size_t i) { // px, since the frame before
    const vpLampOutline &outline = m_observations[i].outline;
    return vpImagePoint::distance(m_tracks[static_cast<size_t>(m_trackOf[i])].place.getCenter(),
                                  {outline.centre.y(), outline.centre.x()});
  };
  std::vector<bool> another(m_observations.size(), false);
  for (size_t i = 0; i < m_observations.size(); ++i) {
    for (size_t k = i + 1; k < m_observations.size(); ++k) {
      if (overlap(boxOf(m_observations[i].outline), boxOf(m_observations[k].outline)) > same) {
        another[way(i) > way(k) ? i : k] = true;
      }
    }
  }
  for (size_t i = another.size(); i-- > 0;) {
    if (another[i]) {
      m_tracks[static_cast<size_t>(m_trackOf[i])].taken = false;
      m_observations.erase(m_observations.begin() + static_cast<std::ptrdiff_t>(i));
      m_trackOf.erase(m_trackOf.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
}

//! What glances left open: lamps that were not found, and other windows that show more than lamps that were.
void vpLampTracker::search(const vpImage<unsigned char> &I)
{
  static const double halo = 0.1, beyond = 4; // of a lamp's extent; px
  std::vector<vpRect> known, open;
  double noise = 0; // grey levels
  for (const vpLampObservation &lamp : m_observations) {
    const vpRect box = boxOf(lamp.outline);
    const double wider = halo + beyond / std::max(1.0, std::min(box.getWidth(), box.getHeight()));
    known.push_back(widened(box, wider));
    noise = std::max(noise, lamp.noise);
  }
  auto shown = [this](const vpRect &window) { // the lamp that is expected there
    return std::any_of(m_observations.begin(), m_observations.end(),
                       [&window](const vpLampObservation &lamp) {
                         return window.isInside({lamp.outline.centre.y(), lamp.outline.centre.x()});
                       });
  };
  for (size_t w = 0; w < m_searched.size(); ++w) {
    const bool strip = w + 1 == m_searched.size(), target = w < m_tracks.size();
    const bool found = target ? m_tracks[w].taken : !strip && shown(m_searched[w]);
    if (!found && (target || known.empty() || detector.showsMore(I, m_searched[w], known, noise))) {
      open.push_back(m_searched[w]);
    }
  }
  if (open.empty()) {
    return;
  }
  detector.detect(I, open);
  for (const vpLampObservation &seen : detector.observations()) {
    const vpImagePoint middle(seen.outline.centre.y(), seen.outline.centre.x());
    const vpRect box = boxOf(seen.outline);
    const bool twice =
        std::any_of(m_observations.begin(), m_observations.begin() + static_cast<long>(known.size()),
                    [&](const vpLampObservation &lamp) {
                      static const double same = 0.3;
                      const vpRect other = boxOf(lamp.outline);
                      return other.isInside(middle) || overlap(box, other) > same;
                    });
    if (!twice) {
      m_observations.push_back(seen);
    }
  }
}

//! Where to look: around each target, where lamps are expected, and the strip whose turn it is.
std::vector<vpRect> vpLampTracker::windows(const vpVlpFrame &frame, const std::vector<vpRect> &expected)
{
  std::vector<vpRect> all;
  for (Track &track : m_tracks) {
    track.taken = false;
    track.found.reset();
    if (track.astray) {
      track.window = track.place;
    } else {
      const bool there = m_inSight >= needed && glanceAsExpected(track, frame.I, expected) &&
                         track.target->goOn(boxOf(track.found->outline));
      if (!there) {
        track.target->track(frame.I);
      }
      track.window = track.target->window();
    }
    all.push_back(widened(track.window, margin));
  }
  all.insert(all.end(), expected.begin(), expected.end());
  all.push_back(strip());
  return all;
}

vpRect vpLampTracker::strip()
{
  const bool columns = m_rig.shutter.alongColumns();
  const double length = columns ? m_rig.width : m_rig.height, across = columns ? m_rig.height : m_rig.width;
  const auto strips = static_cast<unsigned int>(std::ceil(1 / std::max(0.01, std::min(1.0, searchShare))));
  const double width = length / strips, from = (m_strip++ % strips) * width;
  return columns ? vpRect(from, 0, width, across) : vpRect(0, from, across, width);
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
      continue; // found by a glance
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

//! What a glance found is as it was.
void vpLampTracker::followGlanced(Track &track, vpLampObservation &seen, const vpVlpFrame &frame)
{
  track.seenLast = frame.timestamp;
  setRight(track, seen, frame);
}

//! Adds what a frame says of a lamp to what is known of it.
void vpLampTracker::follow(Track &track, vpLampObservation &seen, const vpVlpFrame &frame)
{
  if (blinks(seen)) {
    const bool tells = !m_again || !track.evidence.agrees(seen.features);
    if (tells && !track.evidence.add(seen.features)) {
      track.number = ++m_born; // another lamp in its place
    }
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

void vpLampTracker::bear(vpLampObservation &seen, const vpVlpFrame &frame)
{
  const vpRect box = inside(boxOf(seen.outline), frame.I);
  if (box.getWidth() < 4 || box.getHeight() < 4) {
    return;
  }
  Track track;
  track.target = targetAt(frame.I, box);
  if (!track.target) {
    return;
  }
  track.number = ++m_born;
  track.evidence.add(seen.features);
  track.seenLast = frame.timestamp;
  track.window = track.place = box;
  track.taken = true;
  seen.track = track.number;
  m_tracks.push_back(std::move(track));
}

//! Lamps that were not seen for long, or that left the picture.
void vpLampTracker::bury(double time)
{
  m_tracks.erase(std::remove_if(m_tracks.begin(), m_tracks.end(),
                                [&](const Track &track) {
                                  const vpRect window = track.astray ? track.place : track.target->window();
                                  const bool gone = !(window.getWidth() > 0 && window.getHeight() > 0);
                                  return time - track.seenLast > patience || (gone && !track.taken);
                                }),
                 m_tracks.end());
}

END_VISP_NAMESPACE
