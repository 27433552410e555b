/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Frame after frame: clocks that jump, robots that are carried away, lamps that are hidden or replaced.

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include "common/vpExpectError.h"
#include "hungLamps.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
using State = vpVlpFilter::State;
using hungLamps::Hung;
using hungLamps::Path;
using hungLamps::Place;

//! Four lamps, and a robot that drives slowly below them.
struct TrackedRoom {
  hungLamps::Camera camera = {480, 400, 400};
  std::vector<Hung> lamps = hungLamps::rectangle(0.5, 0.4);

  vpVlpLocalizer localizer() const { return vpVlpLocalizer(camera.rig(), hungLamps::mapOf(lamps)); }

  vpVlpFrame frame(double time, const Path &path) const
  {
    const auto seed = static_cast<unsigned int>(std::abs(time) * 1000) + 1;
    return camera.frame(lamps, time, path, std::fmod(37.7 * time, 1), seed);
  }
};

const double framePeriod = 1.0 / 20; // s

Place stand(double)
{
  return {0.05, -0.03, 0.3};
}

Place drive(double t)
{
  return {-0.1 + 0.1 * t, 0.04 * t, 0.2 + 0.15 * t};
}

double errorOf(const vpVlpFix &fix, const Place &place)
{
  return std::hypot(fix.wMb[0][3] - place.x, fix.wMb[1][3] - place.y);
}

//! A position within so many sigma of x, y and yaw.
testing::AssertionResult isAt(const vpVlpLocation &location, const Place &place, double sigmas)
{
  const vpVlpFix &fix = location.fix;
  if (!fix.valid) {
    return testing::AssertionFailure() << "no position: " << fix.refusal;
  }
  const double yaw = std::atan2(fix.wMb[1][0], fix.wMb[0][0]);
  const Eigen::Vector3d error(fix.wMb[0][3] - place.x, fix.wMb[1][3] - place.y,
                              std::remainder(yaw - place.yaw, 2 * M_PI)),
      sigma(std::sqrt(fix.covariance(0, 0)), std::sqrt(fix.covariance(1, 1)),
            std::sqrt(fix.covariance(5, 5)));
  if ((error.cwiseAbs().array() > sigmas * sigma.array()).any()) {
    return testing::AssertionFailure() << "off by " << error.transpose() << ", sigma " << sigma.transpose();
  }
  return testing::AssertionSuccess();
}

//! Drives \e frames frames from \e first on; the last one's location.
vpVlpLocation run(vpVlpLocalizer &localizer, const TrackedRoom &room, const Path &path, double first,
                  int frames)
{
  vpVlpLocation location;
  for (int k = 0; k < frames; ++k) {
    location = localizer.process(room.frame(first + k * framePeriod, path));
  }
  return location;
}
} // namespace

TEST(Tracking, CarriesThePoseWithinItsSigma)
{
  const TrackedRoom room;
  vpVlpLocalizer localizer = room.localizer();
  for (int k = 0; k < 40; ++k) {
    const double t = 5 + k * framePeriod;
    const auto path = [](double time) { return drive(time - 5); };
    const vpVlpLocation location = localizer.process(room.frame(t, path));
    EXPECT_TRUE(isAt(location, path(t), 4)) << k;
    EXPECT_EQ(location.timestamp, t);
    EXPECT_EQ(location.tracked, k > 0) << k;
    if (k > 3) {
      EXPECT_EQ(location.state, State::tracking) << k;
      EXPECT_LT(errorOf(location.fix, path(t)), 0.001) << k;
      EXPECT_EQ(location.fix.lamps.size(), 4u) << k;
    }
  }
}

// At 5 Hz a robot turns too far between two frames for a filter that knows nothing of its velocity yet.
TEST(Tracking, SecondFrameOfASlowCameraIsAsGoodAsTheNext)
{
  const TrackedRoom room;
  const auto arc = [](double t) {
    return Place{0.25 * std::sin(0.4 * t), 0.25 * (1 - std::cos(0.4 * t)), 0.4 * t};
  };
  vpVlpLocalizer localizer = room.localizer();
  for (int k = 0; k < 8; ++k) {
    const double t = 0.2 * k;
    const vpVlpLocation location = localizer.process(room.frame(t, arc));
    EXPECT_TRUE(isAt(location, arc(t), 5)) << k;
    if (k > 0) {
      EXPECT_LT(errorOf(location.fix, arc(t)), 0.0003) << k;
    }
  }
  EXPECT_FALSE(localizer.filter.claimsWidened());
}

