/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// USB Video Class cameras over libusb, through libuvc: without the kernel's driver, which is left as it was.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <libuvc/libuvc.h>

#include <visp3/core/vpException.h>

#include "vpCameraKinds.h"

BEGIN_VISP_NAMESPACE

namespace
{
const double exposureUnit = 100e-6; // s, of the class

void check(uvc_error_t error, const std::string &doing)
{
  if (error < 0) {
    throw vpException(vpException::ioError, doing + ": " + uvc_strerror(error));
  }
}

template <class T, void (*Close)(T *)>
struct Closer {
  void operator()(T *object) const { Close(object); }
};
using Context = std::unique_ptr<uvc_context_t, Closer<uvc_context_t, uvc_exit>>;
using Device = std::unique_ptr<uvc_device_t, Closer<uvc_device_t, uvc_unref_device>>;
using Handle = std::unique_ptr<uvc_device_handle_t, Closer<uvc_device_handle_t, uvc_close>>;
using Stream = std::unique_ptr<uvc_stream_handle_t, Closer<uvc_stream_handle_t, uvc_stream_close>>;

Context newContext()
{
  uvc_context_t *context = nullptr;
  check(uvc_init(&context, nullptr), "libuvc");
  return Context(context);
}

//! VID:PID, hexadecimal, with /SERIAL or without.
struct Address {
  int vendor = 0;
  int product = 0;
  std::string serial;

  explicit Address(const std::string &text)
  {
    const size_t slash = text.find('/');
    const std::string ids = text.substr(0, slash);
    serial = slash == std::string::npos ? "" : text.substr(slash + 1);
    unsigned int v = 0, p = 0;
    int used = 0;
    if (std::sscanf(ids.c_str(), "%4x:%4x%n", &v, &p, &used) != 2 ||
        static_cast<size_t>(used) != ids.size()) {
      throw vpException(vpException::badValue,
                        "address: " + text + ", expected VID:PID, hexadecimal, as 046d:082d");
    }
    vendor = static_cast<int>(v);
    product = static_cast<int>(p);
  }
};

/*!
  The newest frame, as libuvc's thread delivers it. uvc_stream_get_frame() is no way to wait: that of Debian
  12 (0.0.6) keeps the stream's mutex where it times out, and the next frame never comes.
*/
class Inbox
{
public:
  static void receive(uvc_frame_t *seen, void *inbox) { static_cast<Inbox *>(inbox)->put(*seen); }

  //! \return False where none came within \e patience, s.
  bool take(double patience, vpImage<unsigned char> &I, vpCameraCounters &counters)
  {
    std::unique_lock<std::mutex> lock(m_mutex);
    const bool came =
        m_came.wait_for(lock, std::chrono::duration<double>(patience), [this] { return m_full; });
    counters.broken += m_broken;
    counters.late += m_late;
    m_broken = m_late = 0;
    if (came) {
      std::swap(I, m_newest);
      m_taken = m_time;
      m_full = false;
    }
    return came;
  }

  //! Of the frame that was taken, s since its last packet.
  double age() const
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - m_taken).count();
  }

private:
  void put(const uvc_frame_t &seen)
  {
    const bool grey = seen.frame_format == UVC_FRAME_FORMAT_GRAY8;
    const unsigned int step = grey ? 1 : 2, first = seen.frame_format == UVC_FRAME_FORMAT_UYVY ? 1 : 0;
    const size_t line = std::max<size_t>(seen.step, static_cast<size_t>(step) * seen.width);
    const std::lock_guard<std::mutex> lock(m_mutex);
    if (seen.height == 0 ||
        seen.data_bytes < line * (seen.height - 1) + static_cast<size_t>(step) * seen.width) {
      ++m_broken;
      return;
    }
    m_late += m_full;
    m_newest.resize(seen.height, seen.width);
    for (unsigned int v = 0; v < seen.height; ++v) {
      const unsigned char *from = static_cast<const unsigned char *>(seen.data) + line * v + first;
      for (unsigned int u = 0; u < seen.width; ++u, from += step) {
        m_newest[v][u] = *from;
      }
    }
    m_time = std::chrono::steady_clock::now();
    m_full = true;
    m_came.notify_one();
  }

  std::mutex m_mutex;
  std::condition_variable m_came;
  vpImage<unsigned char> m_newest;
  std::chrono::steady_clock::time_point m_time, m_taken; // when it came; of the one taken last
  bool m_full = false;
  std::uint64_t m_broken = 0, m_late = 0; // not yet told
};

