/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <algorithm>
#include <cmath>
#include <functional>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#include <visp3/vlp_calibration/vpLampSurvey.h>
#include <visp3/vlp_calibration/vpMountCalibration.h>

#include "vlp_calibration/calibrationRun.h"

namespace
{
using namespace calibrationRun;

const double degree = M_PI / 180;

int at(vpRigParameter parameter)
{
  return static_cast<int>(parameter);
}

//! A camera that is not as its rig says, under lamps of two heights.
World worldOf(const vpRigVector &step, double rise = 0.2, std::uint64_t seed = 1)
{
  World world;
  world.rig = vpMovedRig(rig(), step);
  world.map = lamps(rise);
  world.robot = robot(seed);
  world.robot.slipSigma = 0.002;
  world.robot.startX = world.robot.startY = -0.25;
  return world;
}

vpRigVector typicalStep()
{
  vpRigVector step;
  step << 0.012, -0.007, 0.006, 0.2 * degree, -0.13 * degree, 1.5 * degree, 2.5, -1.8, 0.004;
  return step;
}

void expectNear(const vpBundleResult &found, const vpRigVector &truth)
{
  ASSERT_TRUE(found.valid) << found.refusal;
  const vpRigVector error = found.step - truth;
  EXPECT_LT(error.segment<2>(at(vpRigParameter::roll)).cwiseAbs().maxCoeff(), 0.02 * degree);
  EXPECT_LT(std::abs(error(at(vpRigParameter::yaw))), 0.05 * degree);
  EXPECT_LT(error.segment<2>(at(vpRigParameter::u0)).cwiseAbs().maxCoeff(), 0.3);
  EXPECT_LT(error.head<3>().cwiseAbs().maxCoeff(), 0.001);
}

TEST(MountCalibration, SpinAndSquareTellAllNineParameters)
{
  const World world = worldOf(typicalStep());
  const vpBundleResult found =
      vpMountCalibration().solve({drive(world, spin() + square(), 3)}, rig(), world.map);
  expectNear(found, typicalStep());
  EXPECT_TRUE(found.unseparated.empty());
  for (int i = 0; i < vpRigParameterCount; ++i) {
    EXPECT_LT(std::abs(found.step(i) - typicalStep()(i)), 6 * std::sqrt(found.rigCovariance(i, i))) << i;
  }
  EXPECT_NEAR(vpRigStep(rig(), found.rig)(at(vpRigParameter::u0)), found.step(at(vpRigParameter::u0)), 1e-9);
}

TEST(MountCalibration, SpinAndSquareMayBeTwoRuns)
{
  World world = worldOf(typicalStep());
  const vpLampRun turning = drive(world, spin(), 4);
  world.robot.seed = 8;
  const vpLampRun driving = drive(world, square(), 5);
  expectNear(vpMountCalibration().solve({turning, driving}, rig(), world.map), typicalStep());
}

TEST(MountCalibration, KnownPlacesDoAsWell)
{
  World world = worldOf(typicalStep());
  const std::vector<vpTimedVelocity> commands = {{{0.02, 0.06}, 60}};
  vpLampRun run = drive(world, commands, 6);
  run.places = truth(world, commands);
  run.motion = vpLampRun::Motion::known;
  vpLampRun still = run; // of what was put there: a picture while it stands
  still.odometry.clear();
  for (vpLampView &view : still.views) {
    for (vpLampImage &image : view.images) { // seen from where it stood at the frame's time stamp
      Eigen::Vector2d pixel;
      imageOf(world.rig, *run.places.at(view.timestamp), world.map.lamps[image.lamp].position, 0, pixel);
      image.point = pixel;
    }
  }
  expectNear(vpMountCalibration().solve({still}, rig(), world.map), typicalStep());
}

TEST(MountCalibration, AMountThatIsTurnedByARightAngleIsFound)
{
  vpRigVector step = vpRigVector::Zero();
  step(at(vpRigParameter::yaw)) = 90 * degree;
  const World world = worldOf(step);
  const vpBundleResult found =
      vpMountCalibration().solve({drive(world, spin() + square(), 3)}, rig(), world.map);
  ASSERT_TRUE(found.valid) << found.refusal;
  EXPECT_NEAR(found.step(at(vpRigParameter::yaw)), 90 * degree, 0.05 * degree);
}

//! One tick of a wheel turns the base by 0.018 degree, which moves a lamp near the border by 0.1 px.
TEST(MountCalibration, TicksOfTheWheelsDoNotPassForNoiseOfTheImages)
{
  World world = worldOf(typicalStep());
  world.robot.slipSigma = 0;
  const vpBundleResult found =
      vpMountCalibration().solve({drive(world, square() + square(), 3)}, rig(), world.map);
  ASSERT_TRUE(found.valid) << found.refusal;
  EXPECT_NEAR(found.imageFactor, 1, 0.03); // 1.06 with the ticks as they are read
}

//! The ellipse that a lamp's disc makes in the picture.
vpLampOutline outlineOf(const vpVlpRig &rig, const vpHomogeneousMatrix &wMb, const vpLamp &lamp)
{
  Eigen::Vector2d middle, pixel;
  imageOf(rig, wMb, lamp.position, 0, middle);
  std::vector<cv::Point2f> points;
  for (double t = 0; t < 2 * M_PI; t += M_PI / 50) {
    imageOf(rig, wMb, lamp.position + 0.5 * lamp.size * Eigen::Vector3d(std::cos(t), std::sin(t), 0), 0,
            pixel);
    points.emplace_back(pixel.x() - middle.x(), pixel.y() - middle.y());
  }
  const cv::RotatedRect ellipse = cv::fitEllipseDirect(points);
  vpLampOutline outline;
  outline.shape = vpLampOutline::Shape::ellipse;
  outline.centre = middle + Eigen::Vector2d(ellipse.center.x, ellipse.center.y);
  outline.a = 0.5 * ellipse.size.width;
  outline.b = 0.5 * ellipse.size.height;
  outline.angle = ellipse.angle * degree;
  return outline;
}

//! Where a lamp's middle lies in its ellipse depends on the lean that is looked for.
TEST(MountCalibration, LeanIsNotTakenForThePrincipalPointByTheMiddlesOfDiscs)
{
  vpRigVector step = typicalStep();
  step(at(vpRigParameter::roll)) = 1 * degree;
  World world = worldOf(step);
  world.noise = world.stated = 0.001;
  world.robot.slipSigma = 0;
  world.robot.encoderTicks = false;
  vpLampRun run = drive(world, spin() + square(), 3);
  vpDrivenMotion motion(world.robot, spin() + square());
  for (vpLampView &view : run.views) {
    for (vpLampImage &image : view.images) {
      image.outline = outlineOf(world.rig, motion.wMb(image.time), world.map.lamps[image.lamp]);
      image.point = image.outline.middle(rig().camera, rig().verticalInCamera());
    }
  }
  const vpBundleResult found = vpMountCalibration().solve({run}, rig(), world.map);
  ASSERT_TRUE(found.valid) << found.refusal;
  for (const vpRigParameter middle : {vpRigParameter::u0, vpRigParameter::v0}) {
    // 0.006 and 0.045 px off with the middles that rig() has.
    EXPECT_NEAR(found.step(at(middle)), step(at(middle)), 0.003);
  }
}

TEST(MountCalibration, LampsOfOneHeightLeaveThePrincipalPointOpen)
{
  const World world = worldOf(typicalStep(), 0);
  const std::vector<vpLampRun> runs = {drive(world, spin() + square(), 3)};
  vpMountCalibration calibration;
  const vpBundleResult refused = calibration.solve(runs, rig(), world.map);
  EXPECT_FALSE(refused.valid);
  for (const char *part : {"do not tell apart", "u0", "focal", "--fix"}) {
    EXPECT_NE(refused.refusal.find(part), std::string::npos) << refused.refusal;
  }
  const vpVlpRig lens = [&] { // known from a board
    vpRigVector step = vpRigVector::Zero();
    step.tail<3>() = typicalStep().tail<3>();
    return vpMovedRig(rig(), step);
  }();
  for (const vpRigParameter held : {vpRigParameter::u0, vpRigParameter::v0, vpRigParameter::focal}) {
    calibration.bundle.rigSigma(at(held)) = 0;
  }
  vpRigVector rest = typicalStep();
  rest.tail<3>().setZero();
  expectNear(calibration.solve(runs, lens, world.map), rest);
}

TEST(MountCalibration, RefusesARobotThatStandsStill)
{
  const World world = worldOf(vpRigVector::Zero());
  const vpBundleResult found = vpMountCalibration().solve({drive(world, {{{0, 0}, 5}}, 3)}, rig(), world.map);
  EXPECT_FALSE(found.valid);
  EXPECT_NE(found.refusal.find("stands still"), std::string::npos) << found.refusal;
}

TEST(MountCalibration, RefusesTooFewPicturesAndSwappedLamps)
{
  World world = worldOf(typicalStep());
  world.frameRate = 4;
  vpLampRun run = drive(world, spin() + square(), 3);
  vpLampMap swapped = world.map;
  std::swap(swapped.lamps[1].position, swapped.lamps[2].position);
  const vpBundleResult wrong = vpMountCalibration().solve({run}, rig(), swapped);
  EXPECT_FALSE(wrong.valid);
  EXPECT_NE(wrong.refusal.find("LED2 and LED3 are swapped"), std::string::npos) << wrong.refusal;
  run.views.resize(5);
  const vpBundleResult few = vpMountCalibration().solve({run}, rig(), world.map);
  EXPECT_FALSE(few.valid);
  EXPECT_NE(few.refusal.find("too few pictures"), std::string::npos) << few.refusal;
}

//! One lamp hangs 5 mm elsewhere than a map that claims to be exact: what is found of the rig is as
//! uncertain.
TEST(MountCalibration, MapThatDoesNotExplainThePicturesIsInflated)
{
  World world = worldOf(typicalStep());
  world.frameRate = 4;
  const vpLampRun run = drive(world, spin() + square(), 3);
  EXPECT_EQ(vpMountCalibration().solve({run}, rig(), world.map).inflatedLampSigma, 0);
  for (const Eigen::Vector3d &off : {Eigen::Vector3d(0.005, 0, 0), Eigen::Vector3d(0, 0, 0.005)}) {
    vpLampMap claimed = world.map;
    claimed.lamps[1].position += off;
    vpMountCalibration calibration;
    calibration.bundle.rigSigma(at(vpRigParameter::focal)) = 0.01; // told apart from z by heights alone
    const vpBundleResult found = calibration.solve({run}, rig(), claimed);
    ASSERT_TRUE(found.valid) << found.refusal;
    EXPECT_GT(found.inflatedLampSigma, 0.0005);
    EXPECT_LT(found.inflatedLampSigma, 0.01);
    const vpRigVector error = found.step - typicalStep();
    for (int i = 0; i < vpRigParameterCount; ++i) {
      EXPECT_LT(std::abs(error(i)), 4 * std::sqrt(found.rigCovariance(i, i))) << i << ", " << off.transpose();
    }
  }
}

TEST(MountCalibration, RefusesOdometryOfAnotherClockUnitOrSign)
{
  const World world = worldOf(typicalStep());
  const vpLampRun run = drive(world, square(), 3);
  const auto refusalOf = [&](const std::function<void(vpOdometry &)> &change) {
    vpLampRun changed = run;
    for (vpOdometry &sample : changed.odometry) {
      change(sample);
    }
    const vpBundleResult found = vpMountCalibration().solve({changed}, rig(), world.map);
    EXPECT_FALSE(found.valid);
    return found.refusal;
  };
  EXPECT_EQ(refusalOf([](vpOdometry &sample) {
              sample.timestamp += 0.5;
            }).rfind("the odometry's time stamps are about 0.5 s too late", 0),
            0u);
  EXPECT_EQ(refusalOf([](vpOdometry &sample) { sample.w = -sample.w; }).rfind("the odometry's turn rate", 0),
            0u);
  EXPECT_EQ(refusalOf([](vpOdometry &sample) { sample.v *= 1000; }).rfind("the odometry's speed", 0), 0u);
}

TEST(MountCalibration, AGapInTheOdometryTellsNothing)
{
  const World world = worldOf(typicalStep());
  vpLampRun run = drive(world, spin() + square(), 3);
  const double from = run.odometry.front().timestamp + 5, until = from + 4;
  run.odometry.erase(std::remove_if(run.odometry.begin(), run.odometry.end(),
                                    [&](const vpOdometry &sample) {
                                      return sample.timestamp > from && sample.timestamp < until;
                                    }),
                     run.odometry.end());
  const vpBundleResult found = vpMountCalibration().solve({run}, rig(), world.map);
  expectNear(found, typicalStep());
  for (int i = 0; i < vpRigParameterCount; ++i) {
    EXPECT_LT(std::abs(found.step(i) - typicalStep()(i)), 5 * std::sqrt(found.rigCovariance(i, i))) << i;
  }
}

//! Reflections that carry a lamp's own stripes: one image in fifty, up to 60 px off.
TEST(MountCalibration, OutliersAreLeftOut)
{
  const World world = worldOf(typicalStep());
  vpLampRun run = drive(world, spin() + square(), 3);
  size_t made = 0, count = 0;
  for (vpLampView &view : run.views) {
    for (vpLampImage &image : view.images) {
      if (++count % 50 == 0) {
        image.point += Eigen::Vector2d(20 + 40. * (made % 2), -30);
        ++made;
      }
    }
  }
  const vpBundleResult found = vpMountCalibration().solve({run}, rig(), world.map);
  expectNear(found, typicalStep());
  size_t out = 0;
  for (const vpBundleResidual &residual : found.residuals) {
    out += residual.used ? 0 : 1;
  }
  EXPECT_GE(out, made);
  EXPECT_LE(out, made + 3);
}

//! Wheels of wrong size, no slip: the standard deviations are those of the errors.
TEST(MountCalibration, StandardDeviationsAreHonestSlow)
{
  const int seeds = 12;
  double sum = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    World world = worldOf(typicalStep(), 0.2, static_cast<std::uint64_t>(seed));
    world.robot.slipSigma = 0;
    vpMountCalibration calibration;
    const vpBundleResult found =
        calibration.solve({drive(world, spin() + square(), 100 + seed)}, rig(), world.map);
    ASSERT_TRUE(found.valid) << found.refusal;
    const vpRigVector error = found.step - typicalStep();
    sum += error.dot(found.rigCovariance.inverse() * error);
  }
  // Chi-square of 9 x 12 degrees: 99.9 % lie between 0.62 and 1.49 of its mean. Below, it was too careful by
  // a third.
  EXPECT_GT(sum / (9 * seeds), 0.4);
  EXPECT_LT(sum / (9 * seeds), 1.49);
}

