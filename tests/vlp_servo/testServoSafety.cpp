/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What stands between the follower and the base: when it may move, and how fast at most.

#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <visp3/vlp_servo/vpServoSafety.h>

#include "common/vpExpectError.h"
#include "vpPerfectBase.h"

namespace
{
const vpBaseLimits limits = vpTurtleBot3().limits();

vpVlpFix fixAt(double x, double y, double yaw, double sigma = 1e-3)
{
  vpVlpFix fix;
  fix.valid = true;
  fix.wMb = vpStanding(x, y, yaw);
  fix.covariance.diagonal() << sigma * sigma, sigma * sigma, 0, 0, 0, 1e-6;
  return fix;
}

vpVlpLocation tracked(double sigma = 1e-3)
{
  vpVlpLocation location;
  location.fix = fixAt(0, 0, 0, sigma);
  location.tracked = true;
  return location;
}

//! A picture of that very time.
void see(vpServoSafety &safety, double time, vpVlpLocation location)
{
  location.timestamp = time;
  safety.addPicture(time, location);
}

//! One that has seen enough to drive at time 0.
vpServoSafety driving(const vpServoSafetySettings &settings = {})
{
  vpServoSafety safety(settings, limits, true);
  for (int i = 0; i < settings.confirmations; ++i) {
    see(safety, 0, tracked());
  }
  EXPECT_EQ(safety.permit(0, fixAt(0, 0, 0)).share, 1);
  return safety;
}
} // namespace

TEST(ServoSafety, NothingMovesBeforeTheFirstConfirmedFix)
{
  vpServoSafety safety({}, limits, true);
  EXPECT_EQ(safety.permit(0, vpVlpFix()).share, 0);
  EXPECT_EQ(safety.permit(0, fixAt(0, 0, 0)).share, 0); // a pose, and no picture
  for (int i = 0; i < 2; ++i) {
    see(safety, 0.1, tracked());
    EXPECT_EQ(safety.permit(0.1, fixAt(0, 0, 0)).share, 0);
  }
  see(safety, 0.2, vpVlpLocation()); // not in a row
  for (int i = 0; i < 2; ++i) {
    see(safety, 0.3, tracked());
    EXPECT_EQ(safety.permit(0.3, fixAt(0, 0, 0)).share, 0);
  }
  vpVlpLocation single = tracked();
  single.tracked = false; // of one picture alone
  see(safety, 0.3, single);
  EXPECT_EQ(safety.permit(0.3, fixAt(0, 0, 0)).share, 0);
  for (int i = 0; i < 3; ++i) {
    see(safety, 0.4, tracked());
  }
  EXPECT_EQ(safety.permit(0.4, fixAt(0, 0, 0)).share, 1);
}

TEST(ServoSafety, StandsWhereLampsShowAnotherPlaceThanTheMotion)
{
  for (const bool ambiguous : {false, true}) {
    vpServoSafety safety = driving();
    vpVlpLocation elsewhere = tracked();
    elsewhere.relocated = !ambiguous;
    elsewhere.fix.ambiguous = ambiguous;
    see(safety, 0.1, elsewhere);
    const vpServoPermit permit = safety.permit(0.1, fixAt(0, 0, 0));
    EXPECT_EQ(permit.share, 0);
    EXPECT_NE(permit.reason.find(ambiguous ? "either of two places" : "another place"), std::string::npos)
        << permit.reason;
    const int confirmations = vpServoSafetySettings().confirmations;
    for (int i = 0; i < confirmations; ++i) {
      EXPECT_EQ(safety.permit(0.2, fixAt(0, 0, 0)).share, 0) << i;
      see(safety, 0.2, tracked());
    }
    EXPECT_EQ(safety.permit(0.2, fixAt(0, 0, 0)).share, 1);
  }
}

