/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What each step of the filter does: lamps, motion, marks, states.

#include <array>

#include <gtest/gtest.h>
#include <visp3/vlp_localization/vpTwoLampSolver.h>

#include "lampDrive.h"

using namespace lampDrive;
using State = vpVlpFilter::State;

namespace
{
//! Of x, y, z and yaw, as if the robot stood at the origin of w and \e fix were turned about that: errors of
//! poses that differ are then about the same point.
Eigen::Matrix4d aboutOrigin(const vpVlpFix &fix)
{
  const std::array<int, 4> rows = {0, 1, 2, 5};
  Eigen::Matrix4d block, shift = Eigen::Matrix4d::Identity();
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) {
      block(i, k) = fix.covariance(rows[static_cast<size_t>(i)], rows[static_cast<size_t>(k)]);
    }
  }
  shift(0, 3) = fix.wMb[1][3];
  shift(1, 3) = -fix.wMb[0][3];
  return shift * block * shift.transpose();
}

double placeSigma(const vpVlpFix &fix)
{
  return std::sqrt(std::max(fix.covariance(0, 0), fix.covariance(1, 1)));
}

vpHomogeneousMatrix standing(double)
{
  return lampScene::frame(0.1, -0.2, 0, 0, 0, 0.7);
}

vpVlpFix fixWith(double place, double turn)
{
  vpVlpFix fix;
  fix.valid = true;
  fix.covariance(0, 0) = 1e-8;
  fix.covariance(1, 1) = place * place;
  fix.covariance(5, 5) = turn * turn;
  return fix;
}

void expectSame(const vpVlpFix &a, const vpVlpFix &b)
{
  EXPECT_EQ(lampScene::poseError(a.wMb, b.wMb).norm(), 0);
  EXPECT_EQ((a.covariance - b.covariance).norm(), 0);
}

//! Of a symmetric matrix, descending.
template <int N>
Eigen::Matrix<double, N, 1> eigenvaluesOf(Eigen::Matrix<double, N, N> matrix)
{
  Eigen::Matrix<double, N, 1> values;
  cv::Mat1d found(N, 1, values.data());
  cv::eigen(cv::Mat1d(N, N, matrix.data()), found);
  return values;
}

template <int N>
bool symmetricAndNotNegative(const Eigen::Matrix<double, N, N> &covariance)
{
  const Eigen::Matrix<double, N, 1> eigen = eigenvaluesOf<N>(covariance);
  return covariance.allFinite() &&
         (covariance - covariance.transpose()).norm() <= 1e-12 * covariance.norm() &&
         eigen(N - 1) >= -1e-12 * eigen(0);
}
} // namespace

TEST(VlpFilter, TwoLampsSeenOnceGiveThePoseOfTheTwoLampSolver)
{
  Sigmas claims;
  claims.positionSigma = 0.003;
  claims.translationSigma = {0.002, 0.001, 0.003};
  claims.rotationSigma = {0.003, 0.004, 0.002};
  for (const Sigmas &sigmas : {Sigmas(), claims}) {
    for (unsigned int seed = 1; seed <= 50; ++seed) {
      Drive drive(seed, standing, sigmas);
      const vpLampSight first = drive.sight(0, 0), second = drive.sight(2, 0);
      const vpVlpFix solved = vpTwoLampSolver().solve(first, second, drive.rig());
      ASSERT_TRUE(solved.valid) << solved.refusal;
      vpVlpFilter filter(drive.rig());
      drive.start(filter);
      filter.update(first);
      filter.update(second);
      const vpVlpFix fix = filter.now();
      for (int i = 0; i < 6; ++i) {
        const double sigma = std::sqrt(solved.covariance(i, i));
        EXPECT_NEAR(std::sqrt(fix.covariance(i, i)), sigma, 0.03 * sigma) << i << ", seed " << seed;
        // Both linearise, the filter about a pose that is some millimetres off.
        EXPECT_LE(std::abs(lampScene::poseError(solved.wMb, fix.wMb)(i)), 0.1 * sigma + 1e-12)
            << i << ", seed " << seed;
      }
    }
  }
}

