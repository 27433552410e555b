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

//! What reacquisition left open: lamps that were not found, and windows that show more than those that were.
void vpLampTracker::search(const vpVlpFrame &frame)
{
  static const double halo = 0.1, beyond = 4; // of a lamp's extent; px
  std::vector<vpRect> &known = m_scratch->known, &open = m_scratch->open,
                      &knownOrSteady = m_scratch->knownOrSteady;
  known.clear();
  open.clear();
  double noise = 0; // grey levels
  for (const vpLampObservation &lamp : m_observations) {
    const vpRect box = boxOf(lamp.outline);
    const double wider = halo + beyond / std::max(1.0, std::min(box.getWidth(), box.getHeight()));
    known.push_back(widened(box, wider));
    noise = std::max(noise, lamp.noise);
  }
  knownOrSteady = known;
  for (const Steady &steady : m_steady) {
    knownOrSteady.push_back(steady.box);
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
    // Where a lamp is expected, what told nothing of one may be a part of it.
    if (!found &&
        (target || known.empty() ||
         vpLedRoiDetector::showsMore(frame.I, m_searched[w], strip ? knownOrSteady : known, noise))) {
      open.push_back(m_searched[w]);
    }
  }
  if (open.empty()) {
    return;
  }
  detector.detect(frame.I, open);
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
  Steady regions move in the picture as the lamps do: by the similarity that takes these from the frame before
  to this one. What hangs higher or lower soon leaves its box, is seen there, and remembered anew.
*/
void vpLampTracker::moveSteady(double time)
{
  using Complex = std::complex<double>;
  if (m_observations.empty()) {
    m_steady.clear(); // who knows where they are
    return;
  }
  auto beforeOf = [this](size_t i) {
    const vpImagePoint centre = m_tracks[static_cast<size_t>(m_trackOf[i])].place.getCenter();
    return Complex(centre.get_u(), centre.get_v());
  };
  auto nowOf = [this](size_t i) {
    const Eigen::Vector2d &centre = m_observations[i].outline.centre;
    return Complex(centre.x(), centre.y());
  };
  const auto count = static_cast<double>(m_observations.size());
  Complex from = 0, to = 0, products = 0;
  double squares = 0;
  for (size_t i = 0; i < m_observations.size(); ++i) {
    from += beforeOf(i) / count;
    to += nowOf(i) / count;
  }
  for (size_t i = 0; i < m_observations.size(); ++i) {
    products += std::conj(beforeOf(i) - from) * (nowOf(i) - to);
    squares += std::norm(beforeOf(i) - from);
  }
  const Complex turn = squares > 0 ? products / squares : 1;
  for (Steady &steady : m_steady) {
    const vpImagePoint centre = steady.box.getCenter();
    const Complex moved = to + turn * (Complex(centre.get_u(), centre.get_v()) - from);
    steady.box.moveCenter(moved.real(), moved.imag());
  }
  m_steady.erase(std::remove_if(m_steady.begin(), m_steady.end(),
                                [time](const Steady &steady) { return steady.until < time; }),
                 m_steady.end());
}

//! A region that tells nothing of any lamp.
void vpLampTracker::rememberSteady(const vpLampObservation &seen, double time)
{
  static const double around = 0.1, beyond = 8, same = 0.5; // of its extent; px
  if (tells(seen)) {
    return;
  }
  const vpRect box = boxOf(seen.outline);
  const double wider = around + beyond / std::max(1.0, std::min(box.getWidth(), box.getHeight()));
  m_steady.erase(std::remove_if(m_steady.begin(), m_steady.end(),
                                [&box](const Steady &steady) { return overlap(steady.box, box) > same; }),
                 m_steady.end());
  static const double ofCut = 0.25; // a part of it: it may be a lamp that comes into sight
  m_steady.push_back({widened(box, wider), time + (seen.cut ? ofCut : 1) * steadiness});
}

//! Where to look: around each target, where lamps are expected, and the strip whose turn it is.
void vpLampTracker::setWindows(const vpVlpFrame &frame, const std::vector<vpRect> &expected)
{
  std::vector<vpRect> &all = m_searched;
  all.clear();
  for (Track &track : m_tracks) {
    track.taken = false;
    track.found = false;
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
