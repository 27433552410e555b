/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Whether the filter's covariance is what its errors are: drives drawn as its settings and claims say.

#include <gtest/gtest.h>

#include "common/vpExpectError.h"
#include "lampDrive.h"

using namespace lampDrive;

namespace
{
/*!
  A base whose velocity along x and y of b and whose turn rate walk at random: accelerations as a density,
  1/sqrt(Hz). Simulated in steps far shorter than a frame.
*/
class RandomWalk
{
public:
  RandomWalk(Random &random, const vpVlpFilter &filter, double share, double duration)
  {
    Eigen::Vector3d velocity(random.normal(filter.startVelocity), random.normal(filter.startVelocity),
                             random.normal(filter.startTurnRate));
    Eigen::Vector3d pose(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-M_PI, M_PI));
    for (double t = 0; t < duration; t += step) {
      m_poses.push_back(pose);
      pose.head<2>() +=
          step * (Eigen::Rotation2Dd(pose.z() + 0.5 * step * velocity.z()) * velocity.head<2>());
      pose.z() += step * velocity.z();
      const double a = share * filter.acceleration * std::sqrt(step);
      velocity += Eigen::Vector3d(random.normal(a), random.normal(a),
                                  random.normal(share * filter.turnAcceleration * std::sqrt(step)));
    }
  }

  vpHomogeneousMatrix at(double t) const
  {
    const auto k = std::min(m_poses.size() - 2, static_cast<size_t>(t / step));
    const double share = t / step - static_cast<double>(k);
    const Eigen::Vector3d pose = (1 - share) * m_poses[k] + share * m_poses[k + 1];
    return lampScene::frame(pose.x(), pose.y(), 0, 0, 0, pose.z());
  }

private:
  static constexpr double step = 5e-4; // s
  std::vector<Eigen::Vector3d> m_poses;
};

//! Starts slowly enough for what is of second order in the first frame's motion not to count.
void settings(vpVlpFilter &filter)
{
  filter.startTurnRate = 0.3;
  filter.drift = 0; // the floor of these drives is flat
}

struct Result {
  lampScene::ChiSquareMean marked, now;
  int rows = 0;
};

//! Last fixes of drives of ten frames each. \e share: of the random accelerations.
Result drives(int count, double share, const Sigmas &sigmas)
{
  Result result;
  for (int seed = 1; seed <= count; ++seed) {
    vpVlpFilter pattern{vpVlpRig()};
    settings(pattern);
    Random random(static_cast<unsigned int>(1000 + seed));
    const RandomWalk walk(random, pattern, share, 0.5);
    Drive drive(
        static_cast<unsigned int>(seed), [&](double t) { return walk.at(t); }, sigmas);
    vpVlpFilter filter(drive.rig());
    settings(filter);
    drive.start(filter);
    filter.manoeuvreShare = share > 0 ? 1 : 0;
    double t = 0;
    for (int k = 0; k < 10; ++k) {
      t = k * frameTime;
      drive.frame(filter, t);
    }
    result.marked.add(lampScene::nees(filter.marked(), drive.truth(t), &result.rows));
    result.now.add(lampScene::nees(filter.now(), drive.truth(filter.time())));
  }
  return result;
}

//! The means lie where 99 of 100 do.
void expectConsistent(const Result &result, int rows)
{
  EXPECT_EQ(result.rows, rows);
  for (const auto *mean : {&result.marked, &result.now}) {
    EXPECT_NEAR(mean->mean(), rows, 2.576 / 1.96 * mean->halfWidth(rows));
  }
  testing::Test::RecordProperty("marked", std::to_string(result.marked.mean()));
  testing::Test::RecordProperty("now", std::to_string(result.now.mean()));
}

const Sigmas claimed = [] {
  Sigmas sigmas;
  sigmas.positionSigma = 0.005;
  sigmas.translationSigma.setConstant(0.002);
  sigmas.rotationSigma = {0.004, 0.004, 0.003};
  sigmas.principalPointSigma = 0.002;
  sigmas.focalLengthSigma = 0.003;
  return sigmas;
}();
} // namespace

