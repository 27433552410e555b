/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What a scenario says of emission patterns, second images and phones.

#include <gtest/gtest.h>
#include <visp3/vlp_simulation/vpSimulation.h>

#include "common/vpExpectError.h"
#include "simulatedRoom.h"

namespace
{
using simulatedRoom::frames;
using simulatedRoom::head;
using simulatedRoom::still;

const std::string good = head + frames + still; // what follows is on line 5
const std::string square =
    "lamps:\n"
    "  - {id: A, position_m: [-0.3, -0.2, 1.5], shape: square, size_m: 0.3, frequency_hz: 1000}\n"
    "  - {id: B, position_m: [0.3, 0.2, 1.5], diameter_m: 0.3, frequency_hz: 1600, duty: 0.4}\n";

struct Bad {
  std::string text;
  std::string message;
};

void expectRefused(const std::vector<Bad> &all)
{
  for (const Bad &bad : all) {
    SCOPED_TRACE(bad.text);
    const simulatedRoom::Folder folder;
    vpExpectError([&] { folder.load(good + bad.text); }, {"scenario.yaml", bad.message});
  }
}
} // namespace

TEST(ScenarioLuminaires, EmissionOfAllLampsOfOneAndOfOthers)
{
  const simulatedRoom::Folder folder;
  const vpScenario scenario = folder.load(
      good +
      "light: {emission: {type: hot_spot, place: [0.1, 0.2], width: 0.3, rest: 0.4}}\n"
      "truth: {lamps: [{id: B, emission: {type: even}}], more_lamps: [{id: C, position_m: [0, 0, 2], "
      "diameter_m: "
      "0.1, unmodulated: true, emission: {type: dome, rim: 0.2, power: 2}}, {id: D, position_m: [1, 0, 2], "
      "diameter_m: 0.1, unmodulated: true}]}\n");
  ASSERT_EQ(scenario.lamps.size(), 4u);
  const Eigen::Vector2d place(0.6, 0);
  const double spot = vpEmission::hotSpot({0.1, 0.2}, 0.3, 0.4).at(place);
  EXPECT_EQ(scenario.lamps[0].simulated.emission.at(place), spot);
  EXPECT_TRUE(scenario.lamps[1].simulated.emission.even());
  EXPECT_EQ(scenario.lamps[2].simulated.emission.at(place), vpEmission::dome(0.2, 2).at(place));
  EXPECT_EQ(scenario.lamps[3].simulated.emission.at(place), spot);
}

TEST(ScenarioLuminaires, EachTypeIsRead)
{
  const simulatedRoom::Folder folder;
  folder.write("lamps.yaml", square);
  const auto emission = [&](const std::string &text) {
    return folder.load(good + "truth: {lamps: [{id: A, emission: {type: " + text + "}}]}\n")
        .lamps[0]
        .simulated.emission;
  };
  const Eigen::Vector2d place(0.53, -0.21);
  EXPECT_EQ(emission("ring_of_dies, dies: 7, radius: 0.5, width: 0.2, rest: 0.1").at(place),
            vpEmission::ringOfDies(7, 0.5, 0.2, 0.1).at(place));
  EXPECT_EQ(emission("grid_of_dies, across: 3, width: 0.2, rest: 0.1").at(place),
            vpEmission::gridOfDies(3, 0.2, 0.1).at(place));
  EXPECT_EQ(emission("edge_lit, depth: 0.3, rest: 0.2, other: 0.5").at(place),
            vpEmission::edgeLit(0.3, 0.2, 0.5).at(place));
  EXPECT_EQ(emission("cracked, patches: 9, spread: 0.8, seed: 4").at(place),
            vpEmission::cracked(9, 0.8, 4).at(place));
  EXPECT_EQ(emission("tube, width: 0.1").strip(), 0.1);
}

