/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The paper's node mvcam: a camera, on ROS. Beside each picture go camera_info and, latched, the shutter's
// times.

#include <memory>
#include <optional>

#include <visp3/core/vpException.h>
#include <visp3/vlp_sensor/vpCameraSource.h>
#include <visp3/vlp_sensor/vpPictureSequence.h>
#include <visp3/vlp_sensor/vpResizedSource.h>

#include "vpPictures.h"
#include "vpRosMessages.h"
#include "vpRosNode.h"

namespace
{
//! What the private parameters say: a camera, or the folder of a run, whose frames get the time of now.
std::unique_ptr<vpFrameSource> open(const ros::NodeHandle &own, const vpVlpRig &rig)
{
  const std::string uri =
      vpRequiredParameter(own, "camera", "a camera as v4l2:///dev/video0, or a run's folder");
  if (!vpCameraSource::isUri(uri)) {
    return std::make_unique<vpPictureSequence>(vpPictureSequence::fromRun(uri));
  }
  const bool resized = rig.resize.method != vpPictureResize::Method::none;
  vpCameraSettings settings;
  settings.exposure = own.param("exposure", rig.shutter.exposure); // s
  double value = 0;
  if (own.getParam("gain", value)) {
    settings.gain = value;
  }
  if (own.getParam("rate", value)) {
    settings.frameRate = value; // Hz
  }
  settings.region = vpCameraRegion{0, 0, resized ? rig.resize.sourceWidth : rig.width,
                                   resized ? rig.resize.sourceHeight : rig.height};
  vpCameraPatience patience;
  patience.clock = [] { return ros::Time::now().toSec(); };
  patience.stop = [] { return !ros::ok(); };
  std::unique_ptr<vpFrameSource> camera = std::make_unique<vpCameraSource>(uri, settings, patience);
  if (resized) {
    camera = std::make_unique<vpResizedSource>(std::move(camera), rig);
  }
  return camera;
}

//! Frames of a recording come at the rate at which they were taken, with the times of now.
class Replay
{
public:
  void wait(vpVlpFrame &frame)
  {
    const double now = ros::Time::now().toSec();
    if (!m_shift) {
      m_shift = now - frame.timestamp;
    }
    frame.timestamp += *m_shift;
    if (frame.timestamp > now) {
      ros::Duration(frame.timestamp - now).sleep();
    }
  }

private:
  std::optional<double> m_shift; // s
};

void run()
{
  ros::NodeHandle nh, own("~");
  const vpVlpRig rig = vpRigParameter(own);
  const bool live = vpCameraSource::isUri(own.param<std::string>("camera", ""));
  const std::unique_ptr<vpFrameSource> camera = open(own, rig);
  Replay replay;
  ros::Publisher shutter = nh.advertise<visp_vlp::RollingShutter>("camera/rolling_shutter", 1, true);
  shutter.publish(vpRosMessages::rollingShutter(rig.shutter));
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
    if (!live) {
      replay.wait(frame);
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
