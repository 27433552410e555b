/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Where vpLampTracker looks for lamps: at those that are followed, and in search of others.

#include <visp3/vlp_tracking/vpLampTracker.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "vpLampBoxes.h"
#include "vpLampTrack.h"
#include "vpTrackerScratch.h"

BEGIN_VISP_NAMESPACE

using vpLampBoxes::boxOf;
using vpLampBoxes::overlap;
using vpLampBoxes::tells;
using vpLampBoxes::widened;

namespace
{
//! Overlap of boxes of the same light, which may hang higher or lower than the lamps by which it was moved.
const double sameLight = 0.3;
} // namespace

//! Whether the lamp has its middle about there, and is as it was.
bool vpLampTracker::reacquireAt(Track &track, const vpImage<unsigned char> &I, const vpImagePoint &place)
{
  if (!track.sure) {
    return false;
  }
  track.seen = track.known;
  track.seen.outline.centre = {place.get_u(), place.get_v()};
  track.found = detector.reacquire(I, track.seen);
  return track.found;
}

//! The same in the middle of the nearest window in which a lamp is expected.
bool vpLampTracker::reacquireAsExpected(Track &track, const vpImage<unsigned char> &I,
                                        const std::vector<vpRect> &expected)
{
  static const double farthest = 1; // of the lamp's extent, since the frame before
  const vpImagePoint before = track.place.getCenter();
  auto way = [&before](const vpRect &window) { return vpImagePoint::distance(window.getCenter(), before); };
  const auto nearest = std::min_element(expected.begin(), expected.end(),
                                        [&way](const auto &a, const auto &b) { return way(a) < way(b); });
  return nearest != expected.end() &&
         way(*nearest) < farthest * std::max(track.place.getWidth(), track.place.getHeight()) &&
         reacquireAt(track, I, nearest->getCenter());
}