TEST(ServoSafety, SlowsAndStandsAsThePoseGetsUncertain)
{
  const vpServoSafetySettings settings;
  vpServoSafety safety = driving();
  double last = 1;
  for (double sigma = 0; sigma < settings.sigmaStop; sigma += 1e-3) {
    const vpServoPermit permit = safety.permit(0, fixAt(0, 0, 0, sigma));
    EXPECT_EQ(permit.share == 1, sigma <= settings.sigmaSlow) << sigma;
    EXPECT_LE(permit.share, last);
    EXPECT_GT(permit.share, 0);
    last = permit.share;
  }
  const vpServoPermit permit = safety.permit(0, fixAt(0, 0, 0, settings.sigmaStop + 1e-3));
  EXPECT_EQ(permit.share, 0);
  EXPECT_FALSE(permit.final);
  EXPECT_NE(permit.reason.find("51 mm"), std::string::npos) << permit.reason;
}

TEST(ServoSafety, RecoversOnlyOnceThePoseIsConfirmedAnew)
{
  vpServoSafety safety = driving();
  EXPECT_EQ(safety.permit(0.1, fixAt(0, 0, 0, 1)).share, 0);
  EXPECT_EQ(safety.permit(0.1, fixAt(0, 0, 0)).share, 0);
  for (int i = 0; i < 5; ++i) {
    see(safety, 0.2, tracked(0.03)); // below the limit, and not below the lower one
  }
  EXPECT_EQ(safety.permit(0.2, fixAt(0, 0, 0)).share, 0);
  for (int i = 0; i < 3; ++i) {
    see(safety, 0.3, tracked());
  }
  EXPECT_EQ(safety.permit(0.3, fixAt(0, 0, 0)).share, 1);
}

TEST(ServoSafety, CoastsThroughPicturesWithoutLamps)
{
  vpServoSafety safety = driving();
  for (double now = 0.1; now < 2; now += 0.1) {
    see(safety, now, vpVlpLocation());
    EXPECT_EQ(safety.permit(now, fixAt(0, 0, 0)).share, 1); // its covariance still allows
  }
}

TEST(ServoSafety, StandsWhereNoPictureComesAndGivesUp)
{
  const vpServoSafetySettings settings;
  vpServoSafety safety = driving();
  EXPECT_EQ(safety.permit(settings.pictureTimeout - 0.01, fixAt(0, 0, 0)).share, 1);
  const double late = settings.pictureTimeout + 0.01;
  EXPECT_EQ(safety.permit(late, fixAt(0, 0, 0)).share, 0);
  EXPECT_FALSE(safety.permit(late + settings.giveUp - 0.1, fixAt(0, 0, 0)).final);
  const vpServoPermit permit = safety.permit(late + settings.giveUp + 0.1, fixAt(0, 0, 0));
  EXPECT_TRUE(permit.final);
  EXPECT_NE(permit.reason.find("no picture"), std::string::npos);
}

TEST(ServoSafety, APictureOfAnotherTimeCountsForNone)
{
  const vpServoSafetySettings settings;
  for (const double age : {-0.01, settings.pictureTimeout + 0.01, -10.0, 10.0}) {
    vpServoSafety safety = driving();
    vpVlpLocation picture = tracked();
    picture.timestamp = 0.1 - age;
    safety.addPicture(0.1, picture);
    const vpServoPermit permit = safety.permit(0.1, fixAt(0, 0, 0));
    EXPECT_EQ(permit.share, 0) << age;
    EXPECT_NE(permit.reason.find(age < 0 ? "ahead of the clock" : "s old"), std::string::npos)
        << permit.reason;
    for (int i = 0; i < settings.confirmations; ++i) {
      EXPECT_EQ(safety.permit(0.2, fixAt(0, 0, 0)).share, 0) << i;
      see(safety, 0.2, tracked());
    }
    EXPECT_EQ(safety.permit(0.2, fixAt(0, 0, 0)).share, 1);
  }
}

