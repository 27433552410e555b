/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <chrono>
#include <thread>

#include <gtest/gtest.h>
#include <visp3/vlp_core/vpHostTime.h>
#include <visp3/vlp_sensor/vpCameraSource.h>

#include "common/vpExpectError.h"
#include "common/vpExpectLost.h"
#include "usb/vpEmulatedUvcCamera.h"

namespace
{
const std::string uri = "uvc://1bcf:2b8a";

vpCameraSettings settings(double exposure, double gain)
{
  vpCameraSettings asked;
  asked.exposure = exposure;
  asked.gain = gain;
  asked.region = vpCameraRegion{0, 0, vpEmulatedUvcCamera::width, vpEmulatedUvcCamera::height};
  return asked;
}

struct UvcCamera : testing::Test {
  vpEmulatedUvcCamera usb{"CAM7"};
};
} // namespace

TEST_F(UvcCamera, IsListedWithItsSerialNumber)
{
  usb.plug(9);
  std::vector<std::string> missing;
  bool found = false;
  for (const vpCameraDescription &camera : vpCameraSource::list(missing)) {
    found = found || camera.uri == uri + "/CAM7";
  }
  EXPECT_TRUE(found);
}

TEST_F(UvcCamera, TakesPicturesWithTheExposureAndGainThatAreAskedFor)
{
  usb.plug(9);
  vpCameraSource camera(uri + "/CAM7", settings(3e-3, 20));
  vpVlpFrame frame;
  ASSERT_TRUE(camera.next(frame));
  EXPECT_EQ(frame.I.getWidth(), vpEmulatedUvcCamera::width);
  EXPECT_EQ(frame.I.getHeight(), vpEmulatedUvcCamera::height);
  EXPECT_EQ(usb.state().aeMode, 1u) << "manual";
  EXPECT_EQ(frame.I[1][5], 30) << "units of 0.1 ms";
  EXPECT_EQ(frame.I[2][63], 20);
  EXPECT_EQ(frame.I[47][63], 100);
  EXPECT_DOUBLE_EQ(*camera.settings().exposure, 3e-3);
  EXPECT_DOUBLE_EQ(*camera.settings().gain, 20);
  EXPECT_DOUBLE_EQ(*camera.settings().frameRate, vpEmulatedUvcCamera::rate);

  vpCameraSettings change;
  change.exposure = 12e-3;
  change.gain = 60;
  camera.set(change);
  for (int k = 0; k < 5; ++k) { // those on their way
    ASSERT_TRUE(camera.next(frame));
  }
  EXPECT_EQ(frame.I[1][5], 120);
  EXPECT_EQ(frame.I[2][5], 60);
}

TEST_F(UvcCamera, WhatItCannotDoIsRefusedByName)
{
  usb.plug(9);
  vpExpectError([] { vpCameraSource(uri, settings(0.1, 20)); },
                {uri, "exposure: 0.1 s, expected 0.0001 to 0.02"});
  vpExpectError([] { vpCameraSource(uri, settings(1e-3, 65)); }, {uri, "gain: 65, expected 0 to 64"});
  vpCameraSettings large = settings(1e-3, 20);
  large.region = vpCameraRegion{0, 0, 640, 480};
  vpExpectError([&] { vpCameraSource(uri, large); }, {uri, "640 x 480", "GRAY8"});
  vpCameraPatience patience;
  patience.opening = 0;
  vpExpectError([&] { vpCameraSource(uri + "/CAM8", settings(1e-3, 20), patience); },
                {uri + "/CAM8", "no such camera"});
}

TEST_F(UvcCamera, FramesComeOnceEachWithRisingTimes)
{
  usb.plug(9);
  vpCameraSource camera(uri, settings(1e-3, 20));
  vpVlpFrame frame;
  double before = 0;
  int number = -1;
  for (int k = 0; k < 40; ++k) {
    ASSERT_TRUE(camera.next(frame));
    const double now = vpHostTime();
    EXPECT_LE(frame.timestamp, now);
    EXPECT_GT(frame.timestamp, now - 0.5);
    EXPECT_GT(frame.timestamp, before);
    EXPECT_GT(frame.I[0][0], number);
    before = frame.timestamp;
    number = frame.I[0][0];
  }
  EXPECT_EQ(camera.counters().delivered, 40u);
  EXPECT_EQ(camera.counters().broken, 0u);
}

// libuvc's own wait locks itself out where it times out.
TEST_F(UvcCamera, ALongPauseIsWaitedOut)
{
  usb.plug(9);
  vpCameraSource camera(uri, settings(1e-3, 20));
  vpVlpFrame frame;
  for (int k = 0; k < 3; ++k) {
    ASSERT_TRUE(camera.next(frame));
    vpEmulatedUvcCamera::State state = usb.state();
    state.pause = 0.3; // s: six frames, a third of what it waits for
    usb.setState(state);
  }
  EXPECT_EQ(camera.counters().reconnects, 0u);
}

TEST_F(UvcCamera, LateAndBrokenFramesAreCountedAndNotHandedOn)
{
  usb.plug(9);
  vpCameraSource camera(uri, settings(1e-3, 20));
  vpVlpFrame frame;
  ASSERT_TRUE(camera.next(frame));
  std::this_thread::sleep_for(std::chrono::milliseconds(400)); // 20 frames
  ASSERT_TRUE(camera.next(frame));
  ASSERT_TRUE(camera.next(frame));
  EXPECT_GE(camera.counters().late, 10u);
  vpEmulatedUvcCamera::State state = usb.state();
  state.shortFrame = true;
  usb.setState(state);
  for (int k = 0; k < 5; ++k) {
    ASSERT_TRUE(camera.next(frame));
    EXPECT_EQ(frame.I[47][63], 100);
  }
  EXPECT_EQ(camera.counters().broken, 1u);
}

TEST_F(UvcCamera, ComesBackByItselfWithItsSettings)
{
  usb.plug(9);
  vpCameraSource camera(uri, settings(3e-3, 20));
  vpVlpFrame frame;
  ASSERT_TRUE(camera.next(frame));
  usb.unplug();
  vpExpectLost(camera, uri);
  std::thread repair([this] {
    std::this_thread::sleep_for(std::chrono::seconds(2));
    usb.plug(10);
  });
  ASSERT_TRUE(camera.next(frame));
  repair.join();
  EXPECT_EQ(camera.counters().reconnects, 1u);
  EXPECT_EQ(frame.I[1][5], 30);
  EXPECT_EQ(frame.I[2][5], 20);
}
