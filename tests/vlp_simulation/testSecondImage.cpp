/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What a pane or a shiny plate makes of a lamp.

#include <gtest/gtest.h>

#include "common/vpExpectError.h"
#include "cornerScene.h"
#include "simulatedRoom.h"

#include <visp3/vlp_simulation/vpSimulation.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
using cornerScene::Scene;
using simulatedRoom::frames;
using simulatedRoom::head;
using simulatedRoom::still;

//! A small lamp that shines to one side, whose image stands beside it.
struct Pair : Scene {
  Pair()
  {
    lamp().lamp.size = 0.02;
    lamp().lamp.position = Eigen::Vector3d(-0.01, 0, 1.5);
    lamp().emission = vpEmission::edgeLit(0.5, 0.1, 0);
    fast(); // sets the light
  }

  const Eigen::Vector3d shift = {0.03, 0.005, 0};

  //! Light of the image alone.
  cv::Mat_<float> image(double share, double blur, bool mirrored)
  {
    const cv::Mat_<float> alone = fast();
    scene.images = {lamp().image(shift, share, blur, mirrored)};
    const cv::Mat_<float> both = fast();
    scene.images.clear();
    return both - alone;
  }
};

Eigen::Vector2d centroid(const cv::Mat_<float> &light)
{
  Eigen::Vector2d sum(0, 0);
  for (int v = 0; v < light.rows; ++v) {
    for (int u = 0; u < light.cols; ++u) {
      sum += light(v, u) * Eigen::Vector2d(u, v);
    }
  }
  return sum / cv::sum(light)[0];
}

//! Mean square distance from the middle along u, px^2.
double width(const cv::Mat_<float> &light)
{
  const double middle = centroid(light).x();
  double sum = 0;
  for (int u = 0; u < light.cols; ++u) {
    sum += cv::sum(light.col(u))[0] * (u - middle) * (u - middle);
  }
  return sum / cv::sum(light)[0];
}
} // namespace

TEST(SecondImage, IsTheLampElsewhereAndDimmer)
{
  Pair pair;
  const cv::Mat_<float> image = pair.image(0.25, 0, false);
  pair.lamp().lamp.position += pair.shift;
  const cv::Mat_<float> moved = pair.fast() - pair.scene.ambient;
  EXPECT_GT(cv::norm(image, cv::NORM_INF), 30);
  EXPECT_LT(cv::norm(image, 0.25 * moved, cv::NORM_INF), 1e-4)
      << "the same pattern in the same phase on every row";
}

TEST(SecondImage, AMirrorTurnsThePattern)
{
  Pair pair;
  pair.lamp().lamp.modulation.kind = vpModulation::Kind::unmodulated;
  const double scale = 1250 / (1.5 - 0.19); // px per m
  const Eigen::Vector2d middle(31.4 + 0.02 * scale, 44.2 + 0.005 * scale);
  const Eigen::Vector2d plain = centroid(pair.image(1, 0, false)) - middle,
                        mirrored = centroid(pair.image(1, 0, true)) - middle;
  EXPECT_GT(plain.x(), 2);
  const Eigen::Vector2d normal = pair.shift.head<2>().normalized();
  const Eigen::Vector2d expected = plain - 2 * normal.dot(plain) * normal;
  EXPECT_LT((mirrored - expected).norm(), 0.02);
}

//! Of a pattern without a symmetry of its own, on a turned square.
TEST(SecondImage, AMirrorOfAMirrorIsTheLamp)
{
  vpSimulatedLamp lamp;
  lamp.lamp.yaw = 0.4;
  lamp.emission = vpEmission::hotSpot({0.5, 0.3}, 0.3, 0);
  const Eigen::Vector3d shift(0.3, -0.7, 0.1);
  const vpSimulatedLamp twice = lamp.image(shift, 0.5, 0, true).image(-shift, 2, 0, true);
  EXPECT_NEAR(std::remainder(twice.lamp.yaw - lamp.lamp.yaw, 2 * M_PI), 0, 1e-12);
  EXPECT_NEAR((twice.lamp.position - lamp.lamp.position).norm(), 0, 1e-12);
  EXPECT_EQ(twice.level, lamp.level);
  EXPECT_EQ(twice.emission.at({0.2, 0.6}), lamp.emission.at({0.2, 0.6}));
  vpExpectError([&] { lamp.image({0, 0, 1}, 0.5, 0, true); }, {"mirrored", "expected a shift in x or y"});
}

TEST(SecondImage, BlurAddsItsVariance)
{
  Pair pair;
  pair.lamp().lamp.modulation.kind = vpModulation::Kind::unmodulated;
  pair.lamp().lamp.size = 0.01;
  const double sharp = width(pair.image(1, 0, false)), soft = width(pair.image(1, 2, false));
  EXPECT_NEAR(soft - sharp, 4, 0.1);
  EXPECT_NEAR(cv::sum(pair.image(1, 2, false))[0] / cv::sum(pair.image(1, 0, false))[0], 1, 2e-3);
}

TEST(SecondImage, DoesNotGlowOnTheCeiling)
{
  Pair pair;
  pair.scene.ceilingShare = 0.1;
  pair.scene.ceilingRadius = 0.05;
  const cv::Mat_<float> image = pair.image(1, 0, false);
  EXPECT_LT(image(5, 5), 1e-3); // far from it
  EXPECT_GT(cv::norm(image, cv::NORM_INF), 100);
}

TEST(SecondImage, OfAScenarioFollowsTheTrueLamp)
{
  const simulatedRoom::Folder folder;
  const vpScenario scenario = folder.load(
      head + frames + still +
      "draw: {lamp_shift_m: 0.01}\ntruth: {lamps: [{id: B, shift_m: [0.1, 0, 0], level: 100, dark: [{from_s: "
      "5}]}], second_images: [{lamp: B, shift_m: [0.1, 0.2, 0.3], share: 0.2, blur_px: 1, mirrored: true}, "
      "{lamp: A, shift_m: [0, 0, 0.3], share: 0.1}]}\n");
  const vpSimulation simulation(scenario, 3);
  ASSERT_EQ(simulation.scene().lamps.size(), 2u);
  ASSERT_EQ(simulation.scene().images.size(), 2u);
  const vpSimulatedLamp &lamp = simulation.scene().lamps[1], &image = simulation.scene().images[0];
  EXPECT_LT((image.lamp.position - lamp.lamp.position - Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(image.level, 20);
  EXPECT_EQ(image.blur, 1);
  EXPECT_FALSE(image.glows);
  for (double time = 0; time < 6; time += 0.0123) {
    EXPECT_EQ(image.light.over(time, time + 50e-6).share, lamp.light.over(time, time + 50e-6).share);
  }
  EXPECT_EQ(simulation.scene().images[1].blur, 0);
}
