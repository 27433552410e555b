/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// MindVision's cameras over an SDK of our own in the place of the maker's.

#include <cstdlib>

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <visp3/vlp_sensor/vpCameraSource.h>

#include "common/vpExpectError.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
template <class Function>
Function *sdk(const char *name)
{
  return reinterpret_cast<Function *>(dlsym(dlopen(VLP_FAKE_MVSDK, RTLD_NOW), name));
}
} // namespace

TEST(MindVisionCamera, StartsInThePapersOrderAndTellsWhenItIsGone)
{
  setenv("VLP_MVSDK_LIBRARY", VLP_FAKE_MVSDK, 1);
  {
    vpCameraSettings asked;
    asked.exposure = 215e-6;
    asked.gain = 100;
    asked.region = vpCameraRegion{8, 4, 32, 24};
    vpCameraSource camera("mindvision://", asked);
    vpVlpFrame frame;
    ASSERT_TRUE(camera.next(frame));
    const double first = frame.timestamp;
    ASSERT_TRUE(camera.next(frame));
    EXPECT_NEAR(frame.timestamp - first, 0.01, 1e-4) << "by the camera's clock";
    EXPECT_EQ(frame.I.getWidth(), 32u);
    EXPECT_EQ(frame.I.getHeight(), 24u);
    EXPECT_EQ(frame.I[5][5], 20) << "exposure in whole lines";
    EXPECT_DOUBLE_EQ(*camera.settings().exposure, 200e-6);
    EXPECT_EQ(*camera.settings().gain, 100);
    EXPECT_EQ(camera.settings().region->left, 8u);
    sdk<void()>("FakeSdkUnplug")();
    vpExpectError([&] { camera.next(frame); }, {"mindvision://: the camera is gone", "-4"});
  }
  EXPECT_STREQ(sdk<const char *()>("FakeSdkCalls")(),
               "SdkInit Init Play AeOff AnalogGain ExposureTime Monochrome "
               "FrameSpeed ImageResolution Mono8 UnInit");
}

TEST(MindVisionCamera, WithoutTheSdkSaysWhatIsMissing)
{
  setenv("VLP_MVSDK_LIBRARY", "/no/libMVSDK.so", 1);
  vpCameraPatience patience;
  patience.opening = 0;
  vpExpectError([&] { vpCameraSource("mindvision://", {}, patience); },
                {"mindvision://: /no/libMVSDK.so: cannot be loaded", "MindVision's SDK"});
  std::vector<std::string> missing;
  vpCameraSource::list(missing);
  EXPECT_FALSE(missing.empty());
}

TEST(MindVisionCamera, AnotherSerialNumber)
{
  setenv("VLP_MVSDK_LIBRARY", VLP_FAKE_MVSDK, 1);
  vpCameraPatience patience;
  patience.opening = 0;
  vpExpectError([&] { vpCameraSource("mindvision://4567", {}, patience); },
                {"mindvision://4567: no such camera"});
}