// Whatever its covariance says. Half of it is left to wheels that slip.
TEST(ServoSafety, APoseThatMovesOtherwiseThanTheWheelsEndsTheRun)
{
  const vpServoSafetySettings settings;
  const std::pair<vpVlpFix, bool> cases[] = {{fixAt(0, settings.sigmaStop / 2, 0), false},
                                             {fixAt(0, settings.sigmaStop + 1e-3, 0), true},
                                             {fixAt(0, 0, settings.yawStop / 2), false},
                                             {fixAt(0, 0, settings.yawStop + 1e-3), true},
                                             {fixAt(0, settings.sigmaStop + 1e-3, 0, 0.015), false}};
  for (const auto &[fix, ends] : cases) {
    vpServoSafety safety(settings, limits, true);
    safety.addOdometry({0, 0, 0});
    for (int i = 0; i < settings.confirmations; ++i) {
      see(safety, 0, tracked());
    }
    EXPECT_EQ(safety.permit(0, fixAt(0, 0, 0)).share, 1);
    const vpServoPermit permit = safety.permit(0.02, fix);
    EXPECT_EQ(permit.final, ends) << permit.reason;
    EXPECT_EQ(permit.reason.find("otherwise than the wheels") != std::string::npos, ends) << permit.reason;
  }
}

// The other way round: the wheels turn, and the pose stays where it is.
TEST(ServoSafety, WheelsThatTurnOnTheSpotEndTheRun)
{
  vpServoSafety safety = driving();
  double time = 0;
  for (; time < 5 && !safety.permit(time, fixAt(0, 0, 0)).final; time += 0.02) {
    safety.addOdometry({time, 0.2, 0});
    see(safety, time, tracked());
  }
  EXPECT_NEAR(time, vpServoSafetySettings().sigmaStop / 0.2, 0.05);
}

TEST(ServoSafety, AClockThatIsSetBackEndsTheRun)
{
  vpServoSafety safety = driving();
  EXPECT_EQ(safety.permit(0.02, fixAt(0, 0, 0)).share, 1);
  const vpServoPermit permit = safety.permit(-10, fixAt(0, 0, 0));
  EXPECT_TRUE(permit.final);
  EXPECT_NE(permit.reason.find("set back by 10.02 s"), std::string::npos) << permit.reason;
}

TEST(ServoSafety, ACovarianceThatIsNoneIsAStand)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Index axis : {0, 5}) {
    for (const double variance : {nan, -1.0, std::numeric_limits<double>::infinity()}) {
      vpServoSafety safety = driving();
      vpVlpFix fix = fixAt(0, 0, 0);
      fix.covariance.diagonal().head<2>().setConstant(axis == 0 ? variance : 1e-6);
      fix.covariance(5, 5) = axis == 5 ? variance : 1e-6;
      EXPECT_EQ(safety.permit(0.02, fix).share, 0) << axis << " " << variance;
    }
  }
}

TEST(ServoSafety, LowBatteryAndFailuresAreForGood)
{
  vpServoSafety safety = driving();
  safety.setBattery(11.2);
  EXPECT_EQ(safety.permit(0, fixAt(0, 0, 0)).share, 1);
  safety.setBattery(10.9);
  EXPECT_TRUE(safety.permit(0, fixAt(0, 0, 0)).final);
  safety.setBattery(12);
  const vpServoPermit permit = safety.permit(0, fixAt(0, 0, 0));
  EXPECT_TRUE(permit.final);
  EXPECT_EQ(permit.share, 0);
  EXPECT_NE(permit.reason.find("10.9 V"), std::string::npos) << permit.reason;
}

TEST(ServoSafety, NoLimitIsPassedWhateverIsWanted)
{
  const vpServoSafetySettings settings;
  std::mt19937_64 generator(3);
  std::normal_distribution<double> wild(0, 2);
  vpServoSafety safety(settings, limits, false);
  EXPECT_EQ(safety.permit(0, fixAt(0, 0, 0)).share, 1);
  const double dt = 0.02;
  vpBaseVelocity before;
  for (int i = 0; i < 20000; ++i) {
    const vpBaseVelocity wanted{wild(generator), 10 * wild(generator)};
    const vpBaseVelocity now = safety.limited(wanted, dt);
    EXPECT_LE(limits.share(now), 1 + 1e-9);
    const double change = now.v - before.v;
    const bool faster = std::abs(now.v) > std::abs(before.v);
    // Where both wheels are at their limit, a turn that is wanted takes from the speed.
    const bool saturated = limits.share(now) > 1 - 1e-9;
    EXPECT_TRUE(saturated ||
                std::abs(change) <= (faster ? settings.acceleration : settings.braking) * dt + 1e-9)
        << change;
    EXPECT_TRUE(saturated || std::abs(now.w - before.w) <= settings.turnAcceleration * dt + 1e-9);
    before = now;
  }
}