class UvcCamera : public vpCameraDriver
{
public:
  UvcCamera(const Address &address, const vpCameraSettings &asked) : m_context(newContext())
  {
    uvc_device_t *device = nullptr;
    check(uvc_find_device(m_context.get(), &device, address.vendor, address.product,
                          address.serial.empty() ? nullptr : address.serial.c_str()),
          "no such camera");
    m_device.reset(device);
    uvc_device_handle_t *handle = nullptr;
    check(uvc_open(device, &handle), "cannot be opened");
    m_handle.reset(handle);
    uvc_stream_ctrl_t control;
    negotiate(asked, control);
    setControls(asked);
    uvc_stream_handle_t *stream = nullptr;
    check(uvc_stream_open_ctrl(handle, &stream, &control), "stream");
    m_stream.reset(stream);
    check(uvc_stream_start(stream, &Inbox::receive, &m_inbox, 0), "start");
  }

  /*!
    Of a camera that is gone the handle is given up and not closed: libuvc would first set its interfaces
    back, for which Debian 12's libusb (1.0.26) unlocks a mutex that nobody has locked and then ends the
    program.
  */
  ~UvcCamera() override
  {
    m_stream.reset();
    std::uint32_t exposure = 0;
    if (uvc_get_exposure_abs(m_handle.get(), &exposure, UVC_GET_CUR) == UVC_ERROR_NO_DEVICE) {
      static_cast<void>(m_handle.release());
      static_cast<void>(m_device.release());
      static_cast<void>(m_context.release());
    }
  }

  bool grab(double patience, const std::function<double()> &clock, vpVlpFrame &frame,
            vpCameraCounters &counters) override
  {
    if (!m_inbox.take(patience, frame.I, counters)) {
      return false;
    }
    // It was exposed and read out within the time of a frame at most, before its last packet came.
    frame.timestamp = clock() - m_inbox.age() - (m_rate > 0 ? 1 / m_rate : 0);
    return true;
  }

  void set(const vpCameraSettings &asked) override
  {
    if (asked.frameRate) {
      throw vpException(
          vpException::badValue,
          "frame rate: of a camera that is taking pictures, expected it when the camera is opened");
    }
    setControls(asked);
  }

  vpCameraSettings settings() const override
  {
    vpCameraSettings now;
    std::uint32_t exposure = 0;
    std::uint16_t gain = 0;
    if (uvc_get_exposure_abs(m_handle.get(), &exposure, UVC_GET_CUR) >= 0) {
      now.exposure = exposureUnit * exposure;
    }
    if (uvc_get_gain(m_handle.get(), &gain, UVC_GET_CUR) >= 0) {
      now.gain = gain;
    }
    if (m_rate > 0) {
      now.frameRate = m_rate;
    }
    now.region = m_region;
    return now;
  }

private:
  //! The size asked for, or the camera's first; grey, or what has the grey in every second byte.
  void negotiate(const vpCameraSettings &asked, uvc_stream_ctrl_t &control)
  {
    m_region = asked.region ? *asked.region : firstSize();
    if (m_region.left != 0 || m_region.top != 0) {
      throw vpException(vpException::badValue, "region: from (%u, %u), expected (0, 0): UVC knows sizes only",
                        m_region.left, m_region.top);
    }
    const int rate = asked.frameRate ? static_cast<int>(std::lround(*asked.frameRate)) : 0; // 0: any
    for (const uvc_frame_format format :
         {UVC_FRAME_FORMAT_GRAY8, UVC_FRAME_FORMAT_YUYV, UVC_FRAME_FORMAT_UYVY}) {
      if (uvc_get_stream_ctrl_format_size(m_handle.get(), &control, format, static_cast<int>(m_region.width),
                                          static_cast<int>(m_region.height), rate) >= 0) {
        static const double intervalUnit = 100e-9; // s, of the class
        m_rate = control.dwFrameInterval > 0 ? 1 / (intervalUnit * control.dwFrameInterval) : 0;
        return;
      }
    }
    throw vpException(vpException::badValue,
                      "region and frame rate: %u x %u pixels at %d Hz (0: any), expected a size and a rate "
                      "that this camera "
                      "has in GRAY8, YUYV or UYVY",
                      m_region.width, m_region.height, rate);
  }

