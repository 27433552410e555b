/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_sensor/vpCameraSource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpHostTime.h>

#include "vpCameraKinds.h"

BEGIN_VISP_NAMESPACE

namespace
{
const double atOnce = 0.05; // s, that a driver waits at a time

std::vector<vpCameraKind> kinds()
{
  return {vpAravisKind(), vpV4l2Kind(), vpUvcKind(), vpMindVisionKind()};
}

void sleepFor(double seconds)
{
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

vpCameraSource::Opener openerOf(const std::string &uri)
{
  static const std::string separator = "://";
  const size_t at = uri.find(separator);
  std::string known;
  for (const vpCameraKind &kind : kinds()) {
    if (at != std::string::npos && kind.scheme == uri.substr(0, at)) {
      if (!kind.library.empty()) {
        throw vpException(vpException::badValue, uri + ": this build lacks " + kind.scheme +
                                                     " cameras, expected it built with " + kind.library);
      }
      const std::string address = uri.substr(at + separator.size());
      return
          [open = kind.open, address](const vpCameraSettings &settings) { return open(address, settings); };
    }
    known += (known.empty() ? "" : ", ") + kind.scheme + separator;
  }
  throw vpException(vpException::badValue, "camera: " + uri + ", expected one of " + known + " with a name");
}

[[noreturn]] void refuse(const std::string &field, double value, const std::string &expected)
{
  throw vpException(vpException::badValue, "%s: %g, expected %s", field.c_str(), value, expected.c_str());
}
} // namespace

void vpCameraSettings::check() const
{
  auto positive = [](const std::string &field, const std::optional<double> &value, const char *unit) {
    if (value && !(std::isfinite(*value) && *value > 0)) {
      refuse(field, *value, std::string("a number above 0, ") + unit);
    }
  };
  positive("exposure", exposure, "s");
  positive("frame rate", frameRate, "Hz");
  if (gain && !(std::isfinite(*gain) && *gain >= 0)) {
    refuse("gain", *gain, "0 or more");
  }
  if (region && (region->width == 0 || region->height == 0)) {
    throw vpException(vpException::badValue, "region: %u x %u pixels, expected 1 or more each way",
                      region->width, region->height);
  }
}

std::string vpCameraCounters::text() const
{
  std::string text;
  auto add = [&text](std::uint64_t count, const std::string &what) {
    if (count > 0) {
      text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
    }
  };
  add(dropped, "dropped on the way");
  add(broken, "broken");
  add(late, "late (a newer one was there)");
  add(reconnects, reconnects == 1 ? "reconnection" : "reconnections");
  return text.empty() ? "" : "of the camera's frames " + std::to_string(delivered) + " delivered, " + text;
}

vpCameraSource::vpCameraSource(const std::string &uri, const vpCameraSettings &settings,
                               const vpCameraPatience &patience)
    : vpCameraSource(uri, openerOf(uri), settings, patience)
{
}

vpCameraSource::vpCameraSource(const std::string &name, Opener opener, const vpCameraSettings &settings,
                               const vpCameraPatience &patience)
    : m_name(name), m_opener(std::move(opener)), m_asked(settings), m_patience(patience)
{
  settings.check();
  if (!m_patience.clock) {
    m_patience.clock = vpHostTime;
  }
  connect();
}

vpCameraSource::~vpCameraSource() = default;

//! Somebody who held the camera a moment ago, killed perhaps, is given the time to let go of it.
void vpCameraSource::connect()
{
  for (const double until = m_patience.clock() + m_patience.opening; !m_driver;) {
    try {
      m_driver = m_opener(m_asked);
    } catch (const vpException &error) {
      if (error.getCode() != vpException::ioError || m_patience.clock() > until || stopped()) {
        throw vpException(error.getCode(), m_name + ": " + error.getStringMessage());
      }
      sleepFor(std::min(0.2, m_patience.betweenTries));
    }
  }
  begin();
}

void vpCameraSource::begin()
{
  m_lastFrame = m_patience.clock();
  const std::optional<double> rate = m_driver->settings().frameRate;
  m_period = rate && *rate > 0 ? 1 / *rate : 0;
}

bool vpCameraSource::reconnect()
{
  if (m_patience.clock() - m_lastTry < m_patience.betweenTries) {
    return false;
  }
  try {
    m_driver = m_opener(m_asked);
    begin();
    ++m_counters.reconnects;
  } catch (const vpException &) { // not back yet, and told once
    m_driver.reset();
    m_lastTry = m_patience.clock();
  }
  return m_driver != nullptr;
}

void vpCameraSource::lose(const std::string &reason)
{
  m_driver.reset();
  m_lastTry = m_patience.clock();
  throw vpException(vpException::ioError, m_name + ": " + reason + "; waiting for it to come back");
}

bool vpCameraSource::next(vpVlpFrame &frame)
{
  while (!stopped()) {
    if (!m_driver && !reconnect()) {
      sleepFor(atOnce);
      continue;
    }
    bool came = false;
    try {
      came = m_driver->grab(atOnce, m_patience.clock, frame, m_counters);
    } catch (const vpException &error) {
      lose(error.getStringMessage());
    }
    const double now = m_patience.clock();
    if (came) {
      m_lastFrame = now;
      frame.name = m_name + "#" + std::to_string(m_counters.delivered++);
      return true;
    }
    if (const double silent = now - m_lastFrame; silent > std::max(m_patience.silence, 5 * m_period)) {
      lose("no frame for " + std::to_string(std::lround(1e3 * silent)) + " ms");
    }
  }
  return false;
}

void vpCameraSource::set(const vpCameraSettings &settings)
{
  settings.check();
  if (settings.region) {
    throw vpException(vpException::badValue,
                      m_name + ": region of a camera that is taking pictures, expected it when "
                               "the camera is opened");
  }
  if (m_driver) {
    m_driver->set(settings);
  }
  m_asked.exposure = settings.exposure ? settings.exposure : m_asked.exposure;
  m_asked.gain = settings.gain ? settings.gain : m_asked.gain;
  m_asked.frameRate = settings.frameRate ? settings.frameRate : m_asked.frameRate;
}

vpCameraSettings vpCameraSource::settings() const
{
  return m_driver ? m_driver->settings() : vpCameraSettings();
}

bool vpCameraSource::isUri(const std::string &text)
{
  const std::vector<vpCameraKind> all = kinds();
  return std::any_of(all.begin(), all.end(),
                     [&text](const vpCameraKind &kind) { return text.rfind(kind.scheme + "://", 0) == 0; });
}

std::vector<vpCameraDescription> vpCameraSource::list(std::vector<std::string> &missing)
{
  std::vector<vpCameraDescription> cameras;
  for (const vpCameraKind &kind : kinds()) {
    if (!kind.library.empty()) {
      missing.push_back(kind.scheme + "://: this build lacks it, expected " + kind.library);
      continue;
    }
    try {
      for (vpCameraDescription &camera : kind.list()) {
        cameras.push_back(std::move(camera));
      }
    } catch (const vpException &error) {
      missing.push_back(kind.scheme + "://: " + error.getStringMessage());
    }
  }
  return cameras;
}

END_VISP_NAMESPACE
