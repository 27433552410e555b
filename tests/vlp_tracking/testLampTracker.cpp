/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Lamps from frame to frame: numbers that stay with them, ids that are never handed on.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "common/vpExpectError.h"
#include "lampScene.h"

using namespace lampScene;

namespace
{
//! Each lamp keeps the number of its first frame, and its id.
void expectNumbersStay(const Scene &scene, vpLampTracker &tracker, int frames,
                       const std::function<std::vector<Lamp>(int)> &lamps)
{
  std::map<double, unsigned int> numbers;
  std::set<unsigned int> distinct;
  for (int k = 0; k < frames; ++k) {
    const std::vector<vpLampObservation> all = tracker.track(scene.frame(k, lamps(k)));
    EXPECT_EQ(all.size(), lamps(k).size()) << "frame " << k;
    for (const Lamp &lamp : lamps(k)) {
      const vpLampObservation *seen = scene.seen(all, lamp);
      ASSERT_NE(seen, nullptr) << idOf(lamp.frequency) << " in frame " << k;
      EXPECT_GT(seen->track, 0u);
      EXPECT_EQ(numbers.emplace(lamp.frequency, seen->track).first->second, seen->track)
          << idOf(lamp.frequency) << " in frame " << k;
      EXPECT_EQ(seen->id, idOf(lamp.frequency)) << "frame " << k;
      distinct.insert(seen->track);
    }
  }
  EXPECT_EQ(distinct.size(), numbers.size());
  EXPECT_EQ(tracker.tracks(), numbers.size());
}
} // namespace

TEST(LampTracker, NumbersStayWithLampsThatMove)
{
  for (const bool columns : {false, true}) {
    const Scene scene(columns);
    for (const double pace : {0.0, 3.3, 12.0}) { // px a frame
      SCOPED_TRACE(pace);
      vpLampTracker tracker = scene.tracker();
      expectNumbersStay(scene, tracker, 12, [&](int k) { return moved(three, pace * k, 0.3 * pace * k); });
    }
  }
}

TEST(LampTracker, NumbersStayAtAHundredPixelsAFrameFromTheSecondOn)
{
  Scene scene;
  scene.width = 640;
  vpLampTracker tracker = scene.tracker();
  const std::vector<Lamp> two = {{60.3, 60.6, 2000}, {80.4, 240.8, 3500}};
  expectNumbersStay(scene, tracker, 5, [&](int k) { return moved(two, 100.0 * k, 0); });
}

TEST(LampTracker, LampThatIsBackInTimeKeepsItsNumber)
{
  const Scene scene;
  for (const double patience : {1.0, 0.2}) {
    SCOPED_TRACE(patience);
    vpLampTracker tracker = scene.tracker();
    tracker.patience = patience;
    unsigned int first = 0, again = 0;
    for (int k = 0; k < 26; ++k) {
      std::vector<Lamp> lamps = moved(three, 1.5 * k, 0);
      const Lamp hidden = lamps[0];
      if (k >= 6 && k < 18) { // for 0.4 s
        lamps.erase(lamps.begin());
      }
      const std::vector<vpLampObservation> all = tracker.track(scene.frame(k, lamps));
      const vpLampObservation *seen = scene.seen(all, hidden);
      if (patience > 0.4 || k < 18) { // else the search finds it, in a frame of the next five
        EXPECT_EQ(seen != nullptr, lamps.size() == 3) << "frame " << k;
      }
      if (seen != nullptr) {
        (k < 6 ? first : again) = seen->track;
        EXPECT_EQ(seen->id, "L2000") << "frame " << k;
      }
    }
    EXPECT_GT(first, 0u);
    EXPECT_GT(again, 0u);
    EXPECT_EQ(again == first, patience > 0.4);
    EXPECT_EQ(tracker.tracks(), 3u);
  }
}