//! A survey under lamps of which two are measured.
struct Survey {
  World world = worldOf(vpRigVector::Zero(), 0.1);
  vpLampMap claimed = world.map;
  std::vector<vpLampRun> runs = {drive(world, spin() + square() + square(0.6, 0.12), 5)};
  vpLampSurvey survey;

  Survey() { survey.measured = {0, 3}; }
};

TEST(LampSurvey, FindsLampsWhoseMapIsWrongAndNamesThem)
{
  Survey s;
  s.claimed.lamps[1].position += Eigen::Vector3d(0.08, -0.05, 0.03);
  const vpSurveyResult found = s.survey.solve(s.runs, rig(), s.claimed);
  ASSERT_TRUE(found.bundle.valid) << found.bundle.refusal;
  for (size_t k = 0; k < 4; ++k) {
    const Eigen::Vector3d error = found.bundle.map.lamps[k].position - s.world.map.lamps[k].position;
    EXPECT_LT(error.head<2>().cwiseAbs().maxCoeff(), 0.002) << k;
    EXPECT_LT(std::abs(error.z()), 0.005) << k;
  }
  using State = vpSurveyedLamp::State;
  EXPECT_EQ(found.lamps[0].state, State::measured);
  EXPECT_EQ(found.lamps[1].state, State::displaced);
  EXPECT_EQ(found.lamps[2].state, State::found);
  EXPECT_NEAR(found.lamps[1].offset.x(), -0.08, 0.002);
  EXPECT_GT(found.bundle.map.lamps[1].positionSigma, 0);
}