// Readout of 0.1 s, fine pixels: that lamps show no constant velocity is no fault of the map.
TEST(Tracking, LongReadoutOfARobotThatAcceleratesDoesNotWidenTheClaims)
{
  TrackedRoom room;
  room.camera = {2880, 2400, 2400};
  const auto circle = [](double t) {
    return Place{0.1 * std::cos(M_PI * t), 0.1 * std::sin(M_PI * t), 0.02}; // 1 m/s^2
  };
  vpVlpLocalizer localizer = room.localizer();
  for (int k = 0; k < 6; ++k) {
    const double t = k / 8.0;
    const vpVlpLocation location = localizer.process(room.frame(t, circle));
    ASSERT_TRUE(location.fix.valid) << k << ": " << location.fix.refusal;
    EXPECT_FALSE(localizer.filter.claimsWidened()) << k;
    if (k > 0) {
      EXPECT_LT(errorOf(location.fix, circle(t)), 0.0003) << k;
    }
  }
}

// Faster than any motor: whatever it does, two frames later the pose is as good as before, and the claims of
// map and camera are not widened.
TEST(Tracking, RobotThatStopsAndTurnsAtOnceIsFollowed)
{
  const TrackedRoom room;
  const auto path = [](double t) {
    const double driven = std::min(t, 1.0), turned = std::max(0.0, t - 1);
    return Place{-0.1 + 0.2 * driven, 0.05, 0.2 + 2 * std::min(turned, 0.5)};
  };
  vpVlpLocalizer localizer = room.localizer();
  for (int k = 0; k < 40; ++k) {
    const double t = k * framePeriod;
    const vpVlpLocation location = localizer.process(room.frame(t, path));
    ASSERT_TRUE(location.fix.valid) << k << ": " << location.fix.refusal;
    EXPECT_LT(errorOf(location.fix, path(t)), 0.01) << k;
    const bool changing = k < 2 || (k >= 20 && k < 22) || (k >= 30 && k < 32);
    if (!changing) {
      EXPECT_TRUE(isAt(location, path(t), 5)) << k;
      EXPECT_LT(errorOf(location.fix, path(t)), 0.001) << k;
    }
  }
  EXPECT_FALSE(localizer.filter.claimsWidened());
}

TEST(Tracking, FrameThatIsNotLaterIsRefusedInOneLineAndTheNextGoesOn)
{
  const TrackedRoom room;
  vpVlpLocalizer localizer = room.localizer();
  run(localizer, room, stand, 10, 10);
  const double last = 10 + 9 * framePeriod;
  for (const double time : {last, last - 0.03, last - 0.9}) {
    const vpVlpLocation location = localizer.process(room.frame(time, stand));
    EXPECT_FALSE(location.fix.valid);
    EXPECT_EQ(location.fix.refusal, "the frame is not later than the one before it");
    EXPECT_FALSE(location.tracked);
    EXPECT_TRUE(location.observations.empty());
    EXPECT_EQ(location.timestamp, time);
  }
  const vpVlpLocation next = localizer.process(room.frame(last + framePeriod, stand));
  EXPECT_TRUE(next.tracked);
  EXPECT_TRUE(isAt(next, stand(0), 4));
  EXPECT_EQ(next.state, State::tracking);
}

TEST(Tracking, TimeThatIsNoneIsRefusedAndTheNextGoesOn)
{
  const TrackedRoom room;
  vpVlpLocalizer localizer = room.localizer();
  for (int round = 0; round < 2; ++round) {
    for (const double time : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      vpVlpFrame frame = room.frame(10, stand);
      frame.timestamp = time;
      const vpVlpLocation location = localizer.process(frame);
      EXPECT_FALSE(location.fix.valid);
      EXPECT_FALSE(location.fix.refusal.empty());
    }
    const vpVlpLocation next = run(localizer, room, stand, 10 + round, 4);
    EXPECT_TRUE(next.tracked);
    EXPECT_TRUE(isAt(next, stand(0), 4));
  }
}

