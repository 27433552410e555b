/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// MindVision cameras, as the paper's UB-300, through their maker's SDK.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <visp3/core/vpException.h>

#include "vpCameraKinds.h"
#include "vpClockMap.h"
#include "vpMindVisionSdk.h"

BEGIN_VISP_NAMESPACE

namespace
{
const double microsecond = 1e-6;
const double stampUnit = 1e-4; // s, of the camera's time stamps

void check(int status, const std::string &doing)
{
  if (status != 0) {
    throw vpException(vpException::ioError, doing + ": MindVision's SDK says " + std::to_string(status));
  }
}

std::vector<vpMindVisionSdk::Device> devicesOf(const vpMindVisionSdk &sdk)
{
  static const int most = 16, chinese0English1 = 1;
  check(sdk.SdkInit(chinese0English1), "start of the SDK");
  std::vector<vpMindVisionSdk::Device> devices(most);
  int count = most;
  if (sdk.EnumerateDevice(devices.data(), &count) != 0) { // which is also how it says that there is none
    count = 0;
  }
  devices.resize(static_cast<size_t>(std::clamp(count, 0, most)));
  return devices;
}

class MindVisionCamera : public vpCameraDriver
{
public:
  MindVisionCamera(const std::string &serial, const vpCameraSettings &asked)
  {
    std::vector<vpMindVisionSdk::Device> devices = devicesOf(m_sdk);
    const auto device =
        std::find_if(devices.begin(), devices.end(), [&serial](const vpMindVisionSdk::Device &one) {
          return serial.empty() || serial == one.serial;
        });
    if (device == devices.end()) {
      throw vpException(vpException::ioError, "no such camera, expected one that --list-cameras names");
    }
    static const int asLeft = -1;
    check(m_sdk.Init(&*device, asLeft, asLeft, &m_camera), "cannot be opened");
    try {
      start(asked);
    } catch (...) {
      m_sdk.UnInit(m_camera);
      throw;
    }
  }

  ~MindVisionCamera() override { m_sdk.UnInit(m_camera); }

  bool grab(double patience, const std::function<double()> &clock, vpVlpFrame &frame,
            vpCameraCounters &counters) override
  {
    bool came = false;
    for (double wait = patience;; wait = 0) { // until the newest
      vpMindVisionSdk::FrameHead head = {};
      unsigned char *raw = nullptr;
      const int status = m_sdk.GetImageBuffer(m_camera, &head, &raw, static_cast<unsigned int>(1e3 * wait));
      if (status == vpMindVisionSdk::timeOut) {
        return came;
      }
      check(status, "the camera is gone");
      const double arrival = clock();
      const bool sized = head.width > 0 && head.height > 0;
      if (sized) {
        frame.I.resize(static_cast<unsigned int>(head.height), static_cast<unsigned int>(head.width));
      }
      const bool whole = sized && m_sdk.ImageProcess(m_camera, raw, frame.I.bitmap, &head) == 0;
      m_sdk.ReleaseImageBuffer(m_camera, raw);
      counters.late += came ? 1 : 0;
      counters.broken += whole ? 0 : 1;
      came = whole;
      if (whole) {
        frame.timestamp = m_clock.host(stampUnit * head.time, arrival);
      }
    }
  }

  void set(const vpCameraSettings &asked) override
  {
    if (asked.frameRate) {
      throw vpException(vpException::badValue,
                        "frame rate: a MindVision camera has none to set, expected none");
    }
    check(m_sdk.SetAeState(m_camera, 0), "automatic exposure off");
    if (asked.gain) {
      check(m_sdk.SetAnalogGain(m_camera, static_cast<int>(std::lround(*asked.gain))), "gain");
    }
    if (asked.exposure) {
      check(m_sdk.SetExposureTime(m_camera, *asked.exposure / microsecond), "exposure");
    }
  }

  vpCameraSettings settings() const override
  {
    vpCameraSettings now;
    double exposure = 0;
    int gain = 0;
    vpMindVisionSdk::Resolution resolution = {};
    if (m_sdk.GetExposureTime(m_camera, &exposure) == 0) {
      now.exposure = microsecond * exposure; // whole lines
    }
    if (m_sdk.GetAnalogGain(m_camera, &gain) == 0) {
      now.gain = gain;
    }
    if (m_sdk.GetImageResolution(m_camera, &resolution) == 0) {
      now.region = {static_cast<unsigned>(resolution.left), static_cast<unsigned>(resolution.top),
                    static_cast<unsigned>(resolution.width), static_cast<unsigned>(resolution.height)};
    }
    return now;
  }

private:
  //! The order is the paper's.
  void start(const vpCameraSettings &asked)
  {
    check(m_sdk.Play(m_camera), "start");
    MindVisionCamera::set(asked);
    m_sdk.SetMonochrome(m_camera, 1); // a grey camera refuses: it is already
    static const int fastest = 2;
    m_sdk.SetFrameSpeed(m_camera, fastest); // likewise one of a single speed
    if (asked.region) {
      vpMindVisionSdk::Resolution resolution = {};
      check(m_sdk.GetImageResolution(m_camera, &resolution), "region");
      resolution.index = vpMindVisionSdk::custom;
      resolution.left = static_cast<int>(asked.region->left);
      resolution.top = static_cast<int>(asked.region->top);
      resolution.fieldWidth = resolution.width = static_cast<int>(asked.region->width);
      resolution.fieldHeight = resolution.height = static_cast<int>(asked.region->height);
      check(m_sdk.SetImageResolution(m_camera, &resolution), "region");
    }
    check(m_sdk.SetIspOutFormat(m_camera, vpMindVisionSdk::mono8), "format Mono8");
  }

  vpMindVisionSdk m_sdk;
  int m_camera = 0;
  vpClockMap m_clock;
};

std::unique_ptr<vpCameraDriver> open(const std::string &serial, const vpCameraSettings &asked)
{
  return std::make_unique<MindVisionCamera>(serial, asked);
}

std::vector<vpCameraDescription> list()
{
  const vpMindVisionSdk sdk;
  std::vector<vpCameraDescription> cameras;
  for (const vpMindVisionSdk::Device &device : devicesOf(sdk)) {
    cameras.push_back({std::string("mindvision://") + device.serial,
                       std::string(device.product) + ", sensor " + device.sensor + ", " + device.port,
                       "exposure, gain, region"});
  }
  return cameras;
}
} // namespace

vpCameraKind vpMindVisionKind()
{
  return {"mindvision", "", open, list};
}

END_VISP_NAMESPACE
