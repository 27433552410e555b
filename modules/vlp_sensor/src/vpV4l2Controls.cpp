/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_sensor/vpV4l2Device.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <optional>

#include <linux/videodev2.h>

#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

namespace
{
const double exposureUnit = 100e-6; // s

void refuseError(int error, const std::string &doing)
{
  if (error != 0) {
    throw vpException(vpException::ioError, doing + ": " + std::strerror(error));
  }
}

//! A control that exists and is in use, or none. One that an automatism holds is there all the same.
std::optional<v4l2_queryctrl> find(vpV4l2Device &device, std::uint32_t id)
{
  v4l2_queryctrl query = {};
  query.id = id;
  if (device.control(VIDIOC_QUERYCTRL, &query) != 0 || (query.flags & V4L2_CTRL_FLAG_DISABLED) != 0) {
    return std::nullopt;
  }
  return query;
}

std::optional<v4l2_queryctrl> findGain(vpV4l2Device &device)
{
  const std::optional<v4l2_queryctrl> gain = find(device, V4L2_CID_GAIN);
  return gain ? gain : find(device, V4L2_CID_ANALOGUE_GAIN);
}

void write(vpV4l2Device &device, std::uint32_t id, int value, const std::string &what)
{
  v4l2_control control = {id, value};
  refuseError(device.control(VIDIOC_S_CTRL, &control), what);
}

std::optional<int> read(vpV4l2Device &device, std::uint32_t id)
{
  v4l2_control control = {id, 0};
  return device.control(VIDIOC_G_CTRL, &control) == 0 ? std::optional<int>(control.value) : std::nullopt;
}

bool offers(vpV4l2Device &device, std::uint32_t id, int item)
{
  v4l2_querymenu menu = {};
  menu.id = id;
  menu.index = static_cast<std::uint32_t>(item);
  return device.control(VIDIOC_QUERYMENU, &menu) == 0;
}

//! Whatever would change exposure or gain by itself: some cameras have the one, some the other.
void switchAutomaticOff(vpV4l2Device &device)
{
  if (find(device, V4L2_CID_EXPOSURE_AUTO)) {
    const bool manual = offers(device, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL);
    write(device, V4L2_CID_EXPOSURE_AUTO, manual ? V4L2_EXPOSURE_MANUAL : V4L2_EXPOSURE_SHUTTER_PRIORITY,
          "automatic exposure off");
  }
  // Longer exposures in the dark at the cost of the frame rate; automatic gain.
  for (const std::uint32_t id : {V4L2_CID_EXPOSURE_AUTO_PRIORITY, V4L2_CID_AUTOGAIN}) {
    if (find(device, id)) {
      write(device, id, 0, "automatic gain off");
    }
  }
}

//! To the control's nearest step. \param unit Of the control in that of \e value, which is \e unitName.
void setWithin(vpV4l2Device &device, const std::optional<v4l2_queryctrl> &control, const std::string &what,
               double value, double unit, const std::string &unitName)
{
  if (!control) {
    throw vpException(vpException::badValue, what + ": this camera has none to set");
  }
  const double low = unit * control->minimum, high = unit * control->maximum, rounding = 1e-9 * high;
  if (!(value >= low - rounding && value <= high + rounding)) {
    throw vpException(vpException::badValue, "%s: %g%s, expected %g to %g", what.c_str(), value,
                      unitName.c_str(), low, high);
  }
  const int step = std::max(1, static_cast<int>(control->step));
  const int steps = static_cast<int>(std::lround((value - low) / (unit * step)));
  const int nearest = std::min(control->minimum + step * steps, control->maximum);
  write(device, control->id, nearest, what);
}

std::optional<v4l2_fract> timePerFrame(vpV4l2Device &device)
{
  v4l2_streamparm stream = {};
  stream.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  const bool told =
      device.control(VIDIOC_G_PARM, &stream) == 0 && stream.parm.capture.timeperframe.numerator > 0;
  return told ? std::optional<v4l2_fract>(stream.parm.capture.timeperframe) : std::nullopt;
}

void setFrameRate(vpV4l2Device &device, double rate)
{
  static const double fine = 1000; // parts of a hertz
  v4l2_streamparm stream = {};
  stream.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  refuseError(device.control(VIDIOC_G_PARM, &stream), "frame rate");
  if ((stream.parm.capture.capability & V4L2_CAP_TIMEPERFRAME) == 0) {
    throw vpException(vpException::badValue, "frame rate: this camera has none to set");
  }
  stream.parm.capture.timeperframe = {static_cast<std::uint32_t>(fine),
                                      static_cast<std::uint32_t>(std::lround(fine * rate))};
  refuseError(device.control(VIDIOC_S_PARM, &stream), "frame rate");
}
} // namespace

void vpV4l2Controls::set(vpV4l2Device &device, const vpCameraSettings &settings)
{
  switchAutomaticOff(device);
  if (settings.frameRate) { // first: it bounds the exposure
    setFrameRate(device, *settings.frameRate);
  }
  if (settings.exposure) {
    setWithin(device, find(device, V4L2_CID_EXPOSURE_ABSOLUTE), "exposure", *settings.exposure, exposureUnit,
              " s");
  }
  if (settings.gain) {
    setWithin(device, findGain(device), "gain", *settings.gain, 1, "");
  }
}

vpCameraSettings vpV4l2Controls::get(vpV4l2Device &device)
{
  vpCameraSettings settings;
  if (const std::optional<int> exposure = read(device, V4L2_CID_EXPOSURE_ABSOLUTE)) {
    settings.exposure = exposureUnit * *exposure;
  }
  if (const std::optional<v4l2_queryctrl> gain = findGain(device)) {
    settings.gain = read(device, gain->id);
  }
  if (const std::optional<v4l2_fract> time = timePerFrame(device)) {
    settings.frameRate = static_cast<double>(time->denominator) / time->numerator;
  }
  v4l2_format format = {};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (device.control(VIDIOC_G_FMT, &format) == 0) {
    settings.region = {0, 0, format.fmt.pix.width, format.fmt.pix.height};
  }
  return settings;
}

std::string vpV4l2Controls::abilities(vpV4l2Device &device)
{
  std::string text;
  auto add = [&text](const char *what, const std::optional<v4l2_queryctrl> &control, double unit,
                     const char *unitName) {
    char line[100];
    if (control) {
      std::snprintf(line, sizeof(line), "%s%s %g to %g%s", text.empty() ? "" : ", ", what,
                    unit * control->minimum, unit * control->maximum, unitName);
      text += line;
    }
  };
  add("exposure", find(device, V4L2_CID_EXPOSURE_ABSOLUTE), 1e6 * exposureUnit, " us");
  add("gain", findGain(device), 1, "");
  v4l2_fmtdesc format = {};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  for (; device.control(VIDIOC_ENUM_FMT, &format) == 0; ++format.index) {
    text += (text.empty() ? "" : ", ") + std::string(reinterpret_cast<const char *>(format.description));
  }
  return text;
}

END_VISP_NAMESPACE
