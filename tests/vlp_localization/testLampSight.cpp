/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <gtest/gtest.h>

#include <visp3/core/vpMeterPixelConversion.h>
#include <visp3/core/vpPixelMeterConversion.h>
#include <visp3/vlp_localization/vpTwoLampSolver.h>

#include "lampScene.h"

using namespace lampScene;

namespace
{
vpCameraParameters fisheye()
{
  vpCameraParameters camera;
  camera.initProjWithKannalaBrandtDistortion(500, 700, 400, 300, {-0.02, 0.008, -0.004, 0.0006});
  return camera;
}

vpCameraParameters barrel()
{
  vpCameraParameters camera;
  camera.initPersProjWithDistortion(900, 910, 400, 300, -0.15, 0.16);
  return camera;
}

vpLampObservation observationAt(double u, double v)
{
  vpLampObservation observation;
  observation.point = {u, v};
  observation.covariance << 0.04, 0.01, 0.01, 0.09;
  return observation;
}

// Covariance of the ray by drawing image points.
Eigen::Matrix2d drawnCovariance(const vpLampObservation &observation, const vpCameraParameters &camera)
{
  Random random(5);
  const Eigen::Matrix2d root = observation.covariance.llt().matrixL();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  const int draws = 50000;
  for (int i = 0; i < draws; ++i) {
    const Eigen::Vector2d pixel =
        observation.point + root * Eigen::Vector2d(random.normal(1), random.normal(1));
    Eigen::Vector2d ray = Eigen::Vector2d::Zero();
    vpPixelMeterConversion::convertPoint(camera, pixel.x(), pixel.y(), ray.x(), ray.y());
    sum += ray;
    squares += ray * ray.transpose();
  }
  return squares / draws - (sum / draws) * (sum / draws).transpose();
}
} // namespace

TEST(LampSight, TakesIdPlaceAndSigmaFromTheMap)
{
  vpLamp lamp;
  lamp.id = "hall-3";
  lamp.position = {1, -2, 2.5};
  lamp.positionSigma = 0.004;
  const vpLampSight sight = vpLampSight::from(lamp, observationAt(400, 300), barrel());
  EXPECT_EQ(sight.id, "hall-3");
  EXPECT_EQ(sight.position, lamp.position);
  EXPECT_EQ(sight.positionSigma, 0.004);
  EXPECT_LT(sight.ray.norm(), 1e-12); // the principal point is the optical axis
}

TEST(LampSight, WithoutDistortionIsTheAffineRule)
{
  vpCameraParameters camera;
  camera.initPersProjWithoutDistortion(800, 1000, 320, 240);
  const vpLampSight sight = vpLampSight::from(vpLamp(), observationAt(400, 140), camera);
  EXPECT_NEAR(sight.ray.x(), 0.1, 1e-12);
  EXPECT_NEAR(sight.ray.y(), -0.1, 1e-12);
  EXPECT_NEAR(sight.covariance(0, 0), 0.04 / (800.0 * 800), 1e-15);
  EXPECT_NEAR(sight.covariance(1, 1), 0.09 / (1000.0 * 1000), 1e-15);
  EXPECT_NEAR(sight.covariance(0, 1), 0.01 / (800.0 * 1000), 1e-15);
}

TEST(LampSight, UndoesTheRadialDistortionOfVisp)
{
  const vpCameraParameters camera = barrel();
  const vpLampSight sight = vpLampSight::from(vpLamp(), observationAt(700, 60), camera);
  const Eigen::Vector2d plain(300.0 / 900, -240.0 / 910);
  EXPECT_LT((sight.ray - plain * (1 + 0.16 * plain.squaredNorm())).norm(), 1e-12);
}

TEST(LampSight, UndoesTheFisheyeOfVisp)
{
  const vpCameraParameters camera = fisheye();
  for (double x : {-1.2, -0.3, 0.0, 0.8})
    for (double y : {-0.9, 0.1, 1.1}) {
      vpLampObservation observation = observationAt(0, 0);
      vpMeterPixelConversion::convertPoint(camera, x, y, observation.point.x(), observation.point.y());
      const vpLampSight sight = vpLampSight::from(vpLamp(), observation, camera);
      EXPECT_NEAR(sight.ray.x(), x, 1e-6);
      EXPECT_NEAR(sight.ray.y(), y, 1e-6);
    }
}

TEST(LampSight, CovarianceIsThatOfDrawnImagePoints)
{
  for (const vpCameraParameters &camera : {barrel(), fisheye()}) {
    const vpLampObservation observation = observationAt(720, 80);
    const Eigen::Matrix2d claimed = vpLampSight::from(vpLamp(), observation, camera).covariance;
    const Eigen::Matrix2d drawn = drawnCovariance(observation, camera);
    EXPECT_LT((claimed - drawn).norm(), 0.02 * drawn.norm());
  }
}

// From pixels of a strongly distorting lens to the pose that made them.
TEST(LampSight, PixelsOfAFisheyeGiveThePose)
{
  Random random(7);
  const vpCameraParameters camera = fisheye();
  for (int i = 0; i < 100; ++i) {
    const vpVlpRig rig = randomRig(random, 0.2);
    const vpHomogeneousMatrix wMb = randomBase(random);
    std::vector<vpLampSight> lamps;
    for (double side : {-0.7, 0.6}) {
      vpLamp lamp;
      lamp.id = side < 0 ? "A" : "B";
      lamp.position = Eigen::Vector3d(wMb[0][3] + side, wMb[1][3] + random.uniform(-1, 1), 2);
      const vpLampSight seen = sightOf(lamp.id, lamp.position, wMb * rig.bMc);
      vpLampObservation observation = observationAt(0, 0);
      vpMeterPixelConversion::convertPoint(camera, seen.ray.x(), seen.ray.y(), observation.point.x(),
                                           observation.point.y());
      lamps.push_back(vpLampSight::from(lamp, observation, camera));
    }
    const vpVlpFix fix = vpTwoLampSolver().solve(lamps[0], lamps[1], rig);
    ASSERT_TRUE(fix.valid) << fix.refusal;
    EXPECT_LT(poseError(wMb, fix.wMb).norm(), 1e-5);
  }
}