// Turning about the lamp's vertical changes nothing in the picture: this and the height that goes with the
// distance are the two directions in which one lamp says nothing.
TEST(VlpFilter, OneLampCorrectsInTwoDirectionsAndNotAlongTheCircleAboutIt)
{
  Drive drive(1, standing);
  vpVlpFilter filter(drive.rig());
  drive.start(filter);
  drive.frame(filter, 0);
  filter.advance(0.5); // without lamps
  const vpVlpFix before = filter.now();
  const vpLampSight lamp = drive.sight(0, 0.5);
  filter.update(lamp);
  const vpVlpFix after = filter.now();
  EXPECT_LT(placeSigma(after), placeSigma(before));
  EXPECT_LT(distance(after.wMb, drive.truth(0.5)), 3 * placeSigma(after));

  const Eigen::Matrix4d gain = aboutOrigin(after).inverse() - aboutOrigin(before).inverse();
  const Eigen::Vector4d eigen = eigenvaluesOf<4>(0.5 * (gain + gain.transpose()));
  const double best = eigen(0);
  EXPECT_GT(eigen(1), 1e-3 * best);
  EXPECT_LT(std::abs(eigen(2)), 1e-6 * best);
  EXPECT_LT(std::abs(eigen(3)), 1e-6 * best);
  const Eigen::Vector4d circle(lamp.position.y(), -lamp.position.x(), 0, 1);
  EXPECT_LT(std::abs(circle.dot(gain * circle)), 1e-6 * best);
}

TEST(VlpFilter, LampsOfSeveralLinesGiveThePoseAtTheMark)
{
  const Arc arc{0.3, 0.1, 0.5, 0.2, 0, 1};
  for (unsigned int seed = 1; seed <= 20; ++seed) {
    Drive drive(seed, [&](double t) { return arc.at(t); });
    vpVlpFilter filter(drive.rig());
    drive.start(filter);
    double t = 0;
    for (int k = 0; k < 45; ++k) {
      t = k * frameTime;
      drive.frame(filter, t);
    }
    const vpVlpFix marked = filter.marked(), last = filter.now();
    const vpHomogeneousMatrix atMark = arc.at(t), atLast = arc.at(t + drive.lastLine());
    EXPECT_TRUE(within(4, marked, atMark)) << seed;
    EXPECT_TRUE(within(4, last, atLast)) << seed;
    EXPECT_FALSE(within(4, marked, atLast)) << seed;
    EXPECT_LT(distance(marked.wMb, atMark), 0.001);
    EXPECT_NEAR(yawOf(marked.wMb), std::remainder(0.5 + t, 2 * M_PI), 0.001);
    EXPECT_EQ(filter.time(), t + drive.lastLine());
  }
}

TEST(VlpFilter, FixOfTheFutureFollowsTheArcAndIsLessCertainTheFartherItIs)
{
  const Arc arc;
  Drive drive(3, [&](double t) { return arc.at(t); });
  vpVlpFilter filter(drive.rig());
  drive.start(filter);
  for (int k = 0; k < 60; ++k) {
    drive.frame(filter, k * frameTime);
  }
  const vpVlpFix now = filter.now();
  const double from = filter.time();
  double place = placeSigma(now), turn = std::sqrt(now.covariance(5, 5));
  expectSame(filter.fixAt(from), now);
  for (double ahead : {0.03, 0.1, 0.3, 1.0}) {
    const vpVlpFix there = filter.fixAt(from + ahead);
    EXPECT_TRUE(within(3, there, arc.at(from + ahead))) << ahead;
    EXPECT_LT(distance(there.wMb, arc.at(from + ahead)), 0.001 + 0.01 * ahead) << ahead;
    EXPECT_GT(placeSigma(there), place);
    EXPECT_GT(std::sqrt(there.covariance(5, 5)), turn);
    place = placeSigma(there);
    turn = std::sqrt(there.covariance(5, 5));
  }
  EXPECT_EQ(filter.time(), from);
  expectSame(filter.now(), now);
}

TEST(VlpFilter, OfFreeAttitudeItClimbsAsItLeans)
{
  const double speed = 0.1, pitch = -0.07, roll = 0.05; // nose and left side up
  for (const bool isFree : {true, false}) {
    vpVlpFilter filter(lampScene::rigWith(vpHomogeneousMatrix()));
    filter.freeAttitude = isFree;
    for (double t = 0; t < 1.05; t += 0.1) {
      filter.addOdometry({t, speed, 0});
    }
    filter.start(lampScene::frame(0, 0, 0, roll, pitch, 0.7), 0);
    filter.advance(1);
    const vpVlpFix fix = filter.now();
    EXPECT_NEAR(fix.wMb[2][3], isFree ? -speed * std::sin(pitch) : 0, 1e-4);
    const double along = std::cos(0.7) * fix.wMb[0][3] + std::sin(0.7) * fix.wMb[1][3];
    EXPECT_NEAR(along, speed, 0.01 * speed);
  }
}

