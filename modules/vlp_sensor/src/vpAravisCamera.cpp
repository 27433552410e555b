/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// GigE Vision and USB3 Vision cameras, through Aravis.

#include <atomic>
#include <cmath>
#include <cstring>
#include <memory>

#include <arv.h>

#include <visp3/core/vpException.h>

#include "vpCameraKinds.h"
#include "vpClockMap.h"

BEGIN_VISP_NAMESPACE

namespace
{
const double microsecond = 1e-6, nanosecond = 1e-9;

template <class T>
struct Unref {
  void operator()(T *object) const { g_object_unref(object); }
};
template <class T>
using Owned = std::unique_ptr<T, Unref<T>>;

//! What Aravis reports, thrown on: as \e code with what was being done.
class Check
{
public:
  Check(int code, std::string doing) : m_code(code), m_doing(std::move(doing)) {}
  ~Check() noexcept(false) // NOLINT(bugprone-exception-escape): which says that it may throw
  {
    if (m_error != nullptr) {
      const std::string message = m_doing + ": " + m_error->message;
      g_clear_error(&m_error);
      if (std::uncaught_exceptions() == 0) {
        throw vpException(static_cast<vpException::generalExceptionEnum>(m_code), message);
      }
    }
  }
  operator GError **() { return &m_error; }

private:
  int m_code;
  std::string m_doing;
  GError *m_error = nullptr;
};

Check doing(const std::string &what)
{
  return {vpException::ioError, what};
}

//! What does not matter where it fails.
class Ignored
{
public:
  ~Ignored() { g_clear_error(&m_error); }
  operator GError **() { return &m_error; }

private:
  GError *m_error = nullptr;
};

struct Range {
  double low = 0, high = 0;
};

Range rangeOf(ArvCamera *camera, void (*bounds)(ArvCamera *, double *, double *, GError **), double unit)
{
  Range range;
  bounds(camera, &range.low, &range.high, Ignored());
  return {unit * range.low, unit * range.high};
}

void setWithin(ArvCamera *camera, const char *what, const std::optional<double> &value, const char *unitName,
               double unit, gboolean available, void (*bounds)(ArvCamera *, double *, double *, GError **),
               void (*set)(ArvCamera *, double, GError **))
{
  if (!value) {
    return;
  }
  if (available == FALSE) {
    throw vpException(vpException::badValue, "%s: this camera has none to set", what);
  }
  const Range range = rangeOf(camera, bounds, unit);
  const double rounding = 1e-6 * std::abs(*value);
  if (range.high > range.low && !(*value >= range.low - rounding && *value <= range.high + rounding)) {
    throw vpException(vpException::badValue, "%s: %g %s, expected %g to %g", what, *value, unitName,
                      range.low, range.high);
  }
  set(camera, *value / unit, doing(what));
}

//! What can be set, as text.
std::string abilitiesOf(ArvCamera *camera)
{
  gint width = 0, height = 0;
  arv_camera_get_sensor_size(camera, &width, &height, Ignored());
  std::string text = std::to_string(width) + " x " + std::to_string(height) + " pixels";
  auto add = [&text](const char *what, gboolean available, const Range &range, const char *unit) {
    char line[100];
    if (available != FALSE) {
      std::snprintf(line, sizeof(line), ", %s %g to %g%s", what, range.low, range.high, unit);
      text += line;
    }
  };
  add("exposure", arv_camera_is_exposure_time_available(camera, Ignored()),
      rangeOf(camera, arv_camera_get_exposure_time_bounds, 1), " us");
  add("gain", arv_camera_is_gain_available(camera, Ignored()), rangeOf(camera, arv_camera_get_gain_bounds, 1),
      "");
  add("frame rate", arv_camera_is_frame_rate_available(camera, Ignored()),
      rangeOf(camera, arv_camera_get_frame_rate_bounds, 1), " Hz");
  return text;
}

class AravisCamera : public vpCameraDriver
{
public:
  AravisCamera(const std::string &address, const vpCameraSettings &asked)
      : m_camera(arv_camera_new(address.empty() ? nullptr : address.c_str(), doing("cannot be opened")))
  {
    if (!m_camera) {
      throw vpException(vpException::ioError, "no such camera, expected one that --list-cameras names");
    }
    arv_camera_set_pixel_format(m_camera.get(), ARV_PIXEL_FORMAT_MONO_8, doing("pixel format Mono8"));
    setRegion(asked);
    AravisCamera::set(asked);
    startStream();
    m_lostHandler = g_signal_connect(
        arv_camera_get_device(m_camera.get()), "control-lost",
        G_CALLBACK(+[](ArvDevice *, gpointer lost) { *static_cast<std::atomic<bool> *>(lost) = true; }),
        &m_lost);
  }

