/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// A real GigE Vision camera, in software: stripes of the simulator over loopback.

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include <visp3/vlp_core/vpHostTime.h>
#include <visp3/vlp_core/vpTrajectory.h>
#include <visp3/vlp_sensor/vpCameraSource.h>
#include <visp3/vlp_simulation/vpScenario.h>
#include <visp3/vlp_simulation/vpSimulation.h>

#include "cameras/vpFakeGvCamera.h"
#include "common/vpExpectError.h"
#include "common/vpExpectLost.h"
#include "common/vpProcess.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
const std::string serial = "VLP1", uri = "aravis://Aravis-Fake-" + serial;

//! Its grey is 100 for an exposure of 1 ms at gain 0, and 10 more for each of gain.
const vpImage<unsigned char> &plain(unsigned int, double exposure, double gain)
{
  static vpImage<unsigned char> I;
  I.resize(64, 64);
  I = static_cast<unsigned char>(std::min(255., 100e3 * exposure + 10 * gain));
  return I;
}

vpCameraSettings settings(unsigned int width, unsigned int height, double exposure)
{
  vpCameraSettings asked;
  asked.region = vpCameraRegion{0, 0, width, height};
  asked.exposure = exposure;
  asked.frameRate = 12;
  return asked;
}
} // namespace

TEST(AravisCamera, ExposureAndGainAreSetAndReadBackAndChangeThePicture)
{
  const vpFakeGvCamera fake(serial, plain);
  vpCameraSource camera(uri, settings(64, 64, 1e-3));
  vpVlpFrame frame;
  auto grey = [&] { // of a frame that was exposed after the settings changed
    for (int k = 0; k < 3; ++k) {
      EXPECT_TRUE(camera.next(frame));
    }
    return frame.I[32][32];
  };
  EXPECT_EQ(grey(), 100);
  EXPECT_EQ(frame.I.getWidth(), 64u);
  EXPECT_EQ(frame.I.getHeight(), 64u);
  vpCameraSettings change;
  change.exposure = 0.5e-3;
  change.gain = 3;
  camera.set(change);
  EXPECT_DOUBLE_EQ(*camera.settings().exposure, 0.5e-3);
  EXPECT_DOUBLE_EQ(*camera.settings().gain, 3);
  EXPECT_EQ(grey(), 80);
  change.gain = 1000;
  vpExpectError([&] { camera.set(change); }, {"gain: 1000", "expected 0 to 10"});
}

TEST(AravisCamera, FramesComeAtTheirRateWithRisingTimesOnTheHostsClock)
{
  const vpFakeGvCamera fake(serial, plain);
  vpCameraSource camera(uri, settings(64, 64, 1e-3));
  vpVlpFrame frame;
  std::vector<double> times;
  for (int k = 0; k < 13; ++k) {
    ASSERT_TRUE(camera.next(frame));
    const double now = vpHostTime();
    EXPECT_LE(frame.timestamp, now);
    EXPECT_GT(frame.timestamp, now - 0.5);
    EXPECT_TRUE(times.empty() || frame.timestamp > times.back());
    times.push_back(frame.timestamp);
  }
  EXPECT_NEAR(times.back() - times.front(), 1.0, 0.35); // 12 periods and what a busy machine adds
}

TEST(AravisCamera, WhatNobodyTakesIsCounted)
{
  const vpFakeGvCamera fake(serial, plain);
  vpCameraSettings fast = settings(64, 64, 1e-3);
  fast.frameRate = 50;
  vpCameraSource camera(uri, fast);
  vpVlpFrame frame;
  ASSERT_TRUE(camera.next(frame));
  std::this_thread::sleep_for(std::chrono::milliseconds(800)); // 40 frames, room for 6
  for (int k = 0; k < 10; ++k) {
    ASSERT_TRUE(camera.next(frame));
  }
  EXPECT_GE(camera.counters().late, 4u);
  EXPECT_GE(camera.counters().dropped, 10u);
  EXPECT_EQ(camera.counters().delivered, 11u);
  EXPECT_LE(camera.counters().broken, 1u) << "only the frame that was arriving when there was room again";
  EXPECT_NE(camera.remark().find("dropped"), std::string::npos);
}