TEST(VlpFilter, StateGoesByTheCovarianceAlone)
{
  const vpVlpFilter filter{vpVlpRig()};
  EXPECT_EQ(filter.state(vpVlpFix()), State::starting);
  EXPECT_EQ(filter.state(filter.now()), State::starting);
  EXPECT_EQ(filter.state(fixWith(0.019, 0.049)), State::tracking);
  EXPECT_EQ(filter.state(fixWith(0.021, 0.001)), State::coasting);
  EXPECT_EQ(filter.state(fixWith(0.001, 0.051)), State::coasting);
  EXPECT_EQ(filter.state(fixWith(0.199, 0.599)), State::coasting);
  EXPECT_EQ(filter.state(fixWith(0.201, 0.001)), State::lost);
  EXPECT_EQ(filter.state(fixWith(0.001, 0.601)), State::lost);
  EXPECT_EQ(filter.state(fixWith(std::nan(""), 0.001)), State::lost);
}

TEST(VlpFilter, WithoutLampsItCoastsAndIsLostInTheEnd)
{
  Drive drive(1, standing);
  vpVlpFilter filter(drive.rig());
  drive.start(filter);
  for (int k = 0; k < 10; ++k) {
    drive.frame(filter, k * frameTime);
  }
  std::vector<State> states;
  for (int k = 0; k < 400; ++k) {
    const State state = filter.state(filter.fixAt(0.3 + k * frameTime));
    if (states.empty() || states.back() != state) {
      states.push_back(state);
    }
  }
  EXPECT_EQ(states, (std::vector<State>{State::tracking, State::coasting, State::lost}));
}

TEST(VlpFilter, LampBehindTheCameraChangesNothing)
{
  for (double positionSigma : {0.0, 0.01}) {
    Sigmas sigmas;
    sigmas.positionSigma = positionSigma;
    Drive drive(1, standing, sigmas);
    vpVlpFilter filter(drive.rig());
    drive.start(filter);
    drive.frame(filter, 0);
    vpVlpFilter other = filter;
    vpLampSight behind = drive.sight(0, 0);
    behind.id = "below";
    behind.position.z() = -1;
    EXPECT_FALSE(filter.innovation(behind).inFront);
    filter.update(behind);
    expectSame(filter.now(), other.now());
    expectSame(filter.marked(), other.marked());
    const vpLampSight next = drive.sight(1, 0.1);
    for (vpVlpFilter *each : {&filter, &other}) {
      each->advance(0.1);
      each->update(next);
    }
    EXPECT_LT(lampScene::poseError(filter.now().wMb, other.now().wMb).norm(), 1e-12);
  }
}

TEST(VlpFilter, BeforeItsStartNothingHappens)
{
  Drive drive(1, standing);
  vpVlpFilter filter(drive.rig());
  filter.advance(1);
  filter.mark(2);
  EXPECT_FALSE(filter.innovation(drive.sight(0, 0)).inFront);
  filter.update(drive.sight(0, 0));
  for (const vpVlpFix &fix : {filter.now(), filter.marked(), filter.fixAt(3)}) {
    EXPECT_FALSE(fix.valid);
    EXPECT_EQ(fix.refusal, "no pose yet");
  }
  EXPECT_FALSE(filter.started());
}

TEST(VlpFilter, InnovationIsKnownBeforeTheUpdate)
{
  Drive drive(4, standing);
  vpVlpFilter filter(drive.rig());
  drive.start(filter);
  drive.frame(filter, 0);
  const vpVlpFix before = filter.now();
  vpLampSight lamp = drive.sight(1, drive.lastLine());
  const vpVlpFilter::Innovation near = filter.innovation(lamp);
  ASSERT_TRUE(near.inFront);
  EXPECT_NEAR(near.depth, lamp.position.z() - 0.2, 0.01);
  EXPECT_LT(near.distance(0), 20);
  lamp.ray.x() += 0.02;
  const vpVlpFilter::Innovation far = filter.innovation(lamp);
  EXPECT_GT(far.distance(0), 100);
  EXPECT_LT(far.distance(0.05), 2); // 0.02 of 2.3 m: as far as a lamp may hang from its place
  EXPECT_NEAR(far.ray.x() - near.ray.x(), 0.02, 1e-12);
  expectSame(filter.now(), before);
}

TEST(VlpFilter, YawGoesRoundAtHalfATurn)
{
  for (const double w : {1.0, -1.0}) {
    const Arc arc{0, 0, w > 0 ? 2.6 : -2.6, 0.1, 0, w};
    Drive drive(1, [&](double t) { return arc.at(t); });
    vpVlpFilter filter(drive.rig());
    drive.start(filter);
    for (int k = 0; k < 45; ++k) {
      drive.frame(filter, k * frameTime);
      EXPECT_TRUE(within(5, filter.marked(), arc.at(k * frameTime))) << k;
    }
    EXPECT_LT(w * yawOf(filter.now().wMb), 0); // beyond half a turn
    EXPECT_NEAR(filter.velocity().z(), w, 0.02);
  }
  // An innovation across half a turn takes the short way.
  Drive drive(2, [](double) { return lampScene::frame(0, 0, 0, 0, 0, -3.13); });
  vpVlpFilter filter(drive.rig());
  filter.start(lampScene::frame(0, 0, 0, 0, 0, 3.13), 0);
  for (int k = 0; k < 5; ++k) {
    drive.frame(filter, k * frameTime);
  }
  EXPECT_NEAR(yawOf(filter.now().wMb), -3.13, 0.002);
  EXPECT_LT(distance(filter.now().wMb, drive.truth(0)), 0.005);
}

