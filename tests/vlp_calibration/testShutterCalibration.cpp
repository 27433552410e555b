/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>

#include <gtest/gtest.h>
#include <visp3/vlp_calibration/vpShutterCalibration.h>
#include <visp3/vlp_simulation/vpSimulation.h>

#include "common/vpExpectError.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
//! The paper's room, its row time 3 % off what the rig says.
vpSimulation simulation(std::uint64_t seed)
{
  vpScenario scenario = vpScenario::load("data/scenarios/spin.yaml");
  scenario.deviation.rowTime = 1.03;
  scenario.frames = 10;
  return vpSimulation(scenario, seed);
}

//! What its frames tell where the rig states no row time.
vpShutterEstimate withoutRowTime(vpSimulation &world)
{
  vpVlpRig rig = world.rig();
  rig.shutter.rowTime = 0;
  vpShutterCalibration calibration(rig, world.map());
  for (vpVlpFrame frame; world.next(frame);) {
    calibration.add(frame);
  }
  return calibration.solve();
}

vpImage<unsigned char> transposed(const vpImage<unsigned char> &I)
{
  vpImage<unsigned char> turned(I.getWidth(), I.getHeight());
  for (unsigned int v = 0; v < I.getHeight(); ++v) {
    for (unsigned int u = 0; u < I.getWidth(); ++u) {
      turned[u][v] = I[v][u];
    }
  }
  return turned;
}

TEST(ShutterCalibration, TenFramesTellARowTimeThatNobodyKnows)
{
  vpSimulation world = simulation(5);
  const vpShutterEstimate found = withoutRowTime(world);
  ASSERT_TRUE(found.valid) << found.refusal;
  const double truth = world.camera().rig.shutter.rowTime;
  EXPECT_FALSE(found.alongColumns);
  EXPECT_LT(std::abs(found.rowTime / truth - 1), 3e-4); // three times the median that is asked for
  EXPECT_LT(std::abs(found.rowTime - truth), 4 * found.rowTimeSigma);
  EXPECT_LT(found.rowTimeSigma, 2e-4 * truth);
  EXPECT_NEAR(found.exposure, world.camera().rig.shutter.exposure, 0.05 * truth);
}

// In one of these frames the border cuts a lamp, whose frequency is 2 % off, and as uncertain.
TEST(ShutterCalibration, ALampThatTheBorderCutsIsNoWitnessOfAnotherRowTime)
{
  vpScenario scenario = vpScenario::load("data/scenarios/spin.yaml");
  scenario.draw.rowTime = 0.01;
  scenario.frames = 10;
  vpSimulation world(scenario, 40);
  const vpShutterEstimate found = withoutRowTime(world);
  ASSERT_TRUE(found.valid) << found.refusal;
  EXPECT_LT(std::abs(found.rowTime - world.camera().rig.shutter.rowTime), 4 * found.rowTimeSigma);
}

TEST(ShutterCalibration, ColumnsAreFoundByThemselves)
{
  vpSimulation world = simulation(6);
  vpVlpRig rig = world.rig();
  std::swap(rig.width, rig.height);
  std::swap(rig.resize.sourceWidth, rig.resize.sourceHeight);
  vpShutterCalibration calibration(rig, world.map()); // which says rows
  vpVlpFrame frame;
  for (int i = 0; i < 3 && world.next(frame); ++i) {
    frame.I = transposed(frame.I);
    calibration.add(frame);
  }
  const vpShutterEstimate found = calibration.solve();
  ASSERT_TRUE(found.valid) << found.refusal;
  EXPECT_TRUE(found.alongColumns);
  EXPECT_NEAR(found.rowTime / world.camera().rig.shutter.rowTime, 1, 1e-3);
}

TEST(ShutterCalibration, SaysWhereThereAreNoStripes)
{
  vpLamp lamp;
  lamp.id = "A";
  lamp.modulation.kind = vpModulation::Kind::pwm;
  lamp.modulation.frequency = 1000;
  vpShutterCalibration calibration(vpVlpRig(), vpLampMap{{lamp}});
  vpVlpFrame frame;
  frame.I.resize(100, 120, 20);
  calibration.add(frame);
  const vpShutterEstimate found = calibration.solve();
  EXPECT_FALSE(found.valid);
  EXPECT_NE(found.refusal.find("no stripes"), std::string::npos) << found.refusal;
}

//! From two frames of a world, with what the rig states of it.
vpShutterEstimate fromTwoFrames(vpSimulation &world, const vpVlpRig &rig, const vpLampMap &map)
{
  vpShutterCalibration calibration(rig, map);
  vpVlpFrame frame;
  for (int i = 0; i < 2 && world.next(frame); ++i) {
    calibration.add(frame);
  }
  return calibration.solve();
}

// Two lamps on, and one frequency said of both.
TEST(ShutterCalibration, LampsOfOtherFrequenciesAreNoWitnesses)
{
  vpSimulation world = simulation(2);
  vpLampMap one = world.map();
  one.lamps.resize(1);
  const vpShutterEstimate found = fromTwoFrames(world, world.rig(), one);
  EXPECT_FALSE(found.valid);
  EXPECT_NE(found.refusal.find("--lamps"), std::string::npos) << found.refusal;
}

TEST(ShutterCalibration, ARowTimeThatNoCameraHasIsRefused)
{
  vpSimulation world = simulation(2);
  vpLampMap quick = world.map();
  for (vpLamp &lamp : quick.lamps) {
    lamp.modulation.frequency *= 1e6;
  }
  vpVlpRig rig = world.rig();
  rig.shutter.rowTime *= 1e-6;
  const vpShutterEstimate found = fromTwoFrames(world, rig, quick);
  EXPECT_FALSE(found.valid);
  EXPECT_NE(found.refusal.find("expected 1e-07 to 0.01 s"), std::string::npos) << found.refusal;
}

// Each of two lamps says another row time: a vague guess does not choose.
TEST(ShutterCalibration, OneWrongFrequencyOfTwoIsRefused)
{
  vpSimulation world = simulation(2);
  vpLampMap wrong = world.map();
  wrong.lamps.resize(2);
  wrong.lamps[1].modulation.frequency *= 1.07;
  vpVlpRig rig = world.rig();
  rig.shutter.rowTimeSigma = 0.2 * rig.shutter.rowTime;
  const vpShutterEstimate found = fromTwoFrames(world, rig, wrong);
  EXPECT_FALSE(found.valid);
  EXPECT_NE(found.refusal.find("frequency_hz"), std::string::npos) << found.refusal;
}

TEST(ShutterCalibration, NeedsALampOfKnownFrequency)
{
  vpLamp lamp;
  lamp.id = "A";
  vpExpectError([&] { vpShutterCalibration(vpVlpRig(), vpLampMap{{lamp}}); }, {"lamps", "frequency_hz"});
}
} // namespace