TEST(ScenarioLuminaires, PhonesKeysAreRead)
{
  const simulatedRoom::Folder folder;
  const vpSimulatedCamera camera =
      folder
          .load(good + "camera: {hand_blur_px: 1.5, chroma_noise: 2, clipped_channels: 0.1, tone_curve: 2.2, "
                       "sharpening: 0.7, jpeg_quality: 85}\n")
          .camera;
  EXPECT_EQ(camera.handBlur, 1.5);
  EXPECT_EQ(camera.chromaNoise, 2);
  EXPECT_EQ(camera.clippedChannels, 0.1);
  EXPECT_EQ(camera.toneCurve, 2.2);
  EXPECT_EQ(camera.sharpening, 0.7);
  EXPECT_EQ(camera.jpegQuality, 85);
}

TEST(ScenarioLuminaires, WhatIsLeftOutLeavesEveryByte)
{
  const simulatedRoom::Folder folder;
  vpVlpFrame plain, spelt;
  vpSimulation(folder.load(good + "light: {rim: 0.3}\n"), 1).next(plain);
  vpSimulation(folder.load(good + "light: {rim: 0.3, emission: {type: even}}\ncamera: {hand_blur_px: 0, "
                                  "chroma_noise: 0, clipped_channels: 0, tone_curve: 1, sharpening: 0, "
                                  "jpeg_quality: 0}\ntruth: {second_images: []}\n"),
               1)
      .next(spelt);
  EXPECT_TRUE(plain.I == spelt.I);
}

TEST(ScenarioLuminaires, BadEmissionsAreRefusedByName)
{
  const std::string all = "light: {emission: ", one = "truth: {lamps: [{id: A, emission: ";
  expectRefused({
      {all + "hot_spot}\n", ":5: light.emission: hot_spot, expected a mapping"},
      {all + "{width: 1}}\n", ":5: light.emission.type: missing, expected one of even, hot_spot"},
      {all + "{type: spot}}\n", ":5: light.emission.type: spot, expected one of even"},
      {all + "{type: even, rim: 0.1}}\n", ":5: light.emission.rim: unknown key"},
      {all + "{type: dome, rim: 0.1}}\n", ":5: light.emission.power: missing, expected a finite number"},
      {all + "{type: dome, rim: 0.1, power: 11}}\n",
       ":5: light.emission.power: 11, expected a number from 0 to 10"},
      {one + "{type: dome, rim: -1, power: 1}}]}\n",
       ":5: truth.lamps[0].emission.rim: -1, expected a number from 0 to 1"},
      {one + "{type: hot_spot, place: [1, 0.5], width: 0.2, rest: 0}}]}\n",
       ":5: truth.lamps[0].emission.place: 1, 0.5, expected a place within the unit circle"},
      {one + "{type: hot_spot, place: [0, 0], width: 0.001, rest: 0}}]}\n",
       "emission.width: 0.001, expected"},
      {one + "{type: hot_spot, place: [0, 0], width: 0.1, rest: 2}}]}\n", "emission.rest: 2, expected"},
      {one + "{type: ring_of_dies, dies: 101, radius: 0.5, width: 0.1, rest: 0}}]}\n",
       "emission.dies: 101, expected"},
      {one + "{type: ring_of_dies, dies: 5, radius: 0.99, width: 0.1, rest: 0}}]}\n",
       "emission.radius: 0.99, expected"},
      {one + "{type: grid_of_dies, across: 0, width: 0.1, rest: 0}}]}\n", "emission.across: 0, expected"},
      {one + "{type: edge_lit, depth: 0, rest: 0.1, other: 1}}]}\n", "emission.depth: 0, expected"},
      {one + "{type: edge_lit, depth: 1, rest: 0.1, other: 1.5}}]}\n", "emission.other: 1.5, expected"},
      {one + "{type: cracked, patches: 201, spread: 1, seed: 1}}]}\n", "emission.patches: 201, expected"},
      {one + "{type: cracked, patches: 20, spread: 5, seed: 1}}]}\n", "emission.spread: 5, expected"},
      {one + "{type: cracked, patches: 20, spread: 1, seed: -1}}]}\n", "emission.seed: -1, expected"},
      {one + "{type: tube, width: 0.1}}]}\n",
       ":2: lamps: lamp A is a disc with the emission of a tube, expected a square"},
      {one + "{type: tube, width: 2}}]}\n", "emission.width: 2, expected a number from 0.01 to 1"},
      {one + "{type: dome, rim: 0, power: 1}, rim: 0.1}]}\n",
       ":5: truth.lamps[0].rim: beside an emission that is not even"},
      {"truth: {more_lamps: [{id: C, position_m: [0, 0, 2], diameter_m: 0.1, unmodulated: true, emission: "
       "{type: dome, rim: 0, power: 99}}]}\n",
       ":5: truth.more_lamps[0].emission.power: 99, expected"},
  });
}

