/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <limits>

#include <visp3/core/vpDisplay.h>
#include <visp3/vlp_tracking/vpDot2Tracker.h>
#include <visp3/vlp_tracking/vpMeEllipseTracker.h>

#include "common/vpExpectError.h"
#include "trackedScenes.h"

using namespace trackedScenes;
using Method = vpTargetTracker::Method;

namespace
{
const std::vector<Method> methods = {Method::camshiftKalman, Method::dot2, Method::meEllipse};

//! Large and slow enough for moving edges, of one grey value for a dot.
vpTargetScene disc()
{
  vpTargetScene made = scene(1);
  made.size = 70;
  made.background.sigma = made.target.sigma = 5;
  made.path = [](int k) { return Eigen::Vector2d(100.3 + 2.2 * k, 120.4 + 0.7 * k); };
  return made;
}

void expectCode(const std::function<void()> &act, int code)
{
  try {
    act();
    ADD_FAILURE() << "nothing thrown";
  } catch (const vpException &error) {
    EXPECT_EQ(error.getCode(), code) << error.getStringMessage();
  }
}
} // namespace

TEST(TargetTracker, MakesEachMethod)
{
  EXPECT_NE(dynamic_cast<vpCamshiftKalmanTracker *>(vpTargetTracker::make(Method::camshiftKalman).get()),
            nullptr);
  EXPECT_NE(dynamic_cast<vpDot2Tracker *>(vpTargetTracker::make(Method::dot2).get()), nullptr);
  EXPECT_NE(dynamic_cast<vpMeEllipseTracker *>(vpTargetTracker::make(Method::meEllipse).get()), nullptr);
  vpExpectError([] { vpTargetTracker::make(static_cast<Method>(7)); }, {"method", "7"});
}

TEST(TargetTracker, EachMethodFollowsABrightDisc)
{
  for (const Method method : methods)
    for (const bool colour : {false, true}) {
      const std::unique_ptr<vpTargetTracker> tracker = vpTargetTracker::make(method);
      const Track track = run(*tracker, disc(), 60, colour);
      EXPECT_TRUE(track.alwaysSeen()) << "method " << static_cast<int>(method) << ", colour " << colour;
      EXPECT_LT(track.meanError(), 1.5) << "method " << static_cast<int>(method) << ", colour " << colour;
      EXPECT_NEAR(tracker->window().getWidth(), 70, 6) << "method " << static_cast<int>(method);
      for (const double similarity : track.similarity) {
        EXPECT_GT(similarity, 0.5) << "method " << static_cast<int>(method);
        EXPECT_LE(similarity, 1) << "method " << static_cast<int>(method);
      }
    }
}

TEST(TargetTracker, WithoutATargetNoneSeesAny)
{
  for (const Method method : methods) {
    const std::unique_ptr<vpTargetTracker> tracker = vpTargetTracker::make(method);
    run(*tracker, scene(1), 10);
    for (int k = 0; k < 10; ++k) {
      EXPECT_FALSE(tracker->track(vpImage<unsigned char>(300, 400, 60)))
          << "method " << static_cast<int>(method);
      EXPECT_TRUE(std::isfinite(tracker->center().get_u()));
    }
  }
}

TEST(TargetTracker, EachMethodFindsAgainWhatWasGoneForAMoment)
{
  vpTargetScene made = scene(1);
  made.path = [](int k) { return Eigen::Vector2d(150 + 0.3 * k, 140); };
  for (const Method method : methods) {
    const std::unique_ptr<vpTargetTracker> tracker = vpTargetTracker::make(method);
    run(*tracker, made, 10);
    for (int k = 0; k < 3; ++k)
      tracker->track(vpImage<unsigned char>(300, 400, 60));
    for (int k = 13; k < 18; ++k)
      tracker->track(made.grey(k));
    EXPECT_TRUE(tracker->track(made.grey(18))) << "method " << static_cast<int>(method);
    EXPECT_LT(errorOf(*tracker, made, 18), 3) << "method " << static_cast<int>(method);
  }
}