  ~AravisCamera() override
  {
    arv_camera_stop_acquisition(m_camera.get(), Ignored());
    m_stream.reset();
    g_signal_handler_disconnect(arv_camera_get_device(m_camera.get()), m_lostHandler);
  }

  bool grab(double patience, const std::function<double()> &clock, vpVlpFrame &frame,
            vpCameraCounters &counters) override
  {
    if (m_lost) {
      throw vpException(vpException::ioError, "the camera is gone");
    }
    ArvBuffer *newest =
        arv_stream_timeout_pop_buffer(m_stream.get(), static_cast<guint64>(patience / microsecond));
    bool came = false;
    while (newest != nullptr) {
      ArvBuffer *next = arv_stream_try_pop_buffer(m_stream.get());
      const bool whole = isWhole(newest, counters);
      if (whole && next == nullptr) {
        came = take(newest, clock, frame, counters);
      } else if (whole) {
        ++counters.late;
      }
      arv_stream_push_buffer(m_stream.get(), newest);
      newest = next;
    }
    return came;
  }

  void set(const vpCameraSettings &asked) override
  {
    ArvCamera *camera = m_camera.get();
    if (arv_camera_is_exposure_auto_available(camera, Ignored())) {
      arv_camera_set_exposure_time_auto(camera, ARV_AUTO_OFF, doing("automatic exposure off"));
    }
    if (arv_camera_is_gain_auto_available(camera, Ignored())) {
      arv_camera_set_gain_auto(camera, ARV_AUTO_OFF, doing("automatic gain off"));
    }
    setWithin(camera, "exposure", asked.exposure, "s", microsecond,
              arv_camera_is_exposure_time_available(camera, Ignored()), arv_camera_get_exposure_time_bounds,
              arv_camera_set_exposure_time);
    setWithin(camera, "gain", asked.gain, "", 1, arv_camera_is_gain_available(camera, Ignored()),
              arv_camera_get_gain_bounds, arv_camera_set_gain);
    setWithin(camera, "frame rate", asked.frameRate, "Hz", 1,
              arv_camera_is_frame_rate_available(camera, Ignored()), arv_camera_get_frame_rate_bounds,
              arv_camera_set_frame_rate);
  }

  vpCameraSettings settings() const override
  {
    ArvCamera *camera = m_camera.get();
    vpCameraSettings now;
    if (arv_camera_is_exposure_time_available(camera, Ignored())) {
      now.exposure = microsecond * arv_camera_get_exposure_time(camera, doing("exposure"));
    }
    if (arv_camera_is_gain_available(camera, Ignored())) {
      now.gain = arv_camera_get_gain(camera, doing("gain"));
    }
    if (arv_camera_is_frame_rate_available(camera, Ignored())) {
      now.frameRate = arv_camera_get_frame_rate(camera, doing("frame rate"));
    }
    gint left = 0, top = 0, width = 0, height = 0;
    arv_camera_get_region(camera, &left, &top, &width, &height, doing("region"));
    now.region = {static_cast<unsigned>(left), static_cast<unsigned>(top), static_cast<unsigned>(width),
                  static_cast<unsigned>(height)};
    return now;
  }

private:
  void setRegion(const vpCameraSettings &asked)
  {
    if (!asked.region) {
      return;
    }
    const vpCameraRegion &region = *asked.region;
    gint width = 0, height = 0;
    arv_camera_get_sensor_size(m_camera.get(), &width, &height, doing("sensor size"));
    if (region.left + region.width > static_cast<unsigned>(width) ||
        region.top + region.height > static_cast<unsigned>(height)) {
      throw vpException(vpException::badValue,
                        "region: %u x %u pixels from (%u, %u), expected it within the sensor's %d x %d",
                        region.width, region.height, region.left, region.top, width, height);
    }
    arv_camera_set_region(m_camera.get(), static_cast<gint>(region.left), static_cast<gint>(region.top),
                          static_cast<gint>(region.width), static_cast<gint>(region.height), doing("region"));
    gint left = 0, top = 0;
    arv_camera_get_region(m_camera.get(), &left, &top, &width, &height, doing("region"));
    if (static_cast<unsigned>(width) != region.width || static_cast<unsigned>(height) != region.height) {
      throw vpException(vpException::badValue,
                        "region: %u x %u pixels, expected a size that this camera has, as %d x %d",
                        region.width, region.height, width, height);
    }
  }

