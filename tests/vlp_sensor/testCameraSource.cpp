/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What vpCameraSource makes of any camera: it waits, counts, connects anew, and never repeats a frame.

#include <deque>

#include <gtest/gtest.h>
#include <visp3/vlp_sensor/vpCameraSource.h>

#include "common/vpExpectError.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
//! A camera that goes by a script: 'f' a frame, '-' none yet, 'x' it is gone; then none for ever.
struct Script {
  std::deque<std::string> connections; // one for each time that it is opened; "" cannot be opened
  std::vector<vpCameraSettings> opened;
  double now = 0; // s

  vpCameraPatience patience()
  {
    vpCameraPatience patience;
    patience.clock = [this] { return now += 0.01; }; // asking takes a little
    patience.betweenTries = 0.1;
    patience.opening = 0.3;
    patience.silence = 0.5;
    return patience;
  }
};

class ScriptedCamera : public vpCameraDriver
{
public:
  ScriptedCamera(Script &script, std::string frames) : m_script(script), m_frames(std::move(frames)) {}

  bool grab(double patience, const std::function<double()> &clock, vpVlpFrame &frame,
            vpCameraCounters &counters) override
  {
    const char next = m_at < m_frames.size() ? m_frames[m_at++] : '-';
    if (next == 'x') {
      throw vpException(vpException::ioError, "unplugged");
    }
    if (next == 'f') {
      frame.timestamp = clock();
      counters.dropped += 2;
      return true;
    }
    m_script.now += patience;
    return false;
  }
  void set(const vpCameraSettings &settings) override { m_settings = settings; }
  vpCameraSettings settings() const override { return m_settings; }

private:
  Script &m_script;
  std::string m_frames;
  size_t m_at = 0;
  vpCameraSettings m_settings;
};

vpCameraSource::Opener opener(Script &script)
{
  return [&script](const vpCameraSettings &settings) -> std::unique_ptr<vpCameraDriver> {
    const std::string frames = script.connections.empty() ? "" : script.connections.front();
    if (!script.connections.empty()) {
      script.connections.pop_front();
    }
    if (frames.empty()) {
      throw vpException(vpException::ioError, "busy");
    }
    script.opened.push_back(settings);
    return std::make_unique<ScriptedCamera>(script, frames);
  };
}
} // namespace

TEST(CameraSource, ALostCameraIsToldOnceAndComesBackWithItsSettings)
{
  Script script;
  script.connections = {"ffx", "", "", "f"};
  vpCameraSettings asked;
  asked.exposure = 1e-3;
  vpCameraSource camera("mine", opener(script), asked, script.patience());
  asked.exposure = 2e-3;
  camera.set(asked);
  vpVlpFrame frame;
  ASSERT_TRUE(camera.next(frame));
  EXPECT_EQ(frame.name, "mine#0");
  ASSERT_TRUE(camera.next(frame));
  vpExpectError([&] { camera.next(frame); }, {"mine: unplugged", "waiting for it to come back"});
  EXPECT_FALSE(camera.connected());
  EXPECT_FALSE(camera.settings().exposure);
  ASSERT_TRUE(camera.next(frame));
  EXPECT_EQ(frame.name, "mine#2");
  EXPECT_EQ(camera.counters().reconnects, 1u);
  EXPECT_EQ(camera.counters().delivered, 3u);
  EXPECT_EQ(camera.remark(), "of the camera's frames 3 delivered, 6 dropped on the way, 1 reconnection");
  ASSERT_EQ(script.opened.size(), 2u);
  EXPECT_EQ(*script.opened.back().exposure, 2e-3);
}

TEST(CameraSource, ASilentCameraIsLost)
{
  Script script;
  script.connections = {"f"};
  vpCameraSource camera("mine", opener(script), {}, script.patience());
  vpVlpFrame frame;
  ASSERT_TRUE(camera.next(frame));
  const double before = script.now;
  vpExpectError([&] { camera.next(frame); }, {"mine: no frame for "});
  EXPECT_GT(script.now - before, 0.5);
  EXPECT_LT(script.now - before, 0.7);
}

TEST(CameraSource, OneThatSomebodyLetsGoOfInTimeIsOpened)
{
  Script script;
  script.connections = {"", "", "f"};
  vpVlpFrame frame;
  EXPECT_TRUE(vpCameraSource("mine", opener(script), {}, script.patience()).next(frame));
  script.connections.clear();
  vpExpectError([&] { vpCameraSource("mine", opener(script), {}, script.patience()); }, {"mine: busy"});
}

TEST(CameraSource, TheWaitCanBeEnded)
{
  Script script;
  script.connections = {"f"};
  vpCameraPatience patience = script.patience();
  int asked = 0;
  patience.stop = [&asked] { return ++asked > 3; };
  vpCameraSource camera("mine", opener(script), {}, patience);
  vpVlpFrame frame;
  EXPECT_TRUE(camera.next(frame));
  EXPECT_FALSE(camera.next(frame));
}

TEST(CameraSource, BadSettings)
{
  Script script;
  auto open = [&script](const vpCameraSettings &settings) {
    return [&script, settings] { vpCameraSource("mine", opener(script), settings, script.patience()); };
  };
  vpCameraSettings settings;
  settings.exposure = -1;
  vpExpectError(open(settings), {"exposure: -1", "above 0, s"});
  settings.exposure = std::numeric_limits<double>::quiet_NaN();
  vpExpectError(open(settings), {"exposure: nan"});
  settings = {};
  settings.frameRate = 0;
  vpExpectError(open(settings), {"frame rate: 0", "Hz"});
  settings = {};
  settings.region = vpCameraRegion{0, 0, 0, 5};
  vpExpectError(open(settings), {"region: 0 x 5"});
  EXPECT_TRUE(script.opened.empty());
}

TEST(CameraSource, Uris)
{
  EXPECT_TRUE(vpCameraSource::isUri("aravis://"));
  EXPECT_TRUE(vpCameraSource::isUri("v4l2:///dev/video0"));
  EXPECT_FALSE(vpCameraSource::isUri("http://camera"));
  EXPECT_FALSE(vpCameraSource::isUri("run/frames"));
  vpExpectError([] { vpCameraSource("http://camera", vpCameraSettings()); },
                {"camera: http://camera", "aravis://, v4l2://, uvc://, mindvision://"});
  vpCameraPatience patience;
  patience.opening = 0;
  vpExpectError([&] { vpCameraSource("v4l2:///dev/no-video", {}, patience); },
                {"v4l2:///dev/no-video: cannot be opened"});
  vpExpectError([&] { vpCameraSource("v4l2:///dev/null", {}, patience); }, {"v4l2:///dev/null: no camera"});
}