TEST(LampSurvey, OneDistanceGivesAllUpToAChoice)
{
  Survey s;
  const Eigen::Vector3d a = s.world.map.lamps[0].position, b = s.world.map.lamps[3].position;
  s.survey.measured.clear();
  s.survey.distance = vpLampDistance{0, 3, (b - a).norm(), 0.0002};
  for (size_t k = 1; k < 4; ++k) { // only the direction from the first to the last is right
    s.claimed.lamps[k].position = a + 1.3 * (s.claimed.lamps[k].position - a);
  }
  const vpSurveyResult found = s.survey.solve(s.runs, rig(), s.claimed);
  ASSERT_TRUE(found.bundle.valid) << found.bundle.refusal;
  for (size_t k = 0; k < 4; ++k) {
    EXPECT_LT((found.bundle.map.lamps[k].position - s.world.map.lamps[k].position).norm(), 0.003) << k;
  }
}

TEST(LampSurvey, RefusesMeasuredLampsThatAreSwapped)
{
  Survey s;
  std::swap(s.claimed.lamps[0].position, s.claimed.lamps[3].position);
  const vpSurveyResult found = s.survey.solve(s.runs, rig(), s.claimed);
  EXPECT_FALSE(found.bundle.valid);
  EXPECT_NE(found.bundle.refusal.find("LED1 and LED4 are swapped"), std::string::npos)
      << found.bundle.refusal;
}

TEST(LampSurvey, ALampThatNobodySawKeepsItsPlace)
{
  Survey s;
  vpLamp far = s.claimed.lamps[0];
  far.id = "far";
  far.position = {9, 9, 1.5};
  s.claimed.lamps.push_back(far);
  const vpSurveyResult found = s.survey.solve(s.runs, rig(), s.claimed);
  ASSERT_TRUE(found.bundle.valid) << found.bundle.refusal;
  EXPECT_EQ(found.lamps[4].state, vpSurveyedLamp::State::unseen);
  EXPECT_EQ(found.bundle.map.lamps[4].position, far.position);
}

TEST(RigParameters, AStepIsTakenBack)
{
  const vpRigVector step = typicalStep();
  EXPECT_LT((vpRigStep(rig(), vpMovedRig(rig(), step)) - step).cwiseAbs().maxCoeff(), 1e-9);
}
} // namespace