//! The lamps that are where their targets are, and as they were.
void vpLampTracker::reacquire(const vpImage<unsigned char> &I)
{
  for (size_t t = 0; t < m_tracks.size(); ++t) {
    Track &track = m_tracks[t];
    if (track.astray) {
      continue;
    }
    if (track.found || reacquireAt(track, I, track.target->center())) {
      track.taken = true;
      addObservation(track.seen);
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
  std::vector<char> &another = m_scratch->another;
  another.assign(m_observations.size(), 0);
  for (size_t i = 0; i < m_observations.size(); ++i) {
    for (size_t k = i + 1; k < m_observations.size(); ++k) {
      if (overlap(boxOf(m_observations[i].outline), boxOf(m_observations[k].outline)) > same) {
        another[way(i) > way(k) ? i : k] = 1;
      }
    }
  }
  for (size_t i = another.size(); i-- > 0;) {
    if (another[i] != 0) {
      m_tracks[static_cast<size_t>(m_trackOf[i])].taken = false;
      m_observations.erase(m_observations.begin() + static_cast<std::ptrdiff_t>(i));
      m_trackOf.erase(m_trackOf.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
}

//! Whether the lamp that is expected in a window was reacquired, or its target is there, where it was seen
//! last.
bool vpLampTracker::shown(const vpRect &window) const
{
  return std::any_of(m_observations.begin(), m_observations.end(),
                     [&window](const vpLampObservation &lamp) {
                       return window.isInside({lamp.outline.centre.y(), lamp.outline.centre.x()});
                     }) ||
         std::any_of(m_tracks.begin(), m_tracks.end(), [this, &window](const Track &track) {
           return track.fits && track.seenLast == m_time && window.isInside(track.window.getCenter());
         });
}

//! What is to be searched, and what is known: lamps that were reacquired, and steady light.
void vpLampTracker::openWindows(const vpVlpFrame &frame)
{
  static const double halo = 0.1, beyond = 4, beyondSteady = 8; // of an extent; px
  std::vector<vpRect> &known = m_scratch->known, &open = m_scratch->open, &steady = m_scratch->steady,
                      &light = m_scratch->light;
  known.clear();
  open.clear();
  steady.clear();
  auto around = [](const vpRect &box, double more) {
    return widened(box, halo + more / std::max(1.0, std::min(box.getWidth(), box.getHeight())));
  };
  double noise = 0; // grey levels
  for (const vpLampObservation &lamp : m_observations) {
    known.push_back(around(boxOf(lamp.outline), beyond));
    noise = std::max(noise, lamp.noise);
  }
  const vpRect &strip = m_searched.back();
  askAgain(strip, frame.timestamp);
  for (const Steady &each : m_steady) {
    if (!each.asked) {
      steady.push_back(around(each.box, beyondSteady));
    }
  }
  for (size_t w = 0; w + 1 < m_searched.size(); ++w) {
    static const double middle = -0.25; // of an expected window, which the lamp fills
    const bool target = w < m_tracks.size();
    if (target ? m_tracks[w].taken : shown(m_searched[w])) {
      continue;
    }
    if (!target && !known.empty()) {
      vpLedRoiDetector::otherLight(frame.I, m_searched[w], known, noise, light);
      if (light.empty()) {
        continue;
      }
    }
    open.push_back(m_searched[w]);
    // Where a lamp is expected, what told nothing of one may be a part of it.
    const vpRect place = target ? m_tracks[w].window : widened(m_searched[w], middle);
    steady.erase(std::remove_if(steady.begin(), steady.end(),
                                [&place](const vpRect &box) { return overlap(box, place) > 0; }),
                 steady.end());
  }
  known.insert(known.end(), steady.begin(), steady.end());
  vpLedRoiDetector::otherLight(frame.I, strip, known, noise, light);
  double area = 0; // that may have to be looked at for so many
  for (const vpRect &box : light) {
    area += std::pow(3 * std::max(box.getWidth(), box.getHeight()), 2);
  }
  if (area > strip.getWidth() * strip.getHeight()) {
    light.assign(1, strip);
  }
  open.insert(open.end(), light.begin(), light.end());
}

//! What reacquisition left open: lamps that were not found, and windows that show more than those that were.
void vpLampTracker::search(const vpVlpFrame &frame)
{
  openWindows(frame);
  if (m_scratch->open.empty()) {
    return;
  }
  detector.detect(frame.I, m_scratch->open, m_scratch->known);
  const auto reacquired = static_cast<long>(m_observations.size());
  for (const vpLampObservation &seen : detector.observations()) {
    const vpImagePoint middle(seen.outline.centre.y(), seen.outline.centre.x());
    const vpRect box = boxOf(seen.outline);
    const bool twice = std::any_of(m_observations.begin(), m_observations.begin() + reacquired,
                                   [&](const vpLampObservation &lamp) {
                                     static const double same = 0.3;
                                     const vpRect other = boxOf(lamp.outline);
                                     return other.isInside(middle) || overlap(box, other) > same;
                                   });
    if (!twice) {
      addObservation(seen);
      rememberSteady(seen, frame.timestamp);
    }
  }
}

//! All of the picture, whatever was found before.
void vpLampTracker::searchAll(const vpVlpFrame &frame)
{
  m_searched.clear();
  clearObservations();
  m_trackOf.clear();
  for (Track &track : m_tracks) {
    track.taken = false;
  }
  detector.detect(frame.I);
  for (const vpLampObservation &seen : detector.observations()) {
    addObservation(seen);
  }
  m_steady.clear();
  for (const vpLampObservation &seen : m_observations) {
    rememberSteady(seen, frame.timestamp);
  }
}

/*!
  Steady regions move in the picture as the lamps do that were reacquired, or as all targets where none was:
  by the similarity that takes these from the frame before to this one. What hangs higher or lower soon leaves
  its box, is seen there, and remembered anew.
*/
void vpLampTracker::moveSteady(double time)
{
  using Complex = std::complex<double>;
  std::vector<std::pair<Complex, Complex>> &moves = m_scratch->moves;
  moves.clear();
  auto at = [](const vpImagePoint &point) { return Complex(point.get_u(), point.get_v()); };
  for (const Track &track : m_tracks) {
    if (track.taken) { // what is a pixel off moves them on and on
      const Eigen::Vector2d &before = track.known.outline.centre, &centre = track.seen.outline.centre;
      moves.emplace_back(Complex(before.x(), before.y()), Complex(centre.x(), centre.y()));
    } else if (m_observations.empty() && !track.astray) {
      moves.emplace_back(at(track.before), at(track.target->center()));
    }
  }
  if (moves.empty()) {
    m_steady.clear(); // who knows where they are
    return;
  }
  const auto count = static_cast<double>(moves.size());
  Complex from = 0, to = 0, products = 0;
  double squares = 0;
  for (const auto &[before, now] : moves) {
    from += before / count;
    to += now / count;
  }
  for (const auto &[before, now] : moves) {
    products += std::conj(before - from) * (now - to);
    squares += std::norm(before - from);
  }
  const Complex turn = squares > 0 ? products / squares : 1;
  for (Steady &steady : m_steady) {
    const Complex moved = to + turn * (at(steady.box.getCenter()) - from);
    steady.box.moveCenter(moved.real(), moved.imag());
  }
  m_steady.erase(
      std::remove_if(m_steady.begin(), m_steady.end(), // was looked for, and not seen again
                     [&](const Steady &steady) { return steady.asked && steady.until + patience < time; }),
      m_steady.end());
}

//! s, since when a region has been known for no lamp; now, where it was not.
double vpLampTracker::noLampSince(const vpRect &box, double time) const
{
  for (const Steady &steady : m_steady) {
    time = overlap(steady.box, box) > sameLight ? std::min(time, steady.since) : time;
  }
  return time;
}

//! Of the regions in a strip whose time is over that one is looked at again whose time was over first: so no
//! frame takes much longer than others.
void vpLampTracker::askAgain(const vpRect &strip, double time)
{
  Steady *next = nullptr;
  for (Steady &steady : m_steady) {
    if (!steady.asked && steady.until < time && strip.isInside(steady.box.getCenter()) &&
        (next == nullptr || steady.until < next->until)) {
      next = &steady;
    }
  }
  if (next != nullptr) {
    next->asked = true;
    next->until = time;
  }
}

//! A region that is no lamp. What has long been none is trusted for as long again, up to a bound.
void vpLampTracker::rememberSteady(const vpRect &box, double since, bool cut, double time)
{
  m_steady.erase(
      std::remove_if(m_steady.begin(), m_steady.end(),
                     [&box](const Steady &steady) { return overlap(steady.box, box) > sameLight; }),
      m_steady.end());
  static const double ofCut = 0.25; // a part of it: it may be a lamp that comes into sight
  static const double longest = 10; // times: a lamp that shone without a break may have begun to blink
  m_steady.push_back(
      {box, since,
       time + (cut ? ofCut : 1) * std::min(std::max(steadiness, time - since), longest * steadiness)});
}

void vpLampTracker::rememberSteady(const vpLampObservation &seen, double time)
{
  if (!tells(seen)) {
    const vpRect box = boxOf(seen.outline);
    rememberSteady(box, noLampSince(box, time), seen.cut, time);
  }
}

//! Where to look: around each target, where lamps are expected, and the strip whose turn it is.
void vpLampTracker::setWindows(const vpVlpFrame &frame, const std::vector<vpRect> &expected)
{
  std::vector<vpRect> &all = m_searched;
  all.clear();
  for (Track &track : m_tracks) {
    track.taken = false;
    track.found = false;
    track.before = track.target->center();
    if (track.astray) {
      track.window = track.place;
    } else {
      const bool there = m_inSight >= needed && reacquireAsExpected(track, frame.I, expected) &&
                         track.target->goOn(boxOf(track.seen.outline));
      if (!there) {
        track.target->track(frame.I);
      }
      track.window = track.target->window();
    }
    all.push_back(widened(track.window, margin));
  }
  all.insert(all.end(), expected.begin(), expected.end());
  all.push_back(strip());
}

vpRect vpLampTracker::strip()
{
  const bool columns = m_rig.shutter.alongColumns();
  const double length = columns ? m_rig.width : m_rig.height, across = columns ? m_rig.height : m_rig.width;
  const auto strips = static_cast<unsigned int>(std::ceil(1 / std::max(0.01, std::min(1.0, searchShare))));
  const double width = length / strips, from = (m_strip++ % strips) * width;
  return columns ? vpRect(from, 0, width, across) : vpRect(0, from, across, width);
}

END_VISP_NAMESPACE
