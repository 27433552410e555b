/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPictures_h
#define vpPictures_h

#include <functional>
#include <string>

#include <image_transport/image_transport.h>
#include <sensor_msgs/CompressedImage.h>
#include <visp3/vlp_core/vpVlpFrame.h>
#include <visp3/vlp_core/vpVlpRig.h>

//! A picture in JPEG or PNG. \throw vpException (badValue) where it is neither.
vpVlpFrame vpDecoded(const sensor_msgs::CompressedImage &image);

/*!
  Pictures of a camera: `camera/image` with `camera/camera_info`, and `camera/image/compressed`, which
  Debian's image_transport has no plugin for, as that plugin names it. What nobody listens to is not made. The
  private parameter `jpeg_quality` (0) is that of the latter, 0 to 100; 0 makes PNG, which loses nothing.
*/
class vpPicturePublisher
{
public:
  vpPicturePublisher(ros::NodeHandle &nh, const ros::NodeHandle &own, const vpVlpRig &rig);

  void publish(const vpVlpFrame &frame);

private:
  image_transport::ImageTransport m_transport;
  image_transport::CameraPublisher m_pictures;
  ros::Publisher m_compressed; // none where image_transport has its own
  sensor_msgs::CameraInfo m_info;
  std::string m_frameId;
  int m_quality;
};

/*!
  Pictures of `camera/image`; with the private parameter `image_transport` (raw) at compressed, of
  `camera/image/compressed`. Of those that come while one is at work the newest is kept. What is wrong with a
  picture is an error line of the log, and it is dropped.
*/
class vpPictureSubscriber
{
public:
  using Use = std::function<void(const vpVlpFrame &, const std_msgs::Header &)>;

  //! \throw vpException (badValue) where the parameter is neither raw nor compressed.
  vpPictureSubscriber(ros::NodeHandle &nh, const ros::NodeHandle &own, const Use &use);

private:
  image_transport::ImageTransport m_transport;
  Use m_use;
  image_transport::Subscriber m_pictures;
  ros::Subscriber m_compressed;
};

#endif