TEST(VlpFilterConsistency, ConstantMotion)
{
  expectConsistent(drives(300, 0, Sigmas()), 4);
}

TEST(VlpFilterConsistency, RandomAccelerations)
{
  expectConsistent(drives(300, 1, Sigmas()), 4);
}

TEST(VlpFilterConsistency, ConstantMotionUnderClaimsThatHold)
{
  expectConsistent(drives(200, 0, claimed), 6);
}

TEST(VlpFilterConsistency, RandomAccelerationsUnderClaimsThatHold)
{
  expectConsistent(drives(200, 1, claimed), 6);
}

// A filter that linearises about each pose anew would learn the heading from its own corrections.
TEST(VlpFilterConsistency, OneLampAloneForLongTellsNothingThatItDoesNotShow)
{
  for (const bool steady : {false, true}) {
    lampScene::ChiSquareMean mean;
    for (unsigned int seed = 1; seed <= 40; ++seed) {
      const Arc arc{-0.1, 0.05, 0.2, 0.1, 0, 0.15};
      Sigmas sharp;
      sharp.raySigma = 1e-4;
      const auto path = [&arc](double t) { return arc.at(t); };
      Drive drive(seed, path, sharp);
      vpVlpFilter filter(drive.rig());
      drive.start(filter);
      int k = 0;
      for (; k < 15; ++k) {
        drive.frame(filter, k * frameTime);
      }
      filter.manoeuvreShare = 1;
      double before = 0;
      for (; k < 60; ++k) {
        const double t = k * frameTime;
        filter.mark(t);
        filter.update(drive.sight(0, t));
        const double heading = std::sqrt(filter.now().covariance(5, 5));
        if (steady) {
          filter.manoeuvreShare = 0.03;
        } else { // nothing says that it goes on as before
          EXPECT_GT(heading, 0.97 * before) << k << ", seed " << seed;
        }
        before = heading;
      }
      vpVlpFix fix = filter.now();
      fix.covariance.row(2).setZero();
      fix.covariance.col(2).setZero();
      mean.add(lampScene::nees(fix, arc.at(filter.time())));
    }
    // One-sided: the drive is calmer than the accelerations reckoned with. 99 of 100 means lie below.
    EXPECT_LT(mean.mean(), 3 + 2.326 / 1.96 * mean.halfWidth(3)) << steady;
    testing::Test::RecordProperty(steady ? "steady" : "manoeuvring", std::to_string(mean.mean()));
  }
}

// Errors of map and mount are the same in every frame. Counted as new ones in each, they would average out.
TEST(VlpFilterConsistency, StandingStillDoesNotAverageClaimsAway)
{
  Drive drive(
      1, [](double) { return vpHomogeneousMatrix(); }, claimed);
  vpVlpFilter filter(drive.rig());
  drive.start(filter);
  filter.manoeuvreShare = 0;
  double after10 = 0;
  for (int k = 0; k < 200; ++k) {
    drive.frame(filter, k * frameTime);
    if (k == 10) {
      after10 = std::sqrt(filter.marked().covariance(0, 0));
    }
  }
  const double after200 = std::sqrt(filter.marked().covariance(0, 0));
  EXPECT_GT(after200, 0.9 * after10);
  EXPECT_GT(after200, 0.0025); // of four lamps, 5 mm each, and the tilt
}

namespace
{
//! A base whose odometry is off by a constant scale and bias, and by noise as the settings say.
class Wheels
{
public:
  double scale = 0, turnBias = 0; // of v; rad/s
  double period = 0.02;           // s

  Wheels(const vpVlpFilter &filter, unsigned int seed) : m_filter(filter), m_random(seed) {}