TEST(ScenarioLuminaires, BadSecondImagesAreRefusedByName)
{
  const std::string image = "truth: {second_images: [{";
  expectRefused({
      {image + "lamp: Z, shift_m: [1, 0, 0], share: 0.1}]}\n",
       ":5: truth.second_images[0].lamp: Z, expected a lamp of the map or of more_lamps"},
      {image + "lamp: A, share: 0.1}]}\n", ":5: truth.second_images[0].shift_m: missing"},
      {image + "lamp: A, shift_m: [1, 0, 0]}]}\n", ":5: truth.second_images[0].share: missing"},
      {image + "lamp: A, shift_m: [1, 0, 0], share: 1.5}]}\n", "share: 1.5, expected a number from 0 to 1"},
      {image + "lamp: A, shift_m: [1, 0, 0], share: 0.5, blur_px: -1}]}\n", "blur_px: -1, expected"},
      {image + "lamp: A, shift_m: [1e300, 0, 0], share: 0.5}]}\n",
       "shift_m: 1e+300, expected at most 10000 m"},
      {image + "lamp: A, shift_m: [0, 0, 1], share: 0.5, mirrored: true}]}\n",
       "shift_m: of a mirrored image straight above or below its lamp, expected a shift in x or y"},
      {image + "lamp: A, shift_m: [0, 0, -1.4], share: 0.5}]}\n",
       "second image of lamp A at a height of 0.1"},
      {image + "lamp: A, shift_m: [1, 0, 0], share: 0.5, mirror: true}]}\n", "mirror: unknown key"},
  });
}

TEST(ScenarioLuminaires, BadPhonesAreRefusedByName)
{
  expectRefused({
      {"camera: {tone_curve: 0}\n", ":5: camera.tone_curve: 0, expected a number from 0.2 to 5"},
      {"camera: {sharpening: 11}\n", ":5: camera.sharpening: 11, expected a number from 0 to 10"},
      {"camera: {chroma_noise: -1}\n", ":5: camera.chroma_noise: -1, expected a number from 0 to 255"},
      {"camera: {clipped_channels: 0.5}\n",
       ":5: camera.clipped_channels: 0.5, expected a number from 0 to 0.3"},
      {"camera: {hand_blur_px: 51}\n", ":5: camera.hand_blur_px: 51, expected a number from 0 to 50"},
      {"camera: {jpeg_quality: 101}\n",
       ":5: camera.jpeg_quality: 101, expected a whole number from 0 to 100"},
      {"camera: {jpeg_quality: 50.5}\n", ":5: camera.jpeg_quality: 50.5, expected a whole number"},
  });
}

TEST(ScenarioLuminaires, ShippedOneHasLampsOfManyKinds)
{
  const vpScenario scenario = vpScenario::load(VLP_DATA_DIR "/scenarios/luminaires.yaml");
  EXPECT_EQ(scenario.frames, 12u);
  EXPECT_EQ(scenario.lamps.size(), 7u);
  EXPECT_EQ(scenario.secondImages.size(), 1u);
  for (const vpScenario::Lamp &lamp : scenario.lamps) {
    EXPECT_FALSE(lamp.simulated.emission.even()) << lamp.simulated.lamp.id;
    for (const vpScenario::Lamp &other : scenario.lamps) {
      const double f = lamp.simulated.lamp.modulation.frequency,
                   g = other.simulated.lamp.modulation.frequency;
      EXPECT_TRUE(f == g || f > 1.1 * g || g > 1.1 * f) << f << " and " << g << " Hz";
    }
  }
  EXPECT_GT(vpScenario::load(VLP_DATA_DIR "/scenarios/luminaires-phone.yaml").camera.toneCurve, 1);
}
