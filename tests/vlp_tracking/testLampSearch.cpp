/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Where lamps are looked for: as expected, beside steady lights, and again where these were.

#include <gtest/gtest.h>

#include "lampScene.h"

using namespace lampScene;

namespace
{
const int firstFrames = 8; // after which reacquisition will do

std::vector<Lamp> with(std::vector<Lamp> lamps, const Lamp &another)
{
  lamps.push_back(another);
  return lamps;
}

//! Frames from \e first to before \e last in which something is seen at a lamp's place.
int sightings(const Scene &scene, vpLampTracker &tracker, int first, int last, double pace,
              const std::vector<Lamp> &lamps, const Lamp &lamp)
{
  int seen = 0;
  for (int k = first; k < last; ++k) {
    const std::vector<Lamp> now = moved(lamps, pace * k, 0);
    const std::vector<vpLampObservation> all = tracker.track(scene.frame(k, now));
    seen += scene.seen(all, moved({lamp}, pace * k, 0)[0]) != nullptr ? 1 : 0;
    for (const Lamp &each : moved(three, pace * k, 0)) {
      const vpLampObservation *found = scene.seen(all, each);
      EXPECT_TRUE(found != nullptr && found->id == idOf(each.frequency)) << "frame " << k;
    }
  }
  return seen;
}

const Lamp steady = {300, 240, 0};
} // namespace

// As a luminaire's shade does, which noise and motion show anew each time.
TEST(LampSearch, LightThatFitsNoLampByOtherStripesEachTimeIsPassedOverUntilALampShinesThere)
{
  const Scene scene;
  vpLampTracker tracker = scene.tracker();
  tracker.steadiness = 0.3; // s
  const int until = 60, longest = static_cast<int>(10 * tracker.steadiness / frameTime) + 5;
  int early = 0, late = 0, back = -1;
  for (int k = 0; k < until + longest && back < 0; ++k) {
    const Lamp light = {300, 240, k >= until ? 4400 : k % 2 == 0 ? 3000.0 : 3100.0};
    const vpLampObservation *seen = scene.seen(tracker.track(scene.frame(k, with(three, light))), light);
    early += seen != nullptr && k < static_cast<int>(tracker.sure);
    late += seen != nullptr && k >= 15 && k < until;
    back = k >= until && seen != nullptr && seen->id == "L4400" ? k : back;
  }
  EXPECT_GE(early, 4);
  EXPECT_LE(late, 8); // of 45 frames
  EXPECT_GE(back, until);
}

TEST(LampSearch, LampThatTheMapDoesNotHaveIsFollowedAllTheSame)
{
  for (const double pace : {0.0, 2.0}) { // px a frame
    const Scene scene;
    vpLampTracker tracker = scene.tracker();
    tracker.steadiness = 0.3; // s
    const Lamp unknown = {250, 240, 3000};
    EXPECT_GE(sightings(scene, tracker, 0, 45, pace, with(three, unknown), unknown), 44) << pace;
  }
}

// A strip comes round every five frames, 30 of them a second.
TEST(LampSearch, SteadyRegionIsPassedOverForAWhile)
{
  for (const double pace : {0.0, 1.0}) { // px a frame
    SCOPED_TRACE(pace);
    const Scene scene;
    const std::vector<Lamp> lamps = with(three, steady);
    auto seen = [&](double steadiness) {
      vpLampTracker tracker = scene.tracker();
      tracker.steadiness = steadiness;
      EXPECT_GE(sightings(scene, tracker, 0, 10, pace, lamps, steady), 1);
      return sightings(scene, tracker, 10, 58, pace, lamps, steady);
    };
    const int always = seen(0), now = seen(0.3), hardly = seen(2);
    EXPECT_GE(always, 8);
    EXPECT_GE(now, 2);
    EXPECT_LT(now, always);
    EXPECT_LE(hardly, 3);
  }
}

// So that no frame takes much longer than others.
TEST(LampSearch, SteadyRegionsAreLookedAtAgainOneAtATimeAndAllOfThem)
{
  const Scene scene;
  vpLampTracker tracker = scene.tracker();
  tracker.steadiness = 0.3; // s
  std::vector<Lamp> lamps = three;
  std::vector<Lamp> lights;
  for (const double u : {230.0, 300.0, 370.0}) {
    lights.push_back({u, 240, 0});
    lamps = with(lamps, lights.back());
  }
  std::vector<int> looks(lights.size(), 0);
  for (int k = 0; k < 60; ++k) {
    const std::vector<vpLampObservation> &all = tracker.track(scene.frame(k, lamps));
    int atOnce = 0;
    for (size_t i = 0; k >= 10 && i < lights.size(); ++i) {
      const bool seen = scene.seen(all, lights[i]) != nullptr;
      looks[i] += seen ? 1 : 0;
      atOnce += seen ? 1 : 0;
    }
    EXPECT_LE(atOnce, 1) << "frame " << k;
  }
  EXPECT_THAT(looks, testing::Each(testing::Ge(1)));
}