TEST(LampTracker, LampInAnothersPlaceGetsANewNumberAndNeverItsId)
{
  const Scene scene;
  for (const double other : {4400.0, 5200.0}) { // of the map, and none of it
    vpLampTracker tracker = scene.tracker();
    unsigned int before = 0;
    for (int k = 0; k < 14; ++k) {
      std::vector<Lamp> lamps = three;
      lamps[1].frequency = k < 6 ? 2600 : other;
      const std::vector<vpLampObservation> all = tracker.track(scene.frame(k, lamps));
      const vpLampObservation *seen = scene.seen(all, lamps[1]);
      ASSERT_NE(seen, nullptr);
      if (k < 6) {
        before = seen->track;
        EXPECT_EQ(seen->id, "L2600");
      } else {
        EXPECT_GT(seen->track, before) << "frame " << k;
        EXPECT_EQ(seen->id, other < 5000 ? "L4400" : "") << "frame " << k;
      }
    }
    EXPECT_EQ(tracker.tracks(), 3u);
  }
}

// Less than a period of slow stripes says nothing: the id that the track had says nothing of it either.
TEST(LampTracker, RegionThatTellsNothingHasNoId)
{
  const Scene scene;
  vpLampTracker tracker = scene.tracker();
  for (int k = 0; k < 8; ++k) {
    const Lamp lamp{200, 150, k < 5 ? 2600. : 250.};
    const std::vector<vpLampObservation> &all = tracker.track(scene.frame(k, {lamp, {80, 80, 3500}}));
    EXPECT_TRUE(std::any_of(all.begin(), all.end(),
                            [](const vpLampObservation &each) { return each.id == idOf(3500); }));
    EXPECT_EQ(std::any_of(all.begin(), all.end(),
                          [](const vpLampObservation &each) { return each.id == idOf(2600); }),
              k < 5)
        << k;
  }
}

TEST(LampTracker, LampsThatCrossKeepTheirIds)
{
  const Scene scene;
  for (const double apart : {0.0, 30.0, 60.0}) { // px between their ways
    vpLampTracker tracker = scene.tracker();
    for (int k = 0; k < 30; ++k) {
      const std::vector<Lamp> lamps = {
          {60.3 + 9 * k, 150.2, 2000}, {340.7 - 9 * k, 150.2 + apart, 3500}, {200, 40, 2600}};
      const std::vector<vpLampObservation> all = tracker.track(scene.frame(k, lamps));
      const double between = std::hypot(lamps[0].u - lamps[1].u, lamps[0].v - lamps[1].v);
      for (const Lamp &lamp : lamps) {
        const vpLampObservation *seen = scene.seen(all, lamp);
        if (between > 2 * scene.radius + 4 || lamp.frequency == 2600) {
          ASSERT_NE(seen, nullptr) << "frame " << k << ", " << apart;
          EXPECT_EQ(seen->id, idOf(lamp.frequency)) << "frame " << k << ", " << apart;
        } else if (seen != nullptr) { // they overlap: what is seen is both
          EXPECT_TRUE(seen->id.empty() || seen->id == idOf(lamp.frequency))
              << seen->id << " at " << idOf(lamp.frequency) << ", frame " << k << ", " << apart;
        }
      }
    }
  }
}

TEST(LampTracker, LampsThatBlinkAlikeAreNeverTheSameOne)
{
  // The one that goes dark leaves its target with nothing to follow but its neighbour.
  const Scene scene;
  for (const double apart : {62.0, 80.0, 100.0}) { // px
    vpLampTracker tracker = scene.tracker();
    const Lamp stays = {200.3 + apart, 150.2, 2000}, leaves = {200.3, 150.2, 2000}, other = {80, 60, 2600};
    unsigned int number = 0;
    for (int k = 0; k < 30; ++k) {
      const bool dark = k >= 12 && k < 22;
      const std::vector<vpLampObservation> all = tracker.track(
          scene.frame(k, dark ? std::vector<Lamp>{stays, other} : std::vector<Lamp>{stays, other, leaves}));
      EXPECT_EQ(all.size(), dark ? 2u : 3u) << "frame " << k << ", " << apart;
      const vpLampObservation *seen = scene.seen(all, stays);
      ASSERT_NE(seen, nullptr) << "frame " << k << ", " << apart;
      number = number == 0 ? seen->track : number;
      EXPECT_EQ(seen->track, number) << "frame " << k << ", " << apart;
    }
  }
}