  //! Samples that end in (from, to], the base moving at \e v and \e w.
  void speak(vpVlpFilter &filter, double to, const std::function<double(double)> &v,
             const std::function<double(double)> &w)
  {
    for (; m_next <= to + 1e-9; m_next += period) {
      const double middle = m_next - 0.5 * period, trueV = v(middle), trueW = w(middle);
      filter.addOdometry({m_next,
                          (1 + scale) * trueV + m_random.normal(m_filter.odometrySpeed) +
                              m_random.normal(m_filter.odometryShare * trueV),
                          trueW + turnBias + m_random.normal(m_filter.odometryTurnRate) +
                              m_random.normal(m_filter.odometryShare * trueW)});
    }
  }

private:
  const vpVlpFilter m_filter; // settings
  Random m_random;
  double m_next = 0; // s
};

//! To and fro under the lamps for 10 s, turning, then straight on.
double speedAt(double t)
{
  return t < 10 ? 0.4 * std::sin(1.3 * t) : 0.1;
}
double turnRateAt(double t)
{
  return t < 10 ? 0.6 * std::cos(0.9 * t) : 0;
}

//! Integrated once for all drives.
vpHomogeneousMatrix wheeledAt(double t)
{
  static const double step = 1e-3;
  static const std::vector<Eigen::Vector3d> poses = [] {
    std::vector<Eigen::Vector3d> all(1, Eigen::Vector3d(-0.3, 0, 0.2));
    for (int k = 0; k < 16000; ++k) {
      const double middle = (k + 0.5) * step, heading = all.back().z() + 0.5 * step * turnRateAt(middle);
      all.push_back(all.back() + step * Eigen::Vector3d(speedAt(middle) * std::cos(heading),
                                                        speedAt(middle) * std::sin(heading),
                                                        turnRateAt(middle)));
    }
    return all;
  }();
  const auto k = static_cast<size_t>(std::max(0.0, t / step));
  const double share = t / step - static_cast<double>(k);
  const Eigen::Vector3d pose = (1 - share) * poses[k] + share * poses[k + 1];
  return lampScene::frame(pose.x(), pose.y(), 0, 0, 0, pose.z());
}
} // namespace

TEST(VlpFilterConsistency, OdometrysErrorsAreEstimatedWhileLampsAreSeen)
{
  const double scale = 0.01, bias = 0.004, blind = 2; // rad/s, s
  double along = 0, turned = 0;
  const int count = 20;
  for (int seed = 1; seed <= count; ++seed) {
    Drive drive(static_cast<unsigned int>(seed), wheeledAt);
    vpVlpFilter filter(drive.rig());
    Wheels wheels(filter, static_cast<unsigned int>(100 + seed));
    wheels.scale = scale;
    wheels.turnBias = bias;
    drive.start(filter);
    double t = 0;
    for (; t < 10; t += 0.1) {
      wheels.speak(filter, t + 0.06, speedAt, turnRateAt);
      drive.frame(filter, t);
    }
    const double from = filter.time();
    wheels.speak(filter, from + blind + 0.1, speedAt, turnRateAt);
    const vpHomogeneousMatrix truth = drive.truth(from + blind);
    const vpVlpFix ahead = filter.fixAt(from + blind);
    filter.advance(from + blind);
    const vpVlpFix fix = filter.now();
    EXPECT_EQ(lampScene::poseError(fix.wMb, ahead.wMb).norm(), 0) << "as predicted along the same samples";
    EXPECT_TRUE(within(3, fix, truth)) << seed;
    EXPECT_LT(std::sqrt(fix.covariance(0, 0)), 0.01);
    EXPECT_EQ(filter.state(fix), vpVlpFilter::State::tracking);
    const vpHomogeneousMatrix off = truth.inverse() * fix.wMb;
    along += off[0][3] / count;
    turned += yawOf(off) / count;
  }
  // Uncorrected these were 1 % of the way and the bias times the time.
  EXPECT_LT(std::abs(along), 0.3 * scale * 0.1 * blind);
  EXPECT_LT(std::abs(turned), 0.3 * bias * blind);
}

