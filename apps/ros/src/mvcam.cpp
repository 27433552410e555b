/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The paper's node mvcam: a camera, on ROS. Beside each picture go camera_info and, latched, the shutter's
// times.

#include <memory>
#include <optional>
#include <string>

#include <visp3/core/vpException.h>
#include <visp3/vlp_sensor/vpCameraSource.h>
#include <visp3/vlp_sensor/vpPictureSequence.h>
#include <visp3/vlp_sensor/vpResizedSource.h>

#include "vpPictures.h"
#include "vpRosMessages.h"
#include "vpRosNode.h"

namespace
{
/*!
  The camera of the private parameters. `exposure` (s) and `gain` may be set while it runs: they are read
  again once a second. What the camera refuses is an error line, and it goes on as before.
*/
class LiveCamera : public vpFrameSource
{
public:
  LiveCamera(ros::NodeHandle &nh, const ros::NodeHandle &own, const std::string &uri, const vpVlpRig &rig)
      : m_own(own), m_shutter(rig.shutter),
        m_topic(nh.advertise<visp_vlp::RollingShutter>("camera/rolling_shutter", 1, true))
  {
    const bool resized = rig.resize.method != vpPictureResize::Method::none;
    vpCameraSettings settings = asked();
    double rate = 0; // Hz
    if (own.getParam("rate", rate)) {
      settings.frameRate = rate;
    }
    settings.region = vpCameraRegion{0, 0, resized ? rig.resize.sourceWidth : rig.width,
                                     resized ? rig.resize.sourceHeight : rig.height};
    vpCameraPatience patience;
    patience.clock = [] { return ros::Time::now().toSec(); };
    patience.stop = [] { return !ros::ok(); };
    auto camera = std::make_unique<vpCameraSource>(uri, settings, patience);
    m_camera = camera.get();
    m_frames = std::move(camera);
    if (resized) {
      m_frames = std::make_unique<vpResizedSource>(std::move(m_frames), rig);
    }
    tell(settings);
  }

  bool next(vpVlpFrame &frame) override
  {
    if (ros::Time::now() - m_read > ros::Duration(1)) {
      m_read = ros::Time::now();
      const vpCameraSettings settings = asked();
      if (settings.exposure != m_told.exposure || settings.gain != m_told.gain) {
        vpHandle([&] { m_camera->set(settings); });
        tell(settings);
      }
    }
    return m_frames->next(frame);
  }

private:
  vpCameraSettings asked() const
  {
    vpCameraSettings settings;
    settings.exposure = m_own.param("exposure", m_shutter.exposure);
    double gain = 0;
    if (m_own.getParam("gain", gain)) {
      settings.gain = gain;
    }
    return settings;
  }

  void tell(const vpCameraSettings &settings)
  {
    m_told = settings;
    vpRollingShutter shutter = m_shutter;
    shutter.exposure = m_camera->settings().exposure.value_or(*settings.exposure);
    m_topic.publish(vpRosMessages::rollingShutter(shutter));
  }

  ros::NodeHandle m_own;
  vpRollingShutter m_shutter; // of the rig
  ros::Publisher m_topic;
  std::unique_ptr<vpFrameSource> m_frames;
  vpCameraSource *m_camera = nullptr; // at the bottom of m_frames
  vpCameraSettings m_told;
  ros::Time m_read; // the parameters
};

//! Frames of a recording come at the rate at which they were taken, with the times of now.
class Replay : public vpFrameSource
{
public:
  explicit Replay(const std::string &run) : m_frames(vpPictureSequence::fromRun(run)) {}

  bool next(vpVlpFrame &frame) override
  {
    if (!m_frames.next(frame)) {
      return false;
    }
    const double now = ros::Time::now().toSec();
    if (!m_shift) {
      m_shift = now - frame.timestamp;
    }
    frame.timestamp += *m_shift;
    if (frame.timestamp > now) {
      ros::Duration(frame.timestamp - now).sleep();
    }
    return true;
  }

private:
  vpPictureSequence m_frames;
  std::optional<double> m_shift; // s
};

void run()
{
  ros::NodeHandle nh, own("~");
  const vpVlpRig rig = vpRigParameter(own);
  const std::string name =
      vpRequiredParameter(own, "camera", "a camera as v4l2:///dev/video0, or a run's folder");
  std::unique_ptr<vpFrameSource> camera;
  if (vpCameraSource::isUri(name)) {
    camera = std::make_unique<LiveCamera>(nh, own, name, rig);
  } else {
    camera = std::make_unique<Replay>(name);
  }
  vpPicturePublisher pictures(nh, own, rig);
  vpVlpFrame frame;
  while (ros::ok()) {
    try {
      if (!camera->next(frame)) {
        break;
      }
    } catch (const vpException &error) { // about one frame
      ROS_WARN_THROTTLE(1, "%s", error.what());
      continue;
    }
    pictures.publish(frame);
    ros::spinOnce();
  }
}
} // namespace

int main(int argc, char **argv)
{
  return vpRunNode(argc, argv, "mvcam", run);
}
