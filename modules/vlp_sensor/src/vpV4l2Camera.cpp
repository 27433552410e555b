/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Cameras that Linux drives: Video for Linux 2.

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <memory>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <visp3/core/vpException.h>
#include <visp3/vlp_sensor/vpV4l2Device.h>

#include "vpCameraKinds.h"

BEGIN_VISP_NAMESPACE

namespace
{
[[noreturn]] void fail(const std::string &doing, int error)
{
  throw vpException(vpException::ioError, doing + ": " + std::strerror(error));
}

class KernelDevice : public vpV4l2Device
{
public:
  explicit KernelDevice(const std::string &path)
      : m_file(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC))
  {
    if (m_file < 0) {
      fail("cannot be opened", errno);
    }
  }
  ~KernelDevice() override { ::close(m_file); }
  KernelDevice(const KernelDevice &) = delete;
  KernelDevice &operator=(const KernelDevice &) = delete;

  int control(unsigned long request, void *argument) override
  {
    int result = 0;
    do {
      result = ::ioctl(m_file, request, argument);
    } while (result < 0 && errno == EINTR);
    return result < 0 ? errno : 0;
  }

  void *map(size_t length, std::uint32_t offset) const
  {
    return ::mmap(nullptr, length, PROT_READ, MAP_SHARED, m_file, static_cast<off_t>(offset));
  }

  //! \return Whether a frame, or an error, is there.
  bool wait(double seconds)
  {
    pollfd ask = {m_file, POLLIN, 0};
    return ::poll(&ask, 1, static_cast<int>(1e3 * seconds)) > 0;
  }

private:
  int m_file;
};

