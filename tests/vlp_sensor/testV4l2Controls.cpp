/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The control layer of V4L2 cameras, over a kernel of our own.

#include <cerrno>
#include <map>

#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <visp3/vlp_sensor/vpV4l2Device.h>

#include "common/vpExpectError.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
struct Control {
  int minimum, maximum, step, value;
};

//! Keeps controls as uvcvideo does: what is out of range is refused, exposure cannot be set while automatic.
class FakeKernel : public vpV4l2Device
{
public:
  std::map<std::uint32_t, Control> controls;
  std::vector<int> exposureModes = {V4L2_EXPOSURE_MANUAL, V4L2_EXPOSURE_APERTURE_PRIORITY};
  bool hasFrameRate = true;
  v4l2_fract timePerFrame = {1, 30};

  int control(unsigned long request, void *argument) override
  {
    switch (request) {
    case VIDIOC_QUERYCTRL:
      return query(*static_cast<v4l2_queryctrl *>(argument));
    case VIDIOC_QUERYMENU: {
      const auto &menu = *static_cast<v4l2_querymenu *>(argument);
      return std::count(exposureModes.begin(), exposureModes.end(), static_cast<int>(menu.index)) > 0
                 ? 0
                 : EINVAL;
    }
    case VIDIOC_G_CTRL:
      return get(*static_cast<v4l2_control *>(argument));
    case VIDIOC_S_CTRL:
      return set(*static_cast<v4l2_control *>(argument));
    case VIDIOC_G_PARM:
    case VIDIOC_S_PARM:
      return parameters(request == VIDIOC_S_PARM, static_cast<v4l2_streamparm *>(argument)->parm.capture);
    default:
      return ENOTTY;
    }
  }

private:
  int query(v4l2_queryctrl &asked) const
  {
    const auto at = controls.find(asked.id);
    if (at == controls.end()) {
      return EINVAL;
    }
    asked.minimum = at->second.minimum;
    asked.maximum = at->second.maximum;
    asked.step = at->second.step;
    return 0;
  }
  int get(v4l2_control &asked) const
  {
    const auto at = controls.find(asked.id);
    asked.value = at == controls.end() ? 0 : at->second.value;
    return at == controls.end() ? EINVAL : 0;
  }
  int set(const v4l2_control &asked)
  {
    const auto at = controls.find(asked.id);
    if (at == controls.end()) {
      return EINVAL;
    }
    const bool held = asked.id == V4L2_CID_EXPOSURE_ABSOLUTE && controls.count(V4L2_CID_EXPOSURE_AUTO) > 0 &&
                      controls[V4L2_CID_EXPOSURE_AUTO].value != V4L2_EXPOSURE_MANUAL &&
                      controls[V4L2_CID_EXPOSURE_AUTO].value != V4L2_EXPOSURE_SHUTTER_PRIORITY;
    const Control &control = at->second;
    if (held || asked.value < control.minimum || asked.value > control.maximum ||
        (asked.value - control.minimum) % control.step != 0) {
      return held ? EACCES : ERANGE;
    }
    at->second.value = asked.value;
    return 0;
  }
  int parameters(bool set, v4l2_captureparm &capture)
  {
    if (set) {
      timePerFrame = capture.timeperframe;
    }
    capture.capability = hasFrameRate ? V4L2_CAP_TIMEPERFRAME : 0;
    capture.timeperframe = timePerFrame;
    return 0;
  }
};

FakeKernel webcam()
{
  FakeKernel kernel;
  kernel.controls[V4L2_CID_EXPOSURE_AUTO] = {0, 3, 1, V4L2_EXPOSURE_APERTURE_PRIORITY};
  kernel.controls[V4L2_CID_EXPOSURE_AUTO_PRIORITY] = {0, 1, 1, 1};
  kernel.controls[V4L2_CID_EXPOSURE_ABSOLUTE] = {3, 2047, 1, 250};
  kernel.controls[V4L2_CID_GAIN] = {0, 255, 5, 100};
  return kernel;
}
} // namespace