TEST(VlpFilterConsistency, GapInOdometryIsBridged)
{
  for (unsigned int seed = 1; seed <= 10; ++seed) {
    Drive drive(seed, wheeledAt);
    vpVlpFilter filter(drive.rig()), gapless(drive.rig());
    drive.start(filter);
    gapless = filter;
    Wheels wheels(filter, seed), same(filter, seed);
    double t = 0;
    for (; t < 11; t += 0.1) {
      wheels.speak(gapless, t + 0.06, speedAt, turnRateAt);
      same.speak(filter, t + 0.06, speedAt, turnRateAt);
      Drive twin = drive;
      drive.frame(filter, t);
      twin.frame(gapless, t);
    }
    const double lost = filter.time(), back = lost + 0.8, end = lost + 1.5;
    wheels.speak(gapless, end, speedAt, turnRateAt);
    vpVlpFilter unheard(drive.rig());
    same.speak(unheard, back, speedAt, turnRateAt); // these samples never arrive
    same.speak(filter, end, speedAt, turnRateAt);
    filter.advance(end);
    gapless.advance(end);
    EXPECT_TRUE(within(3, gapless.now(), drive.truth(end))) << seed;
    EXPECT_TRUE(within(3, filter.now(), drive.truth(end))) << seed;
    EXPECT_GT(filter.now().covariance(0, 0), 2 * gapless.now().covariance(0, 0));
    // Its velocity is the odometry's again.
    EXPECT_NEAR(filter.velocity().x(), 0.1, 0.02);
    EXPECT_LT(std::sqrt(filter.velocityCovariance()(0, 0)), 0.02);
  }
}

TEST(VlpFilterConsistency, ChangeOfTheWheelsSpeedIsNoReasonToBelieveInASteadyMotion)
{
  Drive drive(1, wheeledAt);
  const auto density = [&drive](vpVlpFilter::Odometry odometry, double last) {
    vpVlpFilter filter(drive.rig());
    filter.odometry = odometry;
    filter.manoeuvreShare = 0.001;
    filter.start(drive.truth(0), 0);
    for (double t = 0; t < 1.01; t += 0.02) {
      filter.addOdometry({t, 0.1, 0});
    }
    filter.mark(1);
    filter.addOdometry({1.02, last, 0});
    filter.advance(1.02);
    return filter.leastOdometry();
  };
  using Odometry = vpVlpFilter::Odometry;
  EXPECT_GT(density(Odometry::measured, 0.1), density(Odometry::followed, 0.1));
  EXPECT_LT(density(Odometry::measured, 0.07), density(Odometry::followed, 0.07) - 20); // nats
}

TEST(VlpFilterConsistency, SamplesThatAreNotLaterAreLeftOut)
{
  Drive drive(1, wheeledAt);
  vpVlpFilter filter(drive.rig());
  drive.start(filter);
  drive.frame(filter, 0);
  vpVlpFilter other = filter;
  for (double t = 0; t < 1; t += 0.02) {
    filter.addOdometry({t, speedAt(t), turnRateAt(t)});
    other.addOdometry({t, speedAt(t), turnRateAt(t)});
    other.addOdometry({t, 50, 50});
    other.addOdometry({t - 0.01, -50, 50});
  }
  filter.advance(0.9);
  other.advance(0.9);
  EXPECT_EQ(lampScene::poseError(filter.now().wMb, other.now().wMb).norm(), 0);
  EXPECT_EQ((filter.now().covariance - other.now().covariance).norm(), 0);
}

TEST(VlpFilterConsistency, SamplesThatAreNotFiniteAreRefusedByName)
{
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  vpVlpFilter filter{vpVlpRig()};
  vpExpectError([&] { filter.addOdometry({nan, 0, 0}); }, {"odometry", "timestamp", "nan", "finite"});
  vpExpectError([&] { filter.addOdometry({0, infinite, 0}); }, {"odometry", "v: inf", "finite"});
  vpExpectError([&] { filter.addOdometry({0, 0, -infinite}); }, {"odometry", "w: -inf", "finite"});
}