TEST(VlpFilter, CovarianceStaysSymmetricAndNotNegative)
{
  Sigmas sigmas;
  sigmas.positionSigma = 0.004;
  sigmas.rotationSigma = {0.01, 0.01, 0.005};
  sigmas.translationSigma.setConstant(0.002);
  for (const bool free : {false, true}) {
    Drive drive(7, standing, sigmas);
    Random random(8);
    vpVlpFilter filter(drive.rig());
    filter.freeAttitude = free;
    drive.start(filter);
    double odometryTime = 0;
    for (int k = 0; k < 2000; ++k) {
      const double t = filter.time() + random.uniform(-0.002, 0.02);
      if (random.uniform(0, 1) < 0.3) {
        odometryTime = std::max(odometryTime, filter.time()) + random.uniform(0.001, 0.1);
        filter.addOdometry({odometryTime, random.normal(0.01), random.normal(0.01)});
      }
      random.uniform(0, 1) < 0.1 ? filter.mark(t) : filter.advance(t);
      const auto lamp = static_cast<size_t>(random.uniform(0, 3.999));
      if (random.uniform(0, 1) < 0.5) {
        filter.update(drive.sight(lamp, t));
      }
      filter.manoeuvreShare = random.uniform(0, 1);
      const vpVlpFix now = filter.now(), marked = filter.marked();
      ASSERT_TRUE(symmetricAndNotNegative(now.covariance)) << k;
      ASSERT_TRUE(symmetricAndNotNegative(marked.covariance)) << k;
      ASSERT_TRUE(symmetricAndNotNegative(filter.velocityCovariance())) << k;
    }
  }
}

TEST(VlpFilter, MixtureHasTheMeanAndCovarianceOfItsParts)
{
  Drive drive(1, standing);
  vpVlpFilter before(drive.rig());
  drive.start(before);
  for (int k = 0; k < 10; ++k) {
    drive.frame(before, k * frameTime);
  }
  std::vector<vpVlpFilter> parts(2, before);
  parts[0].manoeuvreShare = 0.002;
  parts[1].manoeuvreShare = 1;
  for (vpVlpFilter &part : parts) {
    drive.frame(part, 10 * frameTime);
  }
  const vpVlpFix steady = parts[0].now(), manoeuvring = parts[1].now();
  vpVlpFilter mixed = parts[0];
  mixed.mix({&parts[0], &parts[1]}, {0.75, 0.25});
  const vpVlpFix mixture = mixed.now();
  for (unsigned int i = 0; i < 2; ++i) {
    const double apart = steady.wMb[i][3] - manoeuvring.wMb[i][3];
    EXPECT_NEAR(mixture.wMb[i][3], 0.75 * steady.wMb[i][3] + 0.25 * manoeuvring.wMb[i][3], 1e-12);
    EXPECT_NEAR(mixture.covariance(i, i),
                0.75 * steady.covariance(i, i) + 0.25 * manoeuvring.covariance(i, i) +
                    0.75 * 0.25 * apart * apart,
                1e-15);
  }
  mixed = parts[1];
  mixed.mix({&parts[0]}, {1});
  EXPECT_LT(lampScene::poseError(mixed.now().wMb, steady.wMb).norm(), 1e-12);
  EXPECT_LT((mixed.now().covariance - steady.covariance).norm(), 1e-15);
}

TEST(VlpFilter, WidenedClaimsCountFromTheNextStartOn)
{
  Drive drive(1, standing);
  vpVlpFilter filter(drive.rig());
  EXPECT_FALSE(filter.claimsWidened());
  double before = 0;
  for (int times = 0; times < 4; ++times) {
    drive.start(filter);
    for (int k = 0; k < 5; ++k) {
      drive.frame(filter, k * frameTime);
    }
    EXPECT_GT(placeSigma(filter.now()), 1.5 * before) << times;
    before = placeSigma(filter.now());
    filter.widenClaims();
    EXPECT_TRUE(filter.claimsWidened());
    EXPECT_EQ(placeSigma(filter.now()), before);
  }
}