TEST(V4l2Controls, ExposureIsSetToTheNearestUnitWithAllAutomatismsOff)
{
  FakeKernel kernel = webcam();
  vpCameraSettings asked;
  asked.exposure = 0.00213;
  asked.gain = 52;
  asked.frameRate = 12.5;
  vpV4l2Controls::set(kernel, asked);
  EXPECT_EQ(kernel.controls[V4L2_CID_EXPOSURE_AUTO].value, V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(kernel.controls[V4L2_CID_EXPOSURE_AUTO_PRIORITY].value, 0);
  EXPECT_EQ(kernel.controls[V4L2_CID_EXPOSURE_ABSOLUTE].value, 21);
  EXPECT_EQ(kernel.controls[V4L2_CID_GAIN].value, 50) << "steps of 5";
  const vpCameraSettings now = vpV4l2Controls::get(kernel);
  EXPECT_DOUBLE_EQ(*now.exposure, 0.0021);
  EXPECT_DOUBLE_EQ(*now.gain, 50);
  EXPECT_DOUBLE_EQ(*now.frameRate, 12.5);
}

TEST(V4l2Controls, WhatIsLeftOutStays)
{
  FakeKernel kernel = webcam();
  vpV4l2Controls::set(kernel, {});
  EXPECT_EQ(kernel.controls[V4L2_CID_EXPOSURE_ABSOLUTE].value, 250);
  EXPECT_EQ(kernel.controls[V4L2_CID_GAIN].value, 100);
  EXPECT_EQ(kernel.controls[V4L2_CID_EXPOSURE_AUTO].value, V4L2_EXPOSURE_MANUAL) << "never automatic";
}

TEST(V4l2Controls, ACameraWithoutManualModeTakesShutterPriority)
{
  FakeKernel kernel = webcam();
  kernel.exposureModes = {V4L2_EXPOSURE_AUTO, V4L2_EXPOSURE_SHUTTER_PRIORITY};
  vpCameraSettings asked;
  asked.exposure = 0.001;
  vpV4l2Controls::set(kernel, asked);
  EXPECT_EQ(kernel.controls[V4L2_CID_EXPOSURE_AUTO].value, V4L2_EXPOSURE_SHUTTER_PRIORITY);
  EXPECT_EQ(kernel.controls[V4L2_CID_EXPOSURE_ABSOLUTE].value, 10);
}

TEST(V4l2Controls, AGainBesideTheSensorsWillDo)
{
  FakeKernel kernel;
  kernel.controls[V4L2_CID_ANALOGUE_GAIN] = {16, 64, 1, 16};
  vpCameraSettings asked;
  asked.gain = 20;
  vpV4l2Controls::set(kernel, asked);
  EXPECT_EQ(kernel.controls[V4L2_CID_ANALOGUE_GAIN].value, 20);
  EXPECT_EQ(*vpV4l2Controls::get(kernel).gain, 20);
  EXPECT_FALSE(vpV4l2Controls::get(kernel).exposure);
}

TEST(V4l2Controls, RefusesWhatTheCameraCannotDo)
{
  FakeKernel kernel = webcam();
  auto set = [&kernel](double exposure, double gain) {
    return [&kernel, exposure, gain] {
      vpCameraSettings asked;
      asked.exposure = exposure;
      asked.gain = gain;
      vpV4l2Controls::set(kernel, asked);
    };
  };
  vpExpectError(set(50e-6, 10), {"exposure: 5e-05 s", "0.0003 to 0.2047"});
  vpExpectError(set(1e9, 10), {"exposure: 1e+09 s"});
  vpExpectError(set(1e-3, 256), {"gain: 256", "0 to 255"});
  kernel.controls.erase(V4L2_CID_GAIN);
  vpExpectError(set(1e-3, 10), {"gain: this camera has none"});
  vpCameraSettings rate;
  rate.frameRate = 12;
  kernel.hasFrameRate = false;
  vpExpectError([&] { vpV4l2Controls::set(kernel, rate); }, {"frame rate: this camera has none"});
}

TEST(V4l2Controls, AbilitiesNameTheRanges)
{
  FakeKernel kernel = webcam();
  EXPECT_EQ(vpV4l2Controls::abilities(kernel), "exposure 300 to 204700 us, gain 0 to 255");
}