TEST(Tracking, ClockThatIsSetBackStartsAnew)
{
  const TrackedRoom room;
  vpVlpLocalizer localizer = room.localizer();
  run(localizer, room, stand, 1000, 6);
  const auto elsewhere = [](double) { return Place{-0.1, 0.1, -2}; }; // nothing of before is left
  const vpVlpLocation first = localizer.process(room.frame(3, elsewhere));
  EXPECT_FALSE(first.tracked);
  EXPECT_TRUE(isAt(first, elsewhere(0), 4));
  const vpVlpLocation second = localizer.process(room.frame(3 + framePeriod, elsewhere));
  EXPECT_TRUE(second.tracked);
  EXPECT_TRUE(isAt(second, elsewhere(0), 4));
}

TEST(Tracking, OdometryOfAClockThatIsSetBackIsHeard)
{
  const TrackedRoom room;
  vpVlpLocalizer localizer = room.localizer();
  for (const double start : {1000.0, 3.0}) {
    for (int k = 0; k < 12; ++k) {
      const double t = start + k * framePeriod;
      localizer.filter.addOdometry({t + 0.03, 0, 0});
      localizer.process(room.frame(t, stand));
    }
    // It stands still, as the odometry says: at a speed of its own it would be much less certain.
    localizer.filter.addOdometry({start + 12 * framePeriod + 0.4, 0, 0});
    const vpVlpFix later = localizer.filter.fixAt(start + 12 * framePeriod + 0.4);
    EXPECT_LT(std::sqrt(later.covariance(0, 0)), 0.01) << start;
  }
}

TEST(Tracking, GapOfSeveralSecondsStartsAnew)
{
  const TrackedRoom room;
  for (const double gap : {5.0, 60.0, 1e6}) {
    vpVlpLocalizer localizer = room.localizer();
    run(localizer, room, stand, 10, 6);
    const auto elsewhere = [](double) { return Place{-0.1, 0.1, -2}; };
    const vpVlpLocation first = localizer.process(room.frame(10 + gap, elsewhere));
    EXPECT_FALSE(first.tracked) << gap;
    EXPECT_TRUE(isAt(first, elsewhere(0), 4)) << gap;
    EXPECT_TRUE(localizer.process(room.frame(10 + gap + framePeriod, elsewhere)).tracked) << gap;
  }
}

TEST(Tracking, PictureOfAnotherSizeIsRefusedAndTheNextGoesOn)
{
  const TrackedRoom room;
  vpVlpLocalizer localizer = room.localizer();
  for (int k = 0; k < 12; ++k) {
    const double t = k * framePeriod;
    if (k == 0 || k == 6) {
      vpVlpFrame other;
      other.I.resize(120, 160);
      other.timestamp = t;
      vpExpectError([&] { localizer.process(other); }, {"160 x 120", "480 x 400"});
      try {
        other.timestamp = t + 0.001;
        localizer.process(other);
      } catch (const vpException &error) {
        EXPECT_EQ(error.getCode(), vpException::dimensionError);
      }
      continue;
    }
    const vpVlpLocation location = localizer.process(room.frame(t, drive));
    EXPECT_TRUE(isAt(location, drive(t), 4)) << k;
    EXPECT_EQ(location.tracked, k > 1);
  }
}

// No frame in between is off by more than it says; refusals are honest.
TEST(Tracking, RobotThatIsCarriedAwayIsFoundAgainWithinTwoFrames)
{
  const TrackedRoom room;
  for (const Place &there : {Place{-0.25, 0.15, 0.3}, Place{0.05, -0.03, 2.5}, Place{0.15, 0.1, -1.4}}) {
    SCOPED_TRACE(there.x);
    vpVlpLocalizer localizer = room.localizer();
    run(localizer, room, stand, 10, 10);
    const double moved = 10 + 10 * framePeriod;
    for (int k = 0; k < 8; ++k) {
      const vpVlpLocation location =
          localizer.process(room.frame(moved + k * framePeriod, [&](double) { return there; }));
      if (k >= 1) {
        EXPECT_TRUE(isAt(location, there, 4)) << k;
      } else if (location.fix.valid) {
        EXPECT_TRUE(isAt(location, there, 3)) << k;
      } else {
        EXPECT_FALSE(location.fix.refusal.empty());
      }
      if (k > 3) {
        EXPECT_LT(errorOf(location.fix, there), 0.002) << k;
        EXPECT_EQ(location.state, State::tracking);
      }
    }
  }
}

