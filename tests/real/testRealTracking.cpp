/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Real pictures played as a video: tracks that stay with their lamps.

#include "realSet.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <visp3/vlp_core/vpModulation.h>
#include <visp3/vlp_tracking/vpLampTracker.h>

namespace
{
//! What became of one lamp.
struct Seen {
  Eigen::Vector2d place;         // px, in the whole picture of the frame before
  Eigen::Vector2d point;         // px, in what the tracker saw of it
  std::string chips;             // as first seen
  std::set<unsigned int> tracks; // numbers that it had
  int frames = 0;                // in which it was seen
  double step = 0;               // px, the largest of point from frame to frame
  double wander = 0;             // px, likewise of place
  double chipsConfidence = 1;    // of a single frame, the least
};

//! How the pictures of ub300-coded are played: a camera that stands still, three lamps that send words.
struct Video {
  std::vector<size_t> pictures = {};
  double rate = 12; // Hz
  std::function<void(vpLampTracker &)> adjust = {};
  //! Of a part of each frame, 1000 x 800 px; empty: all of it is seen.
  std::function<Eigen::Vector2i(size_t)> corner = {};
};

vpImage<unsigned char> partOf(const vpImage<unsigned char> &I, const Eigen::Vector2i &corner)
{
  vpImage<unsigned char> part(800, 1000);
  for (unsigned int y = 0; y < part.getHeight(); ++y) {
    for (unsigned int x = 0; x < part.getWidth(); ++x) {
      part[y][x] = I[y + static_cast<unsigned int>(corner.y())][x + static_cast<unsigned int>(corner.x())];
    }
  }
  return part;
}

//! The observation at a point, nullptr where there is none.
const vpLampObservation *at(const Eigen::Vector2d &point, const std::vector<vpLampObservation> &all)
{
  const auto found = std::find_if(all.begin(), all.end(), [&point](const vpLampObservation &each) {
    return (each.point - point).norm() < 1;
  });
  return found == all.end() ? nullptr : &*found;
}

//! What each lamp was in all frames. A frame's chips are read beside the tracker, which sums up.
std::vector<Seen> play(RealSet &set, const Video &video)
{
  static const double near = 20; // px
  vpVlpRig rig = set.rig(set.images()[0], set.frame(set.images()[0]));
  if (video.corner) {
    rig.width = 1000;
    rig.height = 800;
  }
  vpLampTracker tracker(rig, {});
  vpLedDetector detector(rig, {});
  if (video.adjust) {
    video.adjust(tracker);
  }
  struct Picture {
    vpVlpFrame frame;
    std::vector<vpLampObservation> seen; // by the detector, where frames are whole pictures
  };
  std::vector<Picture> pictures;
  for (size_t k = 0; k < set.images().size(); ++k) {
    pictures.push_back({set.frame(set.images()[k]), {}});
    if (!video.corner) {
      detector.detect(pictures.back().frame.I);
      pictures.back().seen = detector.observations();
    }
  }
  std::vector<Seen> lamps;
  for (size_t k = 0; k < video.pictures.size(); ++k) {
    const Picture &picture = pictures[video.pictures[k]];
    vpVlpFrame frame = picture.frame;
    frame.timestamp = static_cast<double>(k) / video.rate;
    Eigen::Vector2i corner(0, 0);
    if (video.corner) {
      corner = video.corner(k);
      frame.I = partOf(frame.I, corner);
    }
    std::vector<vpLampObservation> whole = picture.seen;
    if (video.corner) {
      detector.detect(frame.I);
      whole = detector.observations();
    }
    for (const vpLampObservation &seen : tracker.track(frame)) {
      const vpLampObservation *alone = at(seen.point, whole);
      if (alone == nullptr) {
        ADD_FAILURE() << "frame " << k << ": no lamp at " << seen.point.transpose();
        continue;
      }
      const Eigen::Vector2d place = seen.point + corner.cast<double>();
      auto lamp = std::find_if(lamps.begin(), lamps.end(),
                               [&](const Seen &each) { return (each.place - place).norm() < near; });
      if (lamp == lamps.end()) {
        Seen born;
        born.place = place;
        born.point = seen.point;
        born.chips = alone->features.chips;
        lamp = lamps.insert(lamps.end(), born);
      }
      EXPECT_TRUE(vpModulation::sameWord(alone->features.chips, lamp->chips)) << "frame " << k;
      EXPECT_TRUE(vpModulation::sameWord(seen.features.chips, lamp->chips)) << "frame " << k;
      lamp->tracks.insert(seen.track);
      lamp->step = std::max(lamp->step, (seen.point - lamp->point).norm());
      lamp->wander = std::max(lamp->wander, (place - lamp->place).norm());
      lamp->chipsConfidence = std::min(lamp->chipsConfidence, alone->features.chipsConfidence);
      lamp->place = place;
      lamp->point = seen.point;
      ++lamp->frames;
    }
  }
  return lamps;
}

//! Three lamps, each seen in all frames but the first \e missed at most, under one number of its own.
void expectSteady(RealSet &set, const Video &video, size_t missed = 0)
{
  const std::vector<Seen> lamps = play(set, video);
  const size_t frames = video.pictures.size();
  std::set<unsigned int> numbers;
  std::set<std::string> words;
  for (const Seen &lamp : lamps) {
    std::cout << "coded lamp at " << lamp.place.transpose() << ": " << lamp.frames << " of " << frames
              << " frames, track";
    for (unsigned int number : lamp.tracks) {
      std::cout << " " << number;
    }
    std::cout << ", chips " << lamp.chips << " (confidence in a frame at least " << lamp.chipsConfidence
              << "), moved by up to " << lamp.step << " px from frame to frame, in the whole picture by "
              << lamp.wander << "\n";
    EXPECT_GE(static_cast<size_t>(lamp.frames) + missed, frames);
    EXPECT_EQ(lamp.tracks.size(), 1u);
    EXPECT_GT(*lamp.tracks.begin(), 0u) << "not followed";
    EXPECT_FALSE(lamp.chips.empty());
    numbers.insert(*lamp.tracks.begin());
    words.insert(lamp.chips);
  }
  EXPECT_EQ(lamps.size(), 3u);
  EXPECT_EQ(numbers.size(), 3u);
  EXPECT_EQ(words.size(), 3u);
}

//! Frames of six, to and fro: 0 to 5, 4 to 0, 1 to 5 ...
std::vector<size_t> toAndFro(size_t frames)
{
  std::vector<size_t> order;
  for (size_t k = 0; k < frames; ++k) {
    const size_t along = k % 10;
    order.push_back(along < 6 ? along : 10 - along);
  }
  return order;
}

const auto stripsOnly = [](vpLampTracker &tracker) { tracker.needed = 0; };

TEST(Ub300CodedVideo, OneTrackForEachLamp)
{
  VLP_REAL_SET(set, "ub300-coded");
  ASSERT_EQ(set.images().size(), 6u);
  expectSteady(set, {toAndFro(6)});
}

TEST(Ub300CodedVideo, ToAndFroForFiveSeconds)
{
  VLP_REAL_SET(set, "ub300-coded");
  expectSteady(set, {toAndFro(60)});
}

// Only where the tracks are, and in one fifth of each frame: lamps are found as the search comes by, and
// then held by their tracks alone.
TEST(Ub300CodedVideo, WithoutASearchOfWholeFrames)
{
  VLP_REAL_SET(set, "ub300-coded");
  expectSteady(set, {toAndFro(30), 12, stripsOnly}, 4);
}

// A part of each picture that moves, as if the camera did, to and fro twice: real pixels, to 30 px from frame
// to frame.
TEST(Ub300CodedVideo, AsIfTheCameraMoved)
{
  VLP_REAL_SET(set, "ub300-coded");
  const auto corner = [](size_t k) {
    const double t = static_cast<double>(k);
    return Eigen::Vector2d(200 + 75 * std::sin(0.35 * t), 20 + 20 * std::sin(0.5 * t)).cast<int>().eval();
  };
  expectSteady(set, {toAndFro(36), 12, {}, corner});
  expectSteady(set, {toAndFro(36), 12, stripsOnly, corner}, 4);
}
} // namespace
