/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "trackedScenes.h"

using namespace trackedScenes;

TEST(CamshiftKalmanMotion, FollowsATexturedTarget)
{
  for (unsigned int seed = 1; seed <= 5; ++seed)
    for (const double noise : {0., 5., 15.}) {
      vpTargetScene made = textured(seed);
      made.noise = noise;
      vpCamshiftKalmanTracker tracker;
      const Track track = run(tracker, made, 80);
      EXPECT_TRUE(track.alwaysSeen()) << "seed " << seed << ", noise " << noise;
      EXPECT_LT(track.meanError(), 2) << "seed " << seed << ", noise " << noise;
      EXPECT_LT(track.worstError(), 6) << "seed " << seed << ", noise " << noise;
    }
}

// Grey values tell nothing here: red and its surroundings have the same.
TEST(CamshiftKalmanMotion, FollowsAColourAmongItsOwnGrey)
{
  for (unsigned int seed = 1; seed <= 5; ++seed) {
    vpTargetScene made = scene(seed);
    made.background = {cv::Scalar(105, 118, 115), 20, 8};
    made.target = {cv::Scalar(190, 85, 75), 12, 6};
    vpCamshiftKalmanTracker tracker;
    const Track track = run(tracker, made, 80, true);
    EXPECT_TRUE(track.alwaysSeen()) << "seed " << seed;
    EXPECT_LT(track.meanError(), 1.5) << "seed " << seed;
  }
}

TEST(CamshiftKalmanMotion, WhiteIsATargetInColourPicturesToo)
{
  vpTargetScene made = scene(1);
  made.background = {cv::Scalar(70, 50, 40), 10, 8};
  made.target = {cv::Scalar::all(230), 5, 6};
  vpCamshiftKalmanTracker tracker;
  const Track track = run(tracker, made, 60, true);
  EXPECT_TRUE(track.alwaysSeen());
  EXPECT_LT(track.meanError(), 1.5);
}

// The camera and the lamp know nothing of each other: each frame has another phase.
TEST(CamshiftKalmanMotion, FollowsALampWhoseStripesChangeTheirPhase)
{
  for (unsigned int seed = 1; seed <= 6; ++seed)
    for (const double duty : {0.3, 0.5, 0.7}) {
      vpTargetScene made = stripedLamp(seed);
      made.stripeDuty = duty;
      vpCamshiftKalmanTracker tracker;
      const Track track = run(tracker, made, 80);
      EXPECT_TRUE(track.alwaysSeen()) << "period " << made.stripePeriod << ", duty " << duty;
      EXPECT_LT(track.meanError(), 3) << "period " << made.stripePeriod << ", duty " << duty;
    }
}

// A robot turns on the spot, faster and faster: its lamp goes up to 1.8 of its sizes a frame.
TEST(CamshiftKalmanMotion, FollowsAFastTurn)
{
  for (unsigned int seed = 1; seed <= 3; ++seed) {
    vpTargetScene made = stripedLamp(seed);
    made.width = 800;
    made.height = 600;
    made.path = [seed](int k) {
      const double angle = seed + (k < 25 ? 0.006 * k * k : 3.75 + 0.3 * (k - 25));
      return Eigen::Vector2d(400 + 240 * std::cos(angle), 300 + 240 * std::sin(angle));
    };
    vpCamshiftKalmanTracker tracker;
    const Track track = run(tracker, made, 60);
    EXPECT_TRUE(track.alwaysSeen()) << "seed " << seed;
    EXPECT_LT(track.meanError(), 5) << "seed " << seed;
  }
}

// From the first frame on, 120 px a frame: three sizes.
TEST(CamshiftKalmanMotion, FollowsAFastStart)
{
  for (unsigned int seed = 1; seed <= 3; ++seed) {
    vpTargetScene made = stripedLamp(seed);
    made.width = 1000;
    made.path = [](int k) { return Eigen::Vector2d(60 + 119 * k, 60 + 18 * k); };
    vpCamshiftKalmanTracker tracker;
    const Track track = run(tracker, made, 8);
    EXPECT_TRUE(track.alwaysSeen()) << "seed " << seed;
    EXPECT_LT(track.meanError(), 4) << "seed " << seed;
  }
}

TEST(CamshiftKalmanMotion, FollowsOnePixelAFrame)
{
  vpTargetScene made = scene(2);
  made.path = [](int k) { return Eigen::Vector2d(99.5 + k, 99.5); }; // the window given is exact
  vpCamshiftKalmanTracker tracker;
  const Track track = run(tracker, made, 60);
  EXPECT_LT(track.meanError(), 0.5);
  EXPECT_NEAR(tracker.velocity().get_u(), 1, 0.2);
  EXPECT_NEAR(tracker.velocity().get_v(), 0, 0.2);
}

