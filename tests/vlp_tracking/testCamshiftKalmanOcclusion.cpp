/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "trackedScenes.h"

using namespace trackedScenes;

namespace
{
//! Hides the target wholly in the frames from \e first to \e last, wherever it is.
vpTargetScene hidden(vpTargetScene made, int first, int last, double share = 1)
{
  const vpTargetScene::Path path = made.path;
  const double size = made.size;
  made.obstacles = [=](int k) {
    std::vector<cv::Rect> rects;
    if (k >= first && k <= last) {
      const Eigen::Vector2d middle = path(k);
      rects.emplace_back(cvRound(middle.x() - size / 2 - 3), cvRound(middle.y() - size / 2 - 3),
                         cvRound(share * (size + 6)), cvRound(size + 6));
    }
    return rects;
  };
  return made;
}
} // namespace

TEST(CamshiftKalmanOcclusion, TenFramesHiddenAndFoundAgain)
{
  for (unsigned int seed = 1; seed <= 4; ++seed)
    for (const vpTargetScene &made : {scene(seed), textured(seed), stripedLamp(seed)}) {
      vpCamshiftKalmanTracker tracker;
      const Track track = run(tracker, hidden(made, 30, 39), 60);
      for (int k = 30; k <= 39; ++k) {
        EXPECT_FALSE(track.seen[k - 1]) << "seed " << seed << ", frame " << k;
        EXPECT_LT(track.errors[k - 1], 10) << "seed " << seed << ", frame " << k;
      }
      EXPECT_TRUE(track.seen[42]) << "seed " << seed;
      EXPECT_LT(track.errors[42], 4) << "seed " << seed;
    }
}

// Behind a wall that it goes in and out of slowly: what is left of it at the edge is off its middle.
TEST(CamshiftKalmanOcclusion, BehindAWall)
{
  for (unsigned int seed = 1; seed <= 4; ++seed) {
    vpTargetScene made = scene(seed);
    made.obstacles = [](int) { return std::vector<cv::Rect>{{150, 0, 100, 300}}; };
    vpCamshiftKalmanTracker tracker;
    const Track track = run(tracker, made, 100);
    EXPECT_FALSE(track.seen[44]) << "seed " << seed;
    EXPECT_LT(track.worstError(), 20) << "seed " << seed;
    EXPECT_LT(track.errors.back(), 2) << "seed " << seed;
  }
}

TEST(CamshiftKalmanOcclusion, SimilarityFallsWithWhatIsHidden)
{
  for (unsigned int seed = 1; seed <= 3; ++seed) {
    double before = 2;
    for (const double share : {0.0, 0.35, 0.65, 1.0}) {
      vpCamshiftKalmanTracker tracker;
      const Track track = run(tracker, hidden(scene(seed), 20, 21, share), 22);
      EXPECT_LT(track.similarity[19], before) << "seed " << seed << ", hidden " << share;
      before = track.similarity[19];
    }
    EXPECT_LT(before, 0.3) << "seed " << seed;
  }
}

TEST(CamshiftKalmanOcclusion, SigmaGrowsWithEachFrameNotSeen)
{
  const vpTargetScene made = hidden(scene(1), 20, 35);
  vpCamshiftKalmanTracker tracker;
  tracker.initTracking(made.grey(0), made.firstWindow());
  double before = 0;
  for (int k = 1; k <= 35; ++k) {
    tracker.track(made.grey(k));
    if (k >= 20) {
      EXPECT_GT(tracker.positionSigma(), before) << "frame " << k;
    }
    before = tracker.positionSigma();
  }
  EXPECT_LT(tracker.positionSigma(), 100);
  for (int k = 36; k <= 40; ++k)
    tracker.track(made.grey(k));
  EXPECT_LT(tracker.positionSigma(), 3);
}

TEST(CamshiftKalmanOcclusion, CoastsAtTheVelocityItHad)
{
  const vpTargetScene made = hidden(scene(2), 30, 40);
  vpCamshiftKalmanTracker tracker;
  tracker.initTracking(made.grey(0), made.firstWindow());
  for (int k = 1; k <= 30; ++k)
    tracker.track(made.grey(k));
  const vpImagePoint velocity = tracker.velocity();
  EXPECT_NEAR(velocity.get_u(), 3.2, 0.3);
  for (int k = 31; k <= 40; ++k) {
    const vpImagePoint before = tracker.center();
    tracker.track(made.grey(k));
    EXPECT_NEAR(tracker.center().get_u() - before.get_u(), velocity.get_u(), 1e-9);
    EXPECT_NEAR(tracker.center().get_v() - before.get_v(), velocity.get_v(), 1e-9);
  }
}

// However long something else is there: what comes back is known at first sight, and as well as before.
TEST(CamshiftKalmanOcclusion, WhatHidesItDoesNotBecomeTheModel)
{
  for (const double share : {0.6, 1.0}) {
    vpTargetScene made = textured(1);
    made.path = [](int) { return Eigen::Vector2d(200, 150); };
    vpCamshiftKalmanTracker tracker;
    const Track track = run(tracker, hidden(made, 20, 119, share), 130);
    EXPECT_GT(track.similarity[119], track.similarity[18] - 0.05) << "hidden " << share;
    EXPECT_LT(track.errors.back(), 2) << "hidden " << share;
    EXPECT_NEAR(tracker.window().getWidth(), made.size, 0.15 * made.size) << "hidden " << share;
  }
}

// A lamp dimmed slowly by a quarter is the same lamp all the time.
TEST(CamshiftKalmanOcclusion, TheModelFollowsASlowChange)
{
  const vpTargetScene made = stripedLamp(2);
  vpCamshiftKalmanTracker refreshing, rigid;
  rigid.refreshRate = 0;
  double similar[2] = {0, 0};
  for (int k = 0; k < 100; ++k) {
    vpImage<unsigned char> I = made.grey(k);
    for (unsigned int i = 0; i < I.getSize(); ++i)
      I.bitmap[i] = static_cast<unsigned char>(I.bitmap[i] * (1 - k / 400.));
    int which = 0;
    for (vpCamshiftKalmanTracker *tracker : {&refreshing, &rigid}) {
      if (k == 0)
        tracker->initTracking(I, made.firstWindow());
      else
        tracker->track(I);
      similar[which++] = tracker->similarity();
    }
  }
  EXPECT_LT(errorOf(refreshing, made, 99), 3);
  EXPECT_GT(similar[0], 0.8);
  EXPECT_GT(similar[0], similar[1]);
}
