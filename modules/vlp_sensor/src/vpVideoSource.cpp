/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_sensor/vpVideoSource.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#include <opencv2/videoio.hpp>
#include <opencv2/videoio/registry.hpp>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpPrintable.h>

#include "vpGreyOf.h"

BEGIN_VISP_NAMESPACE

namespace
{
[[noreturn]] void fail(const std::string &filename, const std::string &problem)
{
  throw vpException(vpException::ioError, vpPrintable(filename) + ": " + problem);
}

//! FFmpeg where OpenCV has it: the others complain on stderr about each other before they give up.
int backend()
{
  const std::vector<cv::VideoCaptureAPIs> all = cv::videoio_registry::getStreamBackends();
  return std::find(all.begin(), all.end(), cv::CAP_FFMPEG) == all.end() ? cv::CAP_ANY : cv::CAP_FFMPEG;
}
} // namespace

struct vpVideoSource::Impl {
  std::string filename;
  cv::VideoCapture video;
  cv::Mat picture;
  double period = 1; // s, where the stream has no times
  double last = 0;   // s, time of the frame before
  size_t index = 0;  // of the next frame

  //! Time of the frame just read, s.
  double timestamp()
  {
    const double stamp = video.get(cv::CAP_PROP_POS_MSEC) / 1000;
    const bool usable = std::isfinite(stamp) && stamp >= 0 && (index == 0 || stamp > last);
    last = usable ? stamp : (index == 0 ? 0 : last + period);
    return last;
  }
};

vpVideoSource::vpVideoSource(const std::string &filename) : m_impl(std::make_unique<Impl>())
{
  m_impl->filename = filename;
  std::error_code ignored;
  errno = 0;
  if (std::filesystem::is_directory(filename, ignored)) {
    fail(filename, "cannot be opened: " + std::generic_category().message(EISDIR));
  }
  if (!std::ifstream(filename)) { // OpenCV does not say why
    fail(filename, "cannot be opened: " + std::generic_category().message(errno == 0 ? EIO : errno));
  }
  try {
    if (!m_impl->video.open(filename, backend())) {
      fail(filename, "no video that OpenCV can read");
    }
    m_impl->video.set(cv::CAP_PROP_ORIENTATION_AUTO, 0);
    const double rate = m_impl->video.get(cv::CAP_PROP_FPS);
    m_impl->period = std::isfinite(rate) && rate > 0 ? 1 / rate : 1;
  } catch (const cv::Exception &error) {
    fail(filename, "the video cannot be opened: " + error.err);
  }
}

vpVideoSource::~vpVideoSource() = default;

bool vpVideoSource::next(vpVlpFrame &frame)
{
  const std::string name = m_impl->filename + "#" + std::to_string(m_impl->index);
  try {
    if (!m_impl->video.read(m_impl->picture)) {
      return false;
    }
    frame.timestamp = m_impl->timestamp();
    ++m_impl->index;
    if (m_impl->picture.depth() != CV_8U && m_impl->picture.depth() != CV_16U) {
      fail(name, "pixels of type " + cv::typeToString(m_impl->picture.depth()) + ", expected 8 or 16 bits");
    }
    vpGreyOf(m_impl->picture, frame.I);
    frame.name = name;
  } catch (const cv::Exception &error) {
    fail(name, "the frame cannot be read: " + error.err);
  }
  return true;
}

size_t vpVideoSource::size() const
{
  const double count = m_impl->video.get(cv::CAP_PROP_FRAME_COUNT);
  return std::isfinite(count) && count > 0 ? static_cast<size_t>(std::lround(count)) : 0;
}

END_VISP_NAMESPACE