TEST(TargetTracker, WindowsThatNoneTakes)
{
  const vpTargetScene made = scene(1);
  const vpImage<unsigned char> I = made.grey(0);
  const vpImage<vpRGBa> C = made.colour(0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Method method : methods) {
    const std::unique_ptr<vpTargetTracker> tracker = vpTargetTracker::make(method);
    vpExpectError([&] { tracker->initTracking(I, vpRect(10, 20, 3, 40)); },
                  {"initTracking: window is 3 x 40 px at (10, 20)", "expected 4 x 4 px at least"});
    vpExpectError([&] { tracker->initTracking(C, vpRect(10, 20, 40, 0)); }, {"window is 40 x 0 px", "4 x 4"});
    for (const vpRect &outside : {vpRect(-1, 20, 40, 40), vpRect(10, -1, 40, 40), vpRect(361, 20, 40, 40),
                                  vpRect(10, 261, 40, 40), vpRect(1000, 1000, 10, 10)})
      vpExpectError([&] { tracker->initTracking(I, outside); },
                    {"initTracking: window is", "expected inside the picture of 400 x 300 px"});
    for (const vpRect &window : {vpRect(nan, 20, 40, 40), vpRect(10, 20, nan, 40)})
      expectCode([&] { tracker->initTracking(I, window); }, vpException::badValue);
    expectCode([&] { tracker->initTracking(vpImage<unsigned char>(), vpRect(0, 0, 4, 4)); },
               vpException::badValue);
    expectCode([&] { tracker->track(I); }, vpException::notInitialized); // after all that
  }
}

TEST(TargetTracker, PicturesThatNoneTakes)
{
  const vpTargetScene made = scene(1);
  for (const Method method : methods) {
    const std::unique_ptr<vpTargetTracker> tracker = vpTargetTracker::make(method);
    vpExpectError([&] { tracker->track(made.grey(0)); }, {"track", "initTracking()"});
    expectCode([&] { tracker->track(made.colour(0)); }, vpException::notInitialized);
    run(*tracker, made, 3);
    vpExpectError([&] { tracker->track(vpImage<unsigned char>(300, 401)); },
                  {"track: the picture is 401 x 300 px", "expected 400 x 300 px"});
    expectCode([&] { tracker->track(vpImage<vpRGBa>(299, 400)); }, vpException::dimensionError);
    tracker->track(made.grey(3)); // goes on as before
    EXPECT_LT(errorOf(*tracker, made, 3), 3);
  }
}

TEST(TargetTracker, CamshiftMindsColours)
{
  const vpTargetScene made = scene(1);
  vpCamshiftKalmanTracker tracker;
  vpExpectError([&] { tracker.velocity(); }, {"velocity", "initTracking()"});
  vpExpectError([&] { tracker.positionSigma(); }, {"positionSigma", "initTracking()"});
  run(tracker, made, 3);
  vpExpectError([&] { tracker.track(made.colour(3)); }, {"track: the picture has colours", "expected grey"});
  run(tracker, made, 3, true);
  vpExpectError([&] { tracker.track(made.grey(3)); }, {"track: the picture is grey", "expected colours"});
}

// Without a display that does nothing; before initTracking() too.
TEST(TargetTracker, DisplaysWithoutADisplay)
{
  const vpTargetScene made = scene(1);
  const vpImage<unsigned char> I = made.grey(0);
  vpCamshiftKalmanTracker tracker;
  tracker.display(I, vpColor::red);
  tracker.initTracking(I, made.firstWindow());
  tracker.display(I, vpColor::red, 2);
  tracker.display(made.colour(0), vpColor::red);
}

// Told where its target is, it need not look, and knows the target's motion all the same.
TEST(TargetTracker, GoesOnWhereItIsToldAndThenByItself)
{
  const vpTargetScene made = disc();
  vpCamshiftKalmanTracker tracker;
  expectCode([&] { tracker.goOn(vpRect(10, 10, 70, 70)); }, vpException::notInitialized);
  run(tracker, made, 1);
  auto window = [&](int k) {
    const Eigen::Vector2d middle = made.path(k);
    return vpRect(middle.x() - 0.5 * (made.size - 1), middle.y() - 0.5 * (made.size - 1), made.size,
                  made.size);
  };
  int k = 1;
  for (; k < 15; ++k) {
    ASSERT_TRUE(tracker.goOn(window(k)));
    EXPECT_LT(errorOf(tracker, made, k), 0.6);
  }
  EXPECT_NEAR(tracker.velocity().get_u(), 2.2, 0.3);
  EXPECT_NEAR(tracker.velocity().get_v(), 0.7, 0.3);
  for (; k < 25; ++k) {
    EXPECT_TRUE(tracker.track(made.grey(k)));
    EXPECT_LT(errorOf(tracker, made, k), 3);
  }
}

TEST(TargetTracker, MethodsThatHaveToLookSaySo)
{
  const vpTargetScene made = disc();
  for (const Method method : {Method::dot2, Method::meEllipse}) {
    const std::unique_ptr<vpTargetTracker> tracker = vpTargetTracker::make(method);
    run(*tracker, made, 1);
    const vpImagePoint before = tracker->center();
    EXPECT_FALSE(tracker->goOn(vpRect(10, 10, 70, 70)));
    EXPECT_EQ(tracker->center(), before);
  }
}