  void startStream()
  {
    static const int buffers = 6;
    ArvCamera *camera = m_camera.get();
    if (arv_camera_is_gv_device(camera)) {
      // Packet sockets see nothing of a camera on the same machine.
      arv_camera_gv_set_stream_options(camera, ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
    }
    m_stream.reset(arv_camera_create_stream(camera, nullptr, nullptr, doing("stream")));
    if (!m_stream) {
      throw vpException(vpException::ioError, "no stream");
    }
    const size_t payload = arv_camera_get_payload(camera, doing("size of a frame"));
    if (ARV_IS_GV_STREAM(m_stream.get())) {
      g_object_set(m_stream.get(), "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED, "socket-buffer-size",
                   static_cast<gint>(4 * payload), nullptr);
    }
    for (int k = 0; k < buffers; ++k) {
      arv_stream_push_buffer(m_stream.get(), arv_buffer_new_allocate(payload));
    }
    arv_camera_set_acquisition_mode(camera, ARV_ACQUISITION_MODE_CONTINUOUS, Ignored());
    arv_camera_start_acquisition(camera, doing("start"));
  }

  //! Counts it where it is not, and the numbers missing before it.
  bool isWhole(ArvBuffer *buffer, vpCameraCounters &counters)
  {
    const ArvBufferStatus status = arv_buffer_get_status(buffer);
    if (status == ARV_BUFFER_STATUS_ABORTED || status == ARV_BUFFER_STATUS_CLEARED) {
      return false;
    }
    const guint64 number = arv_buffer_get_frame_id(buffer);
    if (m_numbered &&
        number > m_number + 1) { // GigE Vision 1 counts from 1 to 65535: its turn-over is no gap
      counters.dropped += number - m_number - 1;
    }
    m_numbered = true;
    m_number = number;
    if (status != ARV_BUFFER_STATUS_SUCCESS) {
      ++counters.broken;
      return false;
    }
    return true;
  }

  bool take(ArvBuffer *buffer, const std::function<double()> &clock, vpVlpFrame &frame,
            vpCameraCounters &counters)
  {
    size_t bytes = 0;
    const auto *data = static_cast<const unsigned char *>(arv_buffer_get_data(buffer, &bytes));
    const auto width = static_cast<unsigned int>(arv_buffer_get_image_width(buffer)),
               height = static_cast<unsigned int>(arv_buffer_get_image_height(buffer));
    if (arv_buffer_get_image_pixel_format(buffer) != ARV_PIXEL_FORMAT_MONO_8 || data == nullptr ||
        width == 0 || height == 0 || bytes < static_cast<size_t>(width) * height) {
      ++counters.broken;
      return false;
    }
    frame.I.resize(height, width);
    std::memcpy(frame.I.bitmap, data, static_cast<size_t>(width) * height);
    // Both of Aravis' stamps are in ns: the camera's own, at the start of exposure as cameras commonly have
    // it, and that of the real-time clock when the first packet came.
    const double age = nanosecond * (1e3 * static_cast<double>(g_get_real_time()) -
                                     static_cast<double>(arv_buffer_get_system_timestamp(buffer)));
    const double arrival = clock() - std::max(0.0, age);
    const double device = nanosecond * static_cast<double>(arv_buffer_get_timestamp(buffer));
    frame.timestamp = device > 0 ? m_clock.host(device, arrival) : arrival;
    return true;
  }

  std::atomic<bool> m_lost{false}; // set by a thread of the camera's: it outlives that
  Owned<ArvCamera> m_camera;
  Owned<ArvStream> m_stream;
  gulong m_lostHandler = 0;
  bool m_numbered = false;
  guint64 m_number = 0; // of the frame before
  vpClockMap m_clock;
};

std::unique_ptr<vpCameraDriver> open(const std::string &address, const vpCameraSettings &asked)
{
  return std::make_unique<AravisCamera>(address, asked);
}

std::vector<vpCameraDescription> list()
{
  std::vector<vpCameraDescription> cameras;
  arv_update_device_list();
  for (unsigned int k = 0; k < arv_get_n_devices(); ++k) {
    const std::string id = arv_get_device_id(k), maker = arv_get_device_vendor(k),
                      model = arv_get_device_model(k), serial = arv_get_device_serial_nbr(k);
    vpCameraDescription camera{"aravis://" + id, maker + " " + model + ", serial number " + serial, ""};
    try {
      const Owned<ArvCamera> opened(arv_camera_new(id.c_str(), doing("cannot be asked what it can do")));
      camera.abilities = abilitiesOf(opened.get());
    } catch (const vpException &error) { // somebody else has it
      camera.abilities = error.getStringMessage();
    }
    cameras.push_back(camera);
  }
  return cameras;
}
} // namespace

vpCameraKind vpAravisKind()
{
  return {"aravis", "", open, list};
}

END_VISP_NAMESPACE