TEST(LampTracker, LampThatEntersIsBornWithinTheFramesOfOneSearch)
{
  const Scene scene;
  for (const double v : {50.0, 160.0, 270.0})
    for (const double share : {0.5, 0.2, 0.1}) {
      vpLampTracker tracker = scene.tracker();
      tracker.searchShare = share;
      const std::vector<Lamp> there = {{60, 60, 2000}, {60, 250, 3500}};
      int born = -1;
      const int first = 4, search = static_cast<int>(std::ceil(1 / share));
      for (int k = 0; k < first + search && born < 0; ++k) {
        std::vector<Lamp> lamps = there;
        const Lamp entering = {380.0, v, 2600}; // its middle is in, part of it is not
        if (k >= first) {
          lamps.push_back(entering);
        }
        for (const vpLampObservation &each : tracker.track(scene.frame(k, lamps))) {
          if (std::abs(each.outline.centre.x() - entering.u) < 15 &&
              std::abs(each.outline.centre.y() - v) < 15) {
            EXPECT_TRUE(each.cut);
            EXPECT_GT(each.track, 2u);
            born = k;
          }
        }
      }
      EXPECT_GE(born, first) << "at " << v << ", share " << share;
    }
}

TEST(LampTracker, ExpectedWindowsSaveTheSearch)
{
  const Scene scene;
  vpLampTracker tracker = scene.tracker();
  tracker.searchShare = 0.01;
  std::vector<Lamp> lamps = {{60, 250, 2000}, {160, 250, 3500}};
  for (int k = 0; k < 3; ++k) {
    tracker.track(scene.frame(k, lamps));
  }
  EXPECT_EQ(tracker.searched().size(), 3u); // two lamps and a strip
  lamps.push_back({300, 200, 2600});
  EXPECT_EQ(scene.seen(tracker.track(scene.frame(3, lamps)), lamps[2]), nullptr);
  const std::vector<vpLampObservation> all = tracker.track(scene.frame(4, lamps), {vpRect(290, 190, 20, 20)});
  const vpLampObservation *seen = scene.seen(all, lamps[2]);
  ASSERT_NE(seen, nullptr);
  EXPECT_EQ(seen->id, "L2600");
  EXPECT_EQ(tracker.searched().size(), 4u);
  tracker.track(scene.frame(5, {}));
  tracker.track(scene.frame(6, {})); // nothing was in sight: all of the picture is searched
  EXPECT_TRUE(tracker.searched().empty());
}

TEST(LampTracker, StillPicturesGiveWhatTheWholeFrameGives)
{
  for (const bool columns : {false, true}) {
    const Scene scene(columns);
    std::vector<Lamp> lamps = three;
    lamps.push_back({310, 240, 4400});
    vpLampTracker tracker = scene.tracker();
    vpLedDetector detector(scene.rig(), Scene::map());
    for (int k = 0; k < 8; ++k) {
      const vpVlpFrame frame = scene.frame(k, lamps);
      detector.detect(frame.I);
      const std::vector<vpLampObservation> &all = tracker.track(frame);
      ASSERT_EQ(all.size(), detector.observations().size());
      for (const vpLampObservation &whole : detector.observations()) {
        const auto same = std::find_if(all.begin(), all.end(), [&](const vpLampObservation &each) {
          return (each.point - whole.point).norm() < 0.2;
        });
        ASSERT_NE(same, all.end()) << whole.id << ", frame " << k;
        EXPECT_EQ(same->id, whole.id) << "frame " << k;
        EXPECT_NEAR(same->time, whole.time, 40e-6);
        EXPECT_NEAR(same->outline.diameter(), whole.outline.diameter(), 0.3);
        // The mean of the frames so far is the surer the more there were.
        EXPECT_LE(same->features.frequencySigma, 1.5 * whole.features.frequencySigma);
      }
    }
  }
}