TEST(AravisCamera, ComesBackByItselfAfterFiveSeconds)
{
  auto fake = std::make_unique<vpFakeGvCamera>(serial, plain);
  vpCameraSource camera(uri, settings(64, 64, 0.7e-3));
  vpVlpFrame frame;
  ASSERT_TRUE(camera.next(frame));
  const double before = frame.timestamp;
  fake.reset();
  vpExpectLost(camera, uri);
  std::thread repair([&fake] {
    std::this_thread::sleep_for(std::chrono::seconds(5));
    fake = std::make_unique<vpFakeGvCamera>(serial, plain);
  });
  ASSERT_TRUE(camera.next(frame));
  repair.join();
  EXPECT_EQ(camera.counters().reconnects, 1u);
  EXPECT_GT(frame.timestamp, before + 5);
  for (int k = 0; k < 3; ++k) {
    ASSERT_TRUE(camera.next(frame));
  }
  EXPECT_EQ(frame.I[32][32], 70) << "the settings are in force again";
}

TEST(AravisCamera, NoSuchCamera)
{
  vpCameraPatience patience;
  patience.opening = 0.5;
  vpExpectError([&] { vpCameraSource("aravis://nobody", {}, patience); }, {"aravis://nobody: "});
}

TEST(AravisCamera, RegionBeyondTheSensor)
{
  const vpFakeGvCamera fake(serial, plain);
  vpExpectError([&] { vpCameraSource(uri, settings(4096, 64, 1e-3)); },
                {uri, "region: 4096 x 64", "2048 x 2048"});
}

TEST(AravisCamera, IsListedWithWhatItCanDo)
{
  const vpFakeGvCamera fake(serial, plain);
  std::vector<std::string> missing;
  const std::vector<vpCameraDescription> cameras = vpCameraSource::list(missing);
  const auto found = std::find_if(cameras.begin(), cameras.end(),
                                  [](const vpCameraDescription &camera) { return camera.uri == uri; });
  ASSERT_NE(found, cameras.end());
  EXPECT_NE(found->abilities.find("exposure"), std::string::npos) << found->abilities;
}

class VlpLocateLive : public testing::TestWithParam<const char *>
{
};

TEST_P(VlpLocateLive, GivesPosesFromACamera)
{
  // The scene's first pictures of the whole sensor, over and over: a robot that as good as stands.
  const std::string data = VLP_DATA_DIR;
  vpSimulation simulation(vpScenario::load(data + "/scenarios/paper-e.yaml"), 1);
  std::vector<vpImage<unsigned char>> pictures;
  vpVlpFrame frame;
  while (pictures.size() < 4 && simulation.next(frame)) {
    pictures.push_back(frame.I);
  }
  const vpFakeGvCamera fake(serial,
                            [&pictures](unsigned int k, double, double) -> const vpImage<unsigned char> & {
                              return pictures[k % pictures.size()];
                            });
  const vpTemporaryFolder folder;
  vpProcess locate("vlp-locate",
                   {"--rig", data + "/rigs/" + GetParam(), "--lamps", data + "/lamps/paper.yaml", "--camera",
                    uri, "--camera-rate", "4", "--frames", "8", "--poses", folder / "poses.tum"});
  ASSERT_EQ(locate.wait(), 0) << locate.err();
  EXPECT_NE(locate.err().find("exposed for"), std::string::npos) << locate.err();
  const vpHomogeneousMatrix truth = simulation.wMb(0.15);
  const vpTrajectory poses = vpTrajectory::load(folder / "poses.tum");
  EXPECT_GE(poses.size(), 6u);
  for (const vpTimedPose &pose : poses.poses()) {
    EXPECT_LT((pose.wMb.getTranslationVector() - truth.getTranslationVector()).frobeniusNorm(), 0.003);
  }
}

// The camera gives the same pictures; for the first rig the program makes them smaller, as the rig says.
INSTANTIATE_TEST_SUITE_P(Rigs, VlpLocateLive, testing::Values("ub300-800x600.yaml", "ub300-2048x1536.yaml"));