// Of one window to any side, then as it was: the eight neighbours have it in the same frame.
TEST(CamshiftKalmanMotion, AJumpOfOneWindowIsFoundAtOnce)
{
  for (int side = 0; side < 9; ++side) {
    if (side == 4)
      continue;
    vpTargetScene made = scene(1);
    made.path = [side, &made](int k) {
      const Eigen::Vector2d before(200, 150);
      return k < 10 ? before
                    : Eigen::Vector2d(before + made.size * Eigen::Vector2d(side % 3 - 1, side / 3 - 1));
    };
    vpCamshiftKalmanTracker tracker;
    const Track track = run(tracker, made, 20);
    EXPECT_TRUE(track.alwaysSeen()) << "side " << side;
    EXPECT_LT(track.errors[9], 3) << "side " << side;
    EXPECT_LT(track.errors.back(), 2) << "side " << side;
  }
}

TEST(CamshiftKalmanMotion, AFartherJumpIsFoundByTheGrowingWindow)
{
  vpTargetScene made = scene(1);
  made.path = [](int k) { return k < 10 ? Eigen::Vector2d(50, 60) : Eigen::Vector2d(330, 230); };
  vpCamshiftKalmanTracker tracker;
  const Track track = run(tracker, made, 24);
  EXPECT_FALSE(track.seen[9]);
  EXPECT_TRUE(track.seen.back());
  EXPECT_LT(track.errors.back(), 3);
}

TEST(CamshiftKalmanMotion, ASimilarTargetPassingByDoesNotStealIt)
{
  for (unsigned int seed = 1; seed <= 4; ++seed)
    for (const double beside : {0., 15., 35., 50.}) {
      vpTargetScene made = scene(seed);
      const vpTargetScene::Path path = made.path;
      made.other = [path, beside](int k) {
        const Eigen::Vector2d met = path(40);
        return Eigen::Vector2d(met.x() - 3.4 * (k - 40), met.y() + beside);
      };
      vpCamshiftKalmanTracker tracker;
      const Track track = run(tracker, made, 80);
      EXPECT_LT(track.meanError(), 3) << "seed " << seed << ", " << beside << " px beside";
      EXPECT_LT(track.errors.back(), 3) << "seed " << seed << ", " << beside << " px beside";
    }
}

TEST(CamshiftKalmanMotion, TheWindowTakesOverTheTargetsSize)
{
  for (const double scale : {1.02, 1.01, 1.004, 1 / 1.004, 1 / 1.01, 1 / 1.02})
    for (vpTargetScene made : {scene(3), textured(3), stripedLamp(3)}) {
      made.size = scale > 1 ? 30 : 70;
      made.scalePerFrame = scale;
      made.path = [](int k) { return Eigen::Vector2d(120 + 2 * k, 150); };
      vpCamshiftKalmanTracker tracker;
      const Track track = run(tracker, made, 45);
      EXPECT_TRUE(track.alwaysSeen()) << "scale " << scale;
      EXPECT_NEAR(tracker.window().getWidth() / made.sizeAt(44), 1, 0.2) << "scale " << scale;
      EXPECT_NEAR(tracker.window().getHeight() / made.sizeAt(44), 1, 0.2) << "scale " << scale;
      EXPECT_LT(track.meanError(), 2) << "scale " << scale;
    }
}

TEST(CamshiftKalmanMotion, TheWindowKeepsItsSizeWhereTheTargetDoes)
{
  for (unsigned int seed = 1; seed <= 4; ++seed)
    for (const vpTargetScene &made : {scene(seed), textured(seed), stripedLamp(seed)}) {
      vpCamshiftKalmanTracker tracker;
      run(tracker, made, 90);
      EXPECT_NEAR(tracker.window().getWidth(), made.size, 0.15 * made.size) << "seed " << seed;
      EXPECT_NEAR(tracker.window().getHeight(), made.size, 0.15 * made.size) << "seed " << seed;
    }
}

TEST(CamshiftKalmanMotion, TheSameFramesGiveTheSameTrack)
{
  const vpTargetScene made = textured(4);
  vpCamshiftKalmanTracker first, second;
  const Track one = run(first, made, 30), again = run(first, made, 30), other = run(second, made, 30);
  EXPECT_EQ(one.errors, again.errors);
  EXPECT_EQ(one.errors, other.errors);
  EXPECT_EQ(one.similarity, other.similarity);
}