TEST(LampTracker, SteadyRegionsAreSeenAndNotFollowed)
{
  const Scene scene;
  vpLampTracker tracker = scene.tracker();
  std::vector<Lamp> lamps = three;
  lamps.push_back({310, 240, 0});
  const std::vector<vpLampObservation> all = tracker.track(scene.frame(0, lamps));
  const vpLampObservation *steady = scene.seen(all, lamps[3]);
  ASSERT_NE(steady, nullptr);
  EXPECT_EQ(steady->track, 0u);
  EXPECT_EQ(tracker.tracks(), 3u);
}

TEST(LampTracker, FrameThatIsNotLaterIsRefusedAndTheNextGoesOn)
{
  const Scene scene;
  vpLampTracker tracker = scene.tracker();
  const unsigned int number = scene.seen(tracker.track(scene.frame(3, three)), three[0])->track;
  for (const int k : {3, 2}) {
    vpExpectError([&] { tracker.track(scene.frame(k, three)); }, {"time", "0.1 s", "expected"});
  }
  EXPECT_EQ(scene.seen(tracker.track(scene.frame(4, three)), three[0])->track, number);
  tracker.reset();
  EXPECT_EQ(tracker.tracks(), 0u);
  const std::vector<vpLampObservation> all = tracker.track(scene.frame(0, three));
  EXPECT_GT(scene.seen(all, three[0])->track, number) << "a number is given once";
}

TEST(LampTracker, TimeThatIsNoneIsRefused)
{
  const Scene scene;
  vpLampTracker tracker = scene.tracker();
  for (const double time : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    vpVlpFrame frame = scene.frame(0, three);
    frame.timestamp = time;
    vpExpectError([&] { tracker.track(frame); }, {"time", "expected"});
  }
  EXPECT_EQ(tracker.track(scene.frame(1, three)).size(), 3u);
}

TEST(LampTracker, PictureOfAnotherSizeIsRefusedAndTheNextGoesOn)
{
  const Scene scene;
  vpLampTracker tracker = scene.tracker();
  tracker.track(scene.frame(0, three));
  vpVlpFrame other = scene.frame(1, three);
  other.I.resize(100, 200);
  vpExpectError([&] { tracker.track(other); }, {"200 x 100", "400 x 320"});
  const std::vector<vpLampObservation> all = tracker.track(scene.frame(1, three));
  EXPECT_EQ(all.size(), 3u);
  EXPECT_EQ(tracker.tracks(), 3u);
}

// Frames at a steady rate hide the same edges of few stripes between short exposures, again and again.
TEST(LampTracker, LampThatSingleFramesKnowIsNotLostForWhatAllOfThemHide)
{
  const int frames = 16;
  for (double frequency = 2450; frequency < 4300; frequency += 150) {
    Scene scene;
    scene.radius = 1.85 / (frequency * 40e-6); // less than four stripes
    scene.exposure = 10e-6;
    scene.rate = 15;
    vpLampMap map = Scene::map();
    map.lamps[0].modulation.frequency = frequency;
    map.lamps.resize(1);
    const std::vector<Lamp> lamps = {{120.3, 100.6, frequency}};
    vpLampTracker tracker(scene.rig(), map);
    vpLedDetector single(scene.rig(), map);
    int alone = 0, tracked = 0;
    for (int k = 0; k < frames; ++k) {
      const vpVlpFrame frame = scene.frame(k, lamps);
      const vpLampObservation *seen = scene.seen(tracker.track(frame), lamps[0]);
      single.detect(frame.I);
      const vpLampObservation *once = scene.seen(single.observations(), lamps[0]);
      alone += once != nullptr && once->id == map.lamps[0].id;
      tracked += seen != nullptr && seen->id == map.lamps[0].id;
    }
    EXPECT_GE(tracked, alone) << frequency << " Hz";
  }
}