  vpCameraRegion firstSize() const
  {
    const uvc_format_desc_t *const format = uvc_get_format_descs(m_handle.get());
    if (format == nullptr || format->frame_descs == nullptr) {
      throw vpException(vpException::badValue, "format: this camera names none, expected one");
    }
    return {0, 0, format->frame_descs->wWidth, format->frame_descs->wHeight};
  }

  void setControls(const vpCameraSettings &asked)
  {
    static const std::uint8_t manual = 1, shutterPriority = 4;
    if (uvc_set_ae_mode(m_handle.get(), manual) < 0) { // many have only one of the two, some neither
      uvc_set_ae_mode(m_handle.get(), shutterPriority);
    }
    uvc_set_ae_priority(m_handle.get(), 0);
    if (asked.exposure) {
      std::uint32_t low = 0, high = 0;
      const bool told = uvc_get_exposure_abs(m_handle.get(), &low, UVC_GET_MIN) >= 0 &&
                        uvc_get_exposure_abs(m_handle.get(), &high, UVC_GET_MAX) >= 0;
      const double units = std::round(*asked.exposure / exposureUnit);
      if (told && !(units >= low && units <= high)) {
        throw vpException(vpException::badValue, "exposure: %g s, expected %g to %g", *asked.exposure,
                          exposureUnit * low, exposureUnit * high);
      }
      check(uvc_set_exposure_abs(m_handle.get(), static_cast<std::uint32_t>(units)), "exposure");
    }
    if (asked.gain) {
      std::uint16_t low = 0, high = 0;
      const bool told = uvc_get_gain(m_handle.get(), &low, UVC_GET_MIN) >= 0 &&
                        uvc_get_gain(m_handle.get(), &high, UVC_GET_MAX) >= 0;
      const double units = std::round(*asked.gain);
      if (told && !(units >= low && units <= high)) {
        throw vpException(vpException::badValue, "gain: %g, expected %u to %u", *asked.gain, low, high);
      }
      check(uvc_set_gain(m_handle.get(), static_cast<std::uint16_t>(units)), "gain");
    }
  }

  Context m_context; // first: all others are of it
  Device m_device;
  Handle m_handle;
  Inbox m_inbox; // of the stream
  Stream m_stream;
  vpCameraRegion m_region;
  double m_rate = 0; // Hz, as agreed
};

std::unique_ptr<vpCameraDriver> open(const std::string &address, const vpCameraSettings &asked)
{
  return std::make_unique<UvcCamera>(Address(address), asked);
}

std::vector<vpCameraDescription> list()
{
  const Context context = newContext();
  uvc_device_t **devices = nullptr;
  check(uvc_get_device_list(context.get(), &devices), "libuvc");
  std::vector<vpCameraDescription> cameras;
  for (uvc_device_t **device = devices; *device != nullptr; ++device) {
    uvc_device_descriptor_t *about = nullptr;
    if (uvc_get_device_descriptor(*device, &about) < 0) {
      continue;
    }
    auto text = [](const char *given) { return std::string(given != nullptr ? given : ""); };
    char ids[16];
    std::snprintf(ids, sizeof(ids), "%04x:%04x", about->idVendor, about->idProduct);
    const std::string serial = text(about->serialNumber);
    cameras.push_back({std::string("uvc://") + ids + (serial.empty() ? "" : "/" + serial),
                       text(about->manufacturer) + " " + text(about->product),
                       "exposure, gain, size, frame rate"});
    uvc_free_device_descriptor(about);
  }
  uvc_free_device_list(devices, 1);
  return cameras;
}
} // namespace

vpCameraKind vpUvcKind()
{
  return {"uvc", "", open, list};
}

END_VISP_NAMESPACE