TEST(Tracking, HiddenLampsAreCoastedOverAndFoundAgain)
{
  TrackedRoom room;
  vpVlpLocalizer localizer = room.localizer();
  double sigma = 0;
  for (int k = 0; k < 40; ++k) {
    const double t = k * framePeriod;
    const bool hidden = k >= 15 && k < 22;
    for (Hung &lamp : room.lamps) {
      lamp.lit = !hidden;
    }
    const vpVlpLocation location = localizer.process(room.frame(t, drive));
    EXPECT_TRUE(isAt(location, drive(t), 4)) << k;
    EXPECT_EQ(location.tracked, k > 0) << k;
    EXPECT_EQ(location.fix.lamps.empty(), hidden) << k;
    const double now = std::sqrt(location.fix.covariance(0, 0));
    if (k > 15 && hidden) {
      EXPECT_GT(now, sigma) << "less certain with each frame, " << k;
    }
    sigma = now;
    if (k > 24) {
      EXPECT_EQ(location.state, State::tracking) << k;
      EXPECT_LT(errorOf(location.fix, drive(t)), 0.001) << k;
    }
  }
}

//! A base on wheels: it goes where it heads.
Place arc(double t)
{
  const double v = 0.1, w = 0.15; // m/s, rad/s
  return {-0.1 + v / w * std::sin(w * t), v / w * (1 - std::cos(w * t)), w * t};
}

TEST(Tracking, OneLampAloneStillHoldsThePose)
{
  TrackedRoom room, blind;
  vpVlpLocalizer localizer = room.localizer(), other = room.localizer();
  vpVlpLocation one, none;
  for (int k = 0; k < 40; ++k) {
    for (size_t lamp = 0; lamp < 4; ++lamp) {
      room.lamps[lamp].lit = k < 15 || lamp == 2;
      blind.lamps[lamp].lit = k < 15;
    }
    const double t = k * framePeriod;
    one = localizer.process(room.frame(t, arc));
    EXPECT_TRUE(isAt(one, arc(t), 4)) << k;
    if (k < 22) {
      none = other.process(blind.frame(t, arc));
      EXPECT_TRUE(isAt(none, arc(t), 4)) << k;
    }
    if (k == 21) {
      EXPECT_LT(one.fix.covariance(0, 0) + one.fix.covariance(1, 1),
                0.5 * (none.fix.covariance(0, 0) + none.fix.covariance(1, 1)));
    }
  }
  EXPECT_EQ(one.fix.lamps, std::vector<std::string>(1, "C"));
}

TEST(Tracking, WithoutLampsItIsLostInTheEndAndSaysSo)
{
  TrackedRoom room;
  vpVlpLocalizer localizer = room.localizer();
  run(localizer, room, stand, 0, 10);
  for (Hung &lamp : room.lamps) {
    lamp.lit = false;
  }
  const vpVlpLocation lost = run(localizer, room, stand, 0.5, 40);
  EXPECT_FALSE(lost.fix.valid);
  EXPECT_FALSE(lost.tracked);
  EXPECT_EQ(lost.state, State::starting);
  EXPECT_NE(lost.fix.refusal.find("no lamp"), std::string::npos) << lost.fix.refusal;
  const vpVlpLocation found = run(localizer, TrackedRoom(), stand, 3, 2);
  EXPECT_TRUE(found.tracked);
  EXPECT_TRUE(isAt(found, stand(0), 4));
}

TEST(Tracking, LampThatIsReplacedLosesItsIdAtOnce)
{
  for (const double other : {4600.0, 3600.0}) { // unknown to the map; that of D, which is dark
    TrackedRoom room;
    vpVlpLocalizer localizer = room.localizer();
    for (int k = 0; k < 20; ++k) {
      if (k >= 10) {
        room.lamps[3].lit = false;
        room.lamps[1].frequency = other;
      }
      const double t = k * framePeriod;
      const vpVlpLocation location = localizer.process(room.frame(t, drive));
      EXPECT_TRUE(isAt(location, drive(t), 4)) << other << " Hz, " << k;
      for (const vpLampObservation &seen : location.observations) {
        if (k >= 10) {
          EXPECT_NE(seen.id, "B") << other << " Hz, " << k;
          EXPECT_FALSE(seen.id == "D" && seen.accepted) << "it does not hang there, " << k;
        }
      }
    }
  }
}