TEST(ServoSafety, WithoutAPermitItStandsAtOnce)
{
  vpServoSafety safety = driving();
  for (int i = 0; i < 50; ++i) {
    safety.limited({0.2, 0.5}, 0.02);
  }
  EXPECT_GT(safety.limited({0.2, 0.5}, 0.02).v, 0.15);
  const vpVlpFix none;
  EXPECT_EQ(safety.permit(0.02, none).share, 0);
  for (const vpBaseVelocity wanted : {vpBaseVelocity{0.2, 0.5}, vpBaseVelocity()}) {
    const vpBaseVelocity told = safety.limited(wanted, 0.02);
    EXPECT_EQ(told.v, 0);
    EXPECT_EQ(told.w, 0);
  }
}

TEST(ServoSafety, NoNumberIsAStand)
{
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity}) {
    vpServoSafety safety = driving();
    EXPECT_GT(safety.limited({0.1, 0}, 0.02).v, 0);
    EXPECT_EQ(safety.limited({bad, 0}, 0.02).v, 0);
    EXPECT_TRUE(safety.permit(0, fixAt(0, 0, 0)).final);
  }
}

TEST(ServoSafety, FenceHoldsWhateverIsWanted)
{
  vpServoSafetySettings settings;
  settings.fence = Eigen::AlignedBox2d(Eigen::Vector2d(-0.5, -0.4), Eigen::Vector2d(0.5, 0.4));
  std::mt19937_64 generator(5);
  std::normal_distribution<double> wild(0, 1);
  size_t held = 0;
  for (int run = 0; run < 200; ++run) {
    vpServoSafety safety(settings, limits, false);
    vpPerfectBase base;
    base.wMb = vpStanding(0, 0, 10 * wild(generator));
    vpBaseVelocity wanted{0.2, 0};
    for (int i = 0; i < 1000; ++i) {
      if (i % 25 == 0) {
        wanted = {wild(generator) < -1 ? -0.2 : 0.2, 0.5 * wild(generator)};
      }
      const vpServoPermit permit = safety.permit(base.now(), base.at(0));
      const vpBaseVelocity told = safety.limited(permit.share > 0 ? wanted : vpBaseVelocity(), base.period());
      base.setVelocity(told.v, told.w);
      base.next();
      ASSERT_TRUE(settings.fence->contains(Eigen::Vector2d(base.x(), base.y()))) << run;
      held += permit.final && i == 999;
    }
  }
  EXPECT_GT(held, 100u); // else the test tests nothing
}

TEST(ServoSafety, OutsideTheFenceItNeverMoves)
{
  vpServoSafetySettings settings;
  settings.fence = Eigen::AlignedBox2d(Eigen::Vector2d(-0.5, -0.4), Eigen::Vector2d(0.5, 0.4));
  vpServoSafety safety(settings, limits, false);
  EXPECT_TRUE(safety.permit(0, fixAt(0.6, 0, 0)).final);
}

TEST(ServoSafety, BadSettingsAreNamed)
{
  vpServoSafetySettings settings;
  settings.braking = 0;
  vpExpectError([&settings] { vpServoSafety safety(settings, limits, true); }, {"braking: 0"});
  settings = {};
  settings.sigmaStop = settings.sigmaSlow;
  vpExpectError([&settings] { vpServoSafety safety(settings, limits, true); }, {"sigma stop"});
  settings = {};
  settings.fence = Eigen::AlignedBox2d(Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1));
  vpExpectError([&settings] { vpServoSafety safety(settings, limits, true); }, {"fence"});
}