TEST(LampSearch, NewLampIsFoundBesideASteadyRegionAtOnceAndInPlaceOfOneOnceThatIsForgotten)
{
  const Lamp beside = {300, 120, 4400}, instead = {steady.u, steady.v, 4400};
  struct Case {
    Lamp late;
    std::vector<Lamp> after; // all that shines then
    int frames;              // within which it is found
  };
  for (const Case &each :
       {Case{beside, with(with(three, steady), beside), 7}, Case{instead, with(three, instead), 67}}) {
    const Scene scene;
    vpLampTracker tracker = scene.tracker();
    sightings(scene, tracker, 0, 10, 0, with(three, steady), steady);
    EXPECT_GE(sightings(scene, tracker, 10, 10 + each.frames, 0, each.after, each.late), 1);
    EXPECT_EQ(tracker.tracks(), 4u);
  }
}

TEST(LampSearch, LongSteadyRegionsAreSeldomLookedAtAndALampInTheirPlaceIsFoundInTime)
{
  const Scene scene;
  vpLampTracker tracker = scene.tracker();
  tracker.steadiness = 0.1;
  EXPECT_LE(sightings(scene, tracker, 10, 130, 0, with(three, steady), steady), 12); // in 4 s
  const Lamp late = {steady.u, steady.v, 4400};
  EXPECT_GE(sightings(scene, tracker, 130, 130 + 37, 0, with(three, late), late), 1);
}

TEST(LampSearch, LampThatIsExpectedBesideASteadyRegionIsFoundAtOnce)
{
  const Scene scene;
  vpLampTracker tracker = scene.tracker();
  sightings(scene, tracker, 0, 10, 0, with(three, steady), steady);
  const Lamp late = {steady.u, steady.v, 4400};
  const std::vector<vpLampObservation> all =
      tracker.track(scene.frame(10, with(three, late)), {vpRect(250, 190, 100, 100)});
  const vpLampObservation *found = scene.seen(all, late);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->id, idOf(4400));
}

// Farther than its own extent from frame to frame: no tracker of targets could know.
TEST(LampSearch, LampsThatJumpAreFoundWhereTheyAreExpected)
{
  const Scene scene;
  vpLampTracker tracker = scene.tracker();
  int k = 0;
  for (; k < firstFrames; ++k) {
    tracker.track(scene.frame(k, three));
  }
  for (const double jump : {45.0, 0.0, 45.0}) {
    const std::vector<Lamp> now = moved(three, jump, 0.5 * jump);
    std::vector<vpRect> expected;
    for (const Lamp &lamp : now) {
      const double half = 1.7 * scene.radius;
      expected.emplace_back(lamp.u - half, lamp.v - half, 2 * half, 2 * half);
    }
    const std::vector<vpLampObservation> all = tracker.track(scene.frame(k++, now), expected);
    for (const Lamp &lamp : now) {
      const vpLampObservation *found = scene.seen(all, lamp);
      ASSERT_NE(found, nullptr) << jump;
      EXPECT_EQ(found->id, idOf(lamp.frequency));
      EXPECT_LE(found->track, 3u);
    }
    EXPECT_EQ(tracker.tracks(), 3u);
  }
}

// Its first sight says nothing of a frequency; it is a lamp as soon as one does.
// Nothing is where it was: then the whole picture is looked at, in this frame.
TEST(LampSearch, LampsOfACameraThatWasCarriedAwayAreFoundAtOnce)
{
  const Scene scene;
  const std::vector<Lamp> left = {{40, 60, 2000}, {40, 200, 2600}},
                          right = {{340, 80, 3500}, {345, 260, 4400}};
  vpLampTracker tracker = scene.tracker();
  for (int k = 0; k < firstFrames; ++k) {
    tracker.track(scene.frame(k, left));
  }
  const std::vector<vpLampObservation> &all = tracker.track(scene.frame(firstFrames, right));
  for (const Lamp &lamp : right) {
    const vpLampObservation *found = scene.seen(all, lamp);
    ASSERT_TRUE(found != nullptr);
    EXPECT_EQ(found->id, idOf(lamp.frequency));
  }
  EXPECT_EQ(all.size(), right.size());
}

TEST(LampSearch, RegionThatTellsNothingIsNotFollowed)
{
  const Scene scene;
  vpLampTracker tracker = scene.tracker();
  const Lamp slow = {300, 240, 150}; // a stripe of 83 lines
  for (int k = 0; k < 8; ++k) {
    tracker.track(scene.frame(k, with(three, slow)));
    EXPECT_EQ(tracker.tracks(), 3u) << k;
  }
  const Lamp faster = {slow.u, slow.v, 4400};
  sightings(scene, tracker, 8, 80, 0, with(three, faster), faster);
  EXPECT_EQ(tracker.tracks(), 4u);
}