//! Whether the device takes pictures and hands them on as a stream.
bool takesPictures(vpV4l2Device &device, v4l2_capability *capability)
{
  *capability = {};
  if (device.control(VIDIOC_QUERYCAP, capability) != 0) {
    return false;
  }
  const std::uint32_t can = (capability->capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? capability->device_caps
                                                                                   : capability->capabilities;
  return (can & V4L2_CAP_VIDEO_CAPTURE) != 0 && (can & V4L2_CAP_STREAMING) != 0;
}

class V4l2Camera : public vpCameraDriver
{
public:
  V4l2Camera(const std::string &path, const vpCameraSettings &asked) : m_device(path)
  {
    v4l2_capability capability;
    if (!takesPictures(m_device, &capability)) {
      throw vpException(vpException::badValue, "no camera, expected a video device that captures");
    }
    setFormat(asked);
    V4l2Camera::set(asked);
    startStream();
  }

  ~V4l2Camera() override
  {
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    m_device.control(VIDIOC_STREAMOFF, &type);
  }

  bool grab(double patience, const std::function<double()> &clock, vpVlpFrame &frame,
            vpCameraCounters &counters) override
  {
    bool came = false;
    for (double wait = patience; m_device.wait(wait); wait = 0) {
      v4l2_buffer buffer = described();
      const int error = m_device.control(VIDIOC_DQBUF, &buffer);
      if (error == EAGAIN) {
        break;
      }
      if (error != 0) {
        fail("the camera is gone", error);
      }
      counters.late += came ? 1 : 0;
      came = take(buffer, clock, frame, counters);
      if (const int again = m_device.control(VIDIOC_QBUF, &buffer); again != 0) {
        fail("the camera is gone", again);
      }
    }
    return came;
  }

  void set(const vpCameraSettings &asked) override { vpV4l2Controls::set(m_device, asked); }

  vpCameraSettings settings() const override { return vpV4l2Controls::get(m_device); }

private:
  struct Unmap {
    size_t length = 0;
    void operator()(unsigned char *data) const { ::munmap(data, length); }
  };
  using Mapped = std::unique_ptr<unsigned char, Unmap>;

  static v4l2_buffer described()
  {
    v4l2_buffer buffer = {};
    buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    buffer.memory = V4L2_MEMORY_MMAP;
    return buffer;
  }

  //! Grey, or what has the grey in every second byte.
  void setFormat(const vpCameraSettings &asked)
  {
    v4l2_format format = {};
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (const int error = m_device.control(VIDIOC_G_FMT, &format); error != 0) {
      fail("format", error);
    }
    if (asked.region && (asked.region->left != 0 || asked.region->top != 0)) {
      throw vpException(vpException::badValue,
                        "region: from (%u, %u), expected (0, 0): V4L2 knows sizes only", asked.region->left,
                        asked.region->top);
    }
    const unsigned int width = asked.region ? asked.region->width : format.fmt.pix.width,
                       height = asked.region ? asked.region->height : format.fmt.pix.height;
    for (const std::uint32_t pixels :
         {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_UYVY, V4L2_PIX_FMT_NV12}) {
      format.fmt.pix.width = width;
      format.fmt.pix.height = height;
      format.fmt.pix.pixelformat = pixels;
      format.fmt.pix.field = V4L2_FIELD_NONE;
      if (m_device.control(VIDIOC_S_FMT, &format) != 0 || format.fmt.pix.pixelformat != pixels) {
        continue;
      }
      if (format.fmt.pix.width != width || format.fmt.pix.height != height) {
        throw vpException(vpException::badValue,
                          "region: %u x %u pixels, expected a size that this camera has, as %u x %u", width,
                          height, format.fmt.pix.width, format.fmt.pix.height);
      }
      m_format = format.fmt.pix;
      m_step = pixels == V4L2_PIX_FMT_YUYV || pixels == V4L2_PIX_FMT_UYVY ? 2 : 1;
      m_first = pixels == V4L2_PIX_FMT_UYVY ? 1 : 0;
      return;
    }
    throw vpException(vpException::badValue,
                      "format: this camera has none of GREY, YUYV, UYVY and NV12, of which one is "
                      "expected (JPEG spoils stripes)");
  }

  void startStream()
  {
    static const std::uint32_t buffers = 4;
    v4l2_requestbuffers request = {};
    request.count = buffers;
    request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    request.memory = V4L2_MEMORY_MMAP;
    if (const int error = m_device.control(VIDIOC_REQBUFS, &request); error != 0) {
      fail("buffers", error);
    }
    for (std::uint32_t k = 0; k < request.count; ++k) {
      v4l2_buffer buffer = described();
      buffer.index = k;
      if (const int error = m_device.control(VIDIOC_QUERYBUF, &buffer); error != 0) {
        fail("buffers", error);
      }
      void *const data = m_device.map(buffer.length, buffer.m.offset);
      if (data == MAP_FAILED) {
        fail("buffers", errno);
      }
      m_buffers.emplace_back(static_cast<unsigned char *>(data), Unmap{buffer.length});
      if (const int error = m_device.control(VIDIOC_QBUF, &buffer); error != 0) {
        fail("buffers", error);
      }
    }
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (const int error = m_device.control(VIDIOC_STREAMON, &type); error != 0) {
      fail("start", error);
    }
  }

  bool take(const v4l2_buffer &buffer, const std::function<double()> &clock, vpVlpFrame &frame,
            vpCameraCounters &counters)
  {
    if (m_numbered && buffer.sequence > m_number + 1) {
      counters.dropped += buffer.sequence - m_number - 1;
    }
    m_numbered = true;
    m_number = buffer.sequence;
    const size_t line = std::max<size_t>(m_format.bytesperline, static_cast<size_t>(m_step) * m_format.width);
    const size_t needed = line * (m_format.height - 1) + static_cast<size_t>(m_step) * m_format.width;
    if ((buffer.flags & V4L2_BUF_FLAG_ERROR) != 0 || buffer.index >= m_buffers.size() ||
        buffer.bytesused < needed) {
      ++counters.broken;
      return false;
    }
    frame.I.resize(m_format.height, m_format.width);
    const unsigned char *const data = m_buffers[buffer.index].get();
    for (unsigned int v = 0; v < m_format.height; ++v) {
      const unsigned char *from = data + line * v + m_first;
      for (unsigned int u = 0; u < m_format.width; ++u, from += m_step) {
        frame.I[v][u] = *from;
      }
    }
    frame.timestamp = clock() - age(buffer);
    return true;
  }

  /*!
    How long ago its first line's exposure began, s. Where the driver stamps a frame at its end, as most do,
    the time from frame to frame is what readout and exposure take at most: it is taken for that.
  */
  double age(const v4l2_buffer &buffer) const
  {
    if ((buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) {
      return 0;
    }
    timespec now = {};
    clock_gettime(CLOCK_MONOTONIC, &now);
    const double since = static_cast<double>(now.tv_sec - buffer.timestamp.tv_sec) +
                         1e-9 * static_cast<double>(now.tv_nsec) -
                         1e-6 * static_cast<double>(buffer.timestamp.tv_usec);
    if ((buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE) {
      return since;
    }
    const std::optional<double> rate = settings().frameRate;
    return since + (rate && *rate > 0 ? 1 / *rate : 0);
  }

  mutable KernelDevice m_device; // reading a control back goes through it as well
  std::vector<Mapped> m_buffers;
  v4l2_pix_format m_format = {};
  unsigned int m_step = 1;  // bytes from grey to grey
  unsigned int m_first = 0; // bytes before the first
  bool m_numbered = false;
  std::uint32_t m_number = 0; // of the frame before
};

std::unique_ptr<vpCameraDriver> open(const std::string &address, const vpCameraSettings &asked)
{
  return std::make_unique<V4l2Camera>(address, asked);
}

std::vector<vpCameraDescription> list()
{
  std::vector<vpCameraDescription> cameras;
  std::error_code ignored;
  for (const auto &entry : std::filesystem::directory_iterator("/dev", ignored)) {
    const std::string path = entry.path().string();
    if (path.rfind("/dev/video", 0) != 0) {
      continue;
    }
    try {
      KernelDevice device(path);
      v4l2_capability capability;
      if (takesPictures(device, &capability)) {
        cameras.push_back({"v4l2://" + path, reinterpret_cast<const char *>(capability.card),
                           vpV4l2Controls::abilities(device)});
      }
    } catch (const vpException &error) {
      cameras.push_back({"v4l2://" + path, "", error.getStringMessage()});
    }
  }
  return cameras;
}
} // namespace

vpCameraKind vpV4l2Kind()
{
  return {"v4l2", "", open, list};
}

END_VISP_NAMESPACE
